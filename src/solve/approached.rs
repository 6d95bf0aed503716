//! The force under which bodies approach each other by a given distance.

use super::options::Options;
use super::scene::Scene;
use super::solved_scene::{Approaches, SolvedScene};
use crate::base::number::{significant, stated};
use crate::base::stop::go_on;
use crate::base::{BodyKind, Error, Result};
use crate::body::Resolution;
use crate::case::Case;

/// Line contacts approach by about this power of the force (Palmgren's 10/9 for the inverse): along
/// it the search is almost a straight line.
const POWER: f64 = 0.9;

/// Tolerance (p0) of the solutions at the search's beginning, where the case's is at most
/// [`Resolution::COARSE`]. Otherwise it would cost more than it saves.
const SEARCH: f64 = 3e-2;

/// Relative errors of the approach at which the search at low accuracy ends, and the search itself.
const CLOSE: f64 = 1e-3;
const MET: f64 = 1e-10;

/// The latter after [`PATIENCE`] trials, in tolerances: rounding, or one neglected wave more, may
/// decide between two solutions of the contact that are nearly this far apart.
const ROUNDED: f64 = 5e-6;
const PATIENCE: usize = 6;

/// Relative distance of two forces, raised to [`POWER`], from which they give a slope that rounding
/// leaves alone, and one at which no better force is to be found between them: where the number of
/// nodes or of steps of the contact's iteration changes with the force, the approach has a jump of
/// the solution's own accuracy.
const APART: f64 = 1e-6;
const TOGETHER: f64 = 1e-10;

/// Largest such jump, in tolerances.
const JUMP: f64 = 0.1;

/// Most contacts that are solved, those of them by secants, and the largest factor of the force
/// from one to the next.
const MOST_TRIALS: usize = 60;
const MOST_SECANTS: usize = 20;
const LARGEST_STEP: f64 = 8.0;

/// Approach of points one roller radius below the surfaces (m), at the roller's middle.
pub(super) fn approach_m(approaches: &Approaches, case: &Case) -> f64 {
    approaches.at(case.roller.radius_m / case.hertz().c_m) * case.gap_unit_m()
}

/// The solved scene of `case`, and the case with its force. A force that is given by its approach
/// is found first: each trial solves the contact, which is what W, C and p0 need.
///
/// # Errors
/// As [`Options::check_line`]; [`Error::Value`] if no legal force causes the approach,
/// [`Error::NotConverged`] if none was found; else as [`SolvedScene::new`].
pub(super) fn with_force(case: &Case, options: &Options) -> Result<(Case, SolvedScene)> {
    options.check_line(case)?;
    let Some(wanted_m) = case.load.approach_m else {
        let scene = SolvedScene::new(&Scene::new(case, options.method, options.psi))?;
        return Ok((case.clone(), scene));
    };
    let mut search = Search::new(case, options, wanted_m);
    let tolerance = case.accuracy.tolerance;
    if tolerance <= Resolution::COARSE {
        search.run(SEARCH, CLOSE)?;
    }
    let (loaded, mut scene) = search.run(tolerance, MET)?;
    scene.seconds.contact += search.seconds - scene.seconds.total;
    scene.seconds.total = search.seconds;
    Ok((loaded, scene))
}

/// A force raised to [`POWER`], and how far its approach is off, relative to the wanted one.
type Place = [f64; 2];

/// The search for a force, by secants within the narrowest bracket.
struct Search<'a> {
    case: &'a Case,
    options: &'a Options,
    wanted_m: f64,
    /// The legal range.
    range: [f64; 2],
    /// The next force, raised to [`POWER`].
    next: f64,
    /// Change of the relative error with it, once it is known.
    slope: Option<f64>,
    last: Option<Place>,
    /// The nearest places of too small and of too large an approach.
    below: Option<Place>,
    above: Option<Place>,
    /// Time spent on all trials (s).
    seconds: f64,
}

impl<'a> Search<'a> {
    fn new(case: &'a Case, options: &'a Options, wanted_m: f64) -> Self {
        let range = case.legal_forces_n().map(|force| force.powf(POWER));
        let next = line_force(case, wanted_m).powf(POWER).clamp(range[0], range[1]);
        let (slope, last, below, above) = (None, None, None, None);
        Self { case, options, wanted_m, range, next, slope, last, below, above, seconds: 0.0 }
    }

