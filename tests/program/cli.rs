//! The command line: exit codes, messages, files.

use crate::support::{edgeline, files, number, rows, succeeded};
use serde_json::Value;
use std::path::Path;

/// Runs arguments that must be refused, and returns the message.
fn refused(folder: &Path, arguments: &[&str]) -> String {
    crate::support::refused(&mut edgeline(folder, arguments))
}

#[test]
fn help_says_what_is_written_and_how_long_it_takes() {
    let folder = tempfile::tempdir().unwrap();
    let help = edgeline(folder.path(), &["--help"]).output().unwrap();
    assert!(help.status.success());
    let text = String::from_utf8(help.stdout).unwrap();
    let commands: Vec<&str> = text
        .lines()
        .skip_while(|line| !line.starts_with("Commands:"))
        .skip(1)
        .map_while(|line| line.split_whitespace().next())
        .filter(|name| *name != "help")
        .collect();
    assert!(commands.contains(&"solve") && commands.contains(&"doctor"), "{commands:?}");
    for command in commands {
        let help = edgeline(folder.path(), &[command, "--help"]).output().unwrap();
        assert!(help.status.success(), "{command}");
        let text = String::from_utf8(help.stdout).unwrap();
        assert!(
            text.to_lowercase().contains("takes "),
            "{command} --help does not say how long it takes"
        );
        assert!(text.contains("rites "), "{command} --help does not say what it writes");
    }
}

#[test]
fn wrong_usage_exits_with_two() {
    let folder = tempfile::tempdir().unwrap();
    refused(folder.path(), &[]);
    refused(folder.path(), &["sovle"]);
    assert!(refused(folder.path(), &["solve"]).contains("CASE"));
    let said = refused(folder.path(), &["solve", "flush-short", "--method", "quarter"]);
    assert!(said.contains("quarter-space"), "{said}");
    let said = refused(folder.path(), &["solve", "flush-short", "--tolerance", "2"]);
    assert!(said.contains("--tolerance") && said.contains("0.1"), "{said}");
    // A negative number is the value of its option.
    for (arguments, wanted) in [
        (&["solve", "flush-short", "--tolerance", "-1"][..], "--tolerance = -1 is not valid"),
        (&["study", "--exclude", "-1"], "'-1' for '--exclude <C>': give a distance between 0 and"),
        (&["study", "--exclude-pressure", "-1,2"], "'-1' for '--exclude-pressure <C,C>': give a"),
        (&["study", "--repeats", "-1"], "give a number of repetitions between 0 and 10000"),
        (&["compare", "flush-short", "c.csv", "--error-p0", "-1"], "--error-p0 = -1 is not valid"),
        (&["fatigue", "flush-short", "--places", "-1,5"], "give a number of places between"),
    ] {
        let said = refused(folder.path(), arguments);
        assert!(said.contains(wanted), "{said}");
    }
    // Refused for its memory or, if that suffices, for the number of points.
    let field = ["solve", "half-short", "--field", "--field-points", "2000,100,70"];
    assert!(refused(folder.path(), &field).contains("--field-points"));
    assert_eq!(files(folder.path()), [""; 0]);
}

#[test]
fn what_is_built_in_is_listed_printed_and_found() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let printed = |arguments: &[&str]| {
        let output = succeeded(&mut edgeline(path, &[&["cases"], arguments].concat()));
        String::from_utf8(output.stdout).unwrap()
    };
    let list = printed(&[]);
    for line in ["long-contact", "factorial ", "factorial/w1e-3_sl5_lr0.5", "profiled/centre"] {
        assert!(list.lines().any(|own| own.starts_with(line)), "{line}: {list}");
    }
    assert!(
        list.contains("half-short  ") && list.contains(": the roller's edge digs in."),
        "{list}"
    );
    for line in list.lines() {
        printed(&[line.split(' ').next().unwrap()]);
    }
    assert_eq!(printed(&["flush-short"]), include_str!("../../cases/flush-short.toml"));
    // What is printed is a case file, and the name of a study's case is as good.
    std::fs::write(path.join("own.toml"), printed(&["profiled/centre"])).unwrap();
    let solve = |case: &str| {
        let arguments = ["solve", case, "--method", "half-space", "--tolerance", "0.1", "--json"];
        let output = succeeded(&mut edgeline(path, &arguments));
        serde_json::from_slice::<Value>(&output.stdout).unwrap()["p_max_pa"].clone()
    };
    assert_eq!(solve("own.toml"), solve("profiled/centre"));
    assert_ne!(solve("centre"), solve("profiled/centre"));
    // It is a base of sweeps, too.
    std::fs::write(path.join("t.csv"), "W\n1e-3\n").unwrap();
    let sweep = ["sweep", "t.csv", "--tolerance", "0.1", "--method", "half-space", "--base"];
    for base in ["own.toml", "profiled/centre"] {
        succeeded(&mut edgeline(path, &[&sweep[..], &[base]].concat()));
    }
    assert!(refused(path, &[&sweep[..], &["zzz"]].concat()).contains("a built-in case: crown-"));
    for (arguments, wanted) in [
        (["study", "flush-short"], "is a case, not a study; run `edgeline solve flush-short`"),
        (["study", "w1e-3_sl5_lr1"], "is a case, not a study"),
        (["study", "profield"], "did you mean profiled?"),
        (["solve", "flush-shrt"], "did you mean flush-short?"),
        (["solve", "zzz"], "zzz: no such file; give a case file"),
        (["cases", "zzz"], "zzz: no such file; give a case file"),
        (["cases", "factoral"], "did you mean factorial? `edgeline cases` lists all"),
        (["sweep", "flush-short"], "is a built-in case, not the file of a sweep; give a case file"),
        (["sweep", "scenes"], "or run `edgeline study scenes`"),
    ] {
        let said = refused(path, &arguments);
        assert!(said.contains(wanted), "{said}");
    }
}

