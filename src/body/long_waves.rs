//! The wavenumbers at which a body that is shorter than the other one is computed under long waves.

use crate::base::Panels;
use nalgebra::DMatrix;

/// Wavenumber times half-length below which the equations of a plate in bending are so close to
/// singular that errors of its axes decide.
const LOWEST: f64 = 0.008;

/// Nodes of a body in the first panel of wavenumbers, in place of those that both bodies have.
///
/// The panel is as wide as the longer body asks for, and begins at zero. Under an odd load its
/// lowest nodes are waves too long for a much shorter body. What acts there is known from somewhat
/// shorter waves: stresses tend to a limit, and loads and displacements of a plate in bending grow
/// like 1 / k.
#[derive(Debug, Clone)]
pub struct LongWaves {
    nodes: Vec<f64>,
    /// The nodes of both bodies.
    common: Vec<f64>,
    /// The polynomials through the own nodes (columns) at those of both bodies (rows).
    shares: DMatrix<f64>,
}

impl LongWaves {
    /// The nodes of a body of half-length `half` in the first of the panels `coarse`; none where
    /// the common ones will do.
    pub fn new(coarse: &Panels, half: f64) -> Option<Self> {
        let (lowest, order) = (LOWEST / half, coarse.order());
        let common = &coarse.nodes()[..order];
        if common[0] >= lowest {
            return None;
        }
        let own = Panels::new(vec![lowest, coarse.breaks()[1].max(2.0 * lowest)], order);
        let row = |k: &f64| own.polynomials(0, *k).collect::<Vec<_>>();
        let rows: Vec<f64> = common.iter().flat_map(row).collect();
        let shares = DMatrix::from_row_slice(order, order, &rows);
        Some(Self { nodes: own.nodes().to_vec(), common: common.to_vec(), shares })
    }

    /// The nodes.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// The share of own node number `own` in the displacement at the common one number `common`, of
    /// a plate that `bends` or not.
    pub fn displacement(&self, common: usize, own: usize, bends: bool) -> f64 {
        let growth = if bends { self.nodes[own] / self.common[common] } else { 1.0 };
        self.shares[(common, own)] * growth
    }

    /// Rows for the common nodes, the first ones of a matrix, as rows for the own ones.
    pub fn of_common(&self, rows: &DMatrix<f64>) -> DMatrix<f64> {
        let mut own = rows.clone();
        let low = self.shares.tr_mul(&rows.rows(0, self.nodes.len()));
        own.rows_mut(0, self.nodes.len()).copy_from(&low);
        own
    }

    /// An interpolation from the common nodes, the first one and the weights, as one from the own
    /// ones.
    pub fn interpolation(&self, (first, weights): (usize, &[f64])) -> (usize, Vec<f64>) {
        let count = self.nodes.len();
        if first >= count {
            return (first, weights.to_vec());
        }
        let mut own = vec![0.0; count.max(first + weights.len())];
        for (common, weight) in (first..).zip(weights) {
            match common < count {
                true => (0..count).for_each(|j| own[j] += weight * self.shares[(common, j)]),
                false => own[common] += weight,
            }
        }
        (0, own)
    }
}
