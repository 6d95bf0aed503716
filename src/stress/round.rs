//! The contribution of a body's round shape to the stresses of a flat body, to first order in C /
//! R.
//!
//! The stress in a disc loaded normally on its circumference is exactly the sum of the radial
//! half-plane fields of all elements of the load, each behind its own tangent, and of a uniform
//! tension that frees the circumference of normal traction (Timoshenko and Goodier, Theory of
//! Elasticity, 1970, article 41). Near one of two opposite contacts this is, to first order in C /
//! R and in the frame of the surface above the point, the flat half-plane's field, a uniform
//! sigma_xx of w' / (pi R), with w' the load per length, and for each load p ds at the distance u
//! along the surface and the depth z, r^2 = u^2 + z^2,
//!
//! - xx: -(p ds / (pi R)) (u^4 / r^4 + 4 u^4 z^2 / r^6),
//! - zz: (p ds / (pi R)) (u^2 z^2 / r^4 - 4 u^2 z^4 / r^6),
//! - xz: -(p ds / (pi R)) 4 u^3 z^3 / r^6,
//!
//! from the load's tilt u / R and from the drop u^2 / (2 R) of the surface. The uniform tension
//! thus vanishes on the surface itself, and some C below it alone remains.
//!
//! A traction q ds along the surface has the radial field of a force along its own tangent. It
//! leaves a uniform shear q ds / (pi R) on the surface beside it, which an opposite one removes. To
//! first order this adds
//!
//! - xx: (2 q ds / (pi R)) (u^3 z / r^4) (1 - 2 u^2 / r^2),
//! - zz: (2 q ds / (pi R)) (u z / r^2) (1 - 2 u^2 z^2 / r^4),
//! - xz: -(q ds / (pi R)) (4 u^4 z^2 / r^6 + z^4 / r^4).
//!
//! These terms are those of a plane contact. Along a straight, parallel line it is everywhere that
//! of Hertz; with a profile or a tilt it is the local one, [`LocalContact`]. Where the line ends
//! and the body goes on, they fade like the stress below a line of forces. What free ends make of
//! them is neglected, see the limits in `docs/theory.md`. No stress along y belongs to them; under
//! plane strain this neglects some 0.1 C / R.
//!
//! The frame of the surface above the point is rotated by x / R, and a point at the vertical depth
//! z lies x z / R farther out along the surface than x. Rotation and shift apply to the whole flat
//! field, including its free ends. On the surface itself the tractions are those of its own frame,
//! so that the fixed axes have shears there.

use super::flat::FlatStress;
use crate::base::{StressTensor, ledge};
use multiversion::multiversion;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Points of Gauss's rule for the weight sqrt(1 - t^2) across the contact, in groups that are
/// summed together.
const POINTS: usize = GROUPS * LANES;
const GROUPS: usize = 5;
const LANES: usize = 8;

/// Distance (C) within which the loads are those of a local contact, and from the contact's end
/// within which its half-width is not that of the loads around.
const REACH: f64 = 1.0;

/// Nodes of the rule on [-1, 1], and weights that include the Hertz pressure sqrt(1 - t^2).
type Rule = [[[f64; LANES]; 2]; GROUPS];

static RULE: LazyLock<Rule> = LazyLock::new(|| {
    let angle = |i: usize| PI * (i + 1) as f64 / (POINTS + 1) as f64;
    std::array::from_fn(|group| {
        let angles: [f64; LANES] = std::array::from_fn(|lane| angle(group * LANES + lane));
        [angles.map(f64::cos), angles.map(|angle| PI / (POINTS + 1) as f64 * angle.sin().powi(2))]
    })
});

/// The uniform sigma_xx of a disc compressed across its diameter by two loads, w' / (pi R) with the
/// line load w' of Hertz's p0 and C, per C / R (p0). It is no part of a [`RoundStress`]: a load on
/// one side does not cause it, and far from the contact a load on a part of a roller's length is
/// one on all of it.
pub const DIAMETRAL_TENSION: f64 = 0.5;

