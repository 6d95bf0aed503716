//! Checks of a case as a value. Readers add the place in their file, see `document::Table::place`.

use super::draft::{Draft, Form};
use super::keys::{KEYS, Key};
use super::model::{Case, Factors, Fatigue};
use crate::base::number::{significant, stated};
use crate::base::{Error, Result};
use std::f64::consts::PI;

/// Largest number of letters of a name.
pub(super) const MAX_NAME: usize = 64;

/// Rounding: a case from factors at a limit may exceed the limit by this factor.
const ROUNDING: f64 = 1.0 + 1e-9;

/// Least overlap of the bodies, in lengths of the shorter one.
const LEAST_OVERLAP: f64 = 1e-2;

/// Largest range of heights, in roller radii.
const HIGHEST: f64 = 0.1;

/// What W, S_l and L_r give, so that a file with them cannot correct it.
const FOLLOWING: [&str; 3] = ["block.length_m", "load.force_n", "roller.length_m"];

/// The key at `path`.
fn key(path: &str) -> &'static Key {
    Key::find(path).expect("a key of the list")
}

/// What to do with a rough case where only smooth ones are taken.
pub(super) const ON_CELLS: &str =
    "solve it on cells (`edgeline solve --engine cells`), or remove [surface]";

impl Case {
    /// Refuses a case with a name or a number that is not legal, or whose factors are not.
    ///
    /// # Errors
    /// [`Error::Value`] with the key of the case file, for example `block.length_m`.
    pub fn check(&self) -> Result<()> {
        check_name(&self.name)?;
        check_numbers(&Draft::of(self, Form::Load))?;
        self.check_raceway()?;
        self.check_factors()?;
        self.check_width()?;
        self.check_approach()?;
        self.check_pose()?;
        self.check_fatigue()?;
        self.check_heights()?;
        self.check_profiles()
    }

    /// Refuses heights that are no roughness, most likely of another unit.
    fn check_heights(&self) -> Result<()> {
        let Some(heights) = self.heights() else { return Ok(()) };
        let (range, radius) = (heights.range_m(), self.roller.radius_m);
        if range <= HIGHEST * radius {
            return Ok(());
        }
        Err(Error::Value {
            key: "surface.heights".into(),
            value: format!("{} m in all", stated(range)),
            reason: format!(
                "the heights range over {} m, more than a tenth of the roller's radius, {} m",
                stated(range),
                stated(radius)
            ),
            remedy: "give heights in metres; detrend = \"plane\" takes their mean plane off".into(),
        })
    }

    /// Refuses numbers of a measure of fatigue that lack others of the same measure.
    fn check_fatigue(&self) -> Result<()> {
        let Fatigue { dang_van_alpha, dang_van_beta_pa, fatemi_socie_k, yield_pa, .. } =
            self.fatigue;
        let alone = [
            ("dang_van_beta_pa", dang_van_beta_pa, "dang_van_alpha", dang_van_alpha),
            ("fatemi_socie_k", fatemi_socie_k, "yield_pa", yield_pa),
            ("yield_pa", yield_pa, "fatemi_socie_k", fatemi_socie_k),
        ];
        for (own, value, other, wanted) in alone {
            if let (Some(value), None) = (value, wanted) {
                let reason = format!("the measure also needs {other}");
                let remedy = format!("give {other}, or leave out {own}");
                return Err(key(&format!("fatigue.{own}")).refuse(value, reason, &remedy));
            }
        }
        Ok(())
    }

    /// A roller fits into a concave raceway only if its radius is smaller.
    fn check_raceway(&self) -> Result<()> {
        let Some(radius) = self.block.radius_m else { return Ok(()) };
        let roller = self.roller.radius_m;
        if radius > 0.0 || -radius > roller * ROUNDING {
            return Ok(());
        }
        let reason =
            format!("a roller of radius {} m does not fit into this raceway", stated(roller));
        let remedy =
            "make the raceway's radius larger than the roller's, or positive for a convex one";
        Err(key("block.radius_m").refuse(radius, reason, remedy))
    }

