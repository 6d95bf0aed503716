//! Lists the files that are built into the program, the recorded finite-element results and the
//! Python sources of the finite-element model, so that the lists are always complete. Evaluates the
//! closed forms for the tables of stresses, which would take longer than a solve.

use kernels::line_load::{WaveStress, exact, exact_along, exact_apart};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

// The closed forms of the program itself.
#[allow(dead_code)]
#[path = "src/kernels"]
mod kernels {
    pub mod bessel;
    pub mod line_load;
    pub mod patches;
}

fn main() {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("set by cargo"));
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("set by cargo"));

    if env::var_os("CARGO_FEATURE_CLI").is_some() {
        embed_files(&root, &out);
    }
    tabulate(&out);
}

/// Writes the lists of recorded results and of the Python sources.
fn embed_files(root: &Path, out: &Path) {
    for (from, to) in [("reference", "records.rs"), ("calculix", "records_calculix.rs")] {
        println!("cargo::rerun-if-changed=results/{from}");
        let mut records = String::from("&[");
        for folder in children(&root.join("results").join(from)) {
            if folder.join("record.json").is_file() {
                let files =
                    ["record.json", "curves.csv", "pressure.csv"].map(|f| include(&folder.join(f)));
                let name = folder.file_name().expect("a child has a name");
                write!(records, "({name:?}, [{}]),", files.join(", ")).expect("a string grows");
            }
        }
        records.push(']');
        fs::write(out.join(to), records).expect("OUT_DIR can be written");
    }

    // Cargo watches the files, not their folder, which also contains the interpreter's cache. A new
    // file is found nevertheless, because another one must change to import it.
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

/// Writes the tables of stresses.
fn tabulate(out: &Path) {
    for file in ["bessel", "line_load", "patches"] {
        println!("cargo::rerun-if-changed=src/kernels/{file}.rs");
    }
    println!("cargo::rerun-if-changed=build.rs");
    for (name, load) in [("wave", exact as Load), ("along", exact_along), ("apart", exact_apart)] {
        tabulate_load(out, name, load);
    }
}

/// The stresses of a line load of a wavenumber, in a material of some Poisson's ratio, at an offset
/// and a depth.
type Load = fn(f64, f64, f64, f64) -> WaveStress;

/// Writes the tables of the stresses of a `load`.
fn tabulate_load(out: &Path, name: &str, load: Load) {
    let stresses = |(u, v): (f64, f64)| {
        let rho = u.hypot(v);
        let [zero, one] = [0.0, 1.0].map(|nu| {
            let s = load(1.0, nu, u, v);
            [s.xx, s.ww, s.dd, s.wd, s.xw, s.xd].map(|s| rho * s)
        });
        (zero, std::array::from_fn::<f64, 6, _>(|c| one[c] - zero[c]))
    };
    let mut bytes = Vec::new();
    for (zero, more) in kernels::patches::STRESS.places().map(stresses) {
        bytes.extend(zero.iter().chain(&more).flat_map(|s| (*s as f32).to_le_bytes()));
    }
    fs::write(out.join(format!("{name}_stress.f32")), &bytes).expect("OUT_DIR can be written");
    bytes.clear();
    for (zero, more) in kernels::patches::WW.places().map(stresses) {
        bytes.extend([zero[1], more[1]].iter().flat_map(|s| s.to_le_bytes()));
    }
    fs::write(out.join(format!("{name}_ww.f64")), &bytes).expect("OUT_DIR can be written");
}

/// The names in a folder, sorted; none if there is no folder.
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