/// Ends of a contact along y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactEnds {
    /// Their places (C).
    pub at: [f64; 2],
    /// Whether the contact ends there before its bodies do, as its load vanishes.
    pub open: [bool; 2],
}

/// The plane contact near a place of the line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalContact {
    /// Its half-width (C).
    pub half_width: f64,
    /// Its largest pressure, of a semi-elliptic one with the same load (p0).
    pub peak: f64,
    /// x of its middle (C).
    middle: f64,
    /// Distances inwards from the line's ends (C), negative beyond them.
    inside: [f64; 2],
    /// How far the body goes on beyond these ends (C).
    ledges: [f64; 2],
}

/// The load of a row of cells across the contact.
#[derive(Debug, Clone, Copy)]
pub struct RowLoad {
    /// Its place along the line (C).
    pub y: f64,
    /// Its load per length (C p0).
    pub load: f64,
    /// The moment of that about x = 0 (C^2 p0).
    pub moment: f64,
}

impl LocalContact {
    /// The Hertz contact of the mean load.
    pub const HERTZ: LocalContact = LocalContact::endless(1.0, 1.0);

    /// That of an endless line.
    pub const fn endless(half_width: f64, peak: f64) -> Self {
        Self { half_width, peak, middle: 0.0, inside: [f64::INFINITY; 2], ledges: [0.0; 2] }
    }

    /// The same below `y`, of a line that has these `ends`, on a body with ends of its own. A load
    /// that vanishes before its body ends has no image there to speak of.
    #[must_use]
    pub fn on_line(self, y: f64, ContactEnds { at, open }: ContactEnds, body: [f64; 2]) -> Self {
        let beyond = [at[0] - body[0], body[1] - at[1]];
        let goes_on = |i: usize| open[i] && ledge(beyond[i], 0.5 * (body[1] - body[0])) > 0.0;
        let ledges = [0, 1].map(|i| if goes_on(i) { f64::INFINITY } else { beyond[i].max(0.0) });
        Self { inside: [y - at[0], at[1] - y], ledges, ..self }
    }

    /// The part of what an endless line does at (`x`, `z`): of the vertical stress below a line of
    /// forces on a half-space that ends at the distance s, (1 + (3 t - t^3) / 2) / 2 is left, with
    /// t = s / (s^2 + x^2 + z^2)^(1/2) (the integral of Boussinesq's 3 z^3 / (2 pi r^5) along it).
    /// The forces of a contact are spread over its width. Where the body ends a `ledge` farther on,
    /// the line's image in its end face begins after two of them.
    fn share(&self, x: f64, z: f64) -> f64 {
        let off = x * x + z * z + 0.25 * self.half_width * self.half_width;
        let beyond = |s: f64| {
            let t = s / (s * s + off).sqrt();
            0.5 - 0.25 * (3.0 * t - t * t * t)
        };
        let lost = |(s, ledge): (&f64, &f64)| match *ledge > 0.0 {
            true if ledge.is_infinite() => beyond(*s),
            true => beyond(*s) - beyond(s + 2.0 * ledge),
            false => 0.0,
        };
        1.0 - self.inside.iter().zip(&self.ledges).map(lost).sum::<f64>()
    }

    /// The place whose load counts at `y`, in a contact that has these `ends`: what is added
    /// depends on the loads within C, of which the steep ends themselves are no measure.
    pub fn place(y: f64, [from, to]: [f64; 2]) -> f64 {
        let inset = REACH.min(0.5 * (to - from));
        // Where they leave no room, the two may differ by rounding, in either order.
        y.max(from + inset).min(to - inset)
    }

    /// The Hertz contact of a `load` per length (C p0): its half-width in units of C and its
    /// pressure in units of p0 are the same number. A tensile load has no contact.
    pub fn carrying(load: f64) -> Self {
        let half_width = (2.0 / PI * load.max(0.0)).sqrt();
        Self::endless(half_width, half_width)
    }

