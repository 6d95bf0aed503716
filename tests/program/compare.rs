//! `edgeline compare`: brought curves in any units and axes, shifted curves, and files that cannot
//! be used.

use crate::support::{edgeline, files, number, refused, rows, said};
use serde_json::Value;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// A case on record, its roller's radius in mm, and its record.
const CASE: &str = "name = \"any\"
[roller]
radius_m = 0.01
young_pa = 2.1e11
poisson = 0.3
[block]
young_pa = 2.1e11
poisson = 0.3
[dimensionless]
W = 1e-3
S_l = 5
L_r = 0.5
";
const RADIUS_MM: f64 = 10.0;

pub(crate) fn record() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("results/reference/w1e-3_sl5_lr0.5")
}

/// A folder with the case, the record's curves in SI units, the same in mm and MPa in other axes at
/// y < 0, and the same with one curve 2 % too large.
pub(crate) fn bench() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("case.toml"), CASE).unwrap();
    let stresses = ["xx", "yy", "zz", "xy", "xz", "yz"].map(|c| format!("sigma_{c}_pa"));
    let si = format!("body,curve,x_m,y_m,z_m,{}\n", stresses.join(","));
    let mut elsewhere =
        "# name: elsewhere\n# length_unit: mm\n# stress_unit: MPa\n# axes: z -x y\n\
                         # origin: 12.5 3 -1\n# system: space\n# error_p0: 0.004\n\
                         body;path;X;Y;Z;S11;S22;S33;S12;S13;S23\n"
            .to_string();
    let (mut plain, mut shifted) = (si.clone(), si);
    for row in rows(&record().join("curves.csv")).iter().filter(|r| r["mesh"] == "1") {
        let at = ["x_m", "y_m", "z_m"].map(|c| number(row, c));
        let s: Vec<f64> = stresses.iter().map(|c| number(row, c)).collect();
        let (body, curve) = (&row["body"], &row["curve"]);
        let line = |s: &[f64]| {
            let values: Vec<String> = at.iter().chain(s).map(f64::to_string).collect();
            format!("{body},{curve},{}\n", values.join(","))
        };
        plain += &line(&s);
        let factor = if curve == "surface-along-y" { 1.02 } else { 1.0 };
        shifted += &line(&s.iter().map(|v| factor * v).collect::<Vec<_>>());
        // Mirrored in x = 0 and in y = 0, one system of axes for both bodies, turned.
        let [x, y, mut z] = [-at[0] * 1e3, -at[1] * 1e3, at[2] * 1e3];
        let [xx, yy, zz, xy, mut xz, mut yz] =
            [s[0], s[1], s[2], s[3], -s[4], -s[5]].map(|v| v * 1e-6);
        if body == "roller" {
            let surface = RADIUS_MM - (RADIUS_MM * RADIUS_MM - x * x).sqrt();
            (z, xz, yz) = (-(z + surface), -xz, -yz);
        }
        let (place, turned) = ([-y + 12.5, z + 3.0, x - 1.0], [yy, zz, xx, -yz, -xy, xz]);
        let values: Vec<String> = place.iter().chain(&turned).map(f64::to_string).collect();
        writeln!(elsewhere, "{body};{curve};{}", values.join(";")).unwrap();
    }
    for (name, text) in [("si.csv", plain), ("shifted.csv", shifted), ("elsewhere.csv", elsewhere)]
    {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// The errors of a run by what they are of.
fn errors(path: &Path) -> Vec<(String, f64)> {
    let columns = ["method", "body", "curve", "quantity"];
    let place = |row: &crate::support::Row| columns.map(|c| row[c].clone()).join(" ");
    rows(path).iter().map(|row| (place(row), number(row, "max"))).collect()
}

#[test]
fn other_units_and_axes_give_the_same_verdict_and_a_shifted_curve_is_named() {
    let folder = bench();
    let at = |name: &str| folder.path().join(name);
    let run = |file: &str| {
        let arguments = ["compare", "case.toml", file, "--error-p0", "0.004", "--out", "o"];
        let output = edgeline(folder.path(), &arguments).output().unwrap();
        let summary = fs::read_to_string(at("o/summary.json")).unwrap();
        let summary: Value = serde_json::from_str(&summary).unwrap();
        (output.status.code(), said(&output), summary, errors(&at("o/errors.csv")))
    };
    let (code, text, summary, si) = run("si.csv");
    assert_eq!(code, Some(0), "{text}");
    assert!(summary["gates_hold"] == true && text.contains("code-to-code"), "{text}");
    // FEM on record is what the file holds.
    let fem = si.iter().filter(|(place, _)| place.starts_with("fem "));
    assert!(fem.clone().count() == 208 && fem.clone().all(|(_, e)| *e < 1e-6));
    for name in ["compare.html", "curves.csv", "gates.json", "gates.md", "pressure.csv"] {
        assert!(at("o").join(name).is_file(), "{name}");
    }
    assert_eq!(files(&at("o/plots")).len(), 26);

    let (code, text, summary, turned) = run("elsewhere.csv");
    assert_eq!(code, Some(0), "{text}");
    assert_eq!(summary["files"][0]["name"], "elsewhere");
    for ((place, here), (other, there)) in si.iter().zip(&turned) {
        // Next to a singular end a model that is wrong there feels the file's digits.
        let near = if place.starts_with("quarter-space") { 2e-4 } else { 2e-3 };
        assert!(place == other && (here - there).abs() < near, "{place}: {here} and {there}");
    }

    let (code, text, summary, _) = run("shifted.csv");
    assert_eq!(code, Some(1), "{text}");
    let verdict = summary["verdict"].to_string();
    assert!(verdict.contains("block, surface-along-y") && verdict.contains("shifted"), "{verdict}");
    assert!(!verdict.contains("depth-"), "{verdict}");
    assert_eq!(summary["gates_hold"], false);
}

#[test]
fn records_solutions_and_given_limits_are_taken() {
    let folder = bench();
    let run = |arguments: &[&str]| {
        let output = edgeline(folder.path(), arguments).output().unwrap();
        (output.status.code(), said(&output))
    };
    // The record's own files: the finest of their meshes counts.
    let [curves, pressure] =
        ["curves.csv", "pressure.csv"].map(|n| record().join(n).display().to_string());
    let (code, text) = run(&["compare", "case.toml", &curves, &pressure]);
    assert_eq!(code, Some(0), "{text}");
    assert!(
        text.contains("pressure: pressure, RMS") && text.contains("curves: von Mises"),
        "{text}"
    );
    // What mirror solves is not what quarter-space does; its cells are points without a curve.
    let (code, text) = run(&["solve", "case.toml", "--method", "mirror", "--out", "m"]);
    assert_eq!(code, Some(0), "{text}");
    let (code, text) = run(&["compare", "case.toml", "m/pressure.csv"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("contact, points, pressure"), "{text}");
    // The program's own cells are means, and are compared as such: at the contact's edge, too.
    let (code, text) = run(&["solve", "case.toml", "--out", "q"]);
    assert_eq!(code, Some(0), "{text}");
    let (code, text) = run(&["compare", "case.toml", "q/pressure.csv", "--out", "c"]);
    assert_eq!(code, Some(0), "{text}");
    let own = errors(&folder.path().join("c/errors.csv"));
    let own = own.iter().find(|(place, _)| place.starts_with("quarter-space")).unwrap();
    assert!(own.1 < 1e-3, "{own:?}");
    // What no limit takes is refused: a load that is met says nothing of curves.
    let load =
        "[[gate]]\nname = \"load\"\nmethod = \"quarter-space\"\nquantity = \"load\"\nlimit = 1\n";
    fs::write(folder.path().join("load.toml"), load).unwrap();
    let gate = |measure: &str, limit: f64| {
        format!(
            "[[gate]]\nname = \"{measure}\"\nmethod = \"quarter-space\"\nquantity = \"stress\"\n\
                 measure = \"{measure}\"\ncurves = [\"depth-centre\"]\nlimit = {limit}\n"
        )
    };
    let misspelt = gate("rms", 0.02).replace("centre", "center");
    let pressures =
        gate("max", 0.02).replace("\"stress\"", "\"pressure\"").replace("depth-centre", "*");
    for (name, text) in [
        ("misspelt", misspelt.clone()),
        ("pressure", pressures),
        ("farther", gate("rms", 0.02) + "excluded_c = 0.5\n"),
        ("nowhere", gate("rms", 0.02) + "excluded_c = -1\n"),
    ] {
        fs::write(folder.path().join(format!("{name}.toml")), text).unwrap();
    }
    let none = "no gate of quarter-space takes any of its curves";
    for (arguments, wanted) in [
        ([&*pressure, "--exclude-pressure", "0.1"], "add 0.2 to --exclude-pressure"),
        (["/dev/null", "--gates", "/dev/null"], ": holds no gate; add [[gate]] tables"),
        (["si.csv", "--gates", "load.toml"], none),
        (["si.csv", "--gates", "misspelt.toml"], none),
        (["si.csv", "--gates", "pressure.toml"], none),
        (
            ["si.csv", "--gates", "farther.toml"],
            "outside 0.5 C of the edge, and it is compared outside 0.1 C; give such a distance to --exclude",
        ),
    ] {
        let all = [&["compare", "case.toml", "--out", "no"], &arguments[..]].concat();
        let message = refused(&mut edgeline(folder.path(), &all));
        assert!(message.contains(wanted) && message.contains(arguments[0]), "{message}");
    }
    let all = ["compare", "case.toml", "si.csv", "--out", "no", "--gates", "nowhere.toml"];
    let message = refused(&mut edgeline(folder.path(), &all));
    assert!(
        message.contains("nowhere.toml: gate \"rms\": excluded_c = -1 is no distance"),
        "{message}"
    );
    let (code, text) =
        run(&["compare", "case.toml", "si.csv", "--gates", "farther.toml", "--exclude", "0.5"]);
    assert_eq!(code, Some(0), "{text}");
    // Given limits are not widened, and one that selects nothing beside others fails.
    for (text, wanted) in [
        (gate("rms", 0.02), Some(0)),
        (gate("rms", 1e-6), Some(1)),
        (gate("rms", 0.02) + &misspelt.replace("\"rms\"\nmethod", "\"other\"\nmethod"), Some(1)),
    ] {
        fs::write(folder.path().join("gates.toml"), text).unwrap();
        let (code, text) = run(&["compare", "case.toml", "si.csv", "--gates", "gates.toml"]);
        assert_eq!(code, wanted, "{text}");
    }
}

#[test]
fn files_that_cannot_be_used_are_refused_with_their_place() {
    let folder = bench();
    let head = "body,x_m,y_m,z_m,S11 [MPa]\nblock,0,0,0,-1\n";
    for (text, wanted) in [
        (format!("{head}block,0,0,abc,-1\n"), ":3: column 4 (z_m): 'abc' is not a finite number"),
        (format!("{head}block,0,0,0,inf\n"), ":3: column 5 (S11 [MPa]): 'inf'"),
        (
            format!("{head}block,0,0,0,1e300\n"),
            ":3: column 5 (S11 [MPa]): '1e300' is more than 1e14 Pa",
        ),
        ("x_m,y_m,p_pa\n0,0,-2e14\n".into(), ":2: column 3 (p_pa): '-2e14' is more than 1e14 Pa"),
        (format!("{head}ball,0,0,0,-1\n"), ":3: column 1 (body): 'ball' is neither"),
        (format!("{head}block,0,0,0\n"), ":3: has 4 cells where the header has 5; docs"),
        (format!("{head}# a\n\nblock,0,0,0\n"), ":5: has 4 cells"),
        (format!("{head}\n# a\nblock,0,0,0,nan\n"), ":5: column 5"),
        (format!("{head}block,0,1,0,-1\n"), ":3: in our axes y = 1 m is outside the block"),
        (format!("# x\n{head}roller,0,0,0.03,-1\n"), ":4: in our axes z = 0.03 m is outside"),
        ("x_m,y_m,z_m,S11 [MPa]\n0,0,0,1\n".into(), ":1: has no column body"),
        ("body,x_m,z_m,S11 [MPa]\n".into(), ":1: has no column y"),
        ("body,x,y_m,z_m,S11 [MPa]\n".into(), "the unit of column 'x' is not stated"),
        ("body,x_m,y_m,z_m,S11\n".into(), "# stress_unit: ...` above the table"),
        ("body,x_m,y_m,z_m,S11_mm\n".into(), "column 'S11_mm' cannot be in mm"),
        ("x_m,y_m,p_pa,S11_pa\n".into(), "has both stresses and a pressure"),
        ("x_m,y_m\n".into(), "has no column of a stress or a pressure"),
        ("x_m,y_m,p_pa,cpress_pa\n".into(), "columns 'p_pa' and 'cpress_pa' are the same thing"),
        ("x_m,y_m,p_pa\n".into(), "holds no points"),
        ("x_m,y_m,p_pa\n0,3e-3,0\n".into(), "has no point on the contact"),
        ("x_m,y_m,p_pa\n0,0,1e9\n0,7,0\n".into(), ":3: in our axes y = 7 m is outside the block"),
        (
            "# length_unit: m\n# length_unit: mm\nx,y,p_pa\n".into(),
            ":2: length_unit is stated twice",
        ),
        (
            "x_m,y_m,p_pa\n# length_unit: mm\n0,0,1e9\n".into(),
            ":2: length_unit is stated below the names of the columns",
        ),
        ("x_m,y_m,p_pa\r0,0,1e9\r".into(), "has line ends of carriage returns alone"),
        // A line along z whose axes are not stated.
        (
            "x_m,y_m,z_m,p_pa\n0,0,-0.01,0\n0,0,-9e-3,1e9\n".into(),
            ":3: in our axes z = -0.009 m is not on the contact: state axes",
        ),
        (
            "x_m,y_m,z_m,p_pa\n0,0,-1e-4,1e9\n0,0,1e-4,1e9\n".into(),
            "has all 2 pressures of 'points' at one x and y",
        ),
        (
            "# body: block\nx_m,y_m,p_pa\n0,0,1e9\n".into(),
            "states a body, but a pressure is that of both",
        ),
        ("# length_unit: ft\nx,y,p_pa\n".into(), ":1: length_unit cannot be 'ft': give m, cm, mm"),
        (
            "# lenght_unit: mm\nx,y,p_pa\n".into(),
            ":1: 'lenght_unit' is no key; did you mean length_unit?",
        ),
        ("# length_unit: mm\nx_m,y_m,p_pa\n".into(), "column 'x_m' is in m, but length_unit is mm"),
        ("source,x_m,y_m,p_pa\na,0,0,1\nb,0,0,1\n".into(), ":3: column 1 (source): 'b' after 'a'"),
    ] {
        fs::write(folder.path().join("bad.csv"), &text).unwrap();
        let mut command = edgeline(folder.path(), &["compare", "case.toml", "bad.csv"]);
        let message = refused(&mut command);
        assert!(message.contains("bad.csv") && message.contains(wanted), "{text}{message}");
    }
    fs::copy(folder.path().join("si.csv"), folder.path().join("mirror.csv")).unwrap();
    fs::write(folder.path().join("middle.csv"), "x_m,y_m,p_pa\n0,0,2e9\n").unwrap();
    for (arguments, wanted) in [
        (["si.csv", "si.csv"].to_vec(), "name = si is not valid"),
        (["middle.csv", "--body", "block"].to_vec(), "--body = block is not valid: a pressure"),
        (["mirror.csv"].to_vec(), "is called like a model or a code"),
        (["si.csv", "--axes", "x y"].to_vec(), "--axes = x y is not valid"),
    ] {
        let all = [&["compare", "case.toml"], &arguments[..]].concat();
        let message = refused(&mut edgeline(folder.path(), &all));
        assert!(message.contains(wanted), "{message}");
    }
    assert!(!folder.path().join("out").exists());
}

#[test]
fn a_file_all_of_whose_points_are_next_to_an_end_compares_nothing() {
    let folder = bench();
    // Nor has a curve of one point a length.
    let end = 5.0 * 0.02 * (1e-3 / std::f64::consts::PI).sqrt();
    for (text, name) in [
        (format!("x_m,y_m,p_pa\n0,{end},1e9\n"), "contact points"),
        ("curve,x_m,y_m,p_pa\nmiddle,0,0,1e9\n".into(), "contact middle"),
    ] {
        fs::write(folder.path().join("few.csv"), text).unwrap();
        let said = refused(&mut edgeline(folder.path(), &["compare", "case.toml", "few.csv"]));
        let why = "too few points away from the edges, of which a curve takes two in a row";
        let wanted = format!("few.csv: nothing can be compared: {why}: {name}");
        assert!(said.contains(&wanted) && !folder.path().join("out").exists(), "{said}");
    }
}