#[test]
fn bad_case_files_exit_with_two_and_leave_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let said = refused(folder.path(), &["solve", "nowhere.toml", "--out", "o"]);
    assert!(said.contains("nowhere.toml") && said.contains("flush-short"), "{said}");
    let good = include_str!("../../cases/flush-short.toml");
    for (from, to, wanted) in [
        ("poisson = 0.3", "poison = 0.3", "unknown key roller.poison; did you mean poisson?"),
        ("poisson = 0.3", "poisson = 0.5", "roller.poisson = 0.5"),
        ("L_r = 1.0", "L_r = 1.2e3", "dimensionless.L_r = 1.2e3"),
        ("radius_m = 10e-3", "radius_m = -1", "roller.radius_m = -1"),
        ("W = 5e-4", "W = nan", "dimensionless.W = nan"),
        ("[block]", "[block", "is not valid TOML"),
    ] {
        let text = good.replacen(from, to, 1);
        let line = 1 + text.lines().position(|l| l == to).unwrap();
        std::fs::write(folder.path().join("bad.toml"), text).unwrap();
        let said = refused(folder.path(), &["solve", "bad.toml", "--out", "o"]);
        assert!(said.contains(wanted), "{to}: {said}");
        assert!(said.contains(&format!("bad.toml:{line}: ")), "{to}: {said}");
    }
    assert_eq!(files(folder.path()), ["bad.toml"]);
}

#[test]
fn an_approach_gives_the_load_and_is_refused_where_a_force_is_needed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let good = include_str!("../../examples/crowned-eccentric.toml");
    let text = good.replace("force_n = 5000.0", "approach_m = 8e-6");
    std::fs::write(path.join("a.toml"), text).unwrap();
    for (arguments, wanted) in [
        (&["solve", "a.toml", "--engine", "cells"][..], "cells take a force"),
        (&["solve", "a.toml", "--uncertain", "load_n=5%"], "an uncertain case has a force"),
        (&["fem", "a.toml"], "finite elements take a force"),
        (&["deck", "a.toml"], "finite elements take a force"),
        (&["compare", "a.toml", "none.csv"], "every model would find another force"),
        (&["explore", "a.toml"], "the page changes forces"),
    ] {
        let said = refused(path, arguments);
        assert!(said.contains(wanted) && said.contains("give force_n instead"), "{said}");
    }
    assert_eq!(files(path), ["a.toml"]);
    let text = edgeline::case::builtin_case("half-short").unwrap().unwrap().to_toml();
    let force = text.lines().find(|l| l.starts_with("force_n")).unwrap();
    let text = text.replace(force, "approach_m = 1e-12");
    let line = 1 + text.lines().position(|l| l.starts_with("approach_m")).unwrap();
    std::fs::write(path.join("b.toml"), text).unwrap();
    let said = refused(path, &["solve", "b.toml", "--tolerance", "3e-2"]);
    assert!(said.contains(&format!("b.toml:{line}: load.approach_m = 1e-12 is not")), "{said}");
    let solve = ["solve", "a.toml", "--tolerance", "5e-3", "--json"];
    let run = edgeline(path, &solve).output().unwrap();
    let found: Value = serde_json::from_slice(&run.stdout).unwrap();
    let of = |key: &str| found[key].as_f64().unwrap();
    // Where the contact takes one iteration more the approach jumps by some 1e-8.
    assert!((of("approach_m") / 8e-6 - 1.0).abs() < 5e-8, "{found}");
    assert!(of("load_n") > 1e3 && of("load_n") < 1e4 && of("load_error_rel") < 1e-9, "{found}");
    let sweep = "name,load.approach_m\na,8e-6\nb,4e-6\n";
    std::fs::write(path.join("s.csv"), sweep).unwrap();
    let arguments =
        ["sweep", "s.csv", "--base", "a.toml", "--tolerance", "5e-3", "--out", "s.out.csv"];
    assert!(edgeline(path, &arguments).output().unwrap().status.success());
    let rows = rows(&path.join("s.out.csv"));
    assert!((number(&rows[0], "load_n") / of("load_n") - 1.0).abs() < 1e-5, "{rows:?}");
    assert!(number(&rows[1], "load_n") < 0.6 * number(&rows[0], "load_n"));
}