    /// Solves contacts at `tolerance` until the relative error of the approach is at most `met`, or
    /// no better force is to be found.
    fn run(&mut self, tolerance: f64, met: f64) -> Result<(Case, SolvedScene)> {
        // What other tolerances have found is near, but no bracket.
        (self.last, self.below, self.above) = (None, None, None);
        for trial in 0.. {
            go_on()?;
            let force = self.next.powf(1.0 / POWER);
            let case = self.case.clone().with_force(force).with_tolerance(tolerance);
            let scene = Scene::new(&case, self.options.method, self.options.psi);
            // On the way a solution need not be sound.
            let sound = SolvedScene::new(&scene);
            let (scene, unsound) = match sound {
                Err(e @ Error::Unsound { .. }) => (SolvedScene::roughly(&scene)?, Some(e)),
                found => (found?, None),
            };
            let off = approach_m(&scene.approaches(), &case) / self.wanted_m - 1.0;
            self.seconds += scene.seconds.total;
            let settled = self.tell(off, JUMP * tolerance);
            let met = if trial < PATIENCE { met } else { met.max(ROUNDED * tolerance) };
            if off.abs() <= met || settled {
                return match unsound {
                    Some(e) if tolerance == self.case.accuracy.tolerance => Err(e),
                    _ => Ok((case, scene)),
                };
            }
            self.choose(trial)?;
        }
        unreachable!("the trials end")
    }

    /// Takes the relative error of the trial; whether no better force is to be found, and it is
    /// within `jump`.
    fn tell(&mut self, off: f64, jump: f64) -> bool {
        let place = [self.next, off];
        if let Some([at, was]) = self.last.filter(|[at, _]| (place[0] - at).abs() > APART * at) {
            let slope = (off - was) / (place[0] - at);
            // The approach grows with the force.
            self.slope = Some(slope).filter(|slope| *slope > 0.0).or(self.slope);
        }
        self.last = Some(place);
        if off <= 0.0 {
            self.below = Some(place)
        } else {
            self.above = Some(place)
        }
        let narrow = match (self.below, self.above) {
            (Some([low, _]), Some([high, _])) => (high - low).abs() <= TOGETHER * high,
            _ => false,
        };
        narrow && off.abs() <= jump
    }

    /// Where the secant meets the wanted approach.
    fn proposed(&self) -> Option<f64> {
        let [at, off] = self.last?;
        Some(at - off / self.slope?)
    }

    /// Chooses the next force.
    fn choose(&mut self, trial: usize) -> Result<()> {
        let [at, off] = self.last.expect("a trial has been made");
        // Without a slope: as if the approach were proportional to this power of the force.
        let guess = if off > -0.9 { at / (1.0 + off) } else { at * LARGEST_STEP };
        let mut next = self.proposed().unwrap_or(guess).clamp(at / LARGEST_STEP, at * LARGEST_STEP);
        if let (Some([low, _]), Some([high, _])) = (self.below, self.above) {
            // A secant that leaves the bracket, or hardly moves in it, is of no use.
            let late = trial >= MOST_SECANTS;
            if !(low.min(high)..=low.max(high)).contains(&next) || late {
                next = (low * high).sqrt();
            }
        }
        let [least, most] = self.range;
        let end = if off > 0.0 { least } else { most };
        if at == end && self.legal_end_is_not_enough(off) {
            return Err(self.out_of_range(end, off));
        }
        if trial >= MOST_TRIALS {
            return Err(Error::NotConverged {
                iterations: trial,
                residual: off.abs(),
                remedy: "no force of this approach was found: give force_n instead".into(),
            });
        }
        self.next = next.clamp(least, most);
        Ok(())
    }

    /// Whether there is nothing on the other side of the wanted approach.
    fn legal_end_is_not_enough(&self, off: f64) -> bool {
        if off > 0.0 { self.below.is_none() } else { self.above.is_none() }
    }

    fn out_of_range(&self, end: f64, off: f64) -> Error {
        let wanted = self.wanted_m;
        let [force, reached] =
            [end.powf(1.0 / POWER), wanted * (1.0 + off)].map(|v| significant(v, 4));
        let most = if off > 0.0 { "least" } else { "largest" };
        Error::Value {
            key: "load.approach_m".into(),
            value: stated(wanted),
            reason: format!("under the {most} legal force, {force} N, it is {reached} m"),
            remedy: "check the units of the approach, the lengths and the radius (m), and the moduli (Pa)"
                .into(),
        }
    }
}

/// The force (N) under which a line contact of endless bodies approaches by `wanted_m` between
/// points one roller radius below the surfaces (Johnson, Contact Mechanics, 1985, Eq. 5.57, for
/// each body).
fn line_force(case: &Case, wanted_m: f64) -> f64 {
    let (e_star, radius) = (case.contact_modulus(), case.equivalent_radius_m());
    let depth = case.roller.radius_m;
    let lateral = |kind: BodyKind| {
        let material = case.material(kind);
        let nu = material.poisson;
        e_star * material.plane_strain_compliance() * nu / (1.0 - nu)
    };
    let lateral: f64 = BodyKind::ALL.into_iter().map(lateral).sum();
    let [least, most] = case.legal_forces_n();
    let mut force = (least * most).sqrt();
    // Each step narrows the logarithm of an error by its own size, about ten.
    for _ in 0..20 {
        let c = (4.0 * force * radius / (std::f64::consts::PI * e_star * case.shorter_m())).sqrt();
        let growth = (2.0 * (2.0 * depth / c).ln() - lateral).max(1.0);
        force = (std::f64::consts::PI * e_star * case.shorter_m() * wanted_m / growth)
            .clamp(least, most);
    }
    force
}
