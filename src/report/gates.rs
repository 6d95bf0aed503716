//! The outcomes of gates as a table, Markdown, JUnit XML and JSON.

use crate::base::number::significant;
use crate::study::gate::GateOutcome;
use serde_json::{Value, json};
use std::fmt::Write;

/// A number of an outcome, or a dash.
fn number(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_string(), |v| significant(v, 5))
}

/// The number of gates that hold, in words.
pub fn headline(outcomes: &[GateOutcome]) -> String {
    let failed = outcomes.iter().filter(|o| !o.passed).count();
    if failed == 0 {
        format!("all {} gates hold", outcomes.len())
    } else {
        format!("{failed} of {} gates fail", outcomes.len())
    }
}

/// A table for a terminal.
pub fn table(outcomes: &[GateOutcome]) -> String {
    let mut rows = vec![
        ["gate", "model", "value", "limit", "margin", "compared", "holds", "where"]
            .map(String::from),
    ];
    rows.extend(outcomes.iter().map(|o| {
        [
            o.title(),
            o.method.clone(),
            number(o.value),
            significant(o.limit, 5),
            number(o.margin),
            o.compared.to_string(),
            if o.passed { "yes" } else { "NO" }.to_string(),
            o.note.clone(),
        ]
    }));
    let width = |c: usize| rows.iter().map(|r| r[c].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..8).map(width).collect();
    let mut text = String::new();
    for row in &rows {
        let cells: Vec<String> = row
            .iter()
            .zip(&widths)
            .enumerate()
            .map(|(c, (cell, &w))| match c {
                // Numbers to the right, words to the left, the last as it is.
                2..=5 => format!("{cell:>w$}"),
                7 => cell.clone(),
                _ => format!("{cell:<w$}"),
            })
            .collect();
        text.push_str(cells.join("  ").trim_end());
        text.push('\n');
    }
    text
}

/// A table in Markdown with the failed gates first.
pub fn markdown(outcomes: &[GateOutcome]) -> String {
    let mut text = format!("## Accuracy gates: {}\n\n", headline(outcomes));
    text.push_str("| gate | model | value | limit | margin | compared | holds | where |\n");
    text.push_str("|---|---|---:|---:|---:|---:|---|---|\n");
    let mut sorted: Vec<&GateOutcome> = outcomes.iter().collect();
    sorted.sort_by_key(|o| o.passed);
    for o in sorted {
        let holds = if o.passed { "yes" } else { "**NO**" };
        let (value, limit, margin) = (number(o.value), significant(o.limit, 5), number(o.margin));
        let note = o.note.replace('|', "/").replace('\n', " ");
        writeln!(
            text,
            "| {} | {} | {value} | {limit} | {margin} | {} | {holds} | {note} |",
            o.title(),
            o.method,
            o.compared
        )
        .expect("a string grows");
    }
    text
}

/// JUnit XML: a test case for each gate, its class the model.
pub fn junit(outcomes: &[GateOutcome]) -> String {
    let failed = outcomes.iter().filter(|o| !o.passed).count();
    let total = outcomes.len();
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites tests=\"{total}\" \
         failures=\"{failed}\">\n  <testsuite name=\"edgeline gate\" tests=\"{total}\" \
         failures=\"{failed}\" errors=\"0\">\n"
    );
    for o in outcomes {
        let (name, class) =
            (escape(&format!("{}: {}", o.kind.name(), o.title())), escape(&o.method));
        let state = format!(
            "value {}, limit {}, {} compared; {}",
            number(o.value),
            significant(o.limit, 5),
            o.compared,
            o.note
        );
        let state = escape(&state);
        let inside = if o.passed {
            format!("<system-out>{state}</system-out>")
        } else {
            format!("<failure message=\"{state}\"/>")
        };
        writeln!(text, "    <testcase classname=\"{class}\" name=\"{name}\">{inside}</testcase>")
            .expect("a string grows");
    }
    text + "  </testsuite>\n</testsuites>\n"
}

/// The outcomes for other programs.
pub fn json(outcomes: &[GateOutcome]) -> Value {
    json!({
        "hold": !outcomes.is_empty() && outcomes.iter().all(|o| o.passed),
        "failed": outcomes.iter().filter(|o| !o.passed).count(),
        "gates": outcomes,
    })
}

/// Escapes text for XML: the five special characters, and control characters, which XML does not
/// allow.
fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&apos;"),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::gate::Kind;

    fn outcomes() -> Vec<GateOutcome> {
        let good = GateOutcome {
            study: "scenes".to_string(),
            name: "pressure, RMS".to_string(),
            method: "quarter-space".to_string(),
            kind: Kind::Limit,
            passed: true,
            value: Some(0.00123),
            limit: 0.005,
            margin: Some(0.00377),
            compared: 18,
            note: "worst at a, contact, along-y, pressure".to_string(),
        };
        let bad = GateOutcome {
            name: "a < b & \"c\"".to_string(),
            passed: false,
            value: None,
            margin: None,
            compared: 0,
            note: "nothing was compared".to_string(),
            ..good.clone()
        };
        vec![good, bad]
    }

    #[test]
    fn every_form_tells_what_failed() {
        let all = outcomes();
        assert_eq!(headline(&all), "1 of 2 gates fail");
        let text = table(&all);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 3);
        assert!(lines[1].starts_with("scenes: pressure, RMS "), "{text}");
        assert!(lines[1].contains("0.00123  0.005"), "{text}");
        assert!(lines[2].ends_with("NO     nothing was compared"), "{text}");
        let markdown = markdown(&all);
        let first = markdown.lines().nth(4).unwrap();
        assert!(first.contains("**NO**"), "the failed one comes first: {first}");
        assert_eq!(json(&all)["hold"], false);
        assert_eq!(json(&all)["gates"][1]["passed"], false);
    }

    #[test]
    fn junit_is_escaped_and_counts() {
        let xml = junit(&outcomes());
        assert!(xml.contains("tests=\"2\" failures=\"1\""));
        assert!(xml.contains("limit: scenes: a &lt; b &amp; &quot;c&quot;"));
        assert_eq!(xml.matches("<testcase").count(), 2);
        assert_eq!(xml.matches("<failure").count(), 1);
    }
}