#[test]
fn stiffness_and_laminae_are_there_on_demand() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    std::fs::write(path.join("a.toml"), include_str!("../../examples/crowned-eccentric.toml"))
        .unwrap();
    let solve = [
        "solve",
        "a.toml",
        "--tolerance",
        "5e-3",
        "--stiffness",
        "--laminae",
        "40",
        "--plots",
        "--json",
    ];
    let run = edgeline(path, &solve).output().unwrap();
    assert!(run.status.success(), "{}", crate::support::said(&run));
    let found: Value = serde_json::from_slice(&run.stdout).unwrap();
    let stiffness = &found["details"]["stiffness"];
    // A steel roller of 10 mm under 5 kN: hundreds of newtons a micrometre.
    let force = stiffness["force_by_approach_n_per_m"].as_f64().unwrap();
    assert!((1e8..1e9).contains(&force), "{found}");
    assert!(stiffness["moment_by_tilt_nm_per_rad"].as_f64().unwrap() > 0.0);
    let note = String::from_utf8(run.stderr).unwrap();
    assert!(note.contains("beside ISO/TS 16281 the first slice carries"), "{note}");
    let rows = rows(&path.join("out/laminae.csv"));
    assert_eq!(rows.len(), 40);
    for column in ["load_n", "iso_load_n"] {
        let sum: f64 = rows.iter().map(|row| number(row, column)).sum();
        assert!((sum / 5000.0 - 1.0).abs() < 1e-5, "{column}: {sum}");
    }
    assert!(files(&path.join("out")).contains(&"plot-profile.svg".into()));
    let plain = edgeline(path, &["solve", "flush-short", "--json"]).output().unwrap();
    assert!(!String::from_utf8(plain.stdout).unwrap().contains("stiffness"));
    for option in [&["--stiffness"][..], &["--laminae", "40"]] {
        let mut arguments = vec!["solve", "flush-short", "--engine", "cells", "--out", "none"];
        arguments.extend(option);
        let said = refused(path, &arguments);
        assert!(said.contains("the engine on cells does not compute them"), "{said}");
        assert!(said.contains("or take --engine line"), "{said}");
    }
    // A roller that has lifted off at one end, by the standard, too.
    let steel = "young_pa = 210e9\npoisson = 0.3\nlength_m = 6e-3\n";
    let lifted = format!(
        "name = \"lifted\"\n[roller]\nradius_m = 10e-3\n{steel}[block]\n{steel}\
         [load]\nforce_n = 300.0\neccentricity_m = 2e-3\n"
    );
    std::fs::write(path.join("lifted.toml"), lifted).unwrap();
    let run = edgeline(path, &["solve", "lifted.toml", "--laminae", "40"]).output().unwrap();
    let note = String::from_utf8(run.stderr).unwrap();
    assert!(note.contains("the first slice carries no load, as there, and the last 0."), "{note}");
    assert!(
        refused(path, &["solve", "flush-short", "--laminae", "29"])
            .contains("a number of slices between 30 and 2000")
    );
}

#[test]
fn bad_profiles_and_positions_exit_with_two_and_leave_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    std::fs::write(path.join("back.csv"), "y_m,drop_m\n-6e-3,0\n6e-3,0\n5e-3,1e-6\n").unwrap();
    std::fs::write(path.join("short.csv"), "y_m,drop_m\n-4e-3,0\n4e-3,0\n").unwrap();
    let good = include_str!("../../examples/crowned-eccentric.toml");
    let logarithmic = "kind = \"logarithmic\"\namplitude_m = 3e-6\nk = 0.98";
    let table = |file: &str| format!("kind = \"table\"\nfile = \"{file}\"");
    for (from, to, wanted) in [
        ("k = 0.98", "k = 1.0", "roller.profile.k = 1.0 is not valid"),
        ("k = 0.98", "", "the profile logarithmic needs k, which is missing"),
        ("k = 0.98", "k = 0.98\nk1 = 2.0", "the profile logarithmic has no such number"),
        ("\"logarithmic\"", "\"crowned\"", "there is no such profile; did you mean crown?"),
        ("amplitude_m = 3e-6", "amplitude_m = 3e-2", "the profile drops by"),
        ("eccentricity_m = 0.25e-3", "eccentricity_m = 6e-3", "the roller would fall over"),
        ("[load]", "[pose]\noffset_m = 0.02\n[load]", "the bodies overlap along y by 0 m"),
        ("[load]", "[pose]\ntilt_rad = 1e-3\n[load]", "a load with eccentricity_m finds its own"),
        ("[load]", "[pose]\ntilt = 1e-3\n[load]", "unknown key pose.tilt; did you mean tilt_rad?"),
        (logarithmic, &table(""), "roller.profile.file = \"\" is not valid: the path of a file"),
        (
            logarithmic,
            &table("none.csv"),
            "roller.profile.file = \"none.csv\" is not valid: cannot read",
        ),
        (logarithmic, &table("back.csv"), "back.csv:4: y = 0.005 m does not lie beyond"),
        (logarithmic, &table("short.csv"), "its points lie from y = -0.004 to 0.004 m"),
        (
            "length_m = 12e-3",
            "length_m = 12e-3\nradius_m = -9e-3",
            "does not fit into this raceway",
        ),
        (
            "length_m = 12e-3",
            "length_m = 12e-3\nradius_m = -10.01e-3",
            "a quarter of the smaller radius",
        ),
    ] {
        assert!(good.contains(from), "{from}");
        std::fs::write(path.join("bad.toml"), good.replacen(from, to, 1)).unwrap();
        let said = refused(path, &["solve", "bad.toml", "--out", "o"]);
        assert!(said.contains(wanted), "{to}: {said}");
    }
    let raceway = good.replacen("length_m = 12e-3", "length_m = 12e-3\nradius_m = -0.05", 1);
    std::fs::write(path.join("bad.toml"), raceway).unwrap();
    let line = 1 + good.lines().position(|l| l == "length_m = 12e-3").unwrap();
    let place = format!("bad.toml:{}: block.radius_m = -0.05 is not valid: finite", line + 1);
    for command in ["fem", "deck"] {
        let said = refused(path, &[command, "bad.toml", "--out", "o"]);
        assert!(said.contains(&place), "{said}");
    }
    assert_eq!(files(path), ["back.csv", "bad.toml", "short.csv"]);
}

