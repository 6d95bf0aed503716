//! The sweep file: thousands of cases as a grid or as lists of parameters, or as a CSV table.
//!
//! A sweep knows its rows without holding them: row i is put together as the text of a case file and
//! read as one, so that a row is held to exactly what a case file is held to. What is wrong with the
//! file is an error; what is wrong with a row belongs to that row.

use super::Case;
use super::case_file::{GivenLoad, given_load};
use super::document::{Document, Entry, edit_distance, read_text};
use crate::base::{Error, Result};
use crate::host::{self, check_memory};
use std::path::Path;

/// Parameters of a case, as the case file names them, and their short names for columns.
const PARAMETERS: [(&str, &str); 12] = [
    ("roller.radius_m", "radius_m"),
    ("roller.length_m", "roller_length_m"),
    ("roller.young_pa", "roller_young_pa"),
    ("roller.poisson", "roller_poisson"),
    ("block.length_m", "block_length_m"),
    ("block.young_pa", "block_young_pa"),
    ("block.poisson", "block_poisson"),
    ("dimensionless.W", "W"),
    ("dimensionless.S_l", "S_l"),
    ("dimensionless.L_r", "L_r"),
    ("load.force_n", "force_n"),
    ("accuracy.tolerance", "tolerance"),
];

/// Columns that give both bodies the same value.
const BOTH: [(&str, [&str; 2]); 2] = [
    ("young_pa", ["roller.young_pa", "block.young_pa"]),
    ("poisson", ["roller.poisson", "block.poisson"]),
];

/// More rows than this are a slip of the pen.
const MAX_ROWS: usize = 10_000_000;

/// Larger tables are refused unread: [`MAX_ROWS`] rows are smaller (bytes).
const MAX_TABLE_BYTES: u64 = 4 << 30;

/// Memory that a row takes while a sweep runs, and each of its numbers in lists (bytes).
const ROW_BYTES: f64 = 300.0;
const CELL_BYTES: f64 = 8.0;

/// Memory that a table takes in units of its file's size: cells of some six letters become texts.
const TABLE_GROWTH: f64 = 15.0;

/// Refuses `rows` (of `columns` numbers, where they stand side by side) that are too many; `error` makes the
/// error of the words for what is wrong and what to do.
///
/// # Errors
/// The error made, or [`Error::Memory`] where the number of rows alone is legal.
fn check_rows(rows: f64, columns: usize, error: impl Fn(String, &str) -> Error) -> Result<()> {
    let bytes = rows * (ROW_BYTES + CELL_BYTES * columns as f64);
    let remedy = "give fewer values, or several files";
    if rows > MAX_ROWS as f64 {
        let gib = bytes / (1u64 << 30) as f64;
        let message = format!(
            "the lists combine to more than {MAX_ROWS} rows: {rows:.2e} rows would take about {gib:.1e} GiB"
        );
        return Err(error(message, remedy));
    }
    check_memory(&format!("a sweep of {rows} rows"), bytes, remedy)
}

/// Many cases that differ in some parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// Names of what varies: the columns of the results that tell which case a row is.
    columns: Vec<String>,
    /// For each column the parameters it sets, as indices into [`PARAMETERS`]; none for names.
    sets: Vec<Vec<usize>>,
    /// Values that do not vary, by parameter.
    fixed: [Option<f64>; PARAMETERS.len()],
    rows: Rows,
}

#[derive(Debug, Clone, PartialEq)]
enum Rows {
    /// Every combination of the columns' levels; the last column varies fastest.
    Grid(Vec<Vec<f64>>),
    /// The columns' values side by side, as many of each; one row where there is no column.
    Side(Vec<Vec<f64>>),
    /// Texts, row by row.
    List(Vec<Vec<String>>),
}

