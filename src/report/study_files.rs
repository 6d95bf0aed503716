//! The files of a study's run: tidy tables and `summary.json`. Plots, page and Markdown are made
//! from these files alone, so whatever they show can be looked up here.

use super::study_summary::{RoleName, StudySummary};
use super::summarise::{Context, study_summary};
use super::table::{self, Table, number, optional};
use crate::base::number::significant;
use crate::base::{Error, Result};
use crate::stress::{Critical, Curves, Quantity};
use crate::study::effects::{self, Effects};
use crate::study::factorial::half_normal_quantile;
use crate::study::response::{self, Response};
use crate::study::{CaseRun, Engine, MethodRun, Source, StudyRun};
use serde::Serialize;
use std::path::Path;

/// A finished run, as its files hold it.
#[derive(Debug, Clone)]
pub struct StudyFiles {
    /// `summary.json`.
    pub summary: StudySummary,
    /// `study.csv`: one row for each case and source.
    pub study: Table,
    /// `curves.csv`: stresses of every source on the standard curves (Pa).
    pub curves: Table,
    /// `pressure.csv`: contact pressure of every source on the two lines (Pa).
    pub pressure: Table,
    /// `fem_error.csv`: FEM's own error at the points where the record has it (Pa).
    pub fem_error: Table,
    /// `errors.csv`: one row for each case, method, body, curve and quantity (C, p0).
    pub errors: Table,
    /// `effects.csv`: one row for each method, response and effect.
    pub effects: Table,
}

/// Columns of a point and its stresses, as everywhere in the program.
const STRESS_COLUMNS: [&str; 13] = [
    "body",
    "curve",
    "x_m",
    "y_m",
    "z_m",
    "sigma_xx_pa",
    "sigma_yy_pa",
    "sigma_zz_pa",
    "sigma_xy_pa",
    "sigma_xz_pa",
    "sigma_yz_pa",
    "von_mises_pa",
    "tau_max_pa",
];

/// Significant digits of what was computed from factors: fewer than rounding leaves.
const FACTOR_DIGITS: usize = 10;

impl StudyFiles {
    /// The tables of a run.
    pub fn of(run: &StudyRun, context: &Context) -> Self {
        let (effects, not_analysed) = effects::analyse(run);
        Self {
            summary: study_summary(run, context, &effects, &not_analysed),
            study: study_table(run),
            curves: curves_table(run),
            pressure: pressure_table(run),
            fem_error: fem_error_table(run),
            errors: errors_table(run),
            effects: effects_table(run, &effects),
        }
    }

