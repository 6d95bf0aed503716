//! Where the pressure of a contact ends.

use super::layout::Layout;
use super::problem::Problem;
use super::solution::ContactEnd;

/// Both ends of a contact with these modes of the nodes.
pub(super) fn ends(
    problem: &Problem,
    layout: &Layout,
    half_widths: &[f64],
    coefficients: &[Vec<f64>],
) -> [ContactEnd; 2] {
    let (axis, last) = (problem.axis, problem.axis.len() - 1);
    let load = |j: usize| coefficients[j].first().map_or(0.0, |c| c.max(0.0) * half_widths[j]);
    let end = |side: usize| {
        // The first side is that of the mirror image.
        let (outward, at) = if side == 0 { (-1.0, -axis.breaks()[0]) } else { (1.0, axis.end()) };
        if !problem.recedes[side] {
            return ContactEnd::of_bodies(at);
        }
        let node = |j: usize| (outward * axis.nodes()[j], axis.weights()[j], load(j));
        let mut nodes: Vec<_> = (0..=last).map(node).collect();
        let mut free = layout.free[layout.free.len() - 1];
        if side == 0 {
            nodes.reverse();
            free = last - layout.free[0];
        }
        Side { nodes, free }.end(problem.open[side], at)
    };
    let after = end(1);
    [if problem.both_ends { end(0) } else { after }.mirrored(), after]
}

/// The nodes, ascending towards an end.
struct Side {
    /// Each with its weight on the axis and its line load, in that of half-width C and pressure p0.
    nodes: Vec<(f64, f64, f64)>,
    /// The last free one.
    free: usize,
}

impl Side {
    /// The end of this side, on an axis up to `end`, where the bodies end if it is not `open`.
    fn end(&self, open: bool, end: f64) -> ContactEnd {
        let loaded = self.nodes.iter().rposition(|(_, _, load)| *load > 0.0).unwrap_or(0);
        let (from, _, inner) = self.nodes[self.free];
        let rise = |end: f64| (end - from).abs() / inner;
        if loaded + 1 < self.nodes.len() {
            let at = self.behind(loaded);
            return ContactEnd { at, beyond: 0.0, rise: rise(at) };
        }
        if !open || inner == 0.0 {
            return ContactEnd::of_bodies(end);
        }
        // Of the lines through the first of these loads that which is closest to the others,
        // against the one that falls to zero at the axis's end.
        let (mut over, mut norm) = (0.0, 0.0);
        for (y, weight, load) in &self.nodes[self.free + 1..] {
            let share = (y - from) / (end - from);
            over += weight * share * (load / inner - (1.0 - share));
            norm += weight * share * share;
        }
        let left = if norm > 0.0 { (over / norm).clamp(-1.0, 1.0) } else { 0.0 };
        ContactEnd { at: end, beyond: left * (end - from), rise: rise(end) }
    }

    /// Where the pressure ends between the last node that is loaded and the next one.
    fn behind(&self, loaded: usize) -> f64 {
        let (last, _, outer) = self.nodes[loaded];
        let most = self.nodes[loaded + 1].0 - last;
        let beyond = loaded.checked_sub(1).map_or(most, |next| {
            let (y, _, inner) = self.nodes[next];
            (last - y) * outer / (inner - outer)
        });
        // A pressure that does not fall tells nothing.
        last + if beyond > 0.0 { beyond.min(most) } else { most }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nodes 0.1 C apart up to `end`, each with the line load of a contact that ends at 1.63 C.
    fn side(end: f64, load: impl Fn(f64) -> f64) -> Side {
        let y = |j: i32| end + 0.1 * (f64::from(j) - 9.5);
        Side { nodes: (0..10).map(|j| (y(j), 0.1, load(y(j)).max(0.0))).collect(), free: 5 }
    }

    #[test]
    fn a_load_that_falls_linearly_ends_where_it_is_zero() {
        let load = |y: f64| 0.5 * (1.63 - y);
        // Its last nodes carry nothing.
        let end = side(2.0, load).end(true, 2.0);
        assert!((end.at - 1.63).abs() < 1e-12 && end.beyond == 0.0, "{end:?}");
        assert!((end.rise - 2.0).abs() < 1e-12, "{end:?}");
        // It is left at the axis's end, none, or less than none.
        for at in [1.55, 1.63, 1.67] {
            let end = side(at, load).end(true, at);
            let beyond = 0.45 * load(at) / load(at - 0.45);
            assert!((end.beyond - beyond).abs() < 1e-12 && end.at == at, "{end:?}");
        }
        // That of bodies is theirs.
        let end = side(1.5, load).end(false, 1.5);
        assert_eq!(end, ContactEnd { at: 1.5, beyond: 0.0, rise: f64::INFINITY });
    }

    #[test]
    fn a_load_that_tells_nothing_ends_with_its_nodes() {
        // It rises up to its last node.
        let end = side(2.0, |y| if y < 1.6 { y } else { -1.0 }).end(true, 2.0);
        assert!((end.at - 1.65).abs() < 1e-12, "{end:?}");
        // No node carries any.
        let none = side(2.0, |_| 0.0).end(true, 2.0);
        assert!(none.at.is_finite() && none.beyond == 0.0, "{none:?}");
        // The last free node carries none, those behind it do.
        let odd = side(2.0, |y| if (1.5..1.6).contains(&y) { 0.0 } else { 1.0 }).end(true, 2.0);
        assert_eq!((odd.at, odd.beyond), (2.0, 0.0));
    }
}