impl Sweep {
    /// Reads a sweep from a file in TOML or, if its name ends in `.csv`, from a table. `base` gives
    /// a table's rows what its columns do not give; a TOML file gives everything itself.
    ///
    /// # Errors
    /// [`Error::Io`] when the file cannot be read; [`Error::File`] with the line when it is not
    /// TOML or CSV, has an unknown or missing key or column, or a value of the wrong type. Values
    /// out of their range are no errors here: see [`Sweep::case`].
    pub fn read(path: &Path, base: Option<&Case>) -> Result<Sweep> {
        let csv = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv"));
        if !csv {
            if base.is_some() {
                return Err(Error::File {
                    path: path.to_path_buf(),
                    line: None,
                    message: "a sweep in TOML gives all parameters itself".into(),
                    remedy: "leave out --base, or give a CSV table".into(),
                });
            }
            return Sweep::parse(&read_text(path)?, path);
        }
        let size = std::fs::metadata(path).map_or(0, |m| m.len());
        check_memory(
            &format!("the table {}", path.display()),
            size as f64 * TABLE_GROWTH,
            "split it into several files",
        )?;
        let text = host::read_text(path, MAX_TABLE_BYTES, "split it into several files")?;
        Sweep::parse_csv(&text, path, base)
    }

    /// Parses a sweep file in TOML: a case file in which every number may also be a list of numbers
    /// or a range, and `[sweep] combine` says whether lists are combined (`grid`, the default) or
    /// read side by side (`list`).
    ///
    /// # Errors
    /// As [`Sweep::read`].
    pub fn parse(text: &str, path: &Path) -> Result<Sweep> {
        let document = Document::parse(path, text)?;
        let root = document.root();
        root.only(&["name", "sweep", "roller", "block", "dimensionless", "load", "accuracy"])?;
        if let Some(entry) = root.get("name") {
            // It only tells readers what the file is about, but must not be nonsense.
            entry.string()?;
        }
        let side_by_side = match root.get("sweep") {
            None => false,
            Some(entry) => {
                let table = entry.table()?;
                table.only(&["combine"])?;
                let combine = table.require("combine", "combine = \"grid\"")?;
                match combine.string()? {
                    "grid" => false,
                    "list" => true,
                    _ => {
                        return Err(combine.refuse(
                            "lists are combined in one of two ways",
                            "write \"grid\" for every combination, \"list\" for one row for each \
                             place in the lists",
                        ));
                    }
                }
            }
        };
        let mut sweep = Sweep {
            columns: Vec::new(),
            sets: Vec::new(),
            fixed: [None; PARAMETERS.len()],
            rows: Rows::Grid(Vec::new()),
        };
        let lengths: &[&str] = match given_load(&root)? {
            GivenLoad::Dimensionless(_) => &[],
            GivenLoad::Force(_) => &["length_m"],
        };
        let tables: [(&str, &[&str], &[&str]); 5] = [
            ("roller", &["radius_m", "young_pa", "poisson"], lengths),
            ("block", &["young_pa", "poisson"], lengths),
            ("dimensionless", &["W", "S_l", "L_r"], &[]),
            ("load", &["force_n"], &[]),
            ("accuracy", &["tolerance"], &[]),
        ];
        let mut varying: Vec<(usize, usize, Levels)> = Vec::new();
        let mut side: Option<usize> = None;
        for (name, keys, more) in tables {
            let Some(entry) = root.get(name) else {
                if name == "roller" || name == "block" {
                    root.table(name)?;
                }
                continue;
            };
            let table = entry.table()?;
            let keys: Vec<&str> = keys.iter().chain(more).copied().collect();
            table.only(&keys)?;
            for key in keys {
                let entry = table.require(key, &format!("{key} = [1.0, 2.0]"))?;
                let index = parameter(&format!("{name}.{key}"));
                match levels(&entry)? {
                    Levels::One(value) => sweep.fixed[index] = Some(value),
                    values => {
                        if side_by_side && *side.get_or_insert(values.len()) != values.len() {
                            let reason = format!(
                                "it has {} values and a list before it has {}, but lists are read \
                                 side by side",
                                values.len(),
                                side.unwrap_or_default()
                            );
                            return Err(entry.refuse(
                                reason,
                                "give lists of one length, or [sweep] combine = \"grid\"",
                            ));
                        }
                        varying.push((entry.place(), index, values));
                    }
                }
            }
        }
        // The order of the file is the order of the columns.
        varying.sort_by_key(|v| v.0);
        let rows = match side {
            Some(count) => count as f64,
            None => varying.iter().map(|(_, _, values)| values.len() as f64).product(),
        };
        let cells = if side_by_side { varying.len() } else { 0 };
        check_rows(rows, cells, |message, remedy| root.error(message, remedy))?;
        let mut all = Vec::new();
        for (_, index, values) in varying {
            sweep.columns.push(PARAMETERS[index].0.to_string());
            sweep.sets.push(vec![index]);
            all.push(values.expand());
        }
        sweep.rows = if side_by_side { Rows::Side(all) } else { Rows::Grid(all) };
        Ok(sweep)
    }

