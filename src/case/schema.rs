//! The JSON Schema of case files, from the list of their numbers: editors complete and check by it.

use super::check::MAX_NAME;
use super::draft::Form;
use super::keys::{FLAGS, KEYS, Key, Presence, WORDS, Word, split};
use super::profile::{ProfileKind, ProfileSpec};
use crate::base::BodyKind;
use serde_json::{Map, Value, json};

/// The schema of a case file, JSON Schema of 2020-12. A profile has the keys of its kind; what else
/// several keys have to meet together, such as the lengths of both bodies, it does not say.
pub fn case_schema() -> Value {
    let mut tables = Map::new();
    for key in &KEYS {
        let table = tables.entry(key.table()).or_insert_with(|| {
            json!({ "type": "object", "additionalProperties": false, "properties": {}, "required": [] })
        });
        table["properties"][key.leaf()] = number(key);
        if key.presence == Presence::Always {
            push(&mut table["required"], key.leaf());
        }
    }
    for word in &WORDS {
        for (table, leaf) in word.paths.iter().map(|path| split(path)) {
            tables[table]["properties"][leaf] = one_of(word);
        }
    }
    for body in BodyKind::ALL.map(BodyKind::name) {
        let mut profile = tables.remove(&format!("{body}.profile")).expect("a body has a profile");
        push(&mut profile["required"], "kind");
        profile["allOf"] = ProfileKind::ALL.map(of_kind).into();
        tables[body]["properties"]["profile"] = profile;
    }
    for flag in &FLAGS {
        tables[flag.table()]["properties"][flag.leaf()] = json!({
            "description": format!("Whether to take in {}; false by default.", flag.what),
            "type": "boolean",
        });
    }
    push(&mut tables["surface"]["required"], "heights");
    let needed = |(_, table): &(&String, &Value)| table["required"] != json!([]);
    let names = tables.iter().filter(needed).map(|(name, _)| name.as_str());
    let names = names.filter(|name| *name != "surface");
    let required: Vec<&str> = std::iter::once("name").chain(names).collect();
    let mut properties = Map::from_iter([("name".to_string(), name())]);
    properties.extend(tables.clone());
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A case of edgeline",
        "description": "One contact problem: a roller that is pressed on a block. All numbers are in SI units.",
        "type": "object",
        "additionalProperties": false,
        "properties": properties,
        "required": required,
        "oneOf": [form(Form::Load), form(Form::Factors)],
    })
}

fn name() -> Value {
    json!({
        "description": "Names the case in results, and folders.",
        "type": "string",
        "pattern": format!("^[A-Za-z0-9_-][A-Za-z0-9._-]{{0,{}}}$", MAX_NAME - 1),
    })
}

fn number(key: &Key) -> Value {
    let (low, high) = key.range;
    let example: f64 = key.example.parse().expect("an example is a number");
    let mut schema = json!({
        "description": key.what.trim_end_matches(','),
        "type": "number",
        "minimum": low,
        "maximum": high,
        "examples": [example],
    });
    if low < 0.0 && !key.takes(0.0) {
        schema["not"] = json!({ "const": 0 });
    }
    schema
}

fn one_of(word: &Word) -> Value {
    match (word.choices)() {
        choices if choices.is_empty() => json!({ "description": word.what, "type": "string" }),
        choices => json!({ "description": word.what, "enum": choices }),
    }
}

/// What a profile of this kind has to have, and what it has not.
fn of_kind(kind: ProfileKind) -> Value {
    let file = (kind == ProfileKind::Table).then_some("file");
    let own: Vec<&str> = kind.keys().iter().copied().chain(file).collect();
    let all = ProfileSpec::NUMBERS.into_iter().chain(["file"]);
    let others = all.filter(|key| !own.contains(key)).map(|key| (key.to_string(), json!(false)));
    json!({
        "if": { "properties": { "kind": { "const": kind.name() } }, "required": ["kind"] },
        "then": { "required": own, "properties": Map::from_iter(others) },
    })
}

/// What one way of giving the load and the lengths asks for, and what it leaves to the other one.
fn form(form: Form) -> Value {
    let (mut properties, mut required) = (Map::new(), Vec::new());
    for of_table in KEYS.chunk_by(|a, b| a.table() == b.table()) {
        let table = of_table[0].table();
        if of_table.iter().all(|key| !key.is_of(form)) {
            properties.insert(table.to_string(), json!(false));
            continue;
        }
        let of_form = |key: &&Key| key.presence == Presence::With(form);
        let asked: Vec<&str> = of_table.iter().filter(of_form).map(|key| key.leaf()).collect();
        let left = of_table.iter().filter(|key| !key.is_of(form));
        let left: Map<String, Value> = left.map(|key| (key.leaf().into(), json!(false))).collect();
        if !asked.is_empty() {
            required.push(table);
        }
        let several = of_table.iter().filter(|key| key.is_of(form) && key.is_one_of_several());
        let several: Vec<Value> = several.map(|key| json!({ "required": [key.leaf()] })).collect();
        if !several.is_empty() {
            required.push(table);
            properties.insert(table.into(), json!({ "oneOf": several, "properties": left }));
        } else if !asked.is_empty() || !left.is_empty() {
            properties.insert(table.into(), json!({ "required": asked, "properties": left }));
        }
    }
    json!({ "properties": properties, "required": required })
}

/// Adds a text to a list.
fn push(list: &mut Value, text: &str) {
    list.as_array_mut().expect("a list").push(json!(text));
}