    /// Checks that the bodies meet, and that the load lies where they do.
    fn check_pose(&self) -> Result<()> {
        let [from, to] = self.overlap_m();
        let offset = self.pose.offset_m;
        if to - from < LEAST_OVERLAP * self.shorter_m() {
            let overlap = stated((to - from).max(0.0));
            let reason = format!("the bodies overlap along y by {overlap} m only");
            let most = 0.5 * (self.roller.length_m + self.block.length_m);
            let remedy = format!("keep |offset_m| well below {} m", stated(most));
            return Err(key("pose.offset_m").refuse(offset, reason, &remedy));
        }
        let Some(eccentricity) = self.load.eccentricity_m else { return Ok(()) };
        if let Some(tilt) = self.pose.tilt_rad {
            let reason = "a load with eccentricity_m finds its own tilt".to_string();
            let remedy = "remove tilt_rad, or eccentricity_m to hold the tilt";
            return Err(key("pose.tilt_rad").refuse(tilt, reason, remedy));
        }
        if eccentricity <= from || eccentricity >= to {
            let reason = format!(
                "the load's line lies outside the overlap, {} to {} m: the roller would fall over",
                stated(from),
                stated(to)
            );
            let remedy = "place it between the ends of the overlap";
            return Err(key("load.eccentricity_m").refuse(eccentricity, reason, remedy));
        }
        Ok(())
    }

    /// Refuses a load that is given by its approach, where a force is needed.
    ///
    /// # Errors
    /// [`Error::Value`] with `reason` and what to do.
    pub fn check_force(&self, reason: &str) -> Result<()> {
        let Some(approach) = self.load.approach_m else { return Ok(()) };
        let remedy = "give force_n instead: `edgeline solve` finds it, load_n in its summary";
        Err(key("load.approach_m").refuse(approach, reason.into(), remedy))
    }

    /// Refuses a rough surface, where only smooth ones are taken.
    ///
    /// # Errors
    /// [`Error::Value`] with `reason` and what to do.
    pub fn check_smooth(&self, reason: &str) -> Result<()> {
        let Some(surface) = &self.surface else { return Ok(()) };
        Err(Error::Value {
            key: "surface.heights".into(),
            value: format!("{:?}", surface.heights.display()),
            reason: reason.into(),
            remedy: ON_CELLS.into(),
        })
    }

    /// The forces (N) between which all factors are legal.
    pub fn legal_forces_n(&self) -> [f64; 2] {
        let (radius, shorter) = (self.equivalent_radius_m(), self.shorter_m());
        let force = |load: f64| load * self.contact_modulus() * radius * shorter;
        // C = 2 R sqrt(W / pi) is L / (2 S_l).
        let of_width = |width: f64| PI * (width / (2.0 * radius)).powi(2);
        let by_width = |slenderness: f64| of_width(shorter / (2.0 * slenderness));
        let widest = of_width(self.largest_width_m());
        let (least, most) = Factors::SLENDERNESS_RANGE;
        let (low, high) = Factors::LOAD_RANGE;
        let (weakest, strongest) = key("load.force_n").range;
        [
            force(low.max(by_width(most))).max(weakest),
            force(high.min(by_width(least)).min(widest)).min(strongest),
        ]
    }

    /// Largest legal half-width C (m): that part of the smaller radius which the largest legal W
    /// gives on a plane block.
    fn largest_width_m(&self) -> f64 {
        let roller = self.roller.radius_m;
        let smaller = self.block.radius_m.map_or(roller, |radius| radius.abs().min(roller));
        2.0 * (Factors::LOAD_RANGE.1 / PI).sqrt() * smaller
    }

    /// Refuses a contact too wide for its radii: in a closely conforming raceway W says nothing of
    /// that.
    fn check_width(&self) -> Result<()> {
        let (own, most) = (self.hertz().c_m, self.largest_width_m());
        if self.load.approach_m.is_some() || own <= most * ROUNDING {
            return Ok(());
        }
        let [own, most] = [own, most].map(|v| significant(v, 3));
        let reason = format!(
            "the half-width C becomes {own} m, and must not exceed {most} m, a quarter of the smaller radius: \
             the gap would be no parabola"
        );
        let remedy = "lower the load, or make the raceway's radius differ more from the roller's";
        Err(key("load.force_n").refuse(self.load.force_n, reason, remedy))
    }

