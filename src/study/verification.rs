//! Numerical uncertainty of both sides of a comparison, in the terms of ASME V&V 20-2009.
//!
//! The difference E of a model's solution and a code's data is set against what both do not know of
//! themselves: u_num of the code by the grid convergence index of Roache (J. Fluids Eng. 116 (1994)
//! 405), Fs |f1 - f2| / (r^p - 1), and that of the model by its own refinement. |E| beyond
//! sqrt(u_code^2 + u_model^2) is a difference of the models; below, nothing can be said but that
//! they agree. All are root mean squares over the same points, plain means of each curve's points,
//! with equal weights for all curves.
//!
//! Places are kept apart: at least 1 C from the ends of the contact, where solutions are regular,
//! and 0.1 to 1 C from one, where gradients are steep and the pressure of a longer body grows
//! without bound. Nearer, a singular value belongs to its mesh, and nothing is compared.

use super::brought::{BroughtFile, FileRun, GATED, OnPoints};
use super::run::Reference;
use super::source::{Engine, Source};
use crate::base::number::significant;
use crate::body::Resolution;
use crate::case::Case;
use crate::stress::{Curves, PressureLine, Quantity, StressCurve, away_from_edges};
use serde::{Deserialize, Serialize};

/// The tolerance of the solution that says how uncertain a model's solution of `case` is; `None`
/// where that is the finest there is.
pub fn refined_tolerance(case: &Case) -> Option<f64> {
    let own = case.accuracy.tolerance;
    (own > Resolution::FINEST).then_some(0.1 * own)
}

/// A place on the curves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Zone {
    /// At least 1 C from the ends of the contact.
    Regular,
    /// 0.1 to 1 C from one.
    NearEnd,
}

/// Distances from an end of the contact between which places are near it (C).
pub const NEAR_END: [f64; 2] = [0.1, 1.0];

/// What is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Group {
    /// The contact pressure on both lines.
    Pressure,
    /// The six stress components on all curves of both bodies.
    Stress,
}

/// How a code's meshes converge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Convergence {
    /// Differences fall by an order from 1 to the formal one.
    Observed,
    /// They fall faster; the formal order is used.
    Faster,
    /// They fall by an order below 1, or do not fall.
    None,
    /// There are two meshes; the formal order is assumed.
    Assumed,
    /// There is one mesh.
    OneMesh,
    /// The curves come from a file, which states their error or none.
    Stated,
}

/// What the uncertainties say of a difference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Finding {
    /// It is within the numerical uncertainty of both sides.
    Within,
    /// It is larger: a difference of what is modelled.
    Resolved,
    /// One side does not know its uncertainty.
    Unknown,
}

/// A difference with its uncertainties: a row of `verification.csv` (p0).
#[derive(Debug, Clone, PartialEq)]
pub struct VerificationRow {
    /// The case.
    pub case: String,
    /// Whether no one tuned anything to the case.
    pub held_back: bool,
    /// What is compared with the reference: a model, or another code.
    pub source: Source,
    /// The reference.
    pub reference: Source,
    /// What is compared.
    pub group: Group,
    /// Where.
    pub zone: Zone,
    /// RMS of the difference E.
    pub difference: f64,
    /// Relative sizes of the reference's meshes, coarse to fine.
    pub sizes: String,
    /// Observed order of convergence.
    pub order: Option<f64>,
    /// How the meshes converge.
    pub convergence: Convergence,
    /// The factor of safety.
    pub safety: Option<f64>,
    /// The reference's numerical uncertainty: the grid convergence index.
    pub u_reference: Option<f64>,
    /// The source's own: by its refinement, or by its meshes.
    pub u_source: Option<f64>,
    /// Both together.
    pub u_num: Option<f64>,
    /// What they say.
    pub finding: Finding,
}

/// The formal order: that of stresses of quadratic elements at their best points.
const FORMAL_ORDER: f64 = 3.0;

/// Factors of safety for three meshes with an order, and otherwise.
const SAFETY: [f64; 2] = [1.25, 3.0];

