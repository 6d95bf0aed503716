//! The case file: one contact problem.

use super::document::{Document, Entry, Table, read_text};
use super::{BUILTIN_CASES, Block, Case, Factors, Roller, builtin_case};
use crate::base::{Error, Material, Result};
use std::path::Path;

impl Case {
    /// Reads a case file.
    ///
    /// # Errors
    /// [`Error::Io`] when the file cannot be read; [`Error::File`] with the line when it is not
    /// TOML, has an unknown or missing key, or a value that is not legal.
    pub fn read(path: &Path) -> Result<Case> {
        Case::parse(&read_text(path)?, path)
    }

    /// Reads the case file at `path`, or takes the built-in case of that name where no such file
    /// exists.
    ///
    /// # Errors
    /// As [`Case::read`]; the error about a missing file names the built-in cases.
    pub fn find(path: &Path) -> Result<Case> {
        if path.exists() {
            return Case::read(path);
        }
        path.to_str().and_then(builtin_case).unwrap_or_else(|| {
            let names: Vec<&str> = BUILTIN_CASES.iter().map(|(name, _)| *name).collect();
            Err(Error::File {
                path: path.to_path_buf(),
                line: None,
                message: "no such file".into(),
                remedy: format!("give a case file, or a built-in case: {}", names.join(", ")),
            })
        })
    }

    /// Parses the text of a case file; `path` is only named in errors.
    ///
    /// # Errors
    /// As [`Case::read`].
    pub fn parse(text: &str, path: &Path) -> Result<Case> {
        let document = Document::parse(path, text)?;
        let root = document.root();
        if root.get("factors").is_some() {
            return Err(
                root.error("is a study file, not a case file", "run `edgeline study` on it")
            );
        }
        root.only(&["name", "roller", "block", "dimensionless", "load", "accuracy"])?;
        let name = name(&root)?;
        let roller = root.table("roller")?;
        roller.only(&["radius_m", "length_m", "young_pa", "poisson"])?;
        let block = root.table("block")?;
        block.only(&["length_m", "young_pa", "poisson"])?;
        let radius_m = radius(&roller)?;
        let (roller_material, block_material) = (material(&roller)?, material(&block)?);

        let mut case = match given_load(&root)? {
            GivenLoad::Dimensionless(table) => {
                for table in [&roller, &block] {
                    if let Some(length) = table.get("length_m") {
                        return Err(length.refuse(
                            "the lengths follow from [dimensionless]",
                            "remove it, or give [load] and both lengths instead",
                        ));
                    }
                }
                table.only(&["W", "S_l", "L_r"])?;
                let factors = Factors {
                    load: load_factor(&table.require("W", "W = 5e-4")?)?,
                    slenderness: slenderness(&table.require("S_l", "S_l = 5.0")?)?,
                    length_ratio: length_ratio(&table.require("L_r", "L_r = 1.0")?)?,
                };
                let case =
                    Case::from_factors(name, radius_m, roller_material, block_material, factors);
                if let Some(message) = case.out_of_range() {
                    return Err(table
                        .error(message, "check the radius (m), the moduli (Pa) and the factors"));
                }
                case
            }
            GivenLoad::Force(table) => {
                table.only(&["force_n"])?;
                let force = table.require("force_n", "force_n = 1000.0")?;
                let of_roller = roller.require("length_m", "length_m = 10e-3")?;
                let of_block = block.require("length_m", "length_m = 20e-3")?;
                let case = Case {
                    name,
                    roller: Roller {
                        radius_m,
                        length_m: length(&of_roller, "the roller's length in metres")?,
                        material: roller_material,
                    },
                    block: Block {
                        length_m: length(&of_block, "the block's length in metres")?,
                        material: block_material,
                    },
                    force_n: force.number_in(
                        Case::FORCE_RANGE.0,
                        Case::FORCE_RANGE.1,
                        "the load in newtons",
                    )?,
                    tolerance: Case::DEFAULT_TOLERANCE,
                };
                check_factors(&case, &force, &of_roller, &of_block)?;
                case
            }
        };
        case.tolerance = tolerance(&root)?;
        Ok(case)
    }
}

/// The table that gives the load.
pub(super) enum GivenLoad<'d> {
    /// `[dimensionless]`: by the three factors.
    Dimensionless(Table<'d>),
    /// `[load]`: by its force, and by lengths elsewhere.
    Force(Table<'d>),
}

/// Finds the one table that gives the load.
pub(super) fn given_load<'d>(root: &Table<'d>) -> Result<GivenLoad<'d>> {
    match (root.get("dimensionless"), root.get("load")) {
        (Some(dimensionless), None) => Ok(GivenLoad::Dimensionless(dimensionless.table()?)),
        (None, Some(load)) => Ok(GivenLoad::Force(load.table()?)),
        (Some(_), Some(load)) => Err(load.table()?.error(
            "the load is given twice, by [dimensionless] and by [load]",
            "keep one of the two",
        )),
        (None, None) => Err(root.error(
            "there is no load: neither [dimensionless] nor [load]",
            "add [dimensionless] with W, S_l and L_r, or [load] with force_n and both lengths",
        )),
    }
}