    /// That of `rows` of cells: the mean of those within C of `place`, as what is added there does
    /// not follow the load from one row to the next.
    pub fn under_rows(rows: &[RowLoad], place: f64) -> Self {
        let apart = |row: &RowLoad| (row.y - place).abs();
        let nearest = rows.iter().map(apart).fold(f64::INFINITY, f64::min);
        let reach = REACH.max(nearest);
        let (mut load, mut moment, mut count) = (0.0, 0.0, 0.0);
        for row in rows.iter().filter(|row| apart(row) <= reach) {
            (load, moment, count) = (load + row.load, moment + row.moment, count + 1.0);
        }
        let middle = if load > 0.0 { moment / load } else { 0.0 };
        Self { middle, ..Self::carrying(load / count) }
    }

    /// Contributions of the loads' tilt and of the surface's drop, by one of [`Kernel`]s, at (`x`,
    /// `z`) (C).
    fn tilted(&self, sums: Kernel, x: f64, z: f64) -> StressTensor {
        let Self { half_width, peak, .. } = *self;
        if half_width <= 0.0 {
            return StressTensor::default();
        }
        let x = x - self.middle;
        let factor = half_width * peak * self.share(x, z) / PI;
        let of_sum = |sum| factor * sum;
        let [xx, zz, xz] = sums(&RULE, x / half_width, z / half_width).map(of_sum);
        StressTensor { xx, zz, xz, ..StressTensor::default() }
    }
}

/// Sums over a rule's loads at (x, z): contributions to xx, zz and xz.
type Kernel = fn(&Rule, f64, f64) -> [f64; 3];

/// A stress of a body whose surface may be round, in units of p0.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RoundStress {
    /// The flat body's stress.
    pub flat: FlatStress,
    /// The contribution of the round shape per C / R, without [`DIAMETRAL_TENSION`].
    pub round: FlatStress,
}

/// Adds to `stresses` what a skin adds at their points, per C / R, if there is one.
pub fn add_skins(stresses: &mut [RoundStress], skins: &[StressTensor]) {
    stresses.iter_mut().zip(skins).for_each(|(s, skin)| s.round.pressure += *skin);
}

impl RoundStress {
    /// The stress at x and the depth `z` below the surface (C), where the flat body has the stress
    /// `flat` with the derivative `slope` along x, per C, under the pressure of `contact`.
    pub fn new(
        x: f64,
        z: f64,
        flat: impl Into<FlatStress>,
        slope: impl Into<FlatStress>,
        contact: &LocalContact,
    ) -> Self {
        let (flat, slope) = (flat.into(), slope.into());
        let moved = |s: &StressTensor, slope: StressTensor| turned(s) * x + slope * (x * z);
        let pressure = moved(&flat.pressure, slope.pressure) + contact.tilted(tilted, x, z);
        // Nothing is computed without a traction.
        let traction = match flat.traction == StressTensor::default() {
            true => StressTensor::default(),
            false => moved(&flat.traction, slope.traction) + contact.tilted(tilted_along, x, z),
        };
        Self { flat, round: FlatStress { pressure, traction } }
    }

    /// The stress (p0) under the pressure for C / R = `curvature`, positive for a convex body,
    /// without the tension of a disc that is squeezed, [`DIAMETRAL_TENSION`].
    pub fn at(&self, curvature: f64) -> StressTensor {
        self.flat.pressure + self.round.pressure * curvature
    }

    /// The stress (p0) under the pressure as a traction along +x, for C / R = `curvature`.
    pub fn under_traction(&self, curvature: f64) -> StressTensor {
        self.flat.traction + self.round.traction * curvature
    }

    /// The stress at the mirror image in the plane x = 0.
    #[must_use]
    pub fn mirrored_in_x(&self) -> Self {
        Self { flat: self.flat.mirrored_in_x(), round: self.round.mirrored_in_x() }
    }
}

/// Step of the difference quotient along x (C).
pub(super) const STEP: f64 = 1e-4;