/// A code's numerical uncertainty and where it comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridIndex {
    /// Observed order.
    pub order: Option<f64>,
    /// How the meshes converge.
    pub convergence: Convergence,
    /// The factor of safety.
    pub safety: f64,
    /// The index.
    pub index: f64,
}

/// The grid convergence index of the finest of meshes: `sizes` fine to coarse, and `changes`, the
/// norms of the differences of neighbouring ones, the finest first. `None` for one mesh.
pub fn grid_index(sizes: &[f64], changes: &[f64]) -> Option<GridIndex> {
    let (&[fine, middle, ..], &[last, ..]) = (sizes, changes) else { return None };
    let index = |order: f64, safety: f64| safety * last / ((middle / fine).powf(order) - 1.0);
    let found = |order, convergence, used, safety| {
        Some(GridIndex { order, convergence, safety, index: index(used, safety) })
    };
    let (Some(&coarse), Some(&first)) = (sizes.get(2), changes.get(1)) else {
        return found(None, Convergence::Assumed, FORMAL_ORDER, SAFETY[1]);
    };
    match order([coarse, middle, fine], [first, last]) {
        Some(p) if p > FORMAL_ORDER => found(Some(p), Convergence::Faster, FORMAL_ORDER, SAFETY[0]),
        Some(p) if p >= 1.0 => found(Some(p), Convergence::Observed, p, SAFETY[0]),
        low => found(low, Convergence::None, 1.0, SAFETY[1]),
    }
}

/// The order q for which errors that are multiples of size^q change so from mesh to mesh; `None` if
/// no order from 0.001 to 12 does.
fn order([coarse, middle, fine]: [f64; 3], [first, last]: [f64; 2]) -> Option<f64> {
    let ratio = |q: f64| (coarse.powf(q) - middle.powf(q)) / (middle.powf(q) - fine.powf(q));
    let (mut low, mut high) = (1e-3, 12.0);
    let wanted = first / last;
    if last.is_nan() || last <= 0.0 || wanted <= ratio(low) || wanted >= ratio(high) {
        return None;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if ratio(middle) < wanted { low = middle } else { high = middle }
    }
    Some(0.5 * (low + high))
}

/// What is compared, and where.
#[derive(Clone, Copy)]
struct Part<'a> {
    group: Group,
    zone: Zone,
    /// The ends of the case's overlap (C).
    ends: [f64; 2],
    /// The reference. Its curves are compared, and of a file's curves the components that it
    /// states.
    reference: &'a Curves,
}

/// Mean of some numbers, if there are any.
fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), v| (sum + v, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}

impl Part<'_> {
    fn keeps(&self, at: [f64; 3]) -> bool {
        let far = |distance| away_from_edges(at, self.ends, distance);
        match self.zone {
            Zone::Regular => far(NEAR_END[1]),
            Zone::NearEnd => far(NEAR_END[0]) && !far(NEAR_END[1]),
        }
    }

    /// Root mean square of the difference of two sources; `None` where they have no common curve.
    fn difference(&self, a: &Curves, b: &Curves) -> Option<f64> {
        let on_line = |line: &PressureLine| {
            let (a, b) = (a.line(&line.name)?, b.line(&line.name)?);
            let points = a.at.iter().zip(a.p.iter().zip(&b.p));
            let kept = points.filter(|(at, _)| self.keeps([at[0], at[1], 0.0]));
            mean(kept.map(|(_, (p, q))| (p - q).powi(2)))
        };
        let on_curve = |curve: &StressCurve| {
            let [a, b] = [a, b].map(|side| side.curve(curve.body, &curve.name));
            let (a, b) = (a?, b?);
            let stated = |q: &&Quantity| curve.stress.iter().any(|s| !q.of(s).is_nan());
            let components: Vec<&Quantity> = Quantity::ALL[..6].iter().filter(stated).collect();
            let points = a.at.iter().zip(a.stress.iter().zip(&b.stress));
            let kept = points.filter(|(at, _)| self.keeps(**at));
            mean(kept.flat_map(|(_, (s, t))| {
                components.iter().map(move |q| (q.of(s) - q.of(t)).powi(2))
            }))
        };
        let per_curve: Vec<f64> = match self.group {
            Group::Pressure => self.reference.pressure.iter().filter_map(on_line).collect(),
            Group::Stress => self.reference.stress.iter().filter_map(on_curve).collect(),
        };
        mean(per_curve.into_iter()).map(f64::sqrt)
    }
}

