//! Sweeps: what is in memory, what is written when, and files of Parquet.

use super::support::{edgeline, files, refused, rows, start, succeeded, wait_for};
use std::fs;
use std::path::Path;

/// A sweep over `loads` loads, which one solution serves, and these lengths.
fn sweep_file(folder: &Path, loads: usize, lengths: &str) {
    let body = "young_pa = 210e9\npoisson = 0.3";
    let text = format!(
        "[roller]\nradius_m = 10e-3\n{body}\n[block]\n{body}\n[dimensionless]\nS_l = {lengths}\n\
         W = {{ from = 1e-5, to = 1e-3, count = {loads} }}\nL_r = 1.0\n[accuracy]\ntolerance = 1e-2\n"
    );
    fs::write(folder.join("sweep.toml"), text).unwrap();
}

/// Peak memory of a process that runs (MiB).
fn peak_mib(pid: u32) -> Option<f64> {
    let status = fs::read_to_string(format!("/proc/{pid}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix(" kB")?.parse::<f64>().ok()? / 1024.0)
}

#[test]
fn rows_are_written_while_a_sweep_runs_and_are_not_kept() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    sweep_file(path, 10_000_000, "5");
    let out = path.join("s.csv");
    let written = || fs::metadata(&out).map_or(0, |file| file.len());
    let arguments = ["sweep", "sweep.toml", "--method", "half-space", "--out", "s.csv"];
    let mut sweep = start(&mut edgeline(path, &arguments));
    wait_for("rows", || written() > 1 << 20);
    let before = peak_mib(sweep.id()).unwrap();
    // Some 50,000 rows more.
    wait_for("more rows", || written() > 16 << 20);
    let after = peak_mib(sweep.id()).unwrap();
    sweep.kill().unwrap();
    sweep.wait().unwrap();
    assert!(after < before + 24.0 && after < 150.0, "{before} MiB, then {after} MiB");
}

#[test]
fn a_table_is_swept_from_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let loads = (0..20_000).map(|i| format!("c{i},{:e}\n", 1e-4 + 1e-8 * f64::from(i)));
    fs::write(path.join("t.csv"), "name,W\n".to_string() + &loads.collect::<String>()).unwrap();
    let arguments = ["sweep", "t.csv", "--base", "flush-short", "--tolerance", "1e-2", "--json"];
    let mut sweep = edgeline(path, &arguments);
    let first = succeeded(&mut sweep);
    let first: serde_json::Value = serde_json::from_slice(&first.stdout).unwrap();
    assert_eq!((&first["rows"], &first["problems_solved"]), (&20_000.into(), &1.into()));
    let table = rows(&path.join("sweep.csv"));
    assert_eq!((table.len(), table[19_999]["name"].as_str()), (20_000, "c19999"));
    // Again: all rows are there, and the first of them is solved to see whether it is this sweep's.
    let again = succeeded(&mut sweep);
    let again: serde_json::Value = serde_json::from_slice(&again.stdout).unwrap();
    assert_eq!((&again["rows_kept"], &again["problems_solved"]), (&20_000.into(), &1.into()));
    // A shorter table is another sweep.
    fs::write(path.join("t.csv"), "name,W\nc0,1e-4\n").unwrap();
    let said = refused(&mut sweep);
    assert!(
        said.contains("sweep.csv:3: has more rows than this sweep; give another --out"),
        "{said}"
    );
}

#[test]
fn rows_of_another_base_are_no_part_of_a_sweep_and_a_rough_base_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let body = "young_pa = 210e9\npoisson = 0.3\nlength_m = 0.01\n";
    let base = |crown: f64, load: &str, more: &str| {
        let text = format!(
            "name = \"base\"\n[roller]\nradius_m = 10e-3\n{body}[roller.profile]\nkind = \"crown\"\n\
             radius_m = {crown}\n[block]\n{body}{load}\n[accuracy]\ntolerance = 3e-2\n{more}"
        );
        fs::write(path.join("base.toml"), text).unwrap();
    };
    let load = "[load]\nforce_n = 2000.0";
    fs::write(path.join("t.csv"), "radius_m\n0.01\n0.012\n").unwrap();
    let sweep = || edgeline(path, &["sweep", "t.csv", "--base", "base.toml"]);
    base(10.0, load, "");
    succeeded(&mut sweep());
    // The base's force and lengths are kept where a radius varies.
    let table = rows(&path.join("sweep.csv"));
    assert!(table.iter().all(|row| row["load_n"].parse::<f64>().unwrap() == 2000.0), "{table:?}");
    // A crown of another radius makes other rows, though no column says so.
    base(8.0, load, "");
    let before = fs::read(path.join("sweep.csv")).unwrap();
    let said = refused(&mut sweep());
    assert!(said.contains("sweep.csv:2: row 1 has ") && said.contains("another base"), "{said}");
    assert_eq!(fs::read(path.join("sweep.csv")).unwrap(), before);
    fs::write(path.join("h.csv"), "0,0\n0,1e-7\n").unwrap();
    base(10.0, load, "[surface]\nheights = \"h.csv\"\ndx_m = 1e-5\ndy_m = 1e-5\n");
    let said = refused(&mut sweep());
    assert!(said.contains("surface.heights") && said.contains("a sweep solves contacts"), "{said}");
}