/// The stresses of a body with a round surface, for each of `zs` and of `xs`, from `flat`, which
/// gives those of the flat body at each of `zs` for a list of x, and for the place that each of
/// them belongs to, under the plane `contact`. The slopes along x, at the places where the flat
/// stress is `sloped`, are difference quotients, whose points share all sums.
pub(crate) fn rounded(
    xs: &[f64],
    zs: &[f64],
    contact: &LocalContact,
    sloped: impl Fn(f64) -> bool,
    flat: impl Fn(&[f64], &[f64]) -> Vec<Vec<FlatStress>>,
) -> Vec<Vec<RoundStress>> {
    // On the surface points are not shifted along x.
    let below = zs.iter().any(|z| *z > 0.0);
    let sloped = |x: f64| below && sloped(x);
    let points = |&x: &f64| match sloped(x) {
        true => vec![(x, x), (x - STEP, x), (x + STEP, x)],
        false => vec![(x, x)],
    };
    let (all, places): (Vec<f64>, Vec<f64>) = xs.iter().flat_map(points).unzip();
    let rows = zs.iter().zip(flat(&all, &places));
    rows.map(|(&z, row)| {
        let mut row = row.into_iter();
        let mut next = || row.next().expect("one for each of all");
        let at = |&x: &f64| {
            let own = next();
            let slope = if sloped(x) {
                let (before, after) = (next(), next());
                (after - before) * (0.5 / STEP)
            } else {
                FlatStress::default()
            };
            RoundStress::new(x, z, own, slope, contact)
        };
        xs.iter().map(at).collect()
    })
    .collect()
}

/// What a turn of the axes adds to a stress, per radian.
fn turned(s: &StressTensor) -> StressTensor {
    let StressTensor { xx, zz, xy, xz, yz, .. } = *s;
    StressTensor { xx: -2.0 * xz, yy: 0.0, zz: 2.0 * xz, xy: -yz, xz: xx - zz, yz: xy }
}

/// Sums over the rule's loads of the contributions of their tilt and of the surface's drop to xx,
/// zz and xz at (`x`, `z`); compiled for the processor's vector units.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn tilted(rule: &Rule, x: f64, z: f64) -> [f64; 3] {
    summed(rule, x, z, |along, down, across| {
        let zz = along * down * (1.0 - 4.0 * down);
        [-along * along * (1.0 + 4.0 * down), zz, -4.0 * across.powi(3)]
    })
}

/// As [`tilted`], of tractions along +x.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn tilted_along(rule: &Rule, x: f64, z: f64) -> [f64; 3] {
    summed(rule, x, z, |along, down, across| {
        let xx = 2.0 * across * along * (1.0 - 2.0 * along);
        let zz = 2.0 * across * (1.0 - 2.0 * along * down);
        [xx, zz, -down * (4.0 * along * along + down)]
    })
}