    /// Parses a CSV table with a column for each parameter and optionally a column `name`.
    ///
    /// # Errors
    /// As [`Sweep::read`].
    pub fn parse_csv(text: &str, path: &Path, base: Option<&Case>) -> Result<Sweep> {
        let refuse = |line: Option<usize>, message: String, remedy: String| Error::File {
            path: path.to_path_buf(),
            line,
            message,
            remedy,
        };
        let broken = |e: csv::Error| {
            let line = e.position().map(|p| p.line() as usize);
            refuse(line, e.to_string(), "give as many cells in every row as in the header".into())
        };
        let mut reader =
            csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes());
        let columns: Vec<String> =
            reader.headers().map_err(broken)?.iter().map(str::to_string).collect();
        let mut sets = Vec::new();
        let mut given = [false; PARAMETERS.len()];
        for name in &columns {
            let own = column_sets(name).ok_or_else(|| {
                let known = column_names();
                let nearest = known
                    .iter()
                    .min_by_key(|k| edit_distance(k, name))
                    .expect("there are known columns");
                refuse(
                    Some(1),
                    format!("unknown column {name}"),
                    format!("did you mean {nearest}? The columns are {}", known.join(", ")),
                )
            })?;
            for &index in &own {
                if std::mem::replace(&mut given[index], true) {
                    let message = format!("{} is given by two columns", PARAMETERS[index].0);
                    return Err(refuse(Some(1), message, "remove one of them".into()));
                }
            }
            sets.push(own);
        }
        if columns.iter().filter(|c| *c == "name").count() > 1 {
            return Err(refuse(
                Some(1),
                "has two columns name".into(),
                "remove one of them".into(),
            ));
        }
        let is_given = |prefix: &str| {
            PARAMETERS.iter().zip(&given).any(|(p, given)| *given && p.0.starts_with(prefix))
        };
        let lengths = given[parameter("roller.length_m")] || given[parameter("block.length_m")];
        let (factors, load) = (is_given("dimensionless."), is_given("load.") || lengths);
        if factors && load {
            return Err(refuse(
                Some(1),
                "gives the load twice, by W, S_l, L_r and by force_n and lengths".into(),
                "keep the columns of one of the two".into(),
            ));
        }
        // With neither, what is fixed decides; without a base the factors are what is missing.
        let by_load = load;
        let mut fixed = base.map_or([None; PARAMETERS.len()], |case| values_of(case, by_load));
        for (value, given) in fixed.iter_mut().zip(given) {
            if given {
                *value = None;
            }
        }
        let missing: Vec<&str> = (0..PARAMETERS.len())
            .filter(|&i| !given[i] && fixed[i].is_none())
            .map(|i| PARAMETERS[i].0)
            .filter(|name| match name.split_once('.').expect("names have two parts") {
                ("dimensionless", _) => !by_load,
                ("load", _) | (_, "length_m") => by_load,
                (_, "tolerance") => false,
                _ => true,
            })
            .collect();
        if !missing.is_empty() {
            return Err(refuse(
                Some(1),
                format!("has no column for {}", missing.join(", ")),
                "add them, or take them from a case with --base".into(),
            ));
        }
        let mut rows = Vec::new();
        for record in reader.records() {
            rows.push(record.map_err(broken)?.iter().map(str::to_string).collect());
        }
        if rows.is_empty() || rows.len() > MAX_ROWS {
            let message = format!("has {} rows", rows.len());
            return Err(refuse(None, message, format!("give between 1 and {MAX_ROWS}")));
        }
        Ok(Sweep { columns, sets, fixed, rows: Rows::List(rows) })
    }

    /// Number of rows, `None` where it overflows.
    fn count(&self) -> Option<usize> {
        match &self.rows {
            Rows::Grid(levels) => levels.iter().try_fold(1usize, |n, l| n.checked_mul(l.len())),
            Rows::Side(columns) => Some(columns.first().map_or(1, Vec::len)),
            Rows::List(rows) => Some(rows.len()),
        }
    }

    /// Number of rows, at least 1.
    pub fn len(&self) -> usize {
        self.count().expect("checked when the sweep was read")
    }

    /// Whether there are no rows (never, by construction).
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Names of what varies, in the order of the file.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// What stands in the columns in row `i`.
    pub fn cells(&self, i: usize) -> Vec<String> {
        match &self.rows {
            Rows::List(rows) => rows[i].clone(),
            Rows::Side(columns) => columns.iter().map(|values| text_of(values[i])).collect(),
            Rows::Grid(levels) => {
                let mut rest = i;
                let mut cells: Vec<String> = levels
                    .iter()
                    .rev()
                    .map(|l| {
                        let value = l[rest % l.len()];
                        rest /= l.len();
                        text_of(value)
                    })
                    .collect();
                cells.reverse();
                cells
            }
        }
    }

    /// The case of row `i`; it is called what the column `name` says, or `row-1` and so on.
    ///
    /// # Errors
    /// What is wrong with the row's values, in words.
    pub fn case(&self, i: usize) -> std::result::Result<Case, String> {
        let mut values = self.fixed;
        let mut name = format!("row-{}", i + 1);
        for ((cell, column), sets) in self.cells(i).into_iter().zip(&self.columns).zip(&self.sets) {
            if column == "name" {
                name = cell;
                continue;
            }
            let value: f64 = cell.parse().map_err(|_| {
                format!(
                    "{column} = {cell} is not valid: a number belongs here; write for example 1.5"
                )
            })?;
            for &index in sets {
                values[index] = Some(value);
            }
        }
        let mut text = format!("name = {}\n", toml::Value::String(name));
        let mut table = "";
        for ((key, _), value) in PARAMETERS.iter().zip(values) {
            let Some(value) = value else { continue };
            let (own, key) = key.split_once('.').expect("names have two parts");
            if own != table {
                text.push_str(&format!("[{own}]\n"));
                table = own;
            }
            // As TOML writes them: 1e-2, nan, inf.
            let value = if value.is_finite() {
                format!("{value:e}")
            } else {
                value.to_string().to_lowercase()
            };
            text.push_str(&format!("{key} = {value}\n"));
        }
        Case::parse(&text, Path::new("row")).map_err(|e| match e {
            // The row's own text has no place in any file.
            Error::File { message, remedy, .. } => format!("{message}; {remedy}"),
            other => other.to_string(),
        })
    }
}

