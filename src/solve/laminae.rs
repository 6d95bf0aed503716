//! The contact in equal slices, as programs for bearings exchange it, beside the slices of the
//! standard.

use super::solved::SolvedCase;
use crate::base::{BodyKind, Error, HertzScales, Result};
use crate::case::Case;
use crate::stress::Load;
use std::f64::consts::PI;

/// The standard's spring constant of a line contact in series with another one like it, of steel, N
/// and mm, and the powers of length and deflection (ISO/TS 16281:2008, after Palmgren).
const BOTH_CONTACTS: f64 = 35948.0;
const LENGTH_POWER: f64 = 8.0 / 9.0;
const POWER: f64 = 10.0 / 9.0;

/// Bisections of a deflection or a tilt: until nothing is left of a double's digits.
const BISECTIONS: usize = 80;

/// One slice of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lamina {
    /// Place of its middle (m).
    pub y_m: f64,
    /// Its width (m).
    pub width_m: f64,
    /// Its load (N): the integral of the contact pressure.
    pub load_n: f64,
    /// Its load by the standard (N).
    pub standard_load_n: f64,
    /// Pressure in its middle, x = 0 (Pa).
    pub p_pa: f64,
    /// Pressure by the standard (Pa): Hertz's of the standard's load, times the edge factor.
    pub standard_p_pa: f64,
    /// The standard's factor of the pressure near the ends.
    pub edge_factor: f64,
}

/// The contact of a solved case in `count` equal slices over the bodies' overlap, beside those of
/// ISO/TS 16281 under the same force and, where the tilt is free, the same moment; where it is
/// held, at that tilt.
///
/// The standard gives a slice q = c d^(10/9), with d its deflection, which knows nothing of its
/// neighbours, and c = 2^(10/9) 35948 L^(8/9) / n for one contact (N, mm). The constant is that of
/// steel. Error of the own loads: the solution's tolerance; their sum is the force within 1e-6.
///
/// # Errors
/// [`Error::Value`] where the load acts beyond the middle of the outermost slice: slices alone have
/// no such moment.
pub fn laminae(solved: &SolvedCase, count: usize) -> Result<Vec<Lamina>> {
    let case = solved.case();
    check_arm(case, count)?;
    let hertz = *solved.hertz();
    let HertzScales { c_m, p0_pa, .. } = hertz;
    let [from, to] = case.overlap();
    let width = (to - from) / count as f64;
    let edges: Vec<f64> =
        (0..=count).map(|k| if k == count { to } else { from + width * k as f64 }).collect();
    let own = own_loads(solved, &edges);
    let places: Vec<f64> = edges.windows(2).map(|e| 0.5 * (e[0] + e[1]) * c_m).collect();
    let drops: Vec<f64> = places.iter().map(|y_m| drop_at(case, *y_m)).collect();
    let standard = standard_loads(case, &places, &drops, (to - from) * c_m);
    let lamina = |k: usize| {
        let width_m = width * c_m;
        let line = standard[k] / width_m;
        let edge_factor = edge_factor(k + 1, count);
        let radius = case.equivalent_radius_m();
        Lamina {
            y_m: places[k],
            width_m,
            load_n: own[k] * c_m * c_m * p0_pa,
            standard_load_n: standard[k],
            p_pa: solved.pressure(0.0, places[k] / c_m) * p0_pa,
            standard_p_pa: edge_factor * (line * hertz.e_star_pa / (PI * radius)).sqrt(),
            edge_factor,
        }
    };
    Ok((0..count).map(lamina).collect())
}

/// Refuses a load beyond the middles of the outermost of `count` slices.
fn check_arm(case: &Case, count: usize) -> Result<()> {
    let Some(arm_m) = case.load.eccentricity_m else { return Ok(()) };
    let [from, to] = case.overlap_m();
    let nearest = (arm_m - from).min(to - arm_m) / (to - from);
    if nearest * count as f64 >= 0.5 {
        return Ok(());
    }
    Err(Error::Value {
        key: "laminae".into(),
        value: count.to_string(),
        reason:
            "the load acts beyond the middle of the outermost slice: slices alone have no such \
                 moment"
                .into(),
        remedy: format!("take at least {}", (0.5 / nearest).ceil()),
    })
}