/// Sums of a term of u^2 / r^2, z^2 / r^2 and u z / r^2 over the rule's loads, with their weights.
#[inline(always)]
fn summed(rule: &Rule, x: f64, z: f64, term: impl Fn(f64, f64, f64) -> [f64; 3]) -> [f64; 3] {
    let mut sums = [[0.0; LANES]; 3];
    for [nodes, weights] in rule {
        for lane in 0..LANES {
            let u = x - nodes[lane];
            let square = u * u + z * z;
            // A load at the point itself contributes nothing.
            let inverse = if square > 0.0 { 1.0 / square } else { 0.0 };
            let own = term(u * u * inverse, z * z * inverse, u * z * inverse);
            (0..3).for_each(|i| sums[i][lane] += weights[lane] * own[i]);
        }
    }
    sums.map(|lanes| lanes.iter().sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernels::strip;

    #[test]
    fn places_of_loads_lie_in_contacts_of_any_length() {
        for i in 0..2000 {
            // Some leave no room between the insets of both ends, which then differ by rounding.
            let from = 1e-3 * f64::from(i) - 0.7;
            for length in [1e-3, 0.3, 1.1, 5.0] {
                let ends = [from, from + length];
                for y in [-9.0, from + 0.3 * length, 9.0] {
                    let place = LocalContact::place(y, ends);
                    assert!(ends[0] <= place && place <= ends[1], "{y} in {ends:?}: {place}");
                }
            }
        }
    }

    /// Places on the arc and forces of a semi-elliptic load of half-width 1.
    fn loads() -> Vec<(f64, f64)> {
        let rule = crate::base::gauss_legendre(400);
        let angles = rule.0.iter().map(|g| 0.5 * PI * g).zip(rule.1);
        angles.map(|(angle, w)| (angle.sin(), 0.5 * PI * w * angle.cos().powi(2))).collect()
    }

    /// The radial half-plane field xx, zz, xz at the distance `d` from a force.
    fn radial(d: [f64; 2], force: [f64; 2]) -> [f64; 3] {
        let square = d[0] * d[0] + d[1] * d[1];
        let radial = -2.0 / PI * (d[0] * force[0] + d[1] * force[1]) / (square * square);
        [radial * d[0] * d[0], radial * d[1] * d[1], radial * d[0] * d[1]]
    }

    /// Adds a stress to a sum.
    fn add(sum: &mut [f64; 3], own: [f64; 3]) {
        sum.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
    }

    /// A point at a depth below the disc's surface.
    fn below(radius: f64, x: f64, depth: f64) -> [f64; 2] {
        [x, radius - (radius * radius - x * x).sqrt() + depth]
    }

    /// A disc under a semi-elliptic traction of half-width 1 along the surface: the sum of the
    /// radial fields of forces along the tangents and of the shear that frees the surface beside
    /// them, in the frame of the axes.
    fn disc_along(radius: f64, x: f64, depth: f64) -> [f64; 3] {
        let at = below(radius, x, depth);
        let mut sum = [0.0; 3];
        for (s, q) in loads() {
            let (sin, cos) = (s / radius).sin_cos();
            let apex = [radius * sin, radius * (1.0 - cos)];
            add(&mut sum, radial([at[0] - apex[0], at[1] - apex[1]], [q * cos, q * sin]));
            sum[2] -= q / (PI * radius);
        }
        sum
    }

    /// What [`RoundStress`] differs by from such a disc, at most.
    fn off_along(radius: f64) -> f64 {
        let plane = |x: f64, z: f64| {
            let [xx, zz, xz] = strip::stress_along(1.0, &[1.0], x, z);
            let traction = StressTensor { xx, zz, xz, ..StressTensor::default() };
            FlatStress { pressure: StressTensor::default(), traction }
        };
        let mut worst: f64 = 0.0;
        for x in [-1.5, -0.3, 0.0, 0.3, 0.7, 1.5, 2.5] {
            for z in [0.2, 0.5, 1.0, 2.0, 4.0] {
                let traction = (plane(x + 1e-4, z).traction - plane(x - 1e-4, z).traction) * 5e3;
                let slope = FlatStress { pressure: StressTensor::default(), traction };
                let got = RoundStress::new(x, z, plane(x, z), slope, &LocalContact::HERTZ)
                    .under_traction(1.0 / radius);
                for (g, e) in [got.xx, got.zz, got.xz].iter().zip(disc_along(radius, x, z)) {
                    worst = worst.max((g - e).abs());
                }
            }
        }
        worst
    }

    /// Without a ledge nothing fades, and the least one changes the least; far below the end of a
    /// line on a long body half is left.
    #[test]
    fn terms_fade_with_the_ledge() {
        let share = |ledge: f64, s: f64, z: f64| {
            let [from, to] = [-40.0, 40.0];
            let ends = ContactEnds { at: [from, to], open: [false; 2] };
            let line = LocalContact::HERTZ.on_line(to - s, ends, [from, to + ledge]);
            line.share(0.3, z)
        };
        for (s, z) in [(0.1, 0.1), (0.5, 0.3), (3.0, 1.0)] {
            assert_eq!(share(0.0, s, z), 1.0);
            let small = [1e-9, 1e-3, 0.1].map(|ledge| (1.0 - share(ledge, s, z)) / ledge);
            assert!(small.iter().all(|rate| (0.0..3.0).contains(rate)), "{small:?}");
            assert!(share(2.0, s, z) > share(50.0, s, z));
        }
        assert!((share(1e6, 0.0, 30.0) - 0.5).abs() < 0.02);
    }

    #[test]
    fn first_order_of_a_disc_under_a_traction() {
        let (near, far) = (off_along(40.0), off_along(80.0));
        assert!(near < 3e-3 && far < 0.3 * near, "{near} {far}");
    }

    #[test]
    fn a_surface_carries_its_tractions_in_its_own_frame() {
        let pressure = StressTensor { xx: -0.4, yy: -0.3, zz: -0.7, xy: 0.2, xz: 0.0, yz: 0.0 };
        let traction = StressTensor { xx: 0.5, yy: 0.1, zz: 0.0, xy: -0.3, xz: -0.7, yz: 0.0 };
        let (x, curvature) = (0.8, 1e-4);
        let flat = FlatStress { pressure, traction };
        let s = RoundStress::new(x, 0.0, flat, FlatStress::default(), &LocalContact::HERTZ);
        // The normal into the body, and along the surface.
        let (sin, cos) = (x * curvature).sin_cos();
        let on_surface = |s: &StressTensor| {
            let force =
                [-sin * s.xx + cos * s.xz, -sin * s.xy + cos * s.yz, -sin * s.xz + cos * s.zz];
            [cos * force[0] + sin * force[2], force[1], cos * force[2] - sin * force[0]]
        };
        for (s, wanted) in
            [(s.at(curvature), [0.0, 0.0, -0.7]), (s.under_traction(curvature), [-0.7, 0.0, 0.0])]
        {
            let got = on_surface(&s);
            let off = (0..3).map(|i| f64::abs(got[i] - wanted[i])).fold(0.0, f64::max);
            assert!(off < 10.0 * curvature * curvature, "{s:?}");
        }
    }

    /// A disc under opposite semi-elliptic pressures of half-width 1: the sum of the
    /// radial fields behind the tangents and of the uniform tension, in the frame of the axes.
    fn disc(radius: f64, x: f64, depth: f64) -> [f64; 3] {
        let at = below(radius, x, depth);
        let mut sum = [0.0; 3];
        for (s, p) in loads() {
            let (sin, cos) = (s / radius).sin_cos();
            for side in [1.0, -1.0] {
                // Apex, and inward normal; z from the upper contact down, the centre at the radius.
                let apex = [radius * sin, radius - side * radius * cos];
                add(
                    &mut sum,
                    radial([at[0] - apex[0], at[1] - apex[1]], [-p * sin, p * side * cos]),
                );
            }
            let tension = p / (PI * radius);
            add(&mut sum, [tension, tension, 0.0]);
        }
        sum
    }

    #[test]
    fn first_order_of_a_disc_that_is_squeezed() {
        let plane = |x: f64, z: f64| {
            let [xx, zz, xz] = strip::stress(1.0, &[1.0], x, z);
            StressTensor { xx, zz, xz, ..StressTensor::default() }
        };
        let off = |radius: f64| {
            let mut worst: f64 = 0.0;
            for x in [0.0, 0.3, 0.7, 1.5, 2.5] {
                for z in [0.2, 0.5, 1.0, 2.0, 4.0] {
                    let slope = (plane(x + 1e-4, z) - plane(x - 1e-4, z)) * 5e3;
                    let got = RoundStress::new(x, z, plane(x, z), slope, &LocalContact::HERTZ)
                        .at(1.0 / radius);
                    let xx = got.xx + DIAMETRAL_TENSION / radius;
                    for (g, e) in [xx, got.zz, got.xz].iter().zip(disc(radius, x, z)) {
                        worst = worst.max((g - e).abs());
                    }
                }
            }
            worst
        };
        // The remainder is of second order.
        let (near, far) = (off(40.0), off(80.0));
        assert!(near < 3e-3 && far < 0.3 * near, "{near} {far}");
    }
}
