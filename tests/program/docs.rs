//! The documentation: commands of the first steps and of the how-to pages run as they stand, those
//! of all other pages exist, and the reference has every key and option.

use crate::support::{edgeline, files, said};
use std::path::Path;

/// Commands that need a browser, other tools or long: only their options are checked. The study
/// `profiled` has tests of its own.
const NOT_RUN: [&str; 6] = ["explore", "fem", "bench", "doctor", "gate", "study profiled"];

fn page(path: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

/// The arguments of each command of the program in a page's blocks of code.
fn commands(text: &str) -> Vec<Vec<String>> {
    let own = text.lines().filter_map(|line| {
        let line = line.strip_prefix("    ")?.strip_prefix("edgeline ")?;
        Some(line.split(" && ").next()?.split(" # ").next()?.to_string())
    });
    own.map(|line| line.split_whitespace().map(str::to_string).collect()).collect()
}

/// The files that a page asks to save: "Save this as `name`:" and a block of code.
fn saved(text: &str) -> Vec<(String, String)> {
    let blocks = text.split("Save this as `").skip(1);
    let file = |block: &str| {
        let (name, rest) = block.split_once("`:\n\n```").unwrap();
        let content = rest.split_once('\n').unwrap().1.split("```").next().unwrap();
        (name.to_string(), content.to_string())
    };
    blocks.map(file).collect()
}

#[test]
fn commands_of_the_first_steps_and_of_how_to_pages_run() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = 0;
    for path in ["docs/first-steps.md", "docs/howto.md"] {
        let text = page(path);
        for (name, content) in saved(&text) {
            std::fs::write(folder.path().join(name), content).unwrap();
        }
        for arguments in commands(&text) {
            let line = arguments.join(" ");
            let mut arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
            if NOT_RUN.iter().any(|not_run| line.starts_with(not_run)) {
                arguments.push("--help");
            } else if arguments[0] == "study" && !arguments.contains(&"--repeats") {
                // Nobody reads how long it took.
                arguments.extend(["--repeats", "0"]);
            }
            let output = edgeline(folder.path(), &arguments).output().unwrap();
            assert!(output.status.success(), "{path}: {arguments:?}: {}", said(&output));
            run += 1;
        }
    }
    assert!(run >= 17, "{run} commands");
    let made = files(&folder.path().join("report"));
    assert!(made.contains(&"summary.html".into()), "{made:?}");
}

#[test]
fn commands_of_all_pages_exist() {
    let folder = tempfile::tempdir().unwrap();
    let docs = files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("docs"));
    let docs = docs.iter().filter(|name| name.ends_with(".md")).map(|name| format!("docs/{name}"));
    for path in docs.chain(["README.md".into(), "cases/README.md".into()]) {
        for arguments in commands(&page(&path)) {
            let mut all: Vec<&str> = arguments.iter().map(String::as_str).collect();
            all.push("--help");
            let output = edgeline(folder.path(), &all).output().unwrap();
            assert!(output.status.success(), "{path}: {all:?}: {}", said(&output));
        }
    }
}

/// The columns that a page names in the section of a command: the words in code of its tables and
/// texts.
fn named_columns(page: &str, command: &str) -> Vec<String> {
    let section = page.split("\n## ").find(|part| part.lines().next() == Some(command));
    let words = section.unwrap_or_else(|| panic!("{command}")).split('`').skip(1).step_by(2);
    words.map(str::to_string).collect()
}

/// Columns that follow from what is asked for: those of ranges are named by the first and the last.
fn is_one_of_many(column: &str) -> bool {
    let words: Vec<&str> = column.split('_').collect();
    column.starts_with("p_") && column.ends_with("C_p0")
        || column.ends_with("_half_space")
        || ["sigma", "von", "tau"].contains(&words[0])
            && ["rms", "max"].contains(&words[words.len() - 1])
}