/// The loads between the `edges` (C^2 p0).
fn own_loads(solved: &SolvedCase, edges: &[f64]) -> Vec<f64> {
    let pressure = &solved.scene().pressure;
    let axis = pressure.axis();
    let nodal = pressure.line_loads();
    let [first, last] = [axis.breaks()[0], axis.end()];
    let between = |from: f64, to: f64| -> f64 {
        let (from, to) = (from.clamp(first, last), to.clamp(first, last));
        let of_panel = |i: usize| {
            let [a, b] = axis.panel(i);
            let part = [a.max(from), b.min(to)];
            if part[0] >= part[1] {
                return 0.0;
            }
            let nodes = nodal[i * axis.order()..].iter().zip(axis.integrals(i, part));
            nodes.map(|(line, weight)| weight * line.load).sum()
        };
        (0..axis.panel_count()).map(of_panel).sum()
    };
    // The axis of a symmetric contact is its right half.
    let mirrored = |e: &[f64]| if pressure.is_symmetric() { between(-e[1], -e[0]) } else { 0.0 };
    edges.windows(2).map(|e| between(e[0], e[1]) + mirrored(e)).collect()
}

/// The drop of both bodies together at y (m).
fn drop_at(case: &Case, y_m: f64) -> f64 {
    let drop = |body: BodyKind| {
        let [from, to] = case.ends_m(body);
        case.profile(body).map_or(0.0, |profile| profile.drop(y_m - 0.5 * (from + to)))
    };
    BodyKind::ALL.into_iter().map(drop).sum()
}

/// The standard's loads of slices at `places` (m), in equilibrium with the case's force, and with
/// its moment if the tilt is free.
fn standard_loads(case: &Case, places: &[f64], drops: &[f64], length_m: f64) -> Vec<f64> {
    let count = places.len() as f64;
    // A table of drops may be counted from anywhere: the approach follows it.
    let least = drops.iter().copied().fold(f64::INFINITY, f64::min);
    let drops: Vec<f64> = drops.iter().map(|drop| drop - least).collect();
    // N and m in place of N and mm.
    let spring = 2f64.powf(POWER) * BOTH_CONTACTS * (1e3 * length_m).powf(LENGTH_POWER) / count
        * 1e3f64.powf(POWER);
    let loads = |approach: f64, tilt: f64| -> Vec<f64> {
        let slice =
            |(y, drop): (&f64, &f64)| spring * (approach + tilt * y - drop).max(0.0).powf(POWER);
        places.iter().zip(&drops).map(slice).collect()
    };
    let force = case.load.force_n;
    // The deflection of all slices alike, and what profile and tilt may add.
    let alike = (force / (spring * count)).powf(1.0 / POWER);
    let reach = places.iter().fold(0.0, |m: f64, y| m.max(y.abs()));
    let deepest = drops.iter().copied().fold(0.0, f64::max);
    let met = |tilt: f64| -> Vec<f64> {
        let most = count * (alike + deepest) + 2.0 * tilt.abs() * reach;
        let found = bisect([-tilt.abs() * reach, most], |approach| {
            loads(approach, tilt).iter().sum::<f64>() - force
        });
        loads(found, tilt)
    };
    let Some(arm) = case.load.eccentricity_m else {
        return met(case.pose.tilt_rad.unwrap_or(0.0));
    };
    let moment =
        |tilt: f64| -> f64 { met(tilt).iter().zip(places).map(|(q, y)| q * (y - arm)).sum() };
    let half = 0.5 * length_m;
    // Enough to carry everything on the outermost slice.
    let steepest = 4.0 * count * (count * alike + deepest) / half;
    let tilt =
        if arm == 0.0 && moment(0.0) == 0.0 { 0.0 } else { bisect([-steepest, steepest], moment) };
    met(tilt)
}