/// Letters of a name, at most.
pub(super) const MAX_NAME: usize = 64;

/// The name, which also names folders.
pub(super) fn name(root: &Table) -> Result<String> {
    let entry = root.require("name", "name = \"flush-short\"")?;
    let name = entry.string()?;
    let plain = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
    if name.is_empty() || name.len() > MAX_NAME || name.starts_with('.') || !name.chars().all(plain)
    {
        return Err(entry.refuse(
            "a name is 1 to 64 letters, digits, '-', '_' and '.', and does not start with '.'",
            "choose such a name: folders are named after it",
        ));
    }
    Ok(name.to_string())
}

/// The roller's radius (m).
pub(super) fn radius(roller: &Table) -> Result<f64> {
    length(&roller.require("radius_m", "radius_m = 10e-3")?, "the roller's radius in metres")
}

/// Young's modulus and Poisson's ratio.
pub(super) fn material(table: &Table) -> Result<Material> {
    let young = table.require("young_pa", "young_pa = 210e9")?;
    let poisson = table.require("poisson", "poisson = 0.3")?;
    let nu = poisson.number()?;
    if !(0.0..0.5).contains(&nu) {
        return Err(poisson.refuse(
            "Poisson's ratio is at least 0 and less than 0.5",
            "steel has 0.3; for a nearly incompressible material write 0.49",
        ));
    }
    // The lower limit also catches moduli that were written in GPa or MPa.
    let young_pa = young.number_in(1e3, 1e14, "Young's modulus in pascals")?;
    Ok(Material { young_pa, poisson: nu })
}

/// `[accuracy] tolerance`, or its default.
pub(super) fn tolerance(root: &Table) -> Result<f64> {
    let Some(accuracy) = root.get("accuracy") else {
        return Ok(Case::DEFAULT_TOLERANCE);
    };
    let table = accuracy.table()?;
    table.only(&["tolerance"])?;
    let (low, high) = Case::TOLERANCE_RANGE;
    let entry = table.require("tolerance", "tolerance = 1e-3")?;
    entry.number_in(low, high, "the tolerance, a fraction of p0,")
}

pub(super) fn load_factor(entry: &Entry) -> Result<f64> {
    let (low, high) = Factors::LOAD_RANGE;
    entry.number_in(low, high, "the load factor W")
}

pub(super) fn slenderness(entry: &Entry) -> Result<f64> {
    let (low, high) = Factors::SLENDERNESS_RANGE;
    entry.number_in(low, high, "the slenderness S_l")
}

pub(super) fn length_ratio(entry: &Entry) -> Result<f64> {
    let (low, high) = Factors::LENGTH_RATIO_RANGE;
    if entry.number()? > high {
        return Err(entry.refuse(
            "the roller would be longer than the block (L_r = L1 / L2 > 1)",
            "give at most 1, which means flush ends",
        ));
    }
    entry.number_in(low, high, "the length ratio L_r")
}

fn length(entry: &Entry, what: &str) -> Result<f64> {
    let (low, high) = Case::LENGTH_RANGE;
    entry.number_in(low, high, what)
}

/// Checks what a load and lengths amount to; the keys at fault are named.
fn check_factors(case: &Case, force: &Entry, roller: &Entry, block: &Entry) -> Result<()> {
    let factors = case.factors();
    // A case that was written from factors on a limit is a rounding beyond it.
    let slack = 1.0 + 1e-9;
    let outside =
        |value: f64, (low, high): (f64, f64)| !(low / slack..=high * slack).contains(&value);
    if factors.length_ratio > slack {
        return Err(block.refuse(
            format!("the block is shorter than the roller ({:e} m)", case.roller.length_m),
            "make it at least as long: equal lengths are flush ends",
        ));
    }
    let checks: [(&Entry, &str, f64, (f64, f64)); 3] = [
        (block, "L_r = L1 / L2", factors.length_ratio, Factors::LENGTH_RATIO_RANGE),
        (force, "W = w / (E* R L1)", factors.load, Factors::LOAD_RANGE),
        (roller, "S_l = L1 / (2 C)", factors.slenderness, Factors::SLENDERNESS_RANGE),
    ];
    match checks.into_iter().find(|&(_, _, value, range)| outside(value, range)) {
        Some((entry, what, value, (low, high))) => Err(entry.refuse(
            format!("{what} becomes {value:.3e} and must lie between {low:e} and {high:e}"),
            "check the units of the load (N), the lengths and the radius (m), and the moduli (Pa)",
        )),
        None => Ok(()),
    }
}