/// A number as it stands in a cell.
fn text_of(value: f64) -> String {
    format!("{value:e}")
}

/// Index of a parameter by its full name.
fn parameter(name: &str) -> usize {
    PARAMETERS.iter().position(|p| p.0 == name).expect("a name of the list")
}

/// The parameters that a column sets; `None` for a column that is not known.
fn column_sets(name: &str) -> Option<Vec<usize>> {
    if name == "name" {
        return Some(Vec::new());
    }
    if let Some((_, both)) = BOTH.iter().find(|b| b.0 == name) {
        return Some(both.map(parameter).to_vec());
    }
    PARAMETERS.iter().position(|p| p.0 == name || p.1 == name).map(|i| vec![i])
}

/// Short names of all columns.
fn column_names() -> Vec<&'static str> {
    let both = BOTH.iter().map(|b| b.0);
    std::iter::once("name").chain(both).chain(PARAMETERS.iter().map(|p| p.1)).collect()
}

/// The parameters of a case, by load and lengths or by factors.
fn values_of(case: &Case, by_load: bool) -> [Option<f64>; PARAMETERS.len()] {
    let factors = case.factors();
    PARAMETERS.map(|(name, _)| match name {
        "roller.radius_m" => Some(case.roller.radius_m),
        "roller.young_pa" => Some(case.roller.material.young_pa),
        "roller.poisson" => Some(case.roller.material.poisson),
        "block.young_pa" => Some(case.block.material.young_pa),
        "block.poisson" => Some(case.block.material.poisson),
        "accuracy.tolerance" => Some(case.tolerance),
        "roller.length_m" => by_load.then_some(case.roller.length_m),
        "block.length_m" => by_load.then_some(case.block.length_m),
        "load.force_n" => by_load.then_some(case.force_n),
        "dimensionless.W" => (!by_load).then_some(factors.load),
        "dimensionless.S_l" => (!by_load).then_some(factors.slenderness),
        // Equal lengths may come out as 1 and a rounding.
        "dimensionless.L_r" => (!by_load).then_some(factors.length_ratio.min(1.0)),
        other => unreachable!("{other} is not a parameter"),
    })
}