/// The zero of a function that grows.
fn bisect([mut low, mut high]: [f64; 2], value: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if value(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// The standard's factor of the pressure of slice `k` of `count`, from 1:
/// f = 1 - 0.01 / ln(1.985 |2k - n - 1| / (2n - 2)).
fn edge_factor(k: usize, count: usize) -> f64 {
    let (k, n) = (k as f64, count as f64);
    1.0 - 0.01 / (1.985 * (2.0 * k - n - 1.0).abs() / (2.0 * n - 2.0)).ln()
}

#[cfg(test)]
mod tests {
    use super::super::Options;
    use super::*;
    use crate::base::Material;
    use crate::body::EdgeModel;
    use crate::case::{Factors, ProfileKind, ProfileSpec};

    fn solved(eccentricity_m: Option<f64>, profile: bool) -> SolvedCase {
        by(EdgeModel::QuarterSpace, 1.0, eccentricity_m, profile)
    }

    fn by(
        method: EdgeModel,
        length_ratio: f64,
        eccentricity_m: Option<f64>,
        profile: bool,
    ) -> SolvedCase {
        let material = Material { young_pa: 206e9, poisson: 0.3 };
        let factors = Factors { load: 1e-4, slenderness: 20.0, length_ratio };
        let mut case = Case::from_factors("case", 0.01, material, material, factors);
        case.load.eccentricity_m = eccentricity_m;
        if profile {
            case.roller.profile = Some(ProfileSpec::new(ProfileKind::Iso16281));
        }
        let case = case.with_tolerance(5e-3);
        SolvedCase::new(&case, &Options::new(method)).unwrap()
    }

    /// Where the pressure is singular the outermost slices have their share, too.
    #[test]
    fn slices_at_singular_ends_sum_to_the_force() {
        for (method, length_ratio, arm) in [
            (EdgeModel::HalfSpace, 0.6, None),
            (EdgeModel::QuarterSpace, 0.6, Some(2e-4)),
            (EdgeModel::Mirror, 1.4, None),
        ] {
            let solved = by(method, length_ratio, arm, false);
            let force = solved.case().load.force_n;
            let [few, many] = [50, 2000].map(|count| laminae(&solved, count).unwrap());
            for all in [&few, &many] {
                let sum: f64 = all.iter().map(|l| l.load_n).sum();
                assert!((sum / force - 1.0).abs() < 2e-6, "{method}: {sum} of {force}");
            }
            // Forty thin slices are one thick one.
            for (thick, thin) in few.iter().zip(many.chunks(40)) {
                let sum: f64 = thin.iter().map(|l| l.load_n).sum();
                assert!((sum / thick.load_n - 1.0).abs() < 1e-7, "{method}: {sum} of {thick:?}");
            }
        }
    }

    #[test]
    fn both_columns_carry_the_load_where_it_acts() {
        for (eccentricity_m, profile) in [(None, false), (Some(2e-4), true), (Some(-2e-4), false)] {
            let solved = solved(eccentricity_m, profile);
            let force = solved.case().load.force_n;
            for count in [30, 77] {
                let all = laminae(&solved, count).unwrap();
                for of in [|l: &Lamina| l.load_n, |l: &Lamina| l.standard_load_n] {
                    let sum: f64 = all.iter().map(of).sum();
                    assert!((sum / force - 1.0).abs() < 1e-6, "{sum} of {force}");
                    let arm = all.iter().map(|l| l.y_m * of(l)).sum::<f64>() / force;
                    let wanted = eccentricity_m.unwrap_or(0.0);
                    // The own load within a slice need not act in its middle.
                    assert!((arm - wanted).abs() < 1e-5, "{arm} of {wanted}");
                }
            }
        }
    }

    #[test]
    fn a_load_beyond_the_outermost_slice_is_refused() {
        let mut case = solved(None, false).case().clone();
        let [from, to] = case.overlap_m();
        case.load.eccentricity_m = Some(to - 0.011 * (to - from));
        assert!(check_arm(&case, 46).is_ok());
        let said = check_arm(&case, 40).unwrap_err().to_string();
        assert!(said.contains("beyond the middle") && said.contains("take at least 46"), "{said}");
    }

    #[test]
    fn the_standard_is_near_in_the_middle_and_misses_the_end() {
        let all = laminae(&solved(None, false), 41).unwrap();
        let ratio = |k: usize| all[k].load_n / all[k].standard_load_n;
        assert!((ratio(20) - 1.0).abs() < 0.05, "{}", ratio(20));
        // The outermost slice of a flush end carries less by the true contact of nu = 0.3; the
        // standard's slices are alike.
        assert!(
            (ratio(0) - ratio(40)).abs() < 1e-9 && (ratio(0) - 1.0).abs() > 0.02,
            "{}",
            ratio(0)
        );
        assert!((all[0].standard_load_n / all[20].standard_load_n - 1.0).abs() < 1e-12);
        assert!((edge_factor(1, 41) - 2.328).abs() < 2e-3, "{}", edge_factor(1, 41));
        assert!((edge_factor(21, 41) - 1.0).abs() < 1e-12);
    }
}
