//! The case of a request: the text of a case file, or its tables as JSON.

use crate::base::{Error, Result};
use crate::case::Case;
use serde_json::Value as Json;
use std::path::Path;
use toml::{Table, Value};

/// Texts that name files. Each must be that of the case that the explorer was started with, so that
/// a page cannot make the program open another one.
const FILES: [&str; 3] = ["roller.profile.file", "block.profile.file", "surface.heights"];

/// Reads the case of a request, in JSON if `is_json`, otherwise in TOML. `own` is the case that the
/// explorer was started with.
///
/// # Errors
/// The messages of the command line, [`Error::Value`] and [`Error::File`].
pub fn case(body: &[u8], is_json: bool, own: &Case) -> Result<Case> {
    let path = Path::new("the case");
    let refuse = |message: String| Error::File {
        path: path.into(),
        line: None,
        message,
        remedy: "send the text of a case file, or its tables as JSON".into(),
    };
    let text = std::str::from_utf8(body).map_err(|_| refuse("is not UTF-8".into()))?;
    let text = if is_json {
        let tables: Json =
            serde_json::from_str(text).map_err(|e| refuse(format!("is not valid JSON: {e}")))?;
        toml::to_string(&without_gaps(tables)).map_err(|e| refuse(format!("is not a case: {e}")))?
    } else {
        text.to_string()
    };
    if let Ok(tables) = text.parse::<Table>() {
        let own: Table = own.to_toml().parse().expect("a case writes TOML");
        only_own_files("", &Value::Table(tables), &own)?;
    }
    let case = Case::parse(&text, path).map_err(|e| match e {
        // Nobody sees the text that tables make.
        Error::File { path, message, remedy, .. } if is_json => {
            Error::File { path, line: None, message, remedy }
        }
        other => other,
    })?;
    case.check_force("the page changes forces")?;
    Ok(case)
}

/// The same without members that are null: what is not given.
fn without_gaps(value: Json) -> Json {
    match value {
        Json::Object(members) => {
            let given = members.into_iter().filter(|(_, member)| !member.is_null());
            Json::Object(given.map(|(key, member)| (key, without_gaps(member))).collect())
        }
        other => other,
    }
}

/// Refuses [`FILES`] other than those of the `own` case.
fn only_own_files(path: &str, value: &Value, own: &Table) -> Result<()> {
    match value {
        Value::Table(table) => table.iter().try_for_each(|(key, value)| {
            let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            only_own_files(&path, value, own)
        }),
        Value::String(text) if FILES.contains(&path) && find(own, path) != Some(text) => {
            Err(Error::Value {
                key: path.into(),
                value: text.clone(),
                reason: "the explorer opens no files but those of its own case".into(),
                remedy: "start it with that case: `edgeline explore CASE`".into(),
            })
        }
        _ => Ok(()),
    }
}

/// The text at a path.
fn find<'t>(table: &'t Table, path: &str) -> Option<&'t String> {
    match path.split_once('.') {
        Some((first, rest)) => find(table.get(first)?.as_table()?, rest),
        None => match table.get(path)? {
            Value::String(text) => Some(text),
            _ => None,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::builtin_case;

    #[test]
    fn json_and_toml_give_the_same_case() {
        let own = builtin_case("flush-short").unwrap().unwrap();
        let toml = own.to_toml();
        let tables: Table = toml.parse().unwrap();
        let mut json = serde_json::to_value(tables).unwrap();
        json["pose"] = serde_json::json!({ "tilt_rad": null });
        assert_eq!(case(toml.as_bytes(), false, &own).unwrap(), own);
        assert_eq!(case(json.to_string().as_bytes(), true, &own).unwrap(), own);
    }

    #[test]
    fn requests_open_no_files() {
        let own = builtin_case("flush-short").unwrap().unwrap();
        let with_file = own.to_toml().replace(
            "[block]",
            "[roller.profile]\nkind = \"table\"\nfile = \"/etc/passwd\"\n[block]",
        );
        let said = case(with_file.as_bytes(), false, &own).unwrap_err().to_string();
        assert!(
            said.contains("roller.profile.file = /etc/passwd") && said.contains("explore CASE"),
            "{said}"
        );
        let rough =
            own.to_toml() + "[surface]\nheights = \"/etc/passwd\"\ndx_m = 1e-6\ndy_m = 1e-6\n";
        let said = case(rough.as_bytes(), false, &own).unwrap_err().to_string();
        assert!(said.contains("opens no files"), "{said}");
        let tables: Table = own.to_toml().parse().unwrap();
        let mut misspelt = serde_json::to_value(tables).unwrap();
        misspelt["roller"]["radius"] = 1.0.into();
        let misspelt = misspelt.to_string();
        let said = case(misspelt.as_bytes(), true, &own).unwrap_err().to_string();
        assert!(said.starts_with("the case: unknown key roller.radius; did you mean"), "{said}");
        for (body, wanted) in [
            (&b"\xff"[..], "UTF-8"),
            (b"{", "JSON"),
            (b"[]", "not a case"),
            (b"{\"name\": 1}", "no load"),
        ] {
            let said = case(body, true, &own).unwrap_err().to_string();
            assert!(said.contains(wanted), "{said}");
        }
    }
}