/// What says how uncertain one side is.
enum Own<'a> {
    /// The refined solution of a model, if there is one.
    Refined(Option<&'a Curves>),
    /// Relative sizes of the meshes and the coarser of them, finest first.
    Meshes(Vec<f64>, Vec<&'a Curves>),
    /// The error that a file states, if any.
    Stated(Option<f64>),
}

/// One side of a comparison.
struct Side<'a> {
    source: Source,
    curves: &'a Curves,
    own: Own<'a>,
}

/// The places and groups that are compared.
const PARTS: [(Group, Zone); 4] = [
    (Group::Pressure, Zone::Regular),
    (Group::Pressure, Zone::NearEnd),
    (Group::Stress, Zone::Regular),
    (Group::Stress, Zone::NearEnd),
];

impl<'a> Side<'a> {
    fn of_code(engine: &Engine, reference: &'a Reference) -> Self {
        let coarser = || reference.coarser.iter();
        let sizes = reference.size.into_iter().chain(coarser().map(|(size, _)| *size)).collect();
        let others = coarser().map(|(_, curves)| curves).collect();
        let own = Own::Meshes(sizes, others);
        Self { source: engine.clone().into(), curves: &reference.curves, own }
    }

    /// A source at the points of a file; `None` for a model that is not compared.
    fn of_points(on: &'a OnPoints) -> Option<Self> {
        let own = match on.source {
            Source::Model(model) if model != GATED => return None,
            Source::Model(_) => Own::Refined(on.others.first()),
            Source::Engine(_) => Own::Meshes(on.sizes.clone(), on.others.iter().collect()),
        };
        Some(Self { source: on.source.clone(), curves: &on.curves, own })
    }

    fn of_file(file: &'a BroughtFile) -> Self {
        let own = Own::Stated(file.statements.error_p0);
        Self { source: Engine::brought(&file.name).into(), curves: &file.curves, own }
    }

    fn grid_index(&self, part: Part) -> Option<GridIndex> {
        let Own::Meshes(sizes, others) = &self.own else { return None };
        let all: Vec<&Curves> =
            std::iter::once(self.curves).chain(others.iter().copied()).collect();
        let changes = all.windows(2).map_while(|pair| part.difference(pair[0], pair[1]));
        grid_index(sizes, &changes.collect::<Vec<f64>>())
    }

    /// Its own uncertainty of a part; none where it is not known.
    fn uncertainty(&self, part: Part) -> Option<f64> {
        match &self.own {
            Own::Refined(refined) => part.difference(self.curves, (*refined)?),
            Own::Meshes(..) => Some(self.grid_index(part)?.index),
            Own::Stated(error) => *error,
        }
    }

    /// Relative sizes of its meshes in words, coarse to fine.
    fn sizes(&self) -> String {
        let Own::Meshes(sizes, _) = &self.own else { return String::new() };
        sizes.iter().rev().map(|size| significant(*size, 6)).collect::<Vec<_>>().join(" ")
    }
}

/// All differences of a case: of a model, whose `refined` solution, if any, says how uncertain it
/// is, from every reference, and of every further reference from the first.
pub fn rows(
    case: &Case,
    held_back: bool,
    (model, curves, refined): (Source, &Curves, Option<&Curves>),
    references: &[(Engine, &Reference)],
) -> Vec<VerificationRow> {
    let ends = case.overlap();
    let codes: Vec<Side> = references.iter().map(|(engine, r)| Side::of_code(engine, r)).collect();
    let model = Side { source: model, curves, own: Own::Refined(refined) };
    let of_model = codes.iter().map(|code| (&model, code));
    let of_codes = codes.iter().skip(1).map(|code| (code, &codes[0]));
    let pairs = of_model.chain(of_codes);
    let row = |pair| compared((&case.name, ends), held_back, pair);
    pairs.flat_map(row).collect()
}

