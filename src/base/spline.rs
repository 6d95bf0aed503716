//! Cubic splines.

use super::linear;
use nalgebra::DMatrix;

/// The natural cubic spline through values at the ascending `nodes`, at `places`.
pub fn spline(nodes: &[f64], places: &[f64]) -> DMatrix<f64> {
    let n = nodes.len();
    let widths: Vec<f64> = nodes.windows(2).map(|pair| pair[1] - pair[0]).collect();
    // The second derivatives at the nodes, which vanish at both ends.
    let mut system = DMatrix::<f64>::identity(n, n);
    let mut right = DMatrix::<f64>::zeros(n, n);
    for i in 1..n - 1 {
        let [h, g] = [widths[i - 1], widths[i]];
        let row = [(i - 1, h / 6.0, 1.0 / h), (i, (h + g) / 3.0, -1.0 / h - 1.0 / g)];
        for (j, left, slope) in row.into_iter().chain([(i + 1, g / 6.0, 1.0 / g)]) {
            system[(i, j)] = left;
            right[(i, j)] = slope;
        }
    }
    let bends = linear::solve(system, right).expect("nodes differ");
    let mut matrix = DMatrix::zeros(places.len(), n);
    for (mut row, place) in matrix.row_iter_mut().zip(places) {
        let i = nodes[1..n - 1].partition_point(|node| node < place);
        let h = widths[i];
        let [s, t] = [(nodes[i + 1] - place) / h, (place - nodes[i]) / h];
        row[i] += s;
        row[i + 1] += t;
        for (j, v) in [(i, s), (i + 1, t)] {
            row += bends.row(j) * ((v.powi(3) - v) * h * h / 6.0);
        }
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;

    #[test]
    fn splines_follow_smooth_functions() {
        let nodes: Vec<f64> = (0..30).map(|i| 0.01 * f64::from(i * i)).collect();
        let places = [0.005, 0.3, 2.0, 7.9];
        let values = DVector::from_iterator(30, nodes.iter().map(|x| (0.5 * x).sin()));
        let found = spline(&nodes, &places) * values;
        for (got, x) in found.iter().zip(places) {
            assert!((got - (0.5 * x).sin()).abs() < 1e-3, "{x}: {got}");
        }
    }
}
