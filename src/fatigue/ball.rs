//! The smallest ball around points.

use nalgebra::{DMatrix, DVector};

/// Parts of the points' extent that are zero.
const NOTHING: f64 = 1e-10;

/// Most steps; some ten are enough.
const MOST_STEPS: usize = 1000;

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
/// A ball around all points that touches some of them shrinks: its centre walks towards the nearest place
/// at equal distances from those, until it touches one more, and lets go of one that pulls it back (Fischer,
/// Gaertner and Kutz, Fast smallest-enclosing-ball computation in high dimensions, ESA 2003).
pub fn smallest_ball<const N: usize>(points: &[[f64; N]]) -> Ball<N> {
    let Some(first) = points.first() else { return Ball { centre: [0.0; N], radius: 0.0 } };
    let mut centre = *first;
    let farthest = |centre: &[f64; N]| {
        let distances = points.iter().map(|p| squared(&minus(p, centre))).enumerate();
        distances.max_by(|a, b| a.1.total_cmp(&b.1)).expect("points")
    };
    let (start, extent) = farthest(&centre);
    let nothing = NOTHING * extent.sqrt();
    let mut touched = vec![start];
    for _ in 0..MOST_STEPS {
        let (shares, aim) = nearest_in_hull(points, &touched, &centre);
        let way = minus(&aim, &centre);
        if squared(&way).sqrt() <= nothing {
            let (least, share) = shares
                .iter()
                .enumerate()
                .min_by(|a, b| a.1.total_cmp(b.1))
                .expect("one is touched");
            if *share >= -NOTHING {
                break;
            }
            touched.swap_remove(least);
            continue;
        }
        // The part of the way on which the ball touches no other point.
        let reference = points[touched[0]];
        let radius = squared(&minus(&reference, &centre));
        let stop = |(i, p): (usize, &[f64; N])| {
            let approach = dot(&way, &minus(&reference, p));
            let free = !touched.contains(&i) && approach > nothing * nothing;
            free.then(|| (0.5 * (radius - squared(&minus(p, &centre))) / approach, i))
        };
        let next = points.iter().enumerate().filter_map(stop).min_by(|a, b| a.0.total_cmp(&b.0));
        let (part, met) = match next {
            Some((part, i)) if part < 1.0 => (part.max(0.0), Some(i)),
            _ => (1.0, None),
        };
        centre.iter_mut().zip(way).for_each(|(c, w)| *c += part * w);
        touched.extend(met);
    }
    Ball { centre, radius: farthest(&centre).1.sqrt() }
}

/// The place nearest to `centre` in the affine hull of the `touched` points, and the points' shares in it.
fn nearest_in_hull<const N: usize>(
    points: &[[f64; N]],
    touched: &[usize],
    centre: &[f64; N],
) -> (Vec<f64>, [f64; N]) {
    let base = points[touched[0]];
    let edges: Vec<[f64; N]> = touched[1..].iter().map(|i| minus(&points[*i], &base)).collect();
    let count = edges.len();
    if count == 0 {
        return (vec![1.0], base);
    }
    let products = DMatrix::from_fn(count, count, |i, j| dot(&edges[i], &edges[j]));
    let offset = minus(centre, &base);
    let right = DVector::from_fn(count, |i, _| dot(&edges[i], &offset));
    let found = products.lu().solve(&right).unwrap_or_else(|| DVector::zeros(count));
    let mut place = base;
    for (edge, share) in edges.iter().zip(found.iter()) {
        place.iter_mut().zip(edge).for_each(|(p, e)| *p += share * e);
    }
    let mut shares = vec![1.0 - found.sum()];
    shares.extend(found.iter());
    (shares, place)
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