#[test]
fn a_roller_off_its_middle_has_both_ends_in_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let case = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/crowned-eccentric.toml");
    let output =
        edgeline(folder.path(), &["solve", case, "--json", "--out", "o"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
    let number = |key: &str| summary[key].as_f64().unwrap();
    assert!(number("tilt_rad") > 0.0 && number("load_error_rel") < 1e-9, "{summary}");
    let centre = summary["centre_of_pressure_m"][1].as_f64().unwrap();
    assert!((centre / 0.25e-3 - 1.0).abs() < 1e-9, "{centre}");
    let ends = [0, 1].map(|i| summary["contact_y_m"][i].as_f64().unwrap());
    // It ends before the roller does at either end, later on the side of the load.
    assert!(-5e-3 < ends[0] && -ends[0] < ends[1] && ends[1] < 5e-3, "{ends:?}");
    assert!(-ends[0] > 4.5e-3, "{ends:?}");
    let curves = std::fs::read_to_string(folder.path().join("o/curves.csv")).unwrap();
    for name in ["depth-end", "depth-end-neg", "depth-0.9-x1.4-neg"] {
        assert!(curves.contains(&format!("roller,{name},")), "{name}");
    }
    let lines = rows(&folder.path().join("o/line_load.csv"));
    assert!(lines.len() > 20);
}

#[test]
fn output_folder_that_cannot_be_made_exits_with_two() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("taken"), "").unwrap();
    for out in ["taken", "taken/below"] {
        let said = refused(folder.path(), &["solve", "flush-short", "--out", out]);
        assert!(said.contains("cannot create the folder taken"), "{said}");
        assert!(said.contains("; a file is in the way: give another path"), "{said}");
    }
    assert_eq!(files(folder.path()), ["taken"]);
}

#[test]
fn bad_points_exit_with_two_and_leave_nothing() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("p.csv"), "body,x_m,y_m,z_m\nblock,0,0,-1\n").unwrap();
    let arguments = ["solve", "flush-short", "--points", "p.csv", "--out", "o"];
    let said = refused(folder.path(), &arguments);
    assert!(said.contains("p.csv:2: z_m = -1 is outside the block"), "{said}");
    assert_eq!(files(folder.path()), ["p.csv"]);
}

#[test]
fn solve_writes_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let points = "body,x_m,y_m,z_m\nroller,0,0,1e-4\nblock,1e-5,-1e-4,0\nblock,1e-5,1e-4,0\n";
    std::fs::write(folder.path().join("p.csv"), points).unwrap();
    for method in ["half-space", "mirror", "guilbault", "quarter-space"] {
        let out = format!("out/{method}");
        let arguments =
            ["solve", "flush-short", "--method", method, "--points", "p.csv", "--out", &out];
        let output = edgeline(folder.path(), &arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let said = String::from_utf8(output.stdout).unwrap();
        assert!(said.contains(&format!("flush-short by {method}")), "{said}");
        let out = folder.path().join(out);
        let names = ["curves.csv", "line_load.csv", "points.csv", "pressure.csv", "summary.json"];
        assert_eq!(files(&out), names);

        let text = std::fs::read_to_string(out.join("summary.json")).unwrap();
        let summary: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(summary["case"], "flush-short");
        assert_eq!(summary["method"], method);
        assert_eq!(summary["converged"], true);
        assert!(summary["load_error_rel"].as_f64().unwrap() <= 1e-10, "{method}");
        for key in ["setup", "contact", "stress", "total"] {
            assert!(summary["seconds"][key].as_f64().unwrap() >= 0.0, "{key}");
        }
        for key in ["body", "measure", "value_pa", "at_m"] {
            assert!(!summary["critical"][key].is_null(), "{key}");
        }
        let p0 = summary["hertz"]["p0_pa"].as_f64().unwrap();

        // The pressure of all cells is the load, and is the same on either side of both planes.
        let cells = rows(&out.join("pressure.csv"));
        let of = |row, keys: [&str; 3]| keys.iter().map(|k| number(row, k)).product::<f64>();
        let load: f64 = cells.iter().map(|row| of(row, ["p_pa", "dx_m", "dy_m"])).sum();
        let wanted = summary["load_n"].as_f64().unwrap();
        assert!((load / wanted - 1.0).abs() < 1e-9, "{method}: {load} of {wanted} N");
        assert!(cells.iter().all(|row| number(row, "p_pa") >= 0.0));
        for moment in [["p_pa", "dx_m", "x_m"], ["p_pa", "dy_m", "y_m"]] {
            let sum: f64 = cells.iter().map(|row| of(row, moment)).sum();
            let size: f64 = cells.iter().map(|row| of(row, moment).abs()).sum();
            assert!(sum.abs() <= 1e-9 * size, "{method}: {moment:?}");
        }

        let curves = rows(&out.join("curves.csv"));
        for body in ["block", "roller"] {
            for name in edgeline::stress::curves::CURVE_NAMES {
                let rows: Vec<_> =
                    curves.iter().filter(|r| r["body"] == body && r["curve"] == name).collect();
                assert!(rows.len() > 10, "{body} {name}");
                for row in rows {
                    let stress = edgeline::base::StressTensor::from_components(
                        edgeline::base::StressTensor::NAMES
                            .map(|component| number(row, &format!("{component}_pa"))),
                    );
                    let close = |column: &str, value: f64| {
                        let written = number(row, column);
                        assert!(written.is_finite() && (written - value).abs() <= 1e-9 * p0);
                    };
                    close("von_mises_pa", stress.von_mises());
                    close("tau_max_pa", stress.tau_max());
                }
            }
        }

        let points = rows(&out.join("points.csv"));
        let bodies: Vec<&str> = points.iter().map(|row| row["body"].as_str()).collect();
        assert_eq!(bodies, ["roller", "block", "block"]);
        assert_eq!(number(&points[1], "y_m"), -1e-4);
        for column in ["sigma_xx_pa", "von_mises_pa"] {
            let (a, b) = (number(&points[1], column), number(&points[2], column));
            assert!((a - b).abs() <= 1e-9 * a.abs(), "{column} is not symmetric in y");
        }
    }
}

