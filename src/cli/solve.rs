//! `edgeline solve`: one case by one edge model.

use super::output::{Exit, print, print_json, say, warn, wrote};
use super::progress::{progress_bar, show};
use super::provenance::now;
use super::uncertain_options::UncertainOptions;
use super::values::{
    checked_residual, checked_tolerance, count, directions, edge_model, listed, one_of,
    say_if_too_fine, unsuited,
};
use crate::base::number::{duration, significant, stated};
use crate::base::{Error, Result};
use crate::body::EdgeModel;
use crate::case::{Case, find_case};
use crate::host::{Lock, check_memory};
use crate::report::plots::PROGRAM;
use crate::report::{cells, field, page, solution};
use crate::solve::{
    CellDetails, CellOptions, Lamina, MOST_CELLS, MOST_GRID_POINTS, Options, Solution, SolvedCase,
    Summary, check_cells, check_layers, laminae, layers_on_cells, loads_on_cells, solve_on_cells,
    stiffness,
};
use crate::stress::BodyKind;
use crate::stress::curves::CURVE_NAMES;
use clap::builder::PossibleValuesParser;
use clap::{Args, ValueHint};
use serde::Serialize;
use std::path::PathBuf;

/// Solves one case with the semi-analytical method.
///
/// Writes summary.json, pressure.csv (the contact pressure over x at the nodes along y, whose
/// weights are dy_m: the sum of p_pa dx_m dy_m is the load), line_load.csv (load per length and
/// half-width along the contact), curves.csv (stresses on the standard curves of both bodies) and,
/// with --points, points.csv into the output folder (docs/files.md); with --plots also plot-*.svg
/// and .png (pressure, its map, stresses of both bodies) and summary.html, a page about the case.
/// With --laminae, laminae.csv: slices of the contact beside those of ISO/TS 16281, steel's
/// constant. With --uncertain, what uncertain inputs make of the results. Takes well under
/// a second, with --uncertain that for each sample; with --field, or for a scene that is not
/// symmetric, a few seconds.
///
/// With --engine cells, also pressure.npy (numbers of cells across and along) and axes.json (their
/// centres); pressure.csv has a row for each cell, up to 100,000 of them. Takes some seconds, most
/// of them for Love's sums. For a rough surface also pressure_histogram.csv. With --loads
/// load_gap.csv, with --layers layer-BODY-NUMBER.npy (numbers of cells, then xx, yy, zz, xy, xz, yz
/// in Pa) and layers.json.
#[derive(Args)]
pub(super) struct Arguments {
    /// A case file, or the name of a case that `edgeline cases` lists
    #[arg(value_hint = ValueHint::FilePath)]
    pub(super) case: PathBuf,
    /// How the free ends of the bodies are modelled
    #[arg(long, default_value = "quarter-space", value_parser = edge_model())]
    method: EdgeModel,
    /// How the contact is discretised: modes across the line, or uniform cells (the published
    /// method); line by default, cells for a case with a rough surface
    #[arg(long, value_enum)]
    engine: Option<Engine>,
    /// Numbers of cells across and along the contact; by its shape and the width of their region if
    /// absent
    #[arg(long, value_name = "NX,NY", value_delimiter = ',', value_parser = count("cells", 4..=MOST_CELLS))]
    cells: Vec<usize>,
    /// Also the contact under these forces (N), on cells: load, approach, mean gap, real contact
    /// area
    #[arg(long, value_name = "F,F,...", value_delimiter = ',')]
    loads: Vec<f64>,
    /// Also all stresses under every cell at these depths (m), on cells
    #[arg(long, value_name = "Z,Z,...", value_delimiter = ',')]
    layers: Vec<f64>,
    /// Folder for the results; created if it does not exist
    #[arg(long, default_value = "out", value_hint = ValueHint::DirPath)]
    out: PathBuf,
    /// CSV file of further points, with the columns body,x_m,y_m,z_m; lines that begin with # are
    /// comments
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    points: Option<PathBuf>,
    /// Also write pictures of pressure and stresses, and a page about the case
    #[arg(long)]
    plots: bool,
    /// Also write the stress fields of both bodies, field-<body>.vtr for ParaView, in the block's
    /// axes: in the roller z, sigma_xz and sigma_yz have the opposite sign of those in curves.csv;
    /// and pressure.vtr, and pictures of planes through the fields
    #[arg(long, conflicts_with = "points")]
    field: bool,
    /// Numbers of points of a quarter of a body: across, along and into it
    #[arg(long, value_name = "NX,NY,NZ", value_delimiter = ',', default_value = "33,49,41", value_parser = count("grid points", 2..=2000), requires = "field")]
    field_points: Vec<usize>,
    /// Only this body's curves; both by default
    #[arg(long, value_parser = one_of(&BodyKind::ALL, BodyKind::name))]
    body: Vec<BodyKind>,
    /// Only this curve; may be given several times; all by default
    #[arg(long, value_parser = PossibleValuesParser::new(CURVE_NAMES))]
    curve: Vec<String>,
    /// Accuracy as a fraction of p0, that of the case by default; with --engine cells the relative
    /// residual, 1e-8 by default
    #[arg(long)]
    tolerance: Option<f64>,
    /// Adds the stiffnesses, force by approach and moment by tilt, to summary.json: four more
    /// solutions
    #[arg(long)]
    stiffness: bool,
    /// Writes laminae.csv: the loads of N equal slices of the contact beside those of ISO/TS 16281
    #[arg(long, value_name = "N", value_parser = count("slices", 30..=2000))]
    laminae: Option<usize>,
    #[command(flatten)]
    uncertain: UncertainOptions,
    /// Print the summary as one JSON object and nothing else
    #[arg(long)]
    json: bool,
}

