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

#[test]
fn the_reference_has_every_key_option_and_column() {
    let folder = tempfile::tempdir().unwrap();
    let output = edgeline(folder.path(), &["extras", "--out", "e"]).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let text = std::fs::read_to_string(folder.path().join("e/reference.md")).unwrap();
    for key in &edgeline::case::KEYS {
        assert!(text.contains(&format!("| `{}` |", key.path)), "{}", key.path);
    }
    for part in [
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
