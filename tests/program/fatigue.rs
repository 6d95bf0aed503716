//! `edgeline fatigue`: its files, and what it refuses.

use crate::support::{Row, edgeline, files, number, refused, rows};
use serde_json::Value;
use std::fs;

const CASE: &str = "name = 'passed'
    roller = { radius_m = 10e-3, young_pa = 210e9, poisson = 0.3 }
    block = { young_pa = 210e9, poisson = 0.3 }
    dimensionless = { W = 1e-4, S_l = 5.0, L_r = 0.8 }
    sliding = { friction = 0.2 }
    accuracy = { tolerance = 1e-2 }
";

#[test]
fn a_passage_is_written_with_its_critical_places() {
    let folder = tempfile::tempdir().unwrap();
    let fatigue = "fatigue = { dang_van_alpha = 0.3, dang_van_beta_pa = 400e6, fatemi_socie_k = 0.6, \
                   yield_pa = 1.8e9, residual_xx_pa = -100e6 }";
    fs::write(folder.path().join("case.toml"), format!("{CASE}{fatigue}\n")).unwrap();
    let arguments = ["fatigue", "case.toml", "--places", "5,6", "--out", "o", "--json"];
    let run = edgeline(folder.path(), &arguments).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let summary: Value = serde_json::from_slice(&run.stdout).unwrap();
    let out = folder.path().join("o");
    let names = files(&out);
    for body in ["block", "roller"] {
        for measure in ["tau-xz-range", "tau-max", "von-mises", "dang-van", "fatemi-socie"] {
            for form in ["svg", "png"] {
                let name = format!("fatigue-{body}-{measure}.{form}");
                assert!(names.contains(&name), "{name} is not in {names:?}");
            }
            let svg =
                fs::read_to_string(out.join(format!("fatigue-{body}-{measure}.svg"))).unwrap();
            let origin = concat!(", quarter-space, edgeline ", env!("CARGO_PKG_VERSION"));
            assert!(svg.contains(&format!("{origin}: {body}<")), "{measure}");
            // Fatemi and Socie's measure has no unit.
            assert_eq!(svg.contains("(MPa)"), measure != "fatemi-socie", "{measure}");
            assert!(svg.contains("y (mm)") && svg.contains("z (mm)"), "{measure}");
        }
        assert!(names.contains(&format!("fatigue-{body}.vtr")));
    }
    assert!(names.contains(&"summary.json".to_string()));
    let table = rows(&out.join("fatigue.csv"));
    // Half of the roller, and the block's two places beyond its end.
    assert_eq!(table.len(), 5 * 6 + 7 * 6);
    let critical = summary["critical"].as_array().unwrap();
    assert_eq!(critical.len(), 10);
    for found in critical {
        let (body, measure) = (&found["body"], found["measure"].as_str().unwrap());
        let at = [0, 1].map(|axis| found["at_m"][axis].as_f64().unwrap());
        let is_there = |row: &&Row| {
            let off = [number(row, "y_m") - at[0], number(row, "z_m") - at[1]];
            body == row["body"].as_str() && off.iter().all(|d| d.abs() < 1e-12)
        };
        let row = table.iter().find(is_there).expect("the place is one of the table");
        let value = found["value"].as_f64().unwrap();
        assert!((number(row, measure) / value - 1.0).abs() < 1e-9, "{measure}");
        let half_space = found["half_space"]["value"].as_f64().unwrap();
        assert!(half_space > 0.0 && number(row, &format!("{measure}_half_space")) > 0.0);
    }
    let dang_van = critical.iter().find(|c| c["measure"] == "dang_van_pa").unwrap();
    let ratio = dang_van["value"].as_f64().unwrap() / 400e6;
    assert!((dang_van["over_limit"].as_f64().unwrap() / ratio - 1.0).abs() < 1e-12);
}

#[test]
fn half_a_measure_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (fatigue, wanted) in [
        ("dang_van_beta_pa = 4e8", "dang_van_alpha"),
        ("yield_pa = 1e9", "fatemi_socie_k"),
        ("fatemi_socie_k = 0.6", "yield_pa"),
        ("dang_van_alpha = -1.0", "0 and 10"),
    ] {
        let text = format!("{CASE}fatigue = {{ {fatigue} }}\n");
        fs::write(folder.path().join("case.toml"), text).unwrap();
        let said = refused(&mut edgeline(folder.path(), &["fatigue", "case.toml", "--out", "o"]));
        assert!(said.contains(wanted) && !said.contains("follows from W"), "{said}");
    }
    let said = refused(&mut edgeline(folder.path(), &["fatigue", "case.toml", "--places", "5"]));
    assert!(said.contains("--places") || said.contains("dang_van_alpha"), "{said}");
    assert_eq!(files(folder.path()), ["case.toml"]);
}

#[test]
fn cells_refuse_friction() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["solve", "sliding-flush", "--engine", "cells", "--out", "o"];
    let said = refused(&mut edgeline(folder.path(), &arguments));
    assert!(said.contains("sliding.friction") && said.contains("--engine line"), "{said}");
    assert_eq!(files(folder.path()), [""; 0]);
}

/// What to beware of in the contact holds for its passages, too.
#[test]
fn a_passage_under_a_profile_of_noise_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let plain = include_str!("../data/steep.toml");
    let profile = plain.lines().find(|line| line.starts_with("profile")).unwrap();
    for (name, noise, count) in [("smooth", 0.0, 0), ("noisy", 1e-7, 1)] {
        let point = |i: i32| {
            let place = f64::from(i) / 15.0 - 1.0;
            let noise = noise * f64::from(37 * i * i % 101) / 101.0;
            format!("{:.9},{:.12}\n", place * 0.5 * 0.0029844, 3e-6 * place * place + noise)
        };
        let points: String = (0..31).map(point).collect();
        fs::write(folder.path().join("drops.csv"), format!("y_m,drop_m\n{points}")).unwrap();
        let table = "profile = { kind = \"table\", file = \"drops.csv\" }";
        fs::write(folder.path().join("case.toml"), plain.replace(profile, table)).unwrap();
        let arguments =
            ["fatigue", "case.toml", "--places", "3,2", "--tolerance", "3e-2", "--json"];
        let own = ["--method", "mirror", "--out", name];
        let run = edgeline(folder.path(), &arguments).args(own).output().unwrap();
        let said = String::from_utf8_lossy(&run.stderr);
        assert!(run.status.success(), "{said}");
        let summary: Value = serde_json::from_slice(&run.stdout).unwrap();
        let warnings = summary["warnings"].as_array().unwrap();
        assert_eq!(warnings.len(), count, "{name}: {warnings:?}");
        assert_eq!(said.matches("warning: ").count(), count, "{said}");
    }
}
