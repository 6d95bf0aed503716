//! The smallest ball around points.

/// Part of a radius that is rounding.
const ROUNDING: f64 = 1e-12;

/// Part of a distance below which a point adds no direction to those of others.
const DEPENDENT: f64 = 1e-10;

/// A ball in space of N dimensions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball<const N: usize> {
    /// Its centre.
    pub centre: [f64; N],
    /// Its radius.
    pub radius: f64,
}

/// The smallest ball around `points`; one of radius zero at the origin if there are none.
///
/// At most N + 1 points hold it. While a point lies outside, the farthest one joins those that hold
/// the ball, and the smallest ball around these few takes its place (Gaertner, Fast and robust
/// smallest enclosing balls, ESA 1999). It is larger each time, so the search ends. Points along a
/// smooth curve are nearly dependent, which no step here divides by.
pub fn smallest_ball<const N: usize>(points: &[[f64; N]]) -> Ball<N> {
    let Some(first) = points.first() else { return Ball { centre: [0.0; N], radius: 0.0 } };
    let mut centre = *first;
    let mut holding = vec![*first];
    let mut reached = 0.0;
    loop {
        let farthest = farthest(points, &centre);
        let radius = squared(&minus(farthest, &centre)).sqrt();
        if radius <= reached * (1.0 + ROUNDING) {
            return Ball { centre, radius };
        }
        let (larger, held_by) = around(&holding, farthest);
        if larger.radius <= reached {
            // Larger by less than rounding.
            return Ball { centre, radius };
        }
        (centre, reached, holding) = (larger.centre, larger.radius, held_by);
    }
}

/// The smallest ball around the points that are `holding` another one and a point outside that, and
/// those of them that hold it, the one outside among them: of the balls that some hold, the one
/// whose centre has the nearest farthest point.
fn around<const N: usize>(holding: &[[f64; N]], outside: &[f64; N]) -> (Ball<N>, Vec<[f64; N]>) {
    let all: Vec<[f64; N]> = holding.iter().chain([outside]).copied().collect();
    let mut best = (f64::INFINITY, *outside, 0);
    for chosen in 0u32..1 << holding.len() {
        let Some(centre) = circumcentre(outside, of(holding, chosen)) else { continue };
        let radius = squared(&minus(farthest(&all, &centre), &centre)).sqrt();
        if radius < best.0 {
            best = (radius, centre, chosen);
        }
    }
    let (radius, centre, chosen) = best;
    let holding = of(holding, chosen).chain([outside]).copied().collect();
    (Ball { centre, radius }, holding)
}

/// The points that the bits of `chosen` name.
fn of<const N: usize>(points: &[[f64; N]], chosen: u32) -> impl Iterator<Item = &[f64; N]> {
    points.iter().enumerate().filter(move |(i, _)| chosen >> i & 1 == 1).map(|(_, point)| point)
}

/// The place at equal distances from `base` and `others` in their affine hull; none if one of them
/// depends on those before it.
///
/// With an orthonormal basis of the edges from `base`, made one after the other, an edge of length
/// l puts the centre at l^2 / 2 along itself, which gives its coordinates in turn.
fn circumcentre<'a, const N: usize>(
    base: &[f64; N],
    others: impl Iterator<Item = &'a [f64; N]>,
) -> Option<[f64; N]> {
    let mut basis: Vec<[f64; N]> = Vec::with_capacity(N);
    let mut way = [0.0; N];
    for other in others {
        let edge = minus(other, base);
        let mut own = edge;
        // Twice: what one pass leaves of the others is rounding of the edge, not of what is left of
        // it.
        for _ in 0..2 {
            for direction in &basis {
                let part = dot(&own, direction);
                own.iter_mut().zip(direction).for_each(|(o, d)| *o -= part * d);
            }
        }
        let length = squared(&own).sqrt();
        if length <= DEPENDENT * squared(&edge).sqrt() {
            return None;
        }
        let direction = own.map(|o| o / length);
        let part = (0.5 * squared(&edge) - dot(&edge, &way)) / dot(&edge, &direction);
        way.iter_mut().zip(&direction).for_each(|(w, d)| *w += part * d);
        basis.push(direction);
    }
    Some(std::array::from_fn(|i| base[i] + way[i]))
}

