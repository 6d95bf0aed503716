//! Progress on standard error.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::time::Duration;

/// What goes on, for who waits: a line that moves on a terminal, plain lines otherwise.
pub(super) struct Progress {
    bar: Option<ProgressBar>,
}

impl Progress {
    /// Progress of something whose length is not known.
    pub fn new() -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new_spinner();
            let style = ProgressStyle::with_template("{spinner} {prefix}: {msg} ({elapsed})");
            bar.set_style(style.expect("a constant template"));
            bar.enable_steady_tick(Duration::from_millis(100));
            bar
        });
        Self { bar }
    }

    /// Says what is being done to what.
    pub fn say(&self, what: &str, doing: &str) {
        match &self.bar {
            Some(bar) => {
                bar.set_prefix(what.to_string());
                bar.set_message(doing.to_string());
            }
            None => super::say(&format!("{what}: {doing}")),
        }
    }

    /// Clears the line.
    pub fn finish(self) {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
        }
    }
}
