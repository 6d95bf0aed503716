//! Lists the files that are built into the program: the recorded finite-element results and the
//! sources of the finite-element side. Listing them here keeps the lists complete by themselves.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("set by cargo"));
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("set by cargo"));

    println!("cargo::rerun-if-changed=results/reference");
    let mut records = String::from("&[");
    for folder in children(&root.join("results/reference")) {
        if folder.join("record.json").is_file() {
            let files =
                ["record.json", "curves.csv", "pressure.csv"].map(|f| include(&folder.join(f)));
            let name = folder.file_name().expect("a child has a name");
            write!(records, "({name:?}, [{}]),", files.join(", ")).expect("a string grows");
        }
    }
    records.push(']');
    fs::write(out.join("records.rs"), records).expect("OUT_DIR can be written");

    // The files are watched, not their folder, which also takes the interpreter's cache. A file
    // that is new is found all the same: another one has to change to import it.
    let mut sources = String::from("&[");
    for file in children(&root.join("fem/edgeline_fem")) {
        if file.extension().is_some_and(|e| e == "py") {
            println!("cargo::rerun-if-changed={}", file.display());
            let name = file.file_name().expect("a child has a name");
            write!(sources, "({name:?}, {}),", include(&file)).expect("a string grows");
        }
    }
    sources.push(']');
    fs::write(out.join("fem_sources.rs"), sources).expect("OUT_DIR can be written");
}

/// What a folder holds, by name; nothing if it is not there.
fn children(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let mut paths: Vec<PathBuf> = entries.filter_map(|e| e.ok()).map(|e| e.path()).collect();
    paths.sort();
    paths
}

/// The expression that includes a file as text.
fn include(path: &Path) -> String {
    format!("include_str!({:?})", path.display().to_string())
}