/// The point that is farthest from `centre`; there are points.
fn farthest<'a, const N: usize>(points: &'a [[f64; N]], centre: &[f64; N]) -> &'a [f64; N] {
    let distances = points.iter().map(|p| (squared(&minus(p, centre)), p));
    distances.max_by(|a, b| a.0.total_cmp(&b.0)).expect("there are points").1
}

fn minus<const N: usize>(a: &[f64; N], b: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn squared<const N: usize>(a: &[f64; N]) -> f64 {
    dot(a, a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::RngCore;
    use proptest::test_runner::{RngAlgorithm, TestRng};

    /// The stresses of a passage lie on a smooth curve, close to each other. The largest distance
    /// from a place is convex in it: where no small step in any direction lessens it, it is the
    /// least.
    #[test]
    fn balls_of_smooth_curves_are_the_smallest() {
        let mut source = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
        let mut number = || 2.0 * source.next_u64() as f64 / u64::MAX as f64 - 1.0;
        for round in 0..200 {
            // Waves that fade: as flat, in some directions, as the stresses far from the contact.
            let scale: [f64; 5] = std::array::from_fn(|_| 10f64.powf(3.0 * number() - 3.0));
            let [phase, speed]: [[f64; 5]; 2] =
                std::array::from_fn(|_| std::array::from_fn(|_| 3.0 * number()));
            let even = round % 2 == 0;
            let curve: Vec<[f64; 5]> = (-80..=80)
                .map(|i| f64::from(i) / 20.0)
                .map(|x| {
                    std::array::from_fn(|c| {
                        let wave = if even && c < 3 { x.abs() } else { x };
                        scale[c] * (speed[c] * wave + phase[c]).sin() / (1.0 + x * x)
                    })
                })
                .collect();
            let ball = smallest_ball(&curve);
            let reach =
                |centre: &[f64; 5]| squared(&minus(farthest(&curve, centre), centre)).sqrt();
            assert!((reach(&ball.centre) / ball.radius - 1.0).abs() < 1e-14);
            for _ in 0..500 {
                let step: [f64; 5] = std::array::from_fn(|_| number());
                let size = 10f64.powf(3.0 * number() - 4.0) * ball.radius / squared(&step).sqrt();
                let aside = std::array::from_fn(|c| ball.centre[c] + size * step[c]);
                let lessened = ball.radius - reach(&aside);
                assert!(lessened < 1e-10 * ball.radius, "{round}: {ball:?} by {lessened:e}");
            }
        }
    }

    #[test]
    fn balls_of_known_points() {
        assert_eq!(smallest_ball::<3>(&[]).radius, 0.0);
        assert_eq!(smallest_ball(&[[1.0, 2.0]; 5]), Ball { centre: [1.0, 2.0], radius: 0.0 });
        let ball = smallest_ball(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.2], [1.5, -0.1]]);
        assert!((ball.radius - 1.0).abs() < 1e-12 && (ball.centre[0] - 1.0).abs() < 1e-12);
        // The corners of a cube, and points within, all in a plane of five dimensions.
        let corner = |i: usize| {
            let side = |bit: usize| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
            [side(0), side(1), side(2), 0.0, 7.0]
        };
        let mut points: Vec<_> = (0..8).map(corner).collect();
        points.push([0.3, 0.2, -0.9, 0.0, 7.0]);
        let ball = smallest_ball(&points);
        assert!((ball.radius - 3f64.sqrt()).abs() < 1e-12, "{ball:?}");
        // An ellipse: its longer half-axis.
        let ellipse: Vec<[f64; 2]> = (0..360)
            .map(|i| f64::from(i).to_radians())
            .map(|t| [5.0 + 3.0 * t.cos(), t.sin()])
            .collect();
        let ball = smallest_ball(&ellipse);
        assert!((ball.radius - 3.0).abs() < 1e-12 && ball.centre[1].abs() < 1e-9, "{ball:?}");
    }
}