/// The differences of quarter-space and of codes from the curves of a file, at its points; `ends`
/// are those of the case's overlap (C).
pub fn of_file(run: &FileRun, ends: [f64; 2]) -> Vec<VerificationRow> {
    let brought = Side::of_file(&run.file);
    let sides = run.sources.iter().filter_map(Side::of_points);
    sides.flat_map(|side| compared((&run.case, ends), false, (&side, &brought))).collect()
}

/// The differences of a source from a reference in a case whose overlap has these ends (C).
fn compared(
    (case, ends): (&str, [f64; 2]),
    held_back: bool,
    (source, reference): (&Side, &Side),
) -> Vec<VerificationRow> {
    let row = |(group, zone)| {
        let part = Part { group, zone, ends, reference: reference.curves };
        let found = part.difference(source.curves, reference.curves)?;
        let grid = reference.grid_index(part);
        let (u_reference, u_source) = (reference.uncertainty(part), source.uncertainty(part));
        let u_num = u_reference.zip(u_source).map(|(a, b)| a.hypot(b));
        let without = match reference.own {
            Own::Stated(_) => Convergence::Stated,
            Own::Meshes(..) | Own::Refined(_) => Convergence::OneMesh,
        };
        Some(VerificationRow {
            case: case.to_string(),
            held_back,
            source: source.source.clone(),
            reference: reference.source.clone(),
            group,
            zone,
            difference: found,
            sizes: reference.sizes(),
            order: grid.and_then(|g| g.order),
            convergence: grid.map_or(without, |g| g.convergence),
            safety: grid.map(|g| g.safety),
            u_reference,
            u_source,
            u_num,
            finding: match u_num {
                None => Finding::Unknown,
                Some(u) if found <= u => Finding::Within,
                Some(_) => Finding::Resolved,
            },
        })
    };
    PARTS.into_iter().filter_map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Errors 0.1 size^q on sizes 1, 1.4 and 2: the order is found, and the index is the safety
    /// times the error.
    #[test]
    fn known_orders_are_found() {
        let sizes = [1.0, 1.4, 2.0];
        let changes = |q: f64| {
            let error = sizes.map(|s: f64| 0.1 * s.powf(q));
            [error[1] - error[0], error[2] - error[1]]
        };
        for q in [1.2, 2.0, 2.9] {
            let found = grid_index(&sizes, &changes(q)).unwrap();
            assert!((found.order.unwrap() - q).abs() < 1e-9);
            assert_eq!((found.convergence, found.safety), (Convergence::Observed, 1.25));
            assert!((found.index - 0.125).abs() < 1e-12);
        }
        // Faster than the formal order: the formal one gives the larger index.
        let found = grid_index(&sizes, &changes(5.0)).unwrap();
        assert_eq!(found.convergence, Convergence::Faster);
        assert!(found.index > 0.125);
        let slow = grid_index(&sizes, &changes(0.5)).unwrap();
        assert_eq!((slow.convergence, slow.safety), (Convergence::None, 3.0));
        assert!(slow.index > 3.0 * changes(0.5)[0]);
        // Differences that grow with refinement have no order.
        let diverging = grid_index(&sizes, &[0.02, 0.01]).unwrap();
        assert_eq!((diverging.order, diverging.convergence), (None, Convergence::None));
        let two = grid_index(&sizes[..2], &changes(2.0)[..1]).unwrap();
        assert_eq!((two.convergence, two.safety), (Convergence::Assumed, 3.0));
        assert_eq!(grid_index(&sizes[..1], &[]), None);
        assert_eq!(grid_index(&sizes, &[0.0, 0.01]).unwrap().index, 0.0);
    }
}
