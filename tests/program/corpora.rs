//! The readers of files on the inputs that fuzzing has collected, and on damaged copies of them.
//! `fuzz/README.md` describes how the inputs were found.

#[path = "../../fuzz/src/lib.rs"]
mod targets;

use proptest::test_runner::{RngAlgorithm, TestRng};
use std::path::{Path, PathBuf};

/// The inputs of one target, by name: those that were found, and the project's own files of this
/// kind.
fn corpus(target: &str) -> Vec<(PathBuf, Vec<u8>)> {
    let own = match target {
        "case" | "study" => "cases",
        "design" | "sweep" => "examples",
        "gates" => "src/study/gates",
        _ => "",
    };
    let found = format!("fuzz/corpus/{target}");
    let folders = [found.as_str(), own].map(|f| Path::new(env!("CARGO_MANIFEST_DIR")).join(f));
    let used =
        folders.iter().zip([&*found, own]).filter(|(path, f)| !f.is_empty() && path.exists());
    let mut inputs: Vec<(PathBuf, Vec<u8>)> = used
        .flat_map(|(path, _)| std::fs::read_dir(path).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_file())
        .map(|path| (path.clone(), std::fs::read(path).unwrap()))
        .collect();
    inputs.sort();
    assert!(!inputs.is_empty(), "there is no input for {target}");
    inputs
}

/// A copy with some bytes changed, taken out, or put in from elsewhere.
fn damaged(input: &[u8], random: &mut impl FnMut(usize) -> usize) -> Vec<u8> {
    const PIECES: [&[u8]; 12] = [
        b"-",
        b"nan",
        b"1e999",
        b"\"",
        b"\n",
        b",",
        b"[",
        b"{",
        b"0x7f",
        b"\xef\xbb\xbf",
        b"99999999999999999999",
        b"",
    ];
    let mut bytes = input.to_vec();
    for _ in 0..1 + random(4) {
        let at = random(bytes.len() + 1);
        let end = (at + random(8)).min(bytes.len());
        bytes.splice(at..end, PIECES[random(PIECES.len())].iter().copied());
    }
    if random(8) == 0 {
        bytes.truncate(random(bytes.len() + 1));
    }
    bytes
}

/// Runs `target` on all its inputs, and on damaged copies of each.
fn run(target: &str, check: fn(&[u8])) {
    use proptest::prelude::RngCore;
    let mut rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let mut random = |below: usize| (rng.next_u64() % below.max(1) as u64) as usize;
    for (path, input) in corpus(target) {
        let hand = |bytes: &[u8]| {
            let caught = std::panic::catch_unwind(|| check(bytes));
            assert!(caught.is_ok(), "{path:?}, as {:?}", String::from_utf8_lossy(bytes));
        };
        hand(&input);
        for _ in 0..COPIES {
            hand(&damaged(&input, &mut random));
        }
    }
}

/// Damaged copies of each input: some seconds of all targets together.
const COPIES: usize = 1000;

macro_rules! targets {
    ($($target:ident)*) => {
        $(
            #[test]
            fn $target() {
                run(stringify!($target), targets::$target);
            }
        )*

        #[test]
        fn every_target_is_run() {
            let listed = [$(stringify!($target)),*];
            let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/fuzz_targets");
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                assert!(listed.contains(&path.file_stem().unwrap().to_str().unwrap()), "{path:?}");
            }
        }
    };
}

targets! { case study sweep table points fem_result mesh record brought heights design gates }
