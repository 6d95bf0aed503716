//! The imports between the files of a crate, read from the sources. Every path that starts at
//! `crate`, `super`, `self`, a module or an imported name is followed, through re-exports, to the
//! file that defines the name. Code under `#[cfg(test)]` is left out.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Largest number of re-exports of a name.
const PATIENCE: usize = 8;

/// Names of the modules from the crate's root to one of them.
type Place = Vec<String>;

/// The definitions and names of one module, in its own file or within another.
#[derive(Default)]
struct Module {
    file: PathBuf,
    items: BTreeSet<String>,
    /// Names that `use` imports, and their paths.
    bound: BTreeMap<String, Vec<String>>,
    /// Paths of glob imports.
    globs: Vec<Vec<String>>,
    /// Paths used here, by private `use` or in the code.
    used: Vec<Vec<String>>,
    /// Paths of public `use`.
    offered: Vec<Vec<String>>,
}

/// The modules of a crate.
pub struct Sources {
    modules: BTreeMap<Place, Module>,
}

impl Sources {
    /// Reads the modules that `lib.rs` declares, from the texts of all files by their paths below
    /// `src`.
    pub fn new(texts: &BTreeMap<PathBuf, String>) -> Self {
        let mut sources = Self { modules: BTreeMap::new() };
        sources.read(texts, Vec::new(), Path::new("lib.rs"));
        sources
    }

    fn read(&mut self, texts: &BTreeMap<PathBuf, String>, place: Place, file: &Path) {
        let text = texts.get(file).unwrap_or_else(|| panic!("{} is missing", file.display()));
        let tokens = tokens(text);
        let declared = self.scan(&tokens, place.clone(), file);
        for child in declared {
            let folder: PathBuf = place.iter().collect();
            let alone = folder.join(format!("{child}.rs"));
            let with_children = folder.join(&child).join("mod.rs");
            let file = if texts.contains_key(&alone) { alone } else { with_children };
            self.read(texts, [&place[..], &[child]].concat(), &file);
        }
    }

    /// Notes the modules that stand in these tokens, and returns those declared to have files.
    fn scan(&mut self, tokens: &[String], place: Place, file: &Path) -> Vec<String> {
        let mut module = Module { file: file.to_path_buf(), ..Module::default() };
        let (mut declared, mut depth, mut i) = (Vec::new(), 0, 0);
        let at = |i: usize| tokens.get(i).map_or("", String::as_str);
        while i < tokens.len() {
            match at(i) {
                "#" => {
                    let open = i + 1 + usize::from(at(i + 1) == "!");
                    let end = matching(tokens, open);
                    let attribute = &tokens[open..end];
                    let of_tests = at(open + 1) == "cfg" && attribute.iter().any(|t| t == "test");
                    i = if of_tests { item_end(tokens, end) } else { end };
                    continue;
                }
                "use" => {
                    let end = (i..tokens.len()).find(|&j| at(j) == ";").unwrap_or(tokens.len());
                    let public = i > 0 && matches!(at(i - 1), "pub" | ")");
                    module.take_use(&tokens[i + 1..end], public);
                    i = end;
                    continue;
                }
                "mod" if is_name(at(i + 1)) && at(i + 2) == ";" => declared.push(at(i + 1).into()),
                "mod" if is_name(at(i + 1)) && at(i + 2) == "{" => {
                    let end = matching(tokens, i + 2);
                    let inner = [&place[..], &[at(i + 1).to_string()]].concat();
                    self.scan(&tokens[i + 3..end - 1], inner, file);
                    i = end;
                    continue;
                }
                "fn" | "struct" | "enum" | "trait" | "type" | "const" | "static" | "union"
                    if depth == 0 && is_name(at(i + 1)) =>
                {
                    module.items.insert(at(i + 1).into());
                }
                "{" => depth += 1,
                "}" => depth -= 1,
                name if is_name(name) && at(i + 1) == "::" && (i == 0 || at(i - 1) != "::") => {
                    let mut path = vec![name.to_string()];
                    while at(i + 1) == "::" && is_name(at(i + 2)) {
                        path.push(at(i + 2).into());
                        i += 2;
                    }
                    module.used.push(path);
                }
                _ => {}
            }
            i += 1;
        }
        self.modules.insert(place, module);
        declared
    }

    /// The file that defines the name of a path, seen from a module; none outside the crate. The
    /// file of a module's name is the module's own.
    fn resolve(&self, place: &Place, path: &[String], patience: usize) -> Option<&Path> {
        let (mut at, mut rest) = (place.clone(), path);
        match path[0].as_str() {
            "crate" => (at, rest) = (Vec::new(), &path[1..]),
            "self" => rest = &path[1..],
            _ => {}
        }
        while rest.first().is_some_and(|name| name == "super") {
            at.pop();
            rest = &rest[1..];
        }
        let mut module = self.modules.get(&at)?;
        while let Some(name) = rest.first() {
            at.push(name.clone());
            let Some(child) = self.modules.get(&at) else {
                at.pop();
                break;
            };
            (module, rest) = (child, &rest[1..]);
        }
        let Some(name) = rest.first() else { return Some(&module.file) };
        if module.items.contains(name) {
            return Some(&module.file);
        }
        let patience = patience.checked_sub(1)?;
        if let Some(bound) = module.bound.get(name) {
            return self.resolve(&at, &[bound, &rest[1..]].concat(), patience);
        }
        let mut globs = module.globs.iter();
        globs.find_map(|glob| self.resolve(&at, &[glob, rest].concat(), patience))
    }

