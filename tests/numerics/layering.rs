//! Modules import only modules above them in the list of layers at the head of `src/lib.rs`.

use std::fs;
use std::path::{Path, PathBuf};

/// The layers, top first, as the table in the crate's documentation lists them.
fn layers(lib: &str) -> Vec<String> {
    lib.lines()
        .filter_map(|line| line.strip_prefix("//! | ")?.trim_start_matches('[').strip_prefix('`'))
        .map(|rest| rest.split('`').next().expect("split yields one piece at least").to_string())
        .collect()
}

/// The text without comments and string literals, which may mention any module.
fn code_of(text: &str) -> String {
    let mut code = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let skip = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if rest.starts_with("'\"'") {
            3
        } else if rest.starts_with("'\\\"'") {
            4
        } else if let Some(hashes) = raw_string(rest) {
            let close = format!("\"{}", "#".repeat(hashes));
            let body = 2 + hashes;
            rest[body..].find(&close).map_or(rest.len(), |end| body + end + close.len())
        } else if c == '"' {
            string_length(rest)
        } else {
            code.push(c);
            rest = &rest[c.len_utf8()..];
            continue;
        };
        code.push(' ');
        rest = &rest[skip..];
    }
    code
}

/// The number of hashes of a raw string that starts here.
fn raw_string(text: &str) -> Option<usize> {
    let tail = text.strip_prefix('r')?;
    let hashes = tail.len() - tail.trim_start_matches('#').len();
    tail[hashes..].starts_with('"').then_some(hashes)
}

/// Bytes of the string literal that starts here, quotes included.
fn string_length(text: &str) -> usize {
    let mut escaped = false;
    for (i, c) in text.char_indices().skip(1) {
        match c {
            '"' if !escaped => return i + 1,
            '\\' => escaped = !escaped,
            _ => escaped = false,
        }
    }
    text.len()
}

/// Top-level modules that a source file names, by `crate::`, by as many `super::` as lead there,
/// or in braces after either. `depth` is the number of modules that the file is nested in.
fn imports(text: &str, depth: usize) -> Vec<String> {
    let code: String = code_of(text).split_whitespace().collect::<Vec<_>>().join(" ");
    let code = code.replace(" ::", "::").replace(":: ", "::");
    let mut found = Vec::new();
    for (at, _) in code.match_indices("crate::") {
        let own = !code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == '$');
        if own {
            found.extend(heads(&code[at + "crate::".len()..]));
        }
    }
    // An inline module is one level deeper than its file, so `depth` supers may not reach the top;
    // to read them as if they did can only report a name that is a layer's and no sibling's.
    let climb = "super::".repeat(depth);
    for (at, _) in code.match_indices(&climb) {
        let tail = &code[at + climb.len()..];
        found.extend(heads(tail.trim_start_matches("super::")));
    }
    found
}

/// First segments of a path, or of each path in braces.
fn heads(path: &str) -> Vec<String> {
    let identifier = |text: &str| -> String {
        text.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
    };
    let Some(inner) = path.strip_prefix('{') else {
        return vec![identifier(path)];
    };
    let (mut names, mut depth) = (vec![identifier(inner)], 0);
    for (i, c) in inner.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => names.push(identifier(&inner[i + 1..])),
            _ => {}
        }
    }
    names
}

/// Imports against the direction: the file's layer and the layer that it must not know.
fn violations(layers: &[String], files: &[(PathBuf, String)]) -> Vec<(PathBuf, String)> {
    let rank = |name: &str| layers.iter().position(|l| l == name);
    let mut found = Vec::new();
    for (path, text) in files {
        let mut modules: Vec<&str> =
            path.iter().map(|part| part.to_str().expect("names are ASCII")).collect();
        let file = modules.pop().expect("a path is not empty");
        let stem = file.trim_end_matches(".rs");
        if stem != "mod" {
            modules.push(stem);
        }
        let Some(own) = rank(modules[0]) else {
            continue;
        };
        for import in imports(text, modules.len()) {
            if rank(&import).is_some_and(|other| other > own) {
                found.push((path.clone(), import));
            }
        }
    }
    found
}

/// All Rust sources below `folder`, with paths relative to `root`.
fn sources(folder: &Path, root: &Path, into: &mut Vec<(PathBuf, String)>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, root, into);
        } else if path.extension().is_some_and(|e| e == "rs") {
            let relative = path.strip_prefix(root).unwrap().to_path_buf();
            into.push((relative, fs::read_to_string(&path).unwrap()));
        }
    }
}

#[test]
fn no_module_imports_one_below_it() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let lib = fs::read_to_string(root.join("lib.rs")).unwrap();
    let layers = layers(&lib);
    let declared: Vec<&str> = lib
        .lines()
        .filter_map(|line| line.trim_start_matches("pub ").strip_prefix("mod ")?.strip_suffix(';'))
        .collect();
    assert_eq!(layers, declared, "the table of layers lists the modules in their order");
    let mut files = Vec::new();
    sources(&root, &root, &mut files);
    assert!(files.len() >= layers.len(), "found {} files only", files.len());
    let found = violations(&layers, &files);
    assert!(found.is_empty(), "imports against the direction: {found:#?}");
}

#[test]
fn planted_violations_are_found() {
    let layers: Vec<String> = ["base", "kernels", "body", "cli"].map(String::from).to_vec();
    for (path, text, wanted) in [
        ("base/error.rs", "use crate::body::EdgeModel;", vec!["body"]),
        ("base/mod.rs", "fn f() { crate::cli::run() }", vec!["cli"]),
        ("base/mod.rs", "use crate::{base::Error, body::{A, B}, cli};", vec!["body", "cli"]),
        ("base/mod.rs", "use crate::{\n    kernels as k,\n};", vec!["kernels"]),
        ("base/mod.rs", "use super::body;", vec!["body"]),
        ("base/error.rs", "use super::super::{body};", vec!["body"]),
        ("base/error.rs", "use super::body;", vec![]),
        ("body/model.rs", "use crate::base::Result; use crate::kernels::love;", vec![]),
        (
            "base/mod.rs",
            "//! see [`crate::cli`]\n/* crate::cli */ const S: &str = \"crate::cli\";",
            vec![],
        ),
        ("base/mod.rs", "const S: &str = \"\\\"\"; use crate::cli;", vec!["cli"]),
        ("base/mod.rs", "const S: &str = r#\"\"crate::cli\"#; const C: char = '\"';", vec![]),
        ("main.rs", "use edgeline::cli;", vec![]),
    ] {
        let files = [(PathBuf::from(path), text.to_string())];
        let found: Vec<String> = violations(&layers, &files).into_iter().map(|(_, m)| m).collect();
        assert_eq!(found, wanted, "{path}: {text}");
    }
}