#[test]
fn plots_name_case_version_and_units() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["solve", "half-short", "--plots", "--tolerance", "5e-3", "--out", "o"];
    assert!(edgeline(folder.path(), &arguments).status().unwrap().success());
    let out = folder.path().join("o");
    let version = concat!("edgeline ", env!("CARGO_PKG_VERSION"));
    for name in
        ["pressure", "pressure-map", "along-block", "depth-block", "along-roller", "depth-roller"]
    {
        let svg = std::fs::read_to_string(out.join(format!("plot-{name}.svg"))).unwrap();
        for part in ["half-short, quarter-space", version, "(MPa)", "(mm)"] {
            assert!(svg.contains(part), "{name}: {part}");
        }
        let png = std::fs::read(out.join(format!("plot-{name}.png"))).unwrap();
        assert!(png.starts_with(b"\x89PNG\r\n\x1a\n"));
    }
    let page = std::fs::read_to_string(out.join("summary.html")).unwrap();
    let text = std::fs::read_to_string(out.join("summary.json")).unwrap();
    let summary: Value = serde_json::from_str(&text).unwrap();
    let mpa = |value: &Value| {
        let text = format!("{:.1}", value.as_f64().unwrap() * 1e-6);
        format!("{} MPa", text.trim_end_matches(".0"))
    };
    for part in [
        "half-short".to_string(),
        version.to_string(),
        mpa(&summary["p_centre_pa"]),
        mpa(&summary["critical"]["value_pa"]),
        "<td>210 GPa</td>".to_string(),
    ] {
        assert!(page.contains(&part), "{part}");
    }
    assert!(!page.contains("in metres") && !page.contains("in pascals"), "a second unit");
    assert_eq!(page.matches("<svg").count(), 6);
    assert!(!page.replace("http://www.w3.org/2000/svg", "").contains("://"), "nothing is fetched");
    // What is not solved is not drawn.
    let arguments =
        ["solve", "half-short", "--plots", "--curve", "depth-end", "--body", "block", "--out", "p"];
    assert!(edgeline(folder.path(), &arguments).status().unwrap().success());
    let drawn = files(&folder.path().join("p"));
    assert!(drawn.contains(&"plot-depth-block.svg".into()), "{drawn:?}");
    assert!(
        !drawn.iter().any(|name| name.contains("roller") || name.contains("along")),
        "{drawn:?}"
    );
}

#[test]
fn json_is_the_only_thing_on_standard_output() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["solve", "half-short", "--method", "mirror", "--json", "--body", "block"];
    let output = edgeline(folder.path(), &arguments).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    let printed: Value = serde_json::from_slice(&output.stdout).unwrap();
    let text = std::fs::read_to_string(folder.path().join("out/summary.json")).unwrap();
    assert_eq!(printed, serde_json::from_str::<Value>(&text).unwrap());
    let curves = rows(&folder.path().join("out/curves.csv"));
    assert!(curves.iter().all(|row| row["body"] == "block"));
}

