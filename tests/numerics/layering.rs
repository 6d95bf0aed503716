//! Modules import only modules above them in the list of layers at the head of `src/lib.rs`, no two
//! files import each other, directly or in a circle, and comments fit the page.

use crate::imports::Sources;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The layers, top first, as the table in the crate's documentation lists them.
fn layers(lib: &str) -> Vec<String> {
    lib.lines()
        .filter_map(|line| line.strip_prefix("//! | ")?.trim_start_matches('[').strip_prefix('`'))
        .map(|rest| rest.split('`').next().expect("split yields one piece at least").to_string())
        .collect()
}

/// Imports against the direction: a file, and the file of a lower layer that it imports.
fn violations(layers: &[String], sources: &Sources) -> Vec<(PathBuf, PathBuf)> {
    let rank = |file: &Path| {
        let top = file.iter().next().expect("a path is not empty");
        let top = top.to_str().expect("names are ASCII").trim_end_matches(".rs");
        layers.iter().position(|layer| layer == top)
    };
    let against =
        |(from, to): &(&Path, &Path)| matches!((rank(from), rank(to)), (Some(a), Some(b)) if a < b);
    let found = sources.imports().into_iter().filter(against);
    found.map(|(from, to)| (from.into(), to.into())).collect()
}

/// Sets of files that import each other, directly or through others.
fn circles(sources: &Sources) -> BTreeSet<BTreeSet<PathBuf>> {
    let imports = sources.imports();
    let reached = |from| {
        let (mut reached, mut open) = (BTreeSet::new(), vec![from]);
        while let Some(file) = open.pop() {
            let next = imports.iter().filter(|(from, _)| *from == file).map(|(_, to)| *to);
            open.extend(next.filter(|to| reached.insert(*to)));
        }
        reached
    };
    let reach: BTreeMap<&Path, BTreeSet<&Path>> =
        sources.files().into_iter().map(|file| (file, reached(file))).collect();
    let mutual = |file: &Path| -> BTreeSet<PathBuf> {
        let back = reach[file].iter().filter(|other| reach[**other].contains(file));
        back.map(|other| other.to_path_buf()).collect()
    };
    reach.keys().map(|file| mutual(file)).filter(|circle| !circle.is_empty()).collect()
}

/// All Rust sources below `folder`, by their paths relative to `root`.
fn texts(folder: &Path, root: &Path, into: &mut BTreeMap<PathBuf, String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            texts(&path, root, into);
        } else if path.extension().is_some_and(|e| e == "rs") {
            let relative = path.strip_prefix(root).unwrap().to_path_buf();
            into.insert(relative, fs::read_to_string(&path).unwrap());
        }
    }
}

/// The sources of this crate, and their texts.
fn own() -> (Sources, BTreeMap<PathBuf, String>) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut all = BTreeMap::new();
    texts(&root, &root, &mut all);
    (Sources::new(&all), all)
}

#[test]
fn no_module_imports_one_below_it() {
    let (sources, texts) = own();
    let lib = &texts[Path::new("lib.rs")];
    let layers = layers(lib);
    let declared: Vec<&str> = lib
        .lines()
        .filter_map(|line| line.trim_start_matches("pub ").strip_prefix("mod ")?.strip_suffix(';'))
        .collect();
    assert_eq!(layers, declared, "the table of layers lists the modules in their order");
    let found = violations(&layers, &sources);
    assert!(found.is_empty(), "imports against the direction: {found:#?}");
}

#[test]
fn no_files_import_each_other() {
    let (sources, texts) = own();
    // All files apart from the program's main file and those that only tests declare.
    let (read, imports) = (sources.files().len(), sources.imports().len());
    assert!(10 * read > 9 * texts.len() && imports > 2 * read, "{read} files, {imports} imports");
    let found = circles(&sources);
    for circle in &found {
        for (from, to) in sources.imports() {
            if circle.contains(from) && circle.contains(to) {
                println!("{} imports {}", from.display(), to.display());
            }
        }
    }
    assert!(found.is_empty(), "files that import each other: {found:#?}");
}

/// The formatter breaks code, and no comments.
#[test]
fn comments_keep_to_the_width_of_the_code() {
    const WIDTH: usize = 100;
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut all = BTreeMap::new();
    for folder in ["src", "tests", "benches", "examples", "python/src"] {
        texts(&root.join(folder), root, &mut all);
    }
    assert!(all.len() > 300, "{} files", all.len());
    let is_long = |line: &&str| line.trim_start().starts_with("//") && line.chars().count() > WIDTH;
    let long: Vec<String> = all
        .iter()
        .flat_map(|(path, text)| {
            text.lines().filter(is_long).map(move |line| format!("{path:?}: {line}"))
        })
        .collect();
    assert!(long.is_empty(), "comments beyond {WIDTH} characters: {long:#?}");
}

/// Sources from pairs of path and text; a file that no text of them declares is not read.
fn planted(files: &[(&str, &str)]) -> Sources {
    Sources::new(&files.iter().map(|(path, text)| (path.into(), text.to_string())).collect())
}

