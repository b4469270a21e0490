//! Exact covariances from the factor of the normal equations.
//!
//! At the optimum the poses' covariance is `H⁻¹`, to first order, in the tangent space of right
//! perturbations. It is dense and never formed. Two of its parts are enough here:
//!
//! - the blocks of any two nodes, by one solve with the factor for each of their six columns;
//! - the blocks of all nodes, by the selected inverse: from the root of the elimination tree to the
//!   leaves, `Σ_RC = −Σ_RR Y` and `Σ_CC = (L_CC L_CCᵀ)⁻¹ − Yᵀ Σ_RC` with `Y = L_RC L_CC⁻¹`, where
//!   C are the columns of a supernode and R its rows below, which lie in its parent's front.
//!
//! Sources: Takahashi, Fagan, Chin, "Formation of a sparse bus impedance matrix", 1973; Kaess &
//! Dellaert, "Covariance recovery from a square root information matrix for data association", 2009.

use nalgebra::{Matrix3, SMatrix};
use pr_geom::SE2;

use crate::block_cholesky::BlockCholesky;
use crate::elimination::NO_PARENT;
use crate::structure::Structure;
use crate::supernodes::Supernode;

/// Covariance blocks of two nodes: `E[δ_a δ_aᵀ]`, `E[δ_a δ_bᵀ]`, `E[δ_b δ_bᵀ]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointCovariance {
    /// The block of the first node.
    pub first: Matrix3<f64>,
    /// The block between them, rows of the first, columns of the second.
    pub cross: Matrix3<f64>,
    /// The block of the second node.
    pub second: Matrix3<f64>,
}

impl JointCovariance {
    /// Covariance of the relative pose `T_a⁻¹ T_b`, in the tangent space at that pose.
    ///
    /// Perturbing both poses moves the relative pose by `δ = δ_b − A δ_a`, `A = Ad((T_a⁻¹T_b)⁻¹)`,
    /// so that `Σ = Σ_bb + A Σ_aa Aᵀ − A Σ_ab − (A Σ_ab)ᵀ`.
    /// Solà, Deray, Atchuthan 2018, eq. (62) and (65).
    #[must_use]
    pub fn relative(&self, first: &SE2, second: &SE2) -> Matrix3<f64> {
        let adjoint = second.between(first).adjoint();
        let cross = adjoint * self.cross;
        self.second + adjoint * self.first * adjoint.transpose() - cross - cross.transpose()
    }
}

/// Covariance blocks of two nodes by six solves, `solve` being `x ← H⁻¹ x` in elimination order.
///
/// A fixed node has no uncertainty: its blocks are zero.
pub(crate) fn joint_covariance(
    structure: &Structure,
    fixed: &[bool],
    nodes: [usize; 2],
    mut solve: impl FnMut(&mut [f64]),
) -> JointCovariance {
    let rows = nodes.map(|node| 3 * structure.position_of[node] as usize);
    let mut joint = SMatrix::<f64, 6, 6>::zeros();
    let mut column = vec![0.0; 3 * structure.node_count()];
    for (side, &node) in nodes.iter().enumerate().filter(|(_, node)| !fixed[**node]) {
        let start = 3 * structure.position_of[node] as usize;
        for axis in 0..3 {
            column.fill(0.0);
            column[start + axis] = 1.0;
            solve(&mut column);
            for (other, &row) in rows.iter().enumerate().filter(|(k, _)| !fixed[nodes[*k]]) {
                for k in 0..3 {
                    joint[(3 * other + k, 3 * side + axis)] = column[row + k];
                }
            }
        }
    }
    JointCovariance {
        first: joint.fixed_view::<3, 3>(0, 0).into_owned(),
        cross: joint.fixed_view::<3, 3>(0, 3).into_owned(),
        second: joint.fixed_view::<3, 3>(3, 3).into_owned(),
    }
}

/// The covariance block of every node, by node, from the selected inverse of the factor.
pub(crate) fn all_marginals(
    structure: &Structure,
    fixed: &[bool],
    cholesky: &BlockCholesky,
) -> Vec<Matrix3<f64>> {
    let list = &cholesky.supernodes().list;
    let mut fronts: Vec<Vec<f64>> = vec![Vec::new(); list.len()];
    let mut marginals = vec![Matrix3::zeros(); structure.node_count()];
    for (number, supernode) in list.iter().enumerate().rev() {
        let mut front = vec![0.0; 9 * supernode.height() * supernode.height()];
        if supernode.parent != NO_PARENT {
            let parent = &list[supernode.parent as usize];
            let places = &cholesky.supernodes().row_in_parent[supernode.rows()];
            take_rows(
                &mut front,
                supernode,
                &fronts[supernode.parent as usize],
                parent,
                places,
            );
        }
        invert_front(&mut front, supernode, cholesky);
        let height = 3 * supernode.height();
        for (local, position) in supernode.columns().enumerate() {
            let node = structure.node_at[position] as usize;
            if !fixed[node] {
                let entry = |row, column| front[(3 * local + column) * height + 3 * local + row];
                marginals[node] = Matrix3::from_fn(entry);
            }
        }
        fronts[number] = front;
    }
    marginals
}

/// Copies `Σ_RR` out of the front of the parent.
fn take_rows(
    front: &mut [f64],
    supernode: &Supernode,
    parent_front: &[f64],
    parent: &Supernode,
    places: &[u32],
) {
    let height = 3 * supernode.height();
    let parent_height = 3 * parent.height();
    let width = 3 * supernode.width as usize;
    let place = |local: usize| 3 * places[local / 3] as usize + local % 3;
    for column in 0..height - width {
        for row in 0..height - width {
            front[(width + column) * height + width + row] =
                parent_front[place(column) * parent_height + place(row)];
        }
    }
}

/// Fills in `Σ_RC`, its transpose and `Σ_CC`, columns of the run from the last to the first.
fn invert_front(front: &mut [f64], supernode: &Supernode, cholesky: &BlockCholesky) {
    let height = 3 * supernode.height();
    let width = 3 * supernode.width as usize;
    let (panel, reciprocal) = cholesky.panel(supernode);
    for column in (0..width).rev() {
        let factor = &panel[column * height..(column + 1) * height];
        // Σ L = L⁻ᵀ, read in this column: below the diagonal its right side is zero.
        for row in column + 1..height {
            let sum: f64 = (column + 1..height)
                .map(|k| front[k * height + row] * factor[k])
                .sum();
            let value = -sum * reciprocal[column];
            front[column * height + row] = value;
            front[row * height + column] = value;
        }
        let sum: f64 = (column + 1..height)
            .map(|k| front[column * height + k] * factor[k])
            .sum();
        front[column * height + column] = (reciprocal[column] - sum) * reciprocal[column];
    }
}