    /// Names of the tables' files, in the order of [`StudyFiles::tables`].
    pub const TABLES: [&'static str; 6] =
        ["study.csv", "curves.csv", "pressure.csv", "fem_error.csv", "errors.csv", "effects.csv"];

    /// The tables, in the order of [`StudyFiles::TABLES`].
    pub fn tables(&self) -> [&Table; 6] {
        [&self.study, &self.curves, &self.pressure, &self.fem_error, &self.errors, &self.effects]
    }

    /// The run's own files by name: the tables, and `summary.json` last.
    pub fn contents(&self) -> Vec<(String, Vec<u8>)> {
        let tables = Self::TABLES.iter().zip(self.tables());
        let mut contents: Vec<(String, Vec<u8>)> =
            tables.map(|(name, table)| (name.to_string(), table.to_csv().into_bytes())).collect();
        contents.push(("summary.json".to_string(), pretty(&self.summary).into_bytes()));
        contents
    }

    /// Reads a finished run.
    ///
    /// # Errors
    /// [`Error::Io`] or [`Error::File`] when a file is missing or is not what
    /// [`super::page::write_run`] writes.
    pub fn read(folder: &Path) -> Result<Self> {
        let path = folder.join("summary.json");
        let text = table::read(&path)?;
        let refuse = |line: Option<usize>, message: String| Error::File {
            path: path.clone(),
            line,
            message,
            remedy: "give the folder that `edgeline study --out` wrote".to_string(),
        };
        let summary: StudySummary = serde_json::from_str(&text)
            .map_err(|e| refuse(Some(e.line()), format!("is not the summary of a study: {e}")))?;
        let [study, curves, pressure, fem_error, errors, effects] =
            Self::TABLES.map(|name| Table::read(&folder.join(name)));
        Ok(Self {
            summary,
            study: study?,
            curves: curves?,
            pressure: pressure?,
            fem_error: fem_error?,
            errors: errors?,
            effects: effects?,
        })
    }
}

/// JSON with indents and a newline at its end.
pub fn pretty(value: &impl Serialize) -> String {
    let mut text =
        serde_json::to_string_pretty(value).expect("names and numbers are always written");
    text.push('\n');
    text
}

/// One row for each case and source. Errors are in p0, depths in C; `seconds` is the median of
/// warm repeats on one thread for a method, the wall-clock time of all stages for FEM, and
/// `timed_on` says on which machine that was.
fn study_table(run: &StudyRun) -> Table {
    let mut header: Vec<String> = [
        "case",
        "source",
        "role",
        "W",
        "S_l",
        "L_r",
        "c_m",
        "p0_pa",
        "load_n",
        "err",
        "converged",
        "iterations",
        "load_error_rel",
        "approach_m",
        "p_centre_pa",
        "p_max_pa",
        "p_max_x_m",
        "p_max_y_m",
        "critical_body",
        "critical_von_mises_pa",
        "critical_x_m",
        "critical_y_m",
        "critical_z_m",
    ]
    .map(String::from)
    .to_vec();
    header.extend(Response::all().map(Response::name));
    // The first range is that of pressure_max and pressure_rms.
    for c in run.range.pressure_c.iter().skip(1) {
        header.extend([format!("pressure_max_{c}C"), format!("pressure_rms_{c}C")]);
    }
    header.extend(
        [
            "fem_error_pressure",
            "fem_error_stress",
            "seconds",
            "seconds_spread",
            "seconds_cold",
            "seconds_all_threads",
            "threads",
            "speedup",
            "speedup_spread",
            "seconds_setup",
            "seconds_contact",
            "seconds_stress",
            "timed_on",
            "unknowns",
        ]
        .map(String::from),
    );
    let mut table = Table::new(header);
    for case in &run.cases {
        for m in &case.methods {
            let row = method_row(&table, run, case, m);
            table.push(row);
        }
        let row = fem_row(&table, case);
        table.push(row);
    }
    table
}

/// Cells by name; a column that is not set is empty.
struct Row<'a> {
    table: &'a Table,
    cells: Vec<String>,
}

impl<'a> Row<'a> {
    fn new(table: &'a Table, case: &CaseRun, source: &Source) -> Self {
        let mut row = Self { table, cells: vec![String::new(); table.header.len()] };
        let (factors, hertz) = (case.case.factors(), case.case.hertz());
        row.set("case", &case.case.name);
        row.set("source", source.name());
        row.set("role", RoleName::of(&case.role).name());
        row.set("W", &significant(factors.load, FACTOR_DIGITS));
        row.set("S_l", &significant(factors.slenderness, FACTOR_DIGITS));
        row.set("L_r", &significant(factors.length_ratio, FACTOR_DIGITS));
        row.set("c_m", &number(hertz.c_m));
        row.set("p0_pa", &number(hertz.p0_pa));
        row.set("load_n", &number(case.case.load.force_n));
        row
    }

    fn set(&mut self, name: &str, value: &str) {
        let column = self.table.column(name).expect("a column of the header");
        self.cells[column] = value.to_string();
    }

    fn set_critical(&mut self, critical: Option<Critical>, c_m: f64, p0_pa: f64) {
        let Some(critical) = critical else { return };
        self.set("critical_body", critical.body.name());
        self.set("critical_von_mises_pa", &number(critical.value * p0_pa));
        for (name, v) in ["critical_x_m", "critical_y_m", "critical_z_m"].iter().zip(critical.at) {
            self.set(name, &number(v * c_m));
        }
    }
}

