//! The page of a comparison.

use super::summary::Summary;
use crate::base::Result;
use crate::report::draw::Figure;
use crate::report::page::fill;
use crate::study::Source;
use crate::study::brought::{Comparison, GATED};
use minijinja::context;
use serde_json::{Value, json};

const PAGE: &str = include_str!("compare.html");

/// Curves that the page shows open: those with the largest errors of quarter-space.
const OPEN: usize = 4;

/// Curves whose plots are in the page; those of the others are files beside it.
const SHOWN: usize = 12;

/// The page.
///
/// # Errors
/// [`crate::base::Error::File`] if the template does not fit its data.
pub(super) fn html(
    comparison: &Comparison,
    summary: &Summary,
    figures: &[(String, Figure)],
) -> Result<String> {
    let mut curves = curves(comparison);
    let mut by_size: Vec<usize> = (0..curves.len()).collect();
    let size = |i: &usize| curves[*i]["largest"].as_f64().unwrap_or(-1.0);
    by_size.sort_by(|a, b| size(b).total_cmp(&size(a)));
    for (rank, i) in by_size.into_iter().enumerate() {
        let (name, figure) = &figures[i];
        curves[i]["file"] = json!(name);
        curves[i]["open"] = json!(rank < OPEN);
        if rank < SHOWN {
            curves[i]["plot"] = json!(figure.draw().to_themed_svg());
        }
    }
    fill("compare.html", PAGE, context! { s => summary, curves })
}

/// The curves in the order of their plots, each with the errors of all sources.
fn curves(comparison: &Comparison) -> Vec<Value> {
    let mut all = Vec::new();
    for run in &comparison.files {
        let lines = run
            .file
            .curves
            .pressure
            .iter()
            .map(|l| (crate::study::CONTACT, l.name.as_str(), l.at.len()));
        let stress =
            run.file.curves.stress.iter().map(|c| (c.body.name(), c.name.as_str(), c.at.len()));
        for (body, curve, points) in lines.chain(stress) {
            let own = run.errors.iter().filter(|r| r.body == body && r.curve == curve);
            let of = |source: &Source| {
                let rows = own.clone().filter(move |r| r.method == *source);
                rows.map(|r| r.max).max_by(f64::total_cmp)
            };
            let errors: Vec<Value> = run
                .sources
                .iter()
                .map(|on| json!({ "source": on.source.title(), "max": of(&on.source) }))
                .collect();
            let worst = own
                .clone()
                .filter(|r| r.method == GATED.into())
                .max_by(|a, b| a.max.total_cmp(&b.max));
            all.push(json!({
                "reference": run.file.name,
                "body": body,
                "curve": curve,
                "points": points,
                "errors": errors,
                "largest": worst.map(|r| r.max),
                "quantity": worst.map(|r| r.variable),
                "at": worst.map(|r| r.max_at),
            }));
        }
    }
    all
}