#[test]
fn solve_on_cells_writes_arrays_beside_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let solve = |engine: &[&str], out: &str| -> Value {
        let mut arguments = vec!["solve", "flush-short", "--method", "guilbault", "--json"];
        arguments.extend(["--curve", "depth-0.9", "--out", out]);
        arguments.extend(engine);
        let output = edgeline(folder.path(), &arguments).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let cells = solve(&["--engine", "cells", "--cells", "64,100"], "cells");
    assert_eq!(cells["details"]["tolerance"], 1e-8);
    let line = solve(&[], "line");
    let names = ["axes.json", "curves.csv", "pressure.csv", "pressure.npy", "summary.json"];
    let written = files(&folder.path().join("cells"));
    assert!(names.iter().all(|name| written.contains(&name.to_string())), "{written:?}");
    let bytes = std::fs::metadata(folder.path().join("cells/pressure.npy")).unwrap().len();
    assert_eq!(bytes, 128 + 8 * 6400);
    assert_eq!(rows(&folder.path().join("cells/pressure.csv")).len(), 6400);
    for (key, tolerance) in [("p_centre_pa", 2e-3), ("approach_m", 2e-3), ("load_n", 1e-12)] {
        let [got, want] = [&cells, &line].map(|summary| summary[key].as_f64().unwrap());
        assert!((got / want - 1.0).abs() < tolerance, "{key}: {got} {want}");
    }
    assert!(cells["load_error_rel"].as_f64().unwrap() < 1e-12);
    for (arguments, wanted) in [
        (&["--cells", "64,64"][..], "--cells = 64,64 is not valid"),
        (&["--loads", "1,2.5"], "--loads = 1,2.5 is not valid: only the engine on cells takes it"),
        (&["--engine", "cells", "--loads", "5,-1"], "--loads = -1 is not valid: the load in"),
        (&["--engine", "cells", "--loads", "1e12"], "--loads = 1e12 is not valid: W = w"),
        (&["--engine", "cells", "--cells", "64"], "64,128"),
        (&["--engine", "cells", "--cells", "512,8"], "as long as wide"),
        (
            &["--engine", "cells", "--cells", "65536,65536"],
            "a contact on 65536 x 65536 cells takes about",
        ),
        (&["--engine", "cells", "--field"], "--field"),
        (&["--engine", "cells", "--tolerance", "1e-20"], "1e-12"),
    ] {
        let mut all = vec!["solve", "flush-short", "--method", "mirror", "--out", "no"];
        all.extend(arguments);
        let said = refused(folder.path(), &all);
        assert!(said.contains(wanted), "{said}");
    }
    // Beside the roller's middle, the cells' places are those of the pressures.
    let offset = "name = 'offset'\nroller = { radius_m = 10e-3, young_pa = 210e9, poisson = 0.3, length_m = 2.5e-3 }\n\
                  block = { young_pa = 210e9, poisson = 0.3, length_m = 2.5e-3 }\nload = { force_n = 1500.0 }\n\
                  pose = { offset_m = 0.4e-3 }\n";
    std::fs::write(folder.path().join("offset.toml"), offset).unwrap();
    let solve = ["solve", "offset.toml", "--engine", "cells", "--cells", "16,24", "--out", "off"];
    assert!(edgeline(folder.path(), &solve).output().unwrap().status.success());
    let axes = std::fs::read_to_string(folder.path().join("off/axes.json")).unwrap();
    let axes: Value = serde_json::from_str(&axes).unwrap();
    for (i, row) in rows(&folder.path().join("off/pressure.csv")).iter().enumerate() {
        for (axis, at) in [("x_m", i % 16), ("y_m", i / 16)] {
            let [got, want] = [axes[axis][at].as_f64().unwrap(), number(row, axis)];
            assert!((got - want).abs() < 1e-9, "{axis} of cell {i}: {got}, not {want}");
        }
    }
    let case = edgeline::case::builtin_case("flush-short").unwrap().unwrap().to_toml();
    let narrow = format!("{case}\n[cells]\nhalf_width_m = 1e-4\n");
    std::fs::write(folder.path().join("narrow.toml"), narrow).unwrap();
    let narrow =
        ["solve", "narrow.toml", "--engine", "cells", "--cells", "64,100", "--out", "none"];
    let said = refused(folder.path(), &narrow);
    assert!(said.contains("the cells, which end at x = 0.39"), "{said}");
    assert!(!folder.path().join("none").exists());
}

/// A two-dimensional array in numpy's format 1.0.
fn npy([nx, ny]: [usize; 2], value: impl Fn(usize, usize) -> f64) -> Vec<u8> {
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({nx}, {ny}), }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.bytes());
    (0..nx).for_each(|i| (0..ny).for_each(|j| bytes.extend(value(i, j).to_le_bytes())));
    bytes
}

/// flush-short with `surface` in its case file.
fn rough_case(surface: &str) -> String {
    let case = edgeline::case::builtin_case("flush-short").unwrap().unwrap().to_toml();
    format!("{case}\n[surface]\n{surface}\n")
}