fn method_row(table: &Table, run: &StudyRun, case: &CaseRun, m: &MethodRun) -> Vec<String> {
    let mut row = Row::new(table, case, &m.method.into());
    let answer = match &m.answer {
        Ok(answer) => answer,
        Err(message) => {
            row.set("err", message);
            return row.cells;
        }
    };
    let s = &answer.solution.summary;
    row.set("converged", if s.converged { "true" } else { "false" });
    row.set("iterations", &s.iterations.to_string());
    row.set("load_error_rel", &number(s.load_error_rel));
    row.set("approach_m", &number(s.approach_m));
    row.set("p_centre_pa", &number(s.p_centre_pa));
    row.set("p_max_pa", &number(s.p_max_pa));
    row.set("p_max_x_m", &number(s.p_max_at_m[0]));
    row.set("p_max_y_m", &number(s.p_max_at_m[1]));
    row.set_critical(answer.critical, s.hertz.c_m, s.hertz.p0_pa);
    for response in Response::all() {
        row.set(&response.name(), &optional(response.value(case, m)));
    }
    if let Some(summary) = &answer.summary {
        for (c, [max, rms]) in run.range.pressure_c.iter().zip(&summary.pressure).skip(1) {
            row.set(&format!("pressure_max_{c}C"), &number(*max));
            row.set(&format!("pressure_rms_{c}C"), &number(*rms));
        }
        row.set("fem_error_pressure", &optional(summary.ref_error_pressure));
        row.set("fem_error_stress", &optional(summary.ref_error_stress));
    }
    row.set("seconds_setup", &number(s.seconds.setup));
    row.set("seconds_contact", &number(s.seconds.contact));
    row.set("seconds_stress", &number(s.seconds.stress));
    if let Some(one) = m.timing.first() {
        row.set("seconds", &number(one.median_s));
        row.set("seconds_spread", &optional((one.repeats > 1).then(|| one.spread_s())));
        row.set("seconds_cold", &optional(one.cold_s));
    }
    if let Some(all) = m.timing.get(1) {
        row.set("seconds_all_threads", &number(all.median_s));
        row.set("threads", &all.threads.to_string());
    }
    row.set("timed_on", "this machine");
    if let Some(ratio) = response::speedup(case, m) {
        row.set("speedup", &number(ratio.value));
        row.set("speedup_spread", &number(ratio.plus_minus));
    }
    row.cells
}

fn fem_row(table: &Table, case: &CaseRun) -> Vec<String> {
    let mut row = Row::new(table, case, &Source::from(Engine::fenicsx()));
    let reference = match &case.reference {
        Ok(reference) => reference,
        Err(message) => {
            row.set("err", message);
            return row.cells;
        }
    };
    let hertz = case.case.hertz();
    if let Some(line) = reference.curves.line("along-y") {
        row.set("p_centre_pa", &optional(line.p.first().map(|p| p * hertz.p0_pa)));
    }
    row.set_critical(case.reference_critical, hertz.c_m, hertz.p0_pa);
    // What a record says of its own error is in the rows of the methods, over the same points.
    let own = case.methods.iter().find_map(|m| m.answer.as_ref().ok()?.summary.as_ref());
    if let Some(own) = own {
        row.set("fem_error_pressure", &optional(own.ref_error_pressure));
        row.set("fem_error_stress", &optional(own.ref_error_stress));
    }
    let p = &reference.provenance;
    row.set("seconds", &optional(p.seconds));
    row.set("seconds_spread", &optional(p.seconds_spread));
    let machine = if p.live { "this machine" } else { p.machine.as_deref().unwrap_or("") };
    row.set("timed_on", machine);
    row.set("unknowns", &p.unknowns.map(|u| u.to_string()).unwrap_or_default());
    row.cells
}

/// Every source of every case with its answer.
fn sources(run: &StudyRun) -> impl Iterator<Item = (&CaseRun, Source, &Curves)> {
    run.cases.iter().flat_map(|case| {
        let methods = case.methods.iter().filter_map(move |m| {
            let answer = m.answer.as_ref().ok()?;
            Some((case, m.method.into(), &answer.solution.curves))
        });
        let reference = case.reference.iter();
        methods.chain(reference.map(move |r| (case, r.engine.clone().into(), &r.curves)))
    })
}

fn curves_table(run: &StudyRun) -> Table {
    let mut table = Table::new(["case", "source"].into_iter().chain(STRESS_COLUMNS));
    for (case, source, curves) in sources(run) {
        let hertz = curves.hertz;
        for curve in &curves.stress {
            for (at, stress) in curve.at.iter().zip(&curve.stress) {
                let mut row = vec![
                    case.case.name.clone(),
                    source.to_string(),
                    curve.body.name().to_string(),
                    curve.name.clone(),
                ];
                row.extend(at.map(|v| number(v * hertz.c_m)));
                row.extend(Quantity::ALL.iter().map(|q| number(q.of(stress) * hertz.p0_pa)));
                table.push(row);
            }
        }
    }
    table
}

fn pressure_table(run: &StudyRun) -> Table {
    let mut table = Table::new(["case", "source", "line", "x_m", "y_m", "p_pa"]);
    for (case, source, curves) in sources(run) {
        let hertz = curves.hertz;
        for line in &curves.pressure {
            for (at, p) in line.at.iter().zip(&line.p) {
                table.push(vec![
                    case.case.name.clone(),
                    source.to_string(),
                    line.name.clone(),
                    number(at[0] * hertz.c_m),
                    number(at[1] * hertz.c_m),
                    number(p * hertz.p0_pa),
                ]);
            }
        }
    }
    table
}