#[test]
fn planted_violations_are_found() {
    let layers: Vec<String> = ["base", "kernels", "body", "cli"].map(String::from).to_vec();
    let all = [
        ("lib.rs", "pub mod base; pub mod kernels; pub mod body; pub mod cli;"),
        ("kernels.rs", "pub fn love() {}"),
        ("body/mod.rs", "mod model; pub use model::{A, EdgeModel}; pub struct B;"),
        ("body/model.rs", "pub struct A; pub enum EdgeModel { C }"),
        ("cli/mod.rs", "pub fn run() {}"),
    ];
    for (path, text, wanted) in [
        ("base/error.rs", "use crate::body::EdgeModel;", vec!["body/model.rs"]),
        ("base/error.rs", "fn f() { crate::cli::run() }", vec!["cli/mod.rs"]),
        (
            "base/error.rs",
            "use crate::{base::Error, body::{A, B}, cli};",
            vec!["body/mod.rs", "body/model.rs", "cli/mod.rs"],
        ),
        (
            "base/mod.rs",
            "use crate::{\n    kernels as k,\n}; fn f() { k::love() }",
            vec!["kernels.rs"],
        ),
        ("base/mod.rs", "use super::body;", vec!["body/mod.rs"]),
        ("base/error.rs", "use super::super::{body};", vec!["body/mod.rs"]),
        ("base/error.rs", "use super::body;", vec![]),
        ("base/mod.rs", "pub use crate::body::B as D;", vec!["body/mod.rs"]),
        ("base/mod.rs", "mod inner { use super::super::cli::run; }", vec!["cli/mod.rs"]),
        ("base/mod.rs", "#[cfg(test)] mod tests { use crate::cli; }", vec![]),
        (
            "base/mod.rs",
            "//! see [`crate::cli`]\n/* crate::cli */ const S: &str = \"crate::cli\";",
            vec![],
        ),
        ("base/mod.rs", "const S: &str = \"\\\"\"; use crate::cli;", vec!["cli/mod.rs"]),
        ("base/mod.rs", "const S: &str = r#\"\"crate::cli\"#; const C: char = '\"';", vec![]),
        ("base/mod.rs", "fn f<'a>(c: &'a str) { crate::cli::run() }", vec!["cli/mod.rs"]),
    ] {
        let base = match path {
            "base/mod.rs" => text.to_string(),
            _ => "mod error;".to_string(),
        };
        let mut files = all.to_vec();
        files.extend([("base/mod.rs", base.as_str()), (path, text)]);
        let found = violations(&layers, &planted(&files));
        let found: Vec<&str> = found.iter().map(|(_, to)| to.to_str().unwrap()).collect();
        assert_eq!(found, wanted, "{path}: {text}");
    }
}

#[test]
fn planted_circles_are_found() {
    const BOTH: &[&str] = &["m/a.rs", "m/b.rs"];
    for (module, one, other, wanted) in [
        ("mod a; mod b;", "use super::b::B; pub struct A;", "use super::a::A; pub struct B;", BOTH),
        (
            "pub mod a; mod b; pub use a::A;",
            "use super::b::B; pub struct A;",
            "use super::A; pub struct B;",
            BOTH,
        ),
        (
            "mod a; mod b; pub use a::A;",
            "fn f(b: super::b::B) {} pub struct A;",
            "use crate::m::A; pub struct B;",
            BOTH,
        ),
        (
            "mod a; mod b; pub use a::*;",
            "use super::b::B; pub struct A;",
            "use super::A; pub struct B;",
            BOTH,
        ),
        (
            "mod a; mod b; pub use a::A as C;",
            "use super::b; pub struct A; fn f() { b::g::<A>() }",
            "use super::C; pub fn g() {}",
            BOTH,
        ),
        (
            "mod a; mod b; pub use a::A;",
            "use super::b; pub struct A; fn f() { b::g() }",
            "use super::*; pub fn g() {}",
            BOTH,
        ),
        (
            "mod a; mod b; pub use a::A; pub use b::B;",
            "use super::B; pub struct A;",
            "pub struct B;",
            &[],
        ),
        (
            "mod a; mod b;",
            "pub struct A; #[cfg(test)] mod tests { use super::super::b::B; }",
            "use super::a::A; pub struct B;",
            &[],
        ),
        (
            "mod a; mod b; pub struct C; use a::f;",
            "use super::C; pub fn f() {}",
            "use super::C;",
            &["m/a.rs", "m/mod.rs"],
        ),
    ] {
        let files =
            [("lib.rs", "mod m;"), ("m/mod.rs", module), ("m/a.rs", one), ("m/b.rs", other)];
        let wanted: BTreeSet<PathBuf> = wanted.iter().map(PathBuf::from).collect();
        let wanted = [wanted].into_iter().filter(|circle| !circle.is_empty()).collect();
        assert_eq!(circles(&planted(&files)), wanted, "{module} | {one} | {other}");
    }
    // Through a third file, and with the file that declares them.
    let three = [
        ("lib.rs", "mod a; mod b; mod c;"),
        ("a.rs", "use crate::b::B; pub struct A;"),
        ("b.rs", "use crate::c::C; pub struct B;"),
        ("c.rs", "use crate::a::A; pub struct C;"),
    ];
    let names = ["a.rs", "b.rs", "c.rs"].map(PathBuf::from);
    assert_eq!(circles(&planted(&three)), BTreeSet::from([BTreeSet::from(names)]));
    let parent = [
        ("lib.rs", "mod page;"),
        ("page.rs", "mod part; pub struct Page; fn f() { part::g() }"),
        ("page/part.rs", "use super::Page; pub fn g() {}"),
    ];
    let names = ["page.rs", "page/part.rs"].map(PathBuf::from);
    assert_eq!(circles(&planted(&parent)), BTreeSet::from([BTreeSet::from(names)]));
}