#[test]
fn the_page_of_tables_has_every_column() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let page = page("docs/files.md");
    std::fs::write(path.join("points.csv"), "body,x_m,y_m,z_m\nblock,0,0,0\n").unwrap();
    std::fs::write(path.join("sweep.csv"), "W,S_l,L_r\n1e-3,5,1\n").unwrap();
    let design = "case = 'flush-short'\nprofile.kind = 'crown'\nbounds.radius_m = [0.1, 10.0]\n\
                  [[loads]]\nforce_n = 1500.0\n";
    std::fs::write(path.join("design.toml"), design).unwrap();
    let line =
        ["--tolerance", "0.1", "--laminae", "30", "--uncertain", "load_n=5%", "--samples", "4"];
    let solve = [&["solve", "flush-short", "--points", "points.csv"], &line[..]].concat();
    let cells = "solve flush-short --engine cells --cells 16,32 --loads 200";
    for command in [
        solve.join(" ").as_str(),
        cells,
        "fatigue flush-short --places 3,3 --tolerance 0.1",
        "sweep sweep.csv --base flush-short --out o/sweep.csv",
        "design design.toml --starts 1 --tolerance 0.1",
        "study factorial --methods half-space --repeats 0",
        "compare flush-short given.csv",
    ] {
        let mut arguments: Vec<&str> = command.split(' ').collect();
        if !command.contains("--out") {
            arguments.extend(["--out", "o"]);
        }
        let output = edgeline(path, &arguments).output().unwrap();
        // Curves from elsewhere may differ.
        assert!(output.status.code() < Some(2), "{command}: {}", said(&output));
        // Curves are alike everywhere, and a comparison has the tables of a study.
        let named = [arguments[0], "solve", "study"].map(|of| named_columns(&page, of)).concat();
        for file in files(&path.join("o")).iter().filter(|name| name.ends_with(".csv")) {
            assert!(page.contains(&format!("`{file}`")), "{file}");
            let text = std::fs::read_to_string(path.join("o").join(file)).unwrap();
            for column in text.lines().next().unwrap().split(',').filter(|c| !is_one_of_many(c)) {
                assert!(named.contains(&column.to_string()), "{command}: {file}: {column}");
            }
        }
        if command == cells {
            std::fs::copy(path.join("o/pressure.csv"), path.join("given.csv")).unwrap();
        }
        std::fs::remove_dir_all(path.join("o")).unwrap();
    }
}

#[test]
fn the_reference_has_every_key_option_and_column() {
    let folder = tempfile::tempdir().unwrap();
    let output = edgeline(folder.path(), &["extras", "--out", "e"]).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let text = std::fs::read_to_string(folder.path().join("e/reference.md")).unwrap();
    for key in &edgeline::case::KEYS {
        assert!(text.contains(&format!("| `{}` |", key.path)), "{}", key.path);
    }
    for word in &edgeline::case::WORDS {
        assert!(word.paths.iter().all(|path| text.contains(&format!("`{path}`"))), "{word:?}");
    }
    for flag in &edgeline::case::FLAGS {
        assert!(text.contains(&format!("| `{}` |", flag.path)), "{}", flag.path);
    }
    for part in [
        "Poisson's ratio | 0, less than 0.5 |",
        "### edgeline explore",
        "`--tolerance TOLERANCE`",
        "`--port PORT`",
        "`sigma_yy_pa`",
        "`line_load_n_per_m`",
        "| `critical.value_pa` |",
        "| `hertz.c_m` |",
        "| `johns-gohar` | `design_force_n` |",
    ] {
        assert!(text.contains(part), "{part}");
    }
    // Every row of a table has the cells of its head.
    for table in text.split("\n\n").filter(|part| part.starts_with("| ")) {
        let cells = |row: &str| row.replace("\\|", "").matches('|').count();
        let head = cells(table.lines().next().unwrap());
        assert!(table.lines().all(|row| cells(row) == head), "{table}");
    }
}
