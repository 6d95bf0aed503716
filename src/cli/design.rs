//! `edgeline design`: which profile should be ground.

use super::output::{Exit, print, print_json, say};
use super::progress::progress_bar;
use super::values::{checked_tolerance, count, edge_model};
use crate::base::number::{significant, stated};
use crate::base::{Error, Result};
use crate::body::EdgeModel;
use crate::case::{Case, Design};
use crate::host::{Lock, replace_set};
use crate::report::design::{at_bounds, contents, summary, value_pa};
use crate::study::optimum::{Optimum, Settings, seek};
use clap::{Args, ValueHint};
use std::path::PathBuf;
use std::time::Instant;

/// Finds the profile whose largest stress over several loads is smallest.
///
/// Varies the parameters of a profile within bounds (a TOML file, see cases/README.md): first a
/// sample of the bounds, then descents by Nelder and Mead's simplex from its best points. Trials
/// look at the loads that stress good profiles most; the best one is the best under all. The stress
/// is the largest one of both bodies, at least exclude_c half-widths from the surface's edges at
/// the ends of their overlap. Writes case.toml (the case with the profile, ready for `edgeline
/// solve`), loads.csv (what each load sees, at the case's own tolerance), history.csv (all trials,
/// with how many loads they looked at), scans.csv (lines through the optimum along each parameter),
/// plot-parameters and plot-loads (.svg and .png) and summary.json into the output folder. Takes
/// some seconds to half a minute: less than a tenth of a second for each contact.
#[derive(Args)]
pub(super) struct Arguments {
    /// A design file (TOML)
    #[arg(value_hint = ValueHint::FilePath)]
    file: PathBuf,
    /// How the free ends of the bodies are modelled
    #[arg(long, default_value = "quarter-space", value_parser = edge_model())]
    method: EdgeModel,
    /// Folder for the results; created if it does not exist
    #[arg(long, default_value = "design", value_hint = ValueHint::DirPath)]
    out: PathBuf,
    /// Accuracy of the search as a fraction of p0; the optimum is solved with the case's own
    #[arg(long, default_value_t = 3e-2)]
    tolerance: f64,
    /// Seed of the first sample
    #[arg(long, default_value_t = 1, value_name = "N")]
    seed: u64,
    /// Descents, from the best points of the first sample
    #[arg(long, default_value_t = 2, value_name = "N", value_parser = count("descents", 1..=20))]
    starts: usize,
    /// Print the summary as one JSON object and nothing else
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: Arguments) -> Result<Exit> {
    let began = Instant::now();
    let design = Design::read(&arguments.file)?;
    let settings = Settings {
        method: arguments.method,
        tolerance: checked_tolerance(arguments.tolerance)?,
        seed: arguments.seed,
        starts: arguments.starts,
    };
    let _lock = Lock::claim(&arguments.out)?;
    let bar = progress_bar();
    let found = seek(&design, &settings, &|trial, best_pa| {
        bar.set_position(trial as u64);
        bar.set_message(format!("trials, best {} MPa", significant(best_pa * 1e-6, 5)));
    });
    bar.finish_and_clear();
    let found = found?;
    let case = named(&design, &found)?;
    replace_set(&arguments.out, &contents(&design, &settings, &found, &case))?;
    for name in at_bounds(&design, &found) {
        say(&format!(
            "note: {name} lies at one of its bounds; wider ones, where they are legal, may do better"
        ));
    }
    for load in &found.loads {
        for warning in load.summary.warnings() {
            say(&format!("warning: under {} N: {warning}", load.case.load.force_n));
        }
    }
    if arguments.json {
        print_json(&summary(&design, &settings, &found))?;
    } else {
        print(&text(&design, &found, &arguments, began.elapsed().as_secs_f64()))?;
    }
    Ok(Exit::Done)
}

/// The case with the profile, under a name of its own.
fn named(design: &Design, found: &Optimum) -> Result<Case> {
    let case = design.designed(&found.values)?;
    let name = format!("{}-designed", case.name);
    let named = Case { name, ..case.clone() };
    // A very long name keeps its length.
    match named.check() {
        Err(Error::Value { key, .. }) if key == "name" => Ok(case),
        _ => Ok(named),
    }
}

/// The short summary for a reader.
fn text(design: &Design, found: &Optimum, arguments: &Arguments, seconds: f64) -> String {
    let mpa = |value_pa: f64| format!("{} MPa", significant(value_pa * 1e-6, 5));
    let values = design.parameters.iter().zip(&found.values);
    let values: Vec<String> =
        values.map(|(p, v)| format!("{} = {}", p.name, significant(*v, 4))).collect();
    let mut lines = vec![
        format!("{}: {}", design.case.name, values.join(", ")),
        format!(
            "  largest {} {}, at least {} C from the edges of the overlap (search: {})",
            design.objective.label(),
            mpa(found.confirmed_pa),
            design.exclude_c,
            mpa(found.searched_pa),
        ),
    ];
    for (load, before) in found.loads.iter().zip(&found.before) {
        let place = match (load.case.load.eccentricity_m, load.case.pose.tilt_rad) {
            (Some(e), _) => format!(" at y = {} m", stated(e)),
            (None, Some(tilt)) => format!(", tilted by {}", stated(tilt)),
            (None, None) => String::new(),
        };
        let before = before.map_or(String::new(), |before| {
            format!("; with the case's own profile {}", mpa(before))
        });
        lines.push(format!(
            "  {} N{place}: {}{before}",
            load.case.load.force_n,
            mpa(value_pa(load, design.objective)),
        ));
    }
    lines.push(format!(
        "  {} trials, {} contacts, {seconds:.1} s",
        found.history.len(),
        found.solves
    ));
    lines.push(format!(
        "wrote case.toml, loads.csv, history.csv, scans.csv, pictures and summary.json into {}",
        arguments.out.display()
    ));
    lines.join("\n") + "\n"
}