    /// Refuses an approach where no force is legal, so that none can lead to it.
    fn check_approach(&self) -> Result<()> {
        let Some(approach) = self.load.approach_m else { return Ok(()) };
        let [least, most] = self.legal_forces_n();
        if least <= most {
            return Ok(());
        }
        let [least, most] = [least, most].map(|force| significant(force, 3));
        let reason = format!(
            "no force is legal for these radii and lengths: W and S_l ask for at least {least} N and at \
             most {most} N"
        );
        let remedy = "check the units of the lengths and the radii (m), or make the raceway's radius \
                      differ more from the roller's";
        Err(key("load.approach_m").refuse(approach, reason, remedy))
    }

    /// Checks the factors that follow from the load and the lengths; without a force, the lengths
    /// alone.
    fn check_factors(&self) -> Result<()> {
        let factors = self.factors();
        let (block, roller) = (self.block.length_m, self.roller.length_m);
        let Factors { load, slenderness, length_ratio } = factors;
        let force = self.load.force_n;
        let ranges = [Factors::LENGTH_RATIO_RANGE, Factors::LOAD_RANGE, Factors::SLENDERNESS_RANGE];
        let checks = [
            ("block.length_m", block, "L_r = L1 / L2", length_ratio),
            ("load.force_n", force, "W = w / (E* R L)", load),
            ("roller.length_m", roller, "S_l = L / (2 C)", slenderness),
        ];
        let known = if self.load.approach_m.is_some() { 1 } else { checks.len() };
        for ((path, own, name, value), (low, high)) in checks.into_iter().zip(ranges).take(known) {
            if !(low / ROUNDING..=high * ROUNDING).contains(&value) {
                let reason =
                    format!("{name} becomes {value:.3e} and must lie between {low:e} and {high:e}");
                let remedy = "check the units of the load (N), the lengths and the radius (m), and \
                              the moduli (Pa)";
                return Err(key(path).refuse(own, reason, remedy));
            }
        }
        Ok(())
    }
}

impl Draft {
    /// The case, if its name and all of its numbers are legal.
    ///
    /// # Errors
    /// As [`Case::check`], for the keys that the draft's form has.
    pub fn case(&self) -> Result<Case> {
        let mut case = self.case.clone();
        let Some(factors) = self.factors else {
            return case.check().map(|()| case);
        };
        check_name(&case.name)?;
        check_numbers(self)?;
        case.set_factors(factors);
        case.check().map(|()| case).map_err(|e| match e {
            Error::Value { key, value, reason, .. } if FOLLOWING.contains(&&*key) => Error::Value {
                key,
                value,
                reason: format!("it follows from W, S_l and L_r, and {reason}"),
                remedy: "check the radius (m), the moduli (Pa) and the factors".into(),
            },
            other => of_factors(other),
        })
    }
}

/// The same error where the load is given by factors, which have one of its numbers at another
/// place.
pub(super) fn of_factors(error: Error) -> Error {
    match error {
        Error::Value { key, value, reason, remedy } if key == "load.eccentricity_m" => {
            Error::Value { key: "dimensionless.eccentricity_m".into(), value, reason, remedy }
        }
        other => other,
    }
}

/// Refuses a text that cannot be the name of a folder.
pub(super) fn check_name(name: &str) -> Result<()> {
    let plain = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
    let legal = (1..=MAX_NAME).contains(&name.len()) && name.chars().all(plain);
    if legal && !name.starts_with('.') {
        return Ok(());
    }
    Err(Error::Value {
        key: "name".into(),
        value: format!("{name:?}"),
        reason: format!(
            "a name is 1 to {MAX_NAME} letters, digits, '-', '_' and '.', and does not start with '.'"
        ),
        remedy: "choose such a name: folders are named after it".into(),
    })
}

/// Checks each number that the draft has.
fn check_numbers(draft: &Draft) -> Result<()> {
    let given = |key: &'static Key| key.get(draft).map(|value| (key, value));
    KEYS.iter().filter_map(given).try_for_each(|(key, value)| key.check(value))
}