#[test]
fn a_measured_surface_is_pressed_on_cells() {
    let folder = tempfile::tempdir().unwrap();
    let write =
        |name: &str, content: &[u8]| std::fs::write(folder.path().join(name), content).unwrap();
    // C is 0.252 mm, the contact 2.52 mm long.
    write("waves.npy", &npy([80, 90], |i, _| 2e-7 * (0.9 * i as f64).sin()));
    write("holes.npy", &npy([80, 90], |i, j| if (i, j) == (3, 7) { f64::NAN } else { 0.0 }));
    write("metres.npy", &npy([80, 90], |i, _| if i == 0 { -1.0 } else { 1.0 }));
    std::fs::File::create(folder.path().join("huge.npy")).unwrap().set_len(10 << 30).unwrap();
    let steps = "dx_m = 1e-5\ndy_m = 3e-5\n";
    let case = |name: &str, surface: &str| write(name, rough_case(surface).as_bytes());
    case("rough.toml", &format!("heights = \"waves.npy\"\n{steps}detrend = \"mean\""));
    let run = ["solve", "rough.toml", "--json", "--curve", "depth-centre", "--cells", "64,64"];
    let output = edgeline(folder.path(), &run).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(summary["details"]["engine"], "cells");
    assert_eq!(summary["method"], "quarter-space");
    assert!(
        summary["p_max_pa"].as_f64().unwrap() > 1.3 * summary["hertz"]["p0_pa"].as_f64().unwrap()
    );
    let out = folder.path().join("out");
    assert!(out.join("pressure.npy").is_file());
    let shares: f64 =
        rows(&out.join("pressure_histogram.csv")).iter().map(|row| number(row, "share")).sum();
    assert!((shares - 1.0).abs() < 1e-9);
    // The curve under the largest pressure is the most stressed one.
    assert!(rows(&out.join("curves.csv")).iter().any(|row| row["curve"] == "depth-peak"));
    let force = summary["load_n"].as_f64().unwrap();
    let loads = format!("--loads={},{force}", 0.25 * force);
    let more = [&run[..], &[&loads, "--layers", "1e-5,2e-4", "--plots", "--out", "more"]].concat();
    let output = edgeline(folder.path(), &more).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let more = folder.path().join("more");
    let by_load = rows(&more.join("load_gap.csv"));
    for (key, of) in [
        ("approach_m", &summary),
        ("mean_gap_m", &summary["details"]),
        ("contact_area_m2", &summary["details"]),
        ("p_max_pa", &summary),
    ] {
        let [low, own] = [0, 1].map(|i: usize| number(&by_load[i], key));
        assert!((own / of[key].as_f64().unwrap() - 1.0).abs() < 1e-6, "{key}");
        assert!(if key == "mean_gap_m" { low > own } else { low < own }, "{key}");
    }
    for name in ["layer-block-2.npy", "layer-roller-1.npy"] {
        let length = std::fs::metadata(more.join(name)).unwrap().len();
        assert_eq!(length, 128 + 8 * 6 * 64 * 64);
    }
    let layers: Value =
        serde_json::from_str(&std::fs::read_to_string(more.join("layers.json")).unwrap()).unwrap();
    assert_eq!(layers["layers"][1]["z_m"], 2e-4);
    assert!(layers["critical"]["value_pa"].as_f64().unwrap() > 1e8);
    // The case's tolerance has no part on cells.
    let page = std::fs::read_to_string(more.join("summary.html")).unwrap();
    assert!(page.contains("Relative residual asked for") && page.contains("1e−8"), "{page}");
    assert!(!page.contains("olerance"), "{page}");
    for plot in ["plot-heights.png", "plot-peak-block.svg", "plot-pressure-map.png"] {
        assert!(more.join(plot).is_file(), "{plot}");
    }
    let refusals = [
        ("heights = \"holes.npy\"", steps, "holes.npy: heights = NaN at [3, 7]"),
        ("heights = \"huge.npy\"", steps, "10737418240 bytes"),
        ("heights = \"\"", steps, "surface.heights = \"\" is not valid: the path"),
        (
            "heights = \"none.npy\"",
            steps,
            "surface.heights = \"none.npy\" is not valid: cannot read",
        ),
        ("heights = \"metres.npy\"", steps, "the heights range over 2 m, more than a tenth"),
        ("heights = \"waves.npy\"", "dx_m = 1e-5", "surface.dy_m is missing"),
        ("heights = \"waves.npy\"", "dx_m = 1e-5\ndy_m = 1e-5", "along y"),
        // Micrometres typed as metres.
        (
            "heights = \"waves.npy\"",
            "dx_m = 10\ndy_m = 3e-5",
            "surface.dx_m = 10 is not valid: neighbouring heights are further apart than the contact is wide, \
             5.046e-4 m; give the distance in metres",
        ),
        (
            "heights = \"waves.npy\"",
            "dx_m = 1e-5\ndy_m = 30",
            "than the contact is long, 2.523e-3 m",
        ),
        (
            "heights = \"waves.npy\"",
            "dx_m = 1e-8\ndy_m = 3e-5",
            "surface.dx_m = 1e-8 is not valid: with dy_m = 3e-5, the cells are",
        ),
        ("heights = \"waves.npy\"\ndetrend = \"plan\"", steps, "did you mean plane?"),
        ("heights = \"waves.npy\"\nheigths = 1", steps, "did you mean heights?"),
        ("heigths = \"waves.npy\"", steps, "did you mean heights?"),
    ];
    for (heights, steps, wanted) in refusals {
        case("bad.toml", &format!("{heights}\n{steps}"));
        let said = refused(folder.path(), &["solve", "bad.toml", "--out", "no"]);
        assert!(said.contains(wanted), "{said}");
    }
    for (more, wanted) in
        [(["--layers", "-1e-6"], "depth of layer 1"), (["--loads", "0"], "--loads = 0")]
    {
        let said =
            refused(folder.path(), &[&["solve", "rough.toml", "--out", "no"], &more[..]].concat());
        assert!(said.contains(wanted), "{said}");
    }
    // No other engine takes the case.
    for option in [
        &["--field"][..],
        &["--stiffness"],
        &["--laminae", "30"],
        &["--uncertain", "dimensionless.W=5%"],
    ] {
        let all = [&["solve", "rough.toml", "--out", "no"], option].concat();
        let said = refused(folder.path(), &all);
        let wanted =
            format!("surface.heights = \"waves.npy\" is not valid: {} is given", option[0]);
        assert!(said.contains(&wanted) && said.contains("or remove [surface]"), "{said}");
    }
    for arguments in [
        &["solve", "rough.toml", "--engine", "line", "--out", "no"][..],
        &["sweep", "rough.toml", "--out", "no"],
        &["explore", "rough.toml"],
        &["bench", "rough.toml", "--out", "no"],
    ] {
        let said = refused(folder.path(), arguments);
        assert!(said.contains("smooth"), "{said}");
    }
    assert!(!folder.path().join("no").exists());
}

/// A singular end is one that the contact reaches, and no flush one by quarter-space.
#[test]
fn a_largest_pressure_without_a_bound_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let note = "a singular end: it grows with the resolution";
    for (case, method, is_singular) in [
        ("half-short", "quarter-space", true),
        ("flush-short", "quarter-space", false),
        ("flush-short", "half-space", true),
        ("crown-inside", "quarter-space", false),
    ] {
        let solve = ["solve", case, "--method", method, "--tolerance", "0.1", "--plots"];
        let output = succeeded(&mut edgeline(folder.path(), &solve));
        let text = String::from_utf8(output.stdout).unwrap();
        let page = std::fs::read_to_string(folder.path().join("out/summary.html")).unwrap();
        assert_eq!(text.contains(&format!("({note})")), is_singular, "{text}");
        let row = format!("… near</th><td>{note}<");
        assert_eq!(page.contains(&row), is_singular, "{case}");
    }
}

