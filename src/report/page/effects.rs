//! The effects in words and plots.

use crate::report::plots;
use crate::report::study_files::StudyFiles;
use serde_json::{Value, json};

/// The effects of each method in words, and their plots.
pub(super) fn rows(files: &StudyFiles) -> Vec<Value> {
    let row = |method| {
        let told = files.summary.effects_in_words.iter().filter(|t| t.method == method);
        let words: Vec<&str> = told.map(|t| t.text.as_str()).collect();
        let plots: Vec<String> = ["half-normal", "pareto", "interactions"]
            .into_iter()
            .filter_map(|kind| plots::named(files, &format!("{kind}-{method}")))
            .collect();
        (!words.is_empty()).then(|| json!({ "method": method, "words": words, "plots": plots }))
    };
    files.summary.methods.iter().filter_map(|&method| row(method)).collect()
}
