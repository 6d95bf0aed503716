//! The page and its Markdown from their templates.

use super::{effects, errors, explorer, fem, solves, times, verification};
use crate::base::number::{
    duration, duration_with_spread, ratio_with_spread, significant, with_minus_signs,
};
use crate::base::{Error, Result};
use crate::report::fraction::fraction;
use crate::report::plots;
use crate::report::study_files::StudyFiles;
use crate::study::Source;
use minijinja::{Environment, context};

const PAGE: &str = include_str!("page.html");
const MARKDOWN: &str = include_str!("report.md");
const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// Limits that hold for every study.
const CAVEATS: [&str; 5] = [
    "W, S_l and L_r are defined here as W = w / (E* R L), S_l = L / (2 C) and L_r = L1 / L2, L the length \
     of the shorter body; the published study names the factors, its formulas and levels are not in the text \
     that we have.",
    "The stress correction of guilbault is a reconstruction: the formula of its transition factor \
     is not in the text that we have.",
    "For L_r < 1 the pressure grows without bound towards the end of the shorter body. Peaks there are those \
     of a mesh, so the surroundings of the edge are left out and the rest of the curves compared.",
    "The models take both bodies for half-spaces with end faces and the gap for a parabola. A real \
     roller also carries a nearly uniform tension across its diameter of the order of p0 C / (2 R).",
    "FEM's own error is the difference of its two finest meshes: an estimate, not a bound.",
];

/// The page.
///
/// # Errors
/// [`Error::File`] when the run's files lack data of the page.
pub fn html(files: &StudyFiles) -> Result<String> {
    // "<" inside the data would let a name end the script element.
    let data = explorer::data(files).to_string().replace('<', "\\u003c");
    let time_plot = plots::named(files, "time-error").unwrap_or_default();
    render("page.html", PAGE, files, context! { data, time_plot, js => SCRIPT })
}

/// The same tables as Markdown.
///
/// # Errors
/// As [`html`].
pub fn markdown(files: &StudyFiles) -> Result<String> {
    render("report.md", MARKDOWN, files, context! {})
}

/// Fills a template with the data of both forms of the page, and with `more`.
fn render(
    name: &str,
    template: &str,
    files: &StudyFiles,
    more: minijinja::Value,
) -> Result<String> {
    let base = context! {
        s => files.summary,
        caveats => CAVEATS,
        error_tables => errors::tables(files),
        times => times::table(files),
        any_ratio => files.study.iter().any(|row| row.speedup.is_some()),
        effects => effects::rows(files),
        details => solves::details(files),
        work => solves::work(files),
        timed => fem::timed(files),
        equal_error => fem::equal_error(files),
        fem_versions => fem::versions(files),
        verification => verification::data(files),
        any_brought => files.summary.has_brought(),
    };
    fill(name, template, context! { ..more, ..base })
}

/// Fills the template called `name` with `data`, and with the style of all pages as `css`.
///
/// # Errors
/// [`Error::File`] when the data lack what the template shows.
pub fn fill(name: &str, template: &str, data: minijinja::Value) -> Result<String> {
    let mut environment = Environment::new();
    add_filters(&mut environment);
    let fault = |e: minijinja::Error| Error::File {
        path: name.into(),
        line: None,
        message: format!("{e:#}"),
        remedy: "run it again with this version".to_string(),
    };
    environment.add_template(name, template).map_err(fault)?;
    environment
        .get_template(name)
        .and_then(|t| t.render(context! { css => STYLE, ..data }))
        .map_err(fault)
}

/// The formats of numbers in the templates.
fn add_filters(environment: &mut Environment) {
    let dash = || "–".to_string();
    environment.add_filter("p0", move |v: minijinja::Value| {
        as_number(&v).map_or_else(dash, |v| with_minus_signs(&fraction(v)))
    });
    environment.add_filter("ratio", move |v: minijinja::Value, spread: minijinja::Value| {
        as_number(&v)
            .zip(as_number(&spread))
            .map_or_else(dash, |(v, spread)| ratio_with_spread(v, spread))
    });
    environment.add_filter("source", |name: String| {
        let known = Source::all().find(|source| source.name() == name);
        known.map_or(name, |source| source.title().to_string())
    });
    environment.add_filter("typeset", |text: String| typeset(&text));
    environment.add_filter("seconds", move |v: minijinja::Value| {
        as_number(&v).map_or_else(dash, duration)
    });
    environment.add_filter("with_spread", move |v: minijinja::Value, spread: minijinja::Value| {
        match (as_number(&v), as_number(&spread)) {
            (Some(v), Some(spread)) => duration_with_spread(v, spread),
            (Some(v), None) => duration(v),
            (None, _) => dash(),
        }
    });
    environment.add_filter("short", move |v: minijinja::Value| {
        as_number(&v).map_or_else(dash, |v| with_minus_signs(&significant(v, 5)))
    });
}

/// Minus signs instead of hyphens before digits, which also keeps lines from breaking there.
fn typeset(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut before = ' ';
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        let number = rest.peek().is_some_and(char::is_ascii_digit);
        out.push(if c == '-' && number && " (e".contains(before) { '−' } else { c });
        before = c;
    }
    out
}

fn as_number(value: &minijinja::Value) -> Option<f64> {
    f64::try_from(value.clone()).ok().filter(|v| v.is_finite())
}