/// Small bodies have digits, too.
#[test]
fn the_summary_of_a_small_case_has_no_zeros() {
    let folder = tempfile::tempdir().unwrap();
    let case = "name = \"small\"\nroller = { radius_m = 1e-6, young_pa = 1e6, poisson = 0.3 }\n\
                block = { young_pa = 1e6, poisson = 0.3 }\n\
                dimensionless = { W = 1e-4, S_l = 5, L_r = 1 }\n";
    std::fs::write(folder.path().join("small.toml"), case).unwrap();
    let solve = ["solve", "small.toml", "--tolerance=1e-1", "--method", "half-space"];
    let output = succeeded(&mut edgeline(folder.path(), &solve));
    let text = String::from_utf8(output.stdout).unwrap();
    // C = 2 R sqrt(W / pi), p0 = E* sqrt(W / pi), the load W E* R L with L = 10 C.
    let root = (1e-4 / std::f64::consts::PI).sqrt();
    let e_star = 1e6 / 1.82;
    let [c, p0] = [2e-6 * root, e_star * root];
    let load = 1e-4 * e_star * 1e-6 * 10.0 * c;
    for (name, value, unit) in [("load", load, "N"), ("C", c * 1e3, "mm"), ("p0", p0 * 1e-6, "MPa")]
    {
        let shown = text.split(&format!("{name} ")).nth(1).unwrap();
        let shown = shown.split(&format!(" {unit}")).next().unwrap();
        let found: f64 = shown.parse().unwrap();
        assert!((found / value - 1.0).abs() < 1e-4, "{name}: {text}");
    }
}

/// The last line names every file of a run, pictures in two formats once.
#[test]
fn the_last_line_names_all_files_that_were_written() {
    let folder = tempfile::tempdir().unwrap();
    let [line, cells] = ["--tolerance=1e-1", "--cells=16,32"];
    for arguments in [
        &["solve", "flush-short", line, "--laminae", "30", "--plots"][..],
        &["solve", "flush-short", line, "--uncertain", "load_n=5%", "--samples", "8"],
        &["solve", "flush-short", line, "--field", "--field-points", "3,3,3"],
        &["solve", "flush-short", "--engine=cells", cells, "--loads=200", "--layers=1e-4"],
        &["fatigue", "flush-short", line, "--places", "3,3"],
    ] {
        let output = succeeded(&mut edgeline(
            folder.path(),
            &[arguments, &["--method", "half-space", "--out", "o"]].concat(),
        ));
        let text = String::from_utf8(output.stdout).unwrap();
        let last = text.lines().last().unwrap();
        let names = last.strip_prefix("wrote ").unwrap().strip_suffix(" into o").unwrap();
        let both = |name: &str| match name.strip_suffix(".{svg,png}") {
            Some(stem) => vec![format!("{stem}.png"), format!("{stem}.svg")],
            None => vec![name.to_string()],
        };
        let mut named: Vec<String> = names.split(", ").flat_map(both).collect();
        named.sort();
        let out = folder.path().join("o");
        assert_eq!(named, files(&out), "{arguments:?}");
        std::fs::remove_dir_all(out).unwrap();
    }
}

#[test]
fn uncertain_inputs_leave_bands() {
    let folder = tempfile::tempdir().unwrap();
    let solve =
        ["solve", "flush-short", "--tolerance", "1e-2", "--curve", "depth-end", "--samples", "8"];
    let inputs = ["--uncertain", "load_n=5%", "--uncertain", "block.young_pa=4%"];
    let run = |more: &[&str]| {
        edgeline(folder.path(), &[&solve[..], &inputs, more].concat()).output().unwrap()
    };
    assert!(run(&["--out", "a"]).status.success());
    assert!(
        run(&["--out", "b"]).status.success()
            && run(&["--out", "c", "--seed", "2"]).status.success()
    );
    let text = |out: &str, name: &str| {
        std::fs::read_to_string(folder.path().join(out).join(name)).unwrap()
    };
    // The seed makes the samples.
    assert_eq!(text("a", "uncertainty.json"), text("b", "uncertainty.json"));
    assert_ne!(text("a", "uncertainty.json"), text("c", "uncertainty.json"));
    let found: Value = serde_json::from_str(&text("a", "uncertainty.json")).unwrap();
    let centre = &found["results"]["p_centre_pa"];
    let relative = |key: &str| centre[key].as_f64().unwrap() / centre["value"].as_f64().unwrap();
    assert!((relative("first_order") - 0.027).abs() < 0.003, "{centre}");
    assert!(centre["parts"]["load.force_n"].as_f64() > centre["parts"]["block.young_pa"].as_f64());
    let table = rows(&folder.path().join("a/uncertainty.csv"));
    assert!(
        table.iter().any(|r| r["body"] == "contact") && table.iter().any(|r| r["body"] == "roller")
    );
    assert!(table.iter().all(|r| number(r, "low_pa") <= number(r, "high_pa")));
    assert!(files(&folder.path().join("a")).contains(&"plot-uncertainty.png".into()));
    let plot = text("a", "plot-uncertainty.svg");
    assert!(plot.contains("p (MPa)") && plot.contains("von Mises (MPa)"), "{plot}");
    let origin = concat!("flush-short, quarter-space, edgeline ", env!("CARGO_PKG_VERSION"));
    assert!(plot.contains("95 % of the samples") && plot.contains(origin), "{origin}");
    let said =
        refused(folder.path(), &["solve", "flush-short", "--uncertain", "lod_n=5%", "--out", "d"]);
    assert!(said.contains("lod_n") && !folder.path().join("d").exists(), "{said}");
}
