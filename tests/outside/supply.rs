//! The dependencies: built by the oldest supported compiler and from one registry; and unsafe code
//! in one place only. `deny.toml` has the rules on licences.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The packages that are built on this machine, tests included, as cargo knows them.
fn packages() -> Vec<Value> {
    let run = |program: &str, arguments: &[&str]| {
        let done = Command::new(program).args(arguments).current_dir(root()).output().unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        String::from_utf8(done.stdout).unwrap()
    };
    let rustc = run("rustc", &["-vV"]);
    let host = rustc.lines().find_map(|l| l.strip_prefix("host: ")).unwrap();
    // Those of the Python package, which other tests do not need, are fetched where they are
    // missing.
    let arguments = ["metadata", "--format-version", "1", "--locked"];
    let text = run(env!("CARGO"), &[&arguments[..], &["--filter-platform", host]].concat());
    let metadata: Value = serde_json::from_str(&text).unwrap();
    let nodes = metadata["resolve"]["nodes"].as_array().unwrap();
    let built = |package: &&Value| nodes.iter().any(|node| node["id"] == package["id"]);
    metadata["packages"].as_array().unwrap().iter().filter(built).cloned().collect()
}

/// A version of Rust as numbers that compare.
fn version(text: &str) -> Vec<u32> {
    text.split('.').take(2).map(|part| part.parse().unwrap()).collect()
}

/// The oldest supported compiler, by `Cargo.toml`.
const OLDEST: &str = env!("CARGO_PKG_RUST_VERSION");

#[test]
fn dependencies_build_with_the_oldest_supported_compiler() {
    let packages = packages();
    assert!(packages.len() > 100, "only {} packages", packages.len());
    for package in &packages {
        let name = format!("{} {}", package["name"], package["version"]);
        if let Some(needed) = package["rust_version"].as_str() {
            assert!(version(needed) <= version(OLDEST), "{name} needs Rust {needed}, not {OLDEST}");
        }
        let source = package["source"].as_str();
        let registry = "registry+https://github.com/rust-lang/crates.io-index";
        assert!(source.is_none_or(|s| s == registry), "{name} comes from {source:?}");
    }
}

#[test]
fn the_oldest_supported_compiler_is_the_same_everywhere() {
    for (file, wanted) in [
        ("README.md", format!("need Rust {OLDEST}")),
        ("tests/all.sh", format!("install Rust {OLDEST} or newer")),
        (".github/workflows/accuracy.yml", format!("rustup toolchain install {OLDEST}")),
        (".github/workflows/accuracy.yml", format!("cargo +{OLDEST} ")),
    ] {
        let text = fs::read_to_string(root().join(file)).unwrap();
        assert!(text.contains(&wanted), "{file} does not say \"{wanted}\"");
    }
}

#[test]
fn the_version_is_the_same_everywhere() {
    let version = env!("CARGO_PKG_VERSION");
    for (file, wanted) in [
        ("python/Cargo.toml", format!("\nversion = \"{version}\"\n")),
        ("CITATION.cff", format!("\nversion: {version}\n")),
        ("CHANGELOG.md", format!("\n## {version} - ")),
    ] {
        let text = fs::read_to_string(root().join(file)).unwrap();
        assert!(text.contains(&wanted), "{file} does not say {wanted:?}");
    }
}

#[test]
fn unsafe_code_stands_in_one_place() {
    let mut files: Vec<PathBuf> = Vec::new();
    let mut folders = vec![root().join("src")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                files.push(path);
            }
        }
    }
    let names = |needle: &str| -> Vec<String> {
        let found = files.iter().filter(|p| fs::read_to_string(p).unwrap().contains(needle));
        let mut names: Vec<String> = found
            .map(|p| p.strip_prefix(root().join("src")).unwrap().display().to_string())
            .collect();
        names.sort();
        names
    };
    // The compiler refuses unsafe code elsewhere, unless something else allows it.
    assert_eq!(names("deny(unsafe_code)"), ["lib.rs"]);
    assert_eq!(names("forbid(unsafe_code)"), ["main.rs"]);
    assert_eq!(names("allow(unsafe_code)"), ["host/system.rs"]);
}
