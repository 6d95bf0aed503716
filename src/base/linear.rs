//! Dense linear systems.

use multiversion::multiversion;
use nalgebra::{DMatrix, DMatrixView};

/// Columns that are eliminated together.
const BLOCK: usize = 32;

/// Solves `matrix` X = `right` for all columns of `right` by Gaussian elimination with partial
/// pivoting, in blocks, so that nearly all work is matrix products. nalgebra's own factorisation
/// works column by column and takes twice as long for the 250 unknowns of a contact, and four times
/// for 550.
///
/// Returns `None` if the matrix is singular or contains NaN.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
pub fn solve(mut matrix: DMatrix<f64>, mut right: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let n = matrix.nrows();
    assert!(matrix.ncols() == n && right.nrows() == n, "a square system");
    for first in (0..n).step_by(BLOCK) {
        let end = (first + BLOCK).min(n);
        for j in first..end {
            let pivot = matrix.column(j).rows_range(j..).iamax() + j;
            if !(matrix[(pivot, j)].abs() > 0.0 && matrix[(pivot, j)].is_finite()) {
                return None;
            }
            matrix.swap_rows(pivot, j);
            right.swap_rows(pivot, j);
            let inverse = 1.0 / matrix[(j, j)];
            let (own, mut others) = matrix.columns_range_pair_mut(j..j + 1, j + 1..end);
            let mut own = own;
            own.rows_range_mut(j + 1..).iter_mut().for_each(|l| *l *= inverse);
            for mut column in others.column_iter_mut() {
                let factor = -column[j];
                column.rows_range_mut(j + 1..).axpy(
                    factor,
                    &own.column(0).rows_range(j + 1..),
                    1.0,
                );
            }
        }
        let left = copy(matrix.view((first, first), (n - first, end - first)));
        let (top, bottom) = (left.rows(0, end - first), left.rows(end - first, n - end));
        for rest in [&mut matrix.columns_range_mut(end..), &mut right.columns_range_mut(..)] {
            let mut upper = rest.rows_range_mut(first..end);
            top.solve_lower_triangular_with_diag_mut(&mut upper, 1.0);
            let upper = copy(upper.as_view());
            rest.rows_range_mut(end..).gemm(-1.0, &bottom, &upper, 1.0);
        }
    }
    for first in (0..n).step_by(BLOCK).rev() {
        let end = (first + BLOCK).min(n);
        let mut own = right.rows_range_mut(first..end);
        if !matrix
            .view((first, first), (end - first, end - first))
            .solve_upper_triangular_mut(&mut own)
        {
            return None;
        }
        let own = copy(own.as_view());
        let above = matrix.view((0, first), (first, end - first));
        right.rows_range_mut(..first).gemm(-1.0, &above, &own, 1.0);
    }
    Some(right)
}

/// A copy, column by column: nalgebra's own copies entry by entry.
fn copy(view: DMatrixView<f64>) -> DMatrix<f64> {
    let mut entries = Vec::with_capacity(view.len());
    view.column_iter().for_each(|column| entries.extend_from_slice(column.as_slice()));
    DMatrix::from_vec(view.nrows(), view.ncols(), entries)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solutions_satisfy_their_equations() {
        for n in [1, 5, 32, 33, 100] {
            // An irregular matrix whose first pivot is zero.
            let entry = |i: usize, j: usize| ((i * 37 + j * 101 + i * j) as f64).sin();
            let matrix =
                DMatrix::from_fn(
                    n,
                    n,
                    |i, j| if n > 1 && i + j == 0 { 0.0 } else { 0.3 + entry(i, j) },
                );
            let right = DMatrix::from_fn(n, 3, |i, j| (i as f64 - j as f64).cos());
            let solution = solve(matrix.clone(), right.clone()).unwrap();
            let off = (&matrix * solution - right).amax();
            assert!(off < 1e-9, "{n}: {off:e}");
        }
        assert!(solve(DMatrix::from_element(4, 4, 1.0), DMatrix::zeros(4, 1)).is_none());
        assert!(solve(DMatrix::from_element(2, 2, f64::NAN), DMatrix::zeros(2, 1)).is_none());
    }
}