    /// The files that define what a path names; with `*` at its end, all that the module before it
    /// defines or brings.
    fn named(&self, place: &Place, path: &[String]) -> Vec<&Path> {
        let Some((_, before)) = path.split_last().filter(|(last, _)| *last == "*") else {
            return self.resolve(place, path, PATIENCE).into_iter().collect();
        };
        let Some(file) = self.resolve(place, before, PATIENCE) else { return Vec::new() };
        let module = self.modules.iter().find(|(_, module)| module.file == file);
        let (at, module) = module.expect("the file of a module");
        let brought = module.bound.values().filter_map(|path| self.resolve(at, path, PATIENCE));
        brought.chain([file]).collect()
    }

    /// Pairs of files, the first of which imports from the second. Re-exports of a module from its
    /// own submodules do not count.
    pub fn imports(&self) -> BTreeSet<(&Path, &Path)> {
        let mut found = BTreeSet::new();
        for (place, module) in &self.modules {
            let own = module.file.as_path();
            let files = |paths: &[Vec<String>]| -> Vec<&Path> {
                paths.iter().flat_map(|path| self.named(place, path)).collect()
            };
            let folder: PathBuf = place.iter().collect();
            let offered =
                files(&module.offered).into_iter().filter(|file| !file.starts_with(&folder));
            let others = files(&module.used).into_iter().chain(offered);
            found.extend(others.filter(|file| *file != own).map(|file| (own, file)));
        }
        found
    }

    /// The files that were read.
    pub fn files(&self) -> BTreeSet<&Path> {
        self.modules.values().map(|module| module.file.as_path()).collect()
    }
}

impl Module {
    /// Reads the tokens between `use` and its semicolon.
    fn take_use(&mut self, tree: &[String], public: bool) {
        let mut leaves = Vec::new();
        flatten(tree, &[], &mut leaves);
        for (mut path, name) in leaves {
            match name {
                Some(name) => {
                    self.bound.insert(name, path.clone());
                }
                None => {
                    self.globs.push(path.clone());
                    path.push("*".into());
                }
            }
            (if public { &mut self.offered } else { &mut self.used }).push(path);
        }
    }
}

/// Paths of a tree of imports with the names they are bound to, none for `*`.
fn flatten(tree: &[String], prefix: &[String], leaves: &mut Vec<(Vec<String>, Option<String>)>) {
    let mut path = prefix.to_vec();
    let mut i = 0;
    while i < tree.len() {
        match tree[i].as_str() {
            "::" => {}
            "*" => return leaves.push((path, None)),
            "as" => return leaves.push((path, tree.get(i + 1).cloned())),
            "{" => {
                let inner = &tree[i + 1..matching(tree, i) - 1];
                let (mut depth, mut start) = (0, 0);
                for (j, token) in inner.iter().enumerate() {
                    match token.as_str() {
                        "{" => depth += 1,
                        "}" => depth -= 1,
                        "," if depth == 0 => {
                            flatten(&inner[start..j], &path, leaves);
                            start = j + 1;
                        }
                        _ => {}
                    }
                }
                return flatten(&inner[start..], &path, leaves);
            }
            "self" if i + 1 == tree.len() && !prefix.is_empty() => {}
            name => path.push(name.into()),
        }
        i += 1;
    }
    if path.len() > prefix.len() || tree.first().is_some_and(|t| t == "self") {
        let name = path.last().cloned();
        leaves.push((path, name));
    }
}

fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// The index after the bracket that closes the one at `open`.
fn matching(tokens: &[String], open: usize) -> usize {
    let mut depth = 0;
    for (i, token) in tokens.iter().enumerate().skip(open) {
        match token.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return i + 1;
        }
    }
    tokens.len()
}

/// The index after the item that starts at `i`: after its semicolon or its braces.
fn item_end(tokens: &[String], mut i: usize) -> usize {
    while i < tokens.len() {
        match tokens[i].as_str() {
            ";" => return i + 1,
            "{" => return matching(tokens, i),
            "(" | "[" => i = matching(tokens, i),
            _ => i += 1,
        }
    }
    i
}

/// Names, `::` and single characters of a source. Comments are left out, because they may mention
/// any module, and literals are replaced by placeholders.
fn tokens(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let length = if c.is_whitespace() {
            c.len_utf8()
        } else if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if let Some(length) = literal(rest) {
            found.push("\"".into());
            length
        } else {
            let name = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
            let length = match name {
                0 if rest.starts_with("::") => 2,
                0 => c.len_utf8(),
                _ => name,
            };
            found.push(rest[..length].into());
            length
        };
        rest = &rest[length..];
    }
    found
}

/// Bytes of the string or character literal that starts here, if one does.
fn literal(text: &str) -> Option<usize> {
    let tail = text.strip_prefix('b').unwrap_or(text);
    let before = text.len() - tail.len();
    if let Some(raw) = tail.strip_prefix('r') {
        let hashes = raw.len() - raw.trim_start_matches('#').len();
        let body = raw[hashes..].strip_prefix('"')?;
        let close = format!("\"{}", "#".repeat(hashes));
        let end = body.find(&close).map_or(body.len(), |end| end + close.len());
        return Some(before + 2 + hashes + end);
    }
    let quote = tail.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    let mut escaped = false;
    for (i, c) in tail.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            c if c == quote => return Some(before + i + 1),
            // A lifetime: a character literal would have been closed by now.
            _ if quote == '\''
                && tail[1..i].chars().count() == 1
                && !tail[1..].starts_with('\\') =>
            {
                return None;
            }
            _ => {}
        }
    }
    Some(text.len())
}