#[cfg(not(feature = "parquet"))]
#[test]
fn parquet_needs_its_feature() {
    let folder = tempfile::tempdir().unwrap();
    sweep_file(folder.path(), 3, "5");
    let arguments = ["sweep", "sweep.toml", "--out", "s.parquet"];
    let said = refused(&mut edgeline(folder.path(), &arguments));
    assert!(said.contains("s.parquet: this program was built without Parquet; build it"), "{said}");
    assert!(said.contains("--features parquet") && said.contains("ends in .csv"), "{said}");
    assert_eq!(files(folder.path()), ["sweep.toml"]);
}

#[cfg(feature = "parquet")]
mod parquet {
    use super::*;
    use ::parquet::file::reader::{FileReader, SerializedFileReader};
    use ::parquet::record::Field;

    /// Names and cells of a file.
    fn table(file: &Path) -> Vec<Vec<(String, Field)>> {
        let reader = SerializedFileReader::new(fs::File::open(file).unwrap()).unwrap();
        let rows = reader.get_row_iter(None).unwrap();
        let cells = |(name, field): (&String, &Field)| (name.clone(), field.clone());
        rows.map(|row| row.unwrap().get_column_iter().map(cells).collect()).collect()
    }

    fn sweep(folder: &Path, out: &str) -> std::process::Command {
        edgeline(folder, &["sweep", "t.csv", "--base", "flush-short", "--json", "--out", out])
    }

    #[test]
    fn both_forms_hold_the_same_rows() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        let loads = "name,W,tolerance\na,0.0001,1e-2\nb,no number,1e-2\n\"c\",2e-4,0.01\n";
        fs::write(path.join("t.csv"), loads).unwrap();
        succeeded(&mut sweep(path, "s.csv"));
        succeeded(&mut sweep(path, "s.parquet"));
        assert_eq!(files(path), ["s.csv", "s.parquet", "t.csv"]);
        let (csv, parquet) = (rows(&path.join("s.csv")), table(&path.join("s.parquet")));
        assert_eq!((csv.len(), parquet.len()), (3, 3));
        for (csv, parquet) in csv.iter().zip(&parquet) {
            assert_eq!(csv.len(), parquet.len());
            for (name, field) in parquet {
                let text = csv[name].as_str();
                match field {
                    Field::Long(row) => assert_eq!(text, row.to_string()),
                    Field::Str(own) => assert_eq!(text, own),
                    Field::Double(own) => assert_eq!(text.parse::<f64>().unwrap(), *own, "{name}"),
                    Field::Null => {
                        assert!(text.is_empty() || text == "no number", "{name}: {text}")
                    }
                    other => panic!("{name}: {other}"),
                }
            }
        }
        // A finished file is recognised.
        let done = succeeded(&mut sweep(path, "s.parquet"));
        let done: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
        assert_eq!((&done["rows_kept"], &done["problems_solved"]), (&3.into(), &0.into()));
        assert_eq!(table(&path.join("s.parquet")), parquet);
    }

    #[test]
    fn a_stopped_sweep_goes_on_and_other_files_stay() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        fs::write(path.join("t.csv"), "W\n1e-4\n2e-4\n3e-4\n").unwrap();
        succeeded(&mut sweep(path, "s.csv"));
        let csv = fs::read_to_string(path.join("s.csv")).unwrap();
        // As a run leaves it that is killed within the third row.
        let cut = csv.match_indices('\n').nth(2).unwrap().0 + 20;
        fs::write(path.join("s.parquet.part"), &csv[..cut]).unwrap();
        let done = succeeded(&mut sweep(path, "s.parquet"));
        let done: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
        assert_eq!((&done["rows"], &done["rows_kept"]), (&3.into(), &2.into()));
        let whole = fs::read(path.join("s.parquet")).unwrap();
        for (table, wanted) in [
            ("W\n1e-4\n7e-4\n3e-4\n", "is not row 2 of this sweep"),
            ("W,S_l\n1e-4,5\n", "s.parquet: has the columns of something else"),
            ("W\n1e-4\n", "has more rows than this sweep"),
        ] {
            fs::write(path.join("t.csv"), table).unwrap();
            let said = refused(&mut sweep(path, "s.parquet"));
            assert!(said.contains(wanted) && said.contains("give another --out"), "{said}");
            assert_eq!(files(path), ["s.csv", "s.parquet", "t.csv"]);
            assert_eq!(fs::read(path.join("s.parquet")).unwrap(), whole);
        }
        fs::write(path.join("s.parquet"), "no Parquet").unwrap();
        let said = refused(&mut sweep(path, "s.parquet"));
        assert!(said.contains("s.parquet: ") && said.contains("give another --out"), "{said}");
        assert_eq!(files(path), ["s.csv", "s.parquet", "t.csv"]);
    }
}