/// FEM's own error, one row for each point and quantity that has one; `body` is `contact` for the
/// pressure.
fn fem_error_table(run: &StudyRun) -> Table {
    let mut header = vec!["case", "body", "curve", "x_m", "y_m", "z_m", "pressure_pa"];
    header.extend(&STRESS_COLUMNS[5..]);
    let mut table = Table::new(header);
    for case in &run.cases {
        let Ok(reference) = &case.reference else { continue };
        let hertz = reference.curves.hertz;
        let place = |body: &str, curve: &str, at: [f64; 3]| {
            let mut row = vec![case.case.name.clone(), body.to_string(), curve.to_string()];
            row.extend(at.map(|v| number(v * hertz.c_m)));
            row
        };
        for line in &reference.curves.pressure {
            for (at, e) in line.at.iter().zip(line.own_error.iter().flatten()) {
                let mut row = place("contact", &line.name, [at[0], at[1], 0.0]);
                row.push(number(e * hertz.p0_pa));
                row.extend(vec![String::new(); Quantity::ALL.len()]);
                table.push(row);
            }
        }
        for curve in &reference.curves.stress {
            for (at, e) in curve.at.iter().zip(curve.own_error.iter().flatten()) {
                let mut row = place(curve.body.name(), &curve.name, *at);
                row.push(String::new());
                row.extend(e.map(|v| number(v * hertz.p0_pa)));
                table.push(row);
            }
        }
    }
    table
}

fn errors_table(run: &StudyRun) -> Table {
    let mut table = Table::new([
        "case",
        "method",
        "body",
        "curve",
        "quantity",
        "excluded_c",
        "points",
        "max",
        "max_x_c",
        "max_y_c",
        "max_z_c",
        "rms",
        "l1",
        "peak",
        "peak_x_c",
        "peak_y_c",
        "peak_z_c",
        "peak_fem",
        "peak_fem_x_c",
        "peak_fem_y_c",
        "peak_fem_z_c",
        "fem_error_max",
        "fem_error_rms",
    ]);
    let answers = run.cases.iter().flat_map(|c| &c.methods).filter_map(|m| m.answer.as_ref().ok());
    for e in answers.flat_map(|a| &a.errors) {
        let mut row: Vec<String> =
            [&e.case, &e.method, &e.body, &e.curve, &e.quantity].map(String::clone).to_vec();
        row.extend([significant(e.excluded_c, FACTOR_DIGITS), e.points.to_string(), number(e.max)]);
        row.extend(e.max_at.map(number));
        row.extend([number(e.rms), number(e.l1), number(e.peak)]);
        row.extend(e.peak_at.map(number));
        row.push(number(e.peak_ref));
        row.extend(e.peak_ref_at.map(number));
        row.extend([optional(e.ref_error_max), optional(e.ref_error_rms)]);
        table.push(row);
    }
    table
}

fn effects_table(run: &StudyRun, all: &[Effects]) -> Table {
    let mut table = Table::new([
        "method",
        "response",
        "unit",
        "term",
        "effect",
        "half_normal_quantile",
        "pse",
        "me",
        "sme",
        "verdict",
        "mean",
        "centre",
        "curvature",
    ]);
    for e in all {
        let a = &e.analysis;
        let mut order: Vec<usize> = (0..a.effects.len()).collect();
        order.sort_by(|&i, &j| a.effects[i].value.abs().total_cmp(&a.effects[j].value.abs()));
        for (i, effect) in a.effects.iter().enumerate() {
            let rank = order.iter().position(|&j| j == i).expect("every effect is ranked");
            table.push(vec![
                e.method.name().to_string(),
                e.response.name(),
                e.response.unit().to_string(),
                effects::term(&run.factors, &effect.factors),
                number(effect.value),
                number(half_normal_quantile(rank, a.effects.len())),
                optional(a.lenth.map(|l| l.pse)),
                optional(a.lenth.map(|l| l.me)),
                optional(a.lenth.map(|l| l.sme)),
                a.lenth.map_or("", |l| l.verdict(effect.value).name()).to_string(),
                number(a.mean),
                optional(e.centre),
                optional(a.curvature),
            ]);
        }
    }
    table
}
