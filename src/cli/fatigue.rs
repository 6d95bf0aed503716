//! `edgeline fatigue`: what the material goes through as the contact passes it.

use super::output::{Exit, print, print_json, warn, wrote};
use super::progress::Progress;
use super::values::{checked_tolerance, count, directions, edge_model, say_if_too_fine};
use crate::base::Result;
use crate::base::number::significant;
use crate::body::EdgeModel;
use crate::case::find_case;
use crate::host::{Lock, replace_set};
use crate::report::fatigue::{CriticalPlace, Passages, Summary, contents, summary};
use crate::report::study_files::pretty;
use crate::solve::{Options, Passage, SolvedCase};
use crate::stress::BodyKind;
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// Finds where a contact that passes again and again begins to damage its bodies.
///
/// A place of a body sees the stresses along x, one after the other. From this history at places
/// over the length and the depth of both bodies: the range of tau_xz, the largest shear and von
/// Mises stress and, with their numbers in the case's [fatigue] table, the measures of Dang Van and
/// of Fatemi and Socie. Writes fatigue.csv (one row per place, the values by half-spaces beside the
/// method's), fatigue-<body>.vtr for ParaView (z < 0 in the roller), a map of each measure with its
/// largest value marked (fatigue-*.svg and .png), and summary.json with the critical places and how
/// far half-spaces are off. Takes some seconds: 3 to 10 on two cores.
#[derive(Args)]
pub(super) struct Arguments {
    /// A case file, or the name of a case that `edgeline cases` lists
    #[arg(value_hint = ValueHint::FilePath)]
    pub(super) case: PathBuf,
    /// How the free ends of the bodies are modelled
    #[arg(long, default_value = "quarter-space", value_parser = edge_model())]
    method: EdgeModel,
    /// Folder for the results; created if it does not exist
    #[arg(long, default_value = "fatigue", value_hint = ValueHint::DirPath)]
    out: PathBuf,
    /// Numbers of places along the contact and into the bodies; half as many are added beyond an
    /// end
    #[arg(long, value_name = "NY,NZ", value_delimiter = ',', default_value = "33,31", num_args = 1, value_parser = count("places", 2..=500))]
    places: Vec<usize>,
    /// Accuracy as a fraction of p0, that of the case by default
    #[arg(long)]
    tolerance: Option<f64>,
    /// Print the summary as one JSON object and nothing else
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit> {
    let mut case = find_case(&arguments.case)?;
    if let Some(tolerance) = arguments.tolerance {
        case.accuracy.tolerance = checked_tolerance(tolerance)?;
    }
    say_if_too_fine(&case);
    let counts: [usize; 2] = directions("--places", &arguments.places, "places have two", "33,31")?;
    let _lock = Lock::claim(&arguments.out)?;
    let options = Options { curves: Vec::new(), ..Options::new(arguments.method) };
    let solved = SolvedCase::new(&case, &options)?;
    // Half-spaces are judged under the same force, where it is the approach that is given.
    let case = solved.case();
    let passages =
        |method: EdgeModel, bodies: Vec<Passage>| Passages { method: method.name().into(), bodies };
    let progress = Progress::new();
    let report = |body: BodyKind, method: EdgeModel| {
        progress.say(&case.name, &format!("{} by {method}", body.name()));
    };
    let bodies = BodyKind::ALL.map(|body| {
        report(body, arguments.method);
        Passage::new(&solved, body, counts)
    });
    let half_space = match arguments.method {
        EdgeModel::HalfSpace => None,
        _ => {
            let other = SolvedCase::new(case, &Options::new(EdgeModel::HalfSpace))?;
            let beside = bodies.iter().map(|passage| {
                report(passage.body, EdgeModel::HalfSpace);
                passage.by(&other)
            });
            Some(passages(EdgeModel::HalfSpace, beside.collect()))
        }
    };
    progress.finish();
    let own = passages(arguments.method, bodies.to_vec());
    let hertz = case.hertz();
    let warnings = solved.solution().summary.warnings();
    let found = summary(case, &hertz, &own, half_space.as_ref(), warnings);
    let mut files = contents(case, &hertz, &own, half_space.as_ref());
    files.push(("summary.json".into(), pretty(&found).into_bytes()));
    replace_set(&arguments.out, &files)?;
    warn(&found.warnings);
    if arguments.json {
        print_json(&found)?;
    } else {
        let names: Vec<String> = files.into_iter().map(|(name, _)| name).collect();
        print(&format!("{}{}\n", text(&found), wrote(&names, &arguments.out)))?;
    }
    Ok(Exit::Done)
}

/// The short summary for a reader.
fn text(found: &Summary) -> String {
    let Summary { case, method, c_m, p0_pa, friction, critical, warnings: _ } = found;
    let mut lines = vec![format!(
        "{case} by {method}, friction {friction}: C {} mm, p0 {} MPa",
        significant(c_m * 1e3, 5),
        significant(p0_pa * 1e-6, 5)
    )];
    lines.extend(critical.iter().map(|c| line(c, *c_m, *p0_pa)));
    lines.join("\n") + "\n"
}

/// One critical place.
fn line(c: &CriticalPlace, c_m: f64, p0_pa: f64) -> String {
    let CriticalPlace { body, measure, value, at_m, over_limit, half_space, .. } = c;
    let name = measure.trim_end_matches("_pa");
    let value = match measure.ends_with("_pa") {
        true => format!("{:.4} p0", value / p0_pa),
        false => format!("{value:.4e}"),
    };
    let [y, z] = at_m.map(|v| v / c_m);
    let limit = over_limit.map_or(String::new(), |ratio| format!(", {ratio:.3} of the limit"));
    let half_space = half_space.as_ref().map_or(String::new(), |other| {
        let [y, z] = other.at_m.map(|v| v / c_m);
        format!("; half-spaces: {:.2} times that, at y = {y:.2} C, z = {z:.2} C", other.factor)
    });
    format!("  {}, {name}: {value} at y = {y:.2} C, z = {z:.2} C{limit}{half_space}", body.name())
}