/// How a contact is discretised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Engine {
    /// Modes across the contact, on graded nodes along it.
    Line,
    /// Uniform cells of constant pressure.
    Cells,
}

/// Why the engine on cells refuses stiffnesses and laminae.
const NOT_ON_CELLS: &str = "does not compute them";

impl Arguments {
    /// The engine that is asked for; without, the one that takes the case.
    fn engine(&self, case: &Case) -> Engine {
        let own = if case.surface.is_some() { Engine::Cells } else { Engine::Line };
        self.engine.unwrap_or(own)
    }

    /// Refuses options of the engine on cells.
    fn check_no_cells(&self) -> Result<()> {
        for (option, given) in [
            ("cells", listed(&self.cells)),
            ("loads", listed(&self.loads)),
            ("layers", listed(&self.layers)),
        ] {
            if !given.is_empty() {
                let reason = "only the engine on cells takes it";
                return Err(unsuited((option, &given), reason, "add --engine cells"));
            }
        }
        Ok(())
    }

    /// Refuses options of the engine along a line, which takes no rough `case`.
    fn check_cells_alone(&self, case: &Case) -> Result<()> {
        let (key, value, engine, instead) = match &case.surface {
            Some(surface) => (
                "surface.heights",
                format!("{:?}", surface.heights.display()),
                "the engine on cells, which alone carries heights,",
                "remove [surface]",
            ),
            None => ("--engine", "cells".into(), "the engine on cells", "take --engine line"),
        };
        for (option, is_given, reason) in [
            ("field", self.field, "writes no fields"),
            ("stiffness", self.stiffness, NOT_ON_CELLS),
            ("laminae", self.laminae.is_some(), NOT_ON_CELLS),
            ("uncertain", self.uncertain.is_given(), "is too slow for many solutions"),
        ] {
            if is_given {
                return Err(Error::Value {
                    key: key.into(),
                    value,
                    reason: format!("--{option} is given, and {engine} {reason}"),
                    remedy: format!("leave out --{option}, or {instead}"),
                });
            }
        }
        Ok(())
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit> {
    let mut case = find_case(&arguments.case)?;
    let mut options = Options::new(arguments.method);
    if !arguments.body.is_empty() {
        options.bodies.retain(|body| arguments.body.contains(body));
    }
    if !arguments.curve.is_empty() {
        options.curves.retain(|curve| arguments.curve.contains(curve));
    }
    if let Some(path) = &arguments.points {
        options.points = super::points::read(path, &case)?;
    }
    if arguments.engine(&case) == Engine::Cells {
        return run_on_cells(&case, &options, arguments);
    }
    if let Some(tolerance) = arguments.tolerance {
        case.accuracy.tolerance = checked_tolerance(tolerance)?;
    }
    say_if_too_fine(&case);
    arguments.check_no_cells()?;
    options.check_line(&case)?;
    if arguments.uncertain.is_given() {
        case.check_force("an uncertain case has a force")?;
    }
    arguments.uncertain.inputs(&case)?;
    let counts = if arguments.field { Some(field_counts(arguments)?) } else { None };
    let _lock = Lock::claim(&arguments.out)?;
    let solved = SolvedCase::new(&case, &options)?;
    let case = solved.case();
    let mut more = match counts {
        Some(counts) => field::contents(&solved, counts)?,
        None => Vec::new(),
    };
    let mut found = solved.solution();
    if arguments.stiffness {
        found.summary.details.stiffness = Some(stiffness(&solved, &options)?);
    }
    if let Some(count) = arguments.laminae {
        let laminae = laminae(&solved, count)?;
        say(&what_laminae_miss(case, &laminae));
        let table = solution::laminae(&laminae);
        more.push((format!("{}.csv", table.name), table.to_csv().into_bytes()));
    }
    more.extend(pictures(case, &found, None, arguments)?);
    more.extend(arguments.uncertain.contents(case, arguments.method, &found.curves)?);
    let names = solution::write(&found, &options, more, &arguments.out)?;
    warn(&found.summary.warnings());
    tell(case, &found, &names, arguments)
}

/// What the slices of ISO/TS 16281 make of the ends, in words.
fn what_laminae_miss(case: &Case, all: &[Lamina]) -> String {
    let ratio = |lamina: &Lamina| lamina.load_n / lamina.standard_load_n;
    let [first, last] = [&all[0], &all[all.len() - 1]].map(ratio);
    let shown = |ratio: f64| match (ratio.is_finite(), ratio.is_nan()) {
        (true, _) => format!("{ratio:.3} times its load"),
        (false, false) => "a load where it has none".to_string(),
        (false, true) => "no load, as there".to_string(),
    };
    let steel = |young_pa: f64| (195e9..=220e9).contains(&young_pa);
    let own = [case.roller.material.young_pa, case.block.material.young_pa];
    let material = match own.into_iter().all(steel) {
        true => "",
        false => "; the standard's constant is that of steel, which these bodies are not",
    };
    format!(
        "note: laminae: beside ISO/TS 16281 the first slice carries {}, and the last {}{material}",
        shown(first),
        shown(last)
    )
}

/// The same on uniform cells.
fn run_on_cells(case: &Case, options: &Options, arguments: &Arguments) -> Result<Exit> {
    arguments.check_cells_alone(case)?;
    let mut cells = CellOptions::default();
    match arguments.cells[..] {
        [] => {}
        [nx, ny] => cells.counts = Some([nx, ny]),
        _ => {
            let given = ("cells", &*listed(&arguments.cells));
            return Err(unsuited(given, "there are two directions", "give for example 64,128"));
        }
    }
    if let Some(tolerance) = arguments.tolerance {
        cells.tolerance = checked_residual(tolerance)?;
    }
    let grid = check_cells(case, options.method, &cells)?;
    for force_n in &arguments.loads {
        let checked = case.clone().with_force(*force_n).check();
        checked.map_err(|e| e.of_option("--loads", &stated(*force_n)))?;
    }
    check_layers(case, options, &arguments.layers, grid.len())?;
    let _lock = Lock::claim(&arguments.out)?;
    let bar = progress_bar();
    // In tenths of a decade of the residual.
    let tenths = |residual: f64| (-10.0 * residual.log10()).max(0.0) as usize;
    let all = tenths(cells.tolerance);
    let progress = |step: usize, residual: f64| {
        let what = format!("step {step}, residual {residual:.0e}");
        show(&bar, tenths(residual).min(all), all, &what);
    };
    let found = solve_on_cells(case, options, &cells, &progress).and_then(|found| {
        let loads = loads_on_cells(case, options, &cells, &arguments.loads, &progress)?;
        Ok((found, loads))
    });
    bar.finish_and_clear();
    let (found, loads) = found?;
    let hertz = &found.solution.summary.hertz;
    let mut more = cells::contents(&found);
    if case.surface.is_some() {
        more.push(cells::histogram(&found.pressure, hertz));
    }
    if !loads.is_empty() {
        more.push(cells::load_gap(&loads));
    }
    if !arguments.layers.is_empty() {
        let layers = layers_on_cells(case, options, &found.pressure, &arguments.layers)?;
        more.extend(cells::layers(&found, &layers));
    }
    more.extend(pictures(case, &found.solution, Some(&found.solution.summary.details), arguments)?);
    let names = solution::write(&found.solution, options, more, &arguments.out)?;
    tell(case, &found.solution, &names, arguments)
}

/// The pictures and the page, if they are asked for; `cells` is how the case was solved on some.
fn pictures<D>(
    case: &Case,
    found: &Solution<D>,
    cells: Option<&CellDetails>,
    arguments: &Arguments,
) -> Result<Vec<(String, Vec<u8>)>> {
    if !arguments.plots {
        return Ok(Vec::new());
    }
    let engine = if cells.is_some() { " on uniform cells" } else { "" };
    let label = page::Label {
        by: format!("{}{engine}", found.summary.method),
        program: PROGRAM.into(),
        date: now(),
        cells: cells.cloned(),
    };
    page::of_solution(case, &label, found)
}

/// Prints what was found, and the `names` of the files.
fn tell<D: Serialize>(
    case: &Case,
    found: &Solution<D>,
    names: &[String],
    arguments: &Arguments,
) -> Result<Exit> {
    if arguments.json {
        print_json(&found.summary)?;
    } else {
        print(&format!("{}{}\n", text(case, &found.summary), wrote(names, &arguments.out)))?;
    }
    Ok(Exit::Done)
}

/// Memory per point of the field (bytes): its stress, four mirror images of it, and their rows in
/// the files.
const FIELD_POINT_BYTES: f64 = 280.0;

/// The numbers of points of a quarter of a body's field, unless they are too many.
fn field_counts(arguments: &Arguments) -> Result<[usize; 3]> {
    let counts: [usize; 3] =
        directions("--field-points", &arguments.field_points, "a field has three", "33,49,41")?;
    let [nx, ny, nz] = counts.map(|n| n as f64);
    // The block may have half as many additional points on its ledge.
    let (roller, block) = (nx * ny * nz, 1.5 * nx * ny * nz);
    check_memory(
        &format!("a field of {nx} x {ny} x {nz} points a quarter of a body"),
        (roller + block) * FIELD_POINT_BYTES,
        "give fewer --field-points",
    )?;
    if block > MOST_GRID_POINTS as f64 {
        return Err(Error::Value {
            key: "--field-points".into(),
            value: format!("{nx} x {ny} x {nz}"),
            reason: format!(
                "a body has at most {MOST_GRID_POINTS} points, those on a ledge included"
            ),
            remedy: "give fewer".into(),
        });
    }
    Ok(counts)
}

/// The short summary for a reader.
fn text<D>(case: &Case, found: &Summary<D>) -> String {
    let (factors, hertz) = (case.factors(), found.hertz);
    let p0 = hertz.p0_pa;
    let mut lines = vec![
        format!(
            "{} by {}: W {:.4e}, S_l {}, L_r {}",
            found.case,
            found.method,
            factors.load,
            significant(factors.slenderness, 5),
            significant(factors.length_ratio, 5)
        ),
        format!(
            "  load {} N, half-width C {} mm, p0 {} MPa",
            significant(found.load_n, 6),
            significant(hertz.c_m * 1e3, 5),
            significant(p0 * 1e-6, 5)
        ),
        format!(
            "  pressure {:.4} p0 at the centre; largest mean of a cell {:.4} p0 at x = {:.3} C, y = {:.3} C{}",
            found.p_centre_pa / p0,
            found.p_max_pa / p0,
            found.p_max_at_m[0] / hertz.c_m,
            found.p_max_at_m[1] / hertz.c_m,
            solution::unbounded(case, found).map_or(String::new(), |note| format!(" ({note})")),
        ),
    ];
    if let Some(critical) = &found.critical {
        let [x, y, z] = critical.at_m.map(|v| v / hertz.c_m);
        lines.push(format!(
            "  most stressed on the curves: {}, von Mises {:.4} p0 at x = {x:.3} C, y = {y:.3} C, z = {z:.3} C",
            critical.body.name(),
            critical.value_pa / p0,
        ));
    }
    lines.push(format!(
        "  {} iterations, load met to {:.0e}, {}",
        found.iterations,
        found.load_error_rel,
        duration(found.seconds.total)
    ));
    lines.join("\n") + "\n"
}