/// A number, or several.
enum Levels {
    One(f64),
    Many(Vec<f64>),
    Range { low: f64, high: f64, count: usize, logarithmic: bool },
}

impl Levels {
    fn len(&self) -> usize {
        match self {
            Levels::One(_) => 1,
            Levels::Many(values) => values.len(),
            Levels::Range { count, .. } => *count,
        }
    }

    /// The values, one by one.
    fn expand(self) -> Vec<f64> {
        let (low, high, count, logarithmic) = match self {
            Levels::One(value) => return vec![value],
            Levels::Many(values) => return values,
            Levels::Range { low, high, count, logarithmic } => (low, high, count, logarithmic),
        };
        let value = |i: usize| {
            let t = i as f64 / (count - 1) as f64;
            // The ends are met to the last digit.
            if i == 0 {
                low
            } else if i == count - 1 {
                high
            } else if logarithmic {
                // Thirteen digits: a decade's middle is to be a round number.
                let value = (low.ln() + t * (high / low).ln()).exp();
                format!("{value:.12e}").parse().expect("a formatted number")
            } else {
                low + t * (high - low)
            }
        };
        (0..count).map(value).collect()
    }
}

/// A number, a list of numbers, or a range `{ from, to, count, spacing }`.
fn levels(entry: &Entry) -> Result<Levels> {
    if entry.is_list() {
        let values = entry.list()?.iter().map(Entry::number).collect::<Result<_>>()?;
        return Ok(Levels::Many(values));
    }
    let Some(table) = entry.as_table() else {
        return entry.number().map(Levels::One);
    };
    table.only(&["from", "to", "count", "spacing"])?;
    let (from, to) = (table.require("from", "from = 1.0")?, table.require("to", "to = 2.0")?);
    let (low, high) = (from.number()?, to.number()?);
    let entry = table.require("count", "count = 10")?;
    let count = entry.number()?;
    if count.fract() != 0.0 || !(2.0..=MAX_ROWS as f64).contains(&count) {
        return Err(entry.refuse(
            format!("the number of values is a whole number between 2 and {MAX_ROWS}"),
            "write for example 10",
        ));
    }
    let logarithmic = match table.get("spacing") {
        None => false,
        Some(entry) => match entry.string()? {
            "linear" => false,
            "log" if low > 0.0 && high > 0.0 => true,
            "log" => {
                return Err(entry.refuse(
                    "only ranges of positive numbers have equal ratios",
                    "write \"linear\", or correct from and to",
                ));
            }
            _ => return Err(entry.refuse("it is not known", "write \"linear\" or \"log\"")),
        },
    };
    Ok(Levels::Range { low, high, count: count as usize, logarithmic })
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRID: &str = "[roller]\nradius_m = 10e-3\nyoung_pa = 210e9\npoisson = [0.3, 0.25]\n\
        [block]\nyoung_pa = 210e9\npoisson = 0.3\n\
        [dimensionless]\nW = { from = 1e-4, to = 1e-2, count = 3, spacing = \"log\" }\n\
        S_l = 5\nL_r = [0.5, 1.0]\n";

    fn parse(text: &str) -> Result<Sweep> {
        Sweep::parse(text, Path::new("s.toml"))
    }

    fn table(text: &str, base: Option<&str>) -> Result<Sweep> {
        let base = base.map(|name| crate::case::builtin_case(name).unwrap().unwrap());
        Sweep::parse_csv(text, Path::new("s.csv"), base.as_ref())
    }

    #[test]
    fn a_grid_is_every_combination_and_the_last_varies_fastest() {
        let sweep = parse(GRID).unwrap();
        assert_eq!(sweep.columns(), ["roller.poisson", "dimensionless.W", "dimensionless.L_r"]);
        assert_eq!(sweep.len(), 12);
        let cells: Vec<String> = (0..12).map(|i| sweep.cells(i).join(" ")).collect();
        assert_eq!(cells[..3], ["3e-1 1e-4 5e-1", "3e-1 1e-4 1e0", "3e-1 1e-3 5e-1"]);
        assert_eq!(cells[11], "2.5e-1 1e-2 1e0");
        let case = sweep.case(9).unwrap();
        assert_eq!((case.name.as_str(), case.roller.material.poisson), ("row-10", 0.25));
        let factors = case.factors();
        assert!((factors.load - 1e-3).abs() < 1e-15 && (factors.slenderness - 5.0).abs() < 1e-12);
        assert_eq!(case.tolerance, Case::DEFAULT_TOLERANCE);
    }

    #[test]
    fn lists_side_by_side_are_rows() {
        let text = GRID.replace("{ from = 1e-4, to = 1e-2, count = 3, spacing = \"log\" }", "1e-3")
            + "[sweep]\ncombine = \"list\"\n[accuracy]\ntolerance = 1e-2\n";
        let sweep = parse(&text).unwrap();
        assert_eq!((sweep.len(), sweep.cells(1)), (2, vec!["2.5e-1".into(), "1e0".into()]));
        assert_eq!(sweep.case(1).unwrap().tolerance, 1e-2);
        let uneven = text.replace("[0.5, 1.0]", "[0.5, 0.7, 1.0]");
        let said = parse(&uneven).unwrap_err().to_string();
        assert!(said.contains("s.toml:11: dimensionless.L_r") && said.contains("side by side"));
    }

    #[test]
    fn the_example_is_what_it_promises() {
        let sweep = parse(include_str!("../../examples/sweep.toml")).unwrap();
        assert_eq!(sweep.len(), 1050);
        assert_eq!(sweep.columns(), ["dimensionless.W", "dimensionless.S_l", "dimensionless.L_r"]);
        assert!((0..sweep.len()).all(|i| sweep.case(i).is_ok()));
    }

    #[test]
    fn one_case_is_a_sweep_of_one_row() {
        let sweep = parse(include_str!("../../cases/flush-short.toml")).unwrap();
        assert_eq!((sweep.len(), sweep.columns().len()), (1, 0));
        assert!((sweep.case(0).unwrap().factors().load - 5e-4).abs() < 1e-15);
    }

    #[test]
    fn what_is_wrong_with_the_file_is_an_error() {
        for (from, to, wanted) in [
            ("poisson = 0.3", "poison = 0.3", "s.toml:7: unknown key block.poison; did you mean"),
            ("S_l = 5", "S_l = \"5\"", "dimensionless.S_l = \"5\" is not valid: a number"),
            ("S_l = 5", "S_l = []", "dimensionless.S_l = []"),
            ("S_l = 5\n", "", "dimensionless.S_l is missing"),
            ("L_r = [0.5, 1.0]", "L_r = [0.5, true]", "a finite number belongs here"),
            ("count = 3", "count = 2.5", "a whole number between 2"),
            ("count = 3", "counts = 3", "did you mean count"),
            ("from = 1e-4", "from = 0", "equal ratios"),
            ("count = 3", "count = 10000000", "more than 10000000 rows"),
            ("[dimensionless]", "[load]\nforce_n = 1\n[dimensionless]", "the load is given twice"),
            ("[block]", "[sweep]\ncombine = \"zip\"\n[block]", "lists are combined in one of two"),
            ("[block]", "[blok]", "unknown key blok; did you mean block"),
            ("radius_m = 10e-3", "radius_m = 10e-3\nlength_m = 1", "unknown key roller.length_m"),
        ] {
            assert!(GRID.contains(from), "{from}");
            let said = parse(&GRID.replacen(from, to, 1)).unwrap_err().to_string();
            assert!(said.contains(wanted), "{to}: {said}");
        }
    }

    #[test]
    fn what_is_wrong_with_a_row_belongs_to_the_row() {
        let sweep = parse(&GRID.replace("[0.5, 1.0]", "[0.5, 1.5]")).unwrap();
        assert!(sweep.case(0).is_ok());
        let said = sweep.case(1).unwrap_err();
        assert!(said.starts_with("dimensionless.L_r = 1.5e0 is not valid: the roller"), "{said}");
    }

    #[test]
    fn a_table_takes_short_names_and_a_base() {
        let text = "name,W,S_l,L_r,poisson\na,1e-4,5,1,0.3\nb, 2e-4 ,6,0.5,0.25\nc,x,6,0.5,0.25\n";
        let sweep = table(text, Some("half-short")).unwrap();
        assert_eq!((sweep.len(), sweep.columns().len()), (3, 5));
        let b = sweep.case(1).unwrap();
        assert_eq!((b.name.as_str(), b.roller.radius_m), ("b", 10e-3));
        assert_eq!((b.block.material.poisson, b.roller.material.poisson), (0.25, 0.25));
        assert!(sweep.case(2).unwrap_err().starts_with("W = x is not valid"));
        let said = table(text, None).unwrap_err().to_string();
        assert!(said.contains("s.csv:1: has no column for roller.radius_m"), "{said}");

        let loads = "force_n,roller_length_m,block.length_m\n1500,1e-3,2e-3\nnan,1e-3,2e-3\n";
        let sweep = table(loads, Some("half-short")).unwrap();
        assert_eq!(sweep.case(0).unwrap().force_n, 1500.0);
        assert!(sweep.case(1).unwrap_err().contains("a finite number belongs here"));
        // The loads alone take the base's lengths.
        let sweep = table("force_n\n100\n", Some("half-short")).unwrap();
        let base = crate::case::builtin_case("half-short").unwrap().unwrap();
        assert!(
            (sweep.case(0).unwrap().roller.length_m / base.roller.length_m - 1.0).abs() < 1e-14
        );
    }

    #[test]
    fn broken_tables_are_errors() {
        for (text, wanted) in [
            ("W,S_l,Lr\n1,2,3\n", "unknown column Lr; did you mean L_r?"),
            ("W,S_l,L_r\n1e-4,5\n", "s.csv:2: "),
            ("W,S_l,L_r\n", "has 0 rows"),
            ("W,W\n1,1\n", "dimensionless.W is given by two columns"),
            ("poisson,block_poisson\n0.3,0.3\n", "block.poisson is given by two columns"),
            ("name,name\na,b\n", "two columns name"),
            ("W,force_n\n1e-4,1\n", "gives the load twice"),
        ] {
            let said = table(text, Some("flush-short")).unwrap_err().to_string();
            assert!(said.contains(wanted), "{text}: {said}");
        }
    }
}
