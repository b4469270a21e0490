//! Nodes with one measurement each, to an earlier node.
//!
//! Such a *tail* adds no information about the earlier nodes, so their covariances are unchanged. Its own follow
//! by propagation. The measurement of node t from its parent p adds the blocks `H_tt` and `H_tp` to the normal
//! equations (`H_tt` with the ridge). Then
//!
//! ```text
//! δ_t = A δ_p + w,   A = −H_tt⁻¹ H_tp,   w ~ N(0, H_tt⁻¹),
//! ```
//!
//! hence `Σ_tx = A Σ_px` for every earlier node x, and `Σ_tt = A Σ_pp Aᵀ + H_tt⁻¹`.
//!
//! Source: Kaess & Dellaert, "Covariance recovery from a square root information matrix for data
//! association", 2009, whose recursion this is for nodes that are eliminated first.

use nalgebra::Matrix3;

use super::prefix::Prefix;
use crate::error::OptimizeError;
use crate::factor::{JacobianModel, PreparedPose};
use crate::kernel::RobustKernel;
use crate::marginals::JointCovariance;
use crate::problem::Problem;

/// Dependence of a node of the tail on its parent: `δ = A δ_parent + w`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Propagation {
    /// The earlier node of its measurement.
    pub parent: usize,
    /// A.
    pub map: Matrix3<f64>,
    /// Covariance of w.
    noise: Matrix3<f64>,
}

impl Propagation {
    /// Linearizes the only factor of a node.
    ///
    /// # Errors
    /// If the factor leaves the node unconstrained.
    pub fn new(problem: &Problem, factor: usize, ridge: f64) -> Result<Self, OptimizeError> {
        let ends = &problem.factors()[factor];
        let [from, to] = [ends.from, ends.to].map(|end| PreparedPose::new(&problem.poses()[end]));
        let part = problem.prepared()[factor].linearize(
            &from,
            &to,
            JacobianModel::Exact,
            RobustKernel::None,
        );
        let to_from = Matrix3::from_column_slice(&part.to_from);
        let node = ends.from.max(ends.to);
        let (own, to_parent) = if node == ends.to {
            (part.to_to, to_from)
        } else {
            (part.from_from, to_from.transpose())
        };
        let [xx, xy, xt, yy, yt, tt] = own;
        let own = Matrix3::new(xx, xy, xt, xy, yy, yt, xt, yt, tt) + Matrix3::identity() * ridge;
        let noise = own
            .cholesky()
            .ok_or(OptimizeError::NotPositiveDefinite { node })?
            .inverse();
        let parent = ends.from.min(ends.to);
        // A fixed parent does not move.
        let is_free = !problem.fixed()[parent];
        let map = if is_free {
            -(noise * to_parent)
        } else {
            Matrix3::zeros()
        };
        Ok(Self { parent, map, noise })
    }

    /// Eliminates the node: adds its columns to those of its parent. Both are given by position.
    pub fn push_back(&self, columns: &mut [[f64; 3]], [parent, node]: [usize; 2]) {
        let own = at(columns, node);
        put(columns, parent, at(columns, parent) + self.map.tr_mul(&own));
        put(columns, node, self.noise * own);
    }

    /// Back-substitution: adds the contribution of the parent's solution.
    pub fn propagate(&self, columns: &mut [[f64; 3]], [parent, node]: [usize; 2]) {
        let own = at(columns, node) + self.map * at(columns, parent);
        put(columns, node, own);
    }
}

/// The three rows at a position.
pub(super) fn at(columns: &[[f64; 3]], position: usize) -> Matrix3<f64> {
    Matrix3::from_fn(|row, column| columns[3 * position + row][column])
}

/// Sets the three rows at a position.
pub(super) fn put(columns: &mut [[f64; 3]], position: usize, block: Matrix3<f64>) {
    for (row, entries) in columns[3 * position..3 * position + 3]
        .iter_mut()
        .enumerate()
    {
        *entries = core::array::from_fn(|column| block[(row, column)]);
    }
}

/// Dependence of two nodes on the prefix.
pub(super) struct Tail<'a> {
    prefix: Prefix,
    /// By node, from the first of the tail.
    propagations: &'a [Propagation],
    ends: [usize; 2],
    /// The ancestors of the two nodes in the prefix; a node of the prefix is its own.
    roots: [usize; 2],
}

impl<'a> Tail<'a> {
    /// Follows two nodes back to the prefix.
    pub fn new(prefix: Prefix, propagations: &'a [Propagation], ends: [usize; 2]) -> Self {
        let root = |mut node: usize| {
            while node >= prefix.nodes {
                node = propagations[node - prefix.nodes].parent;
            }
            node
        };
        Self {
            prefix,
            roots: ends.map(root),
            propagations,
            ends,
        }
    }

    /// The nodes whose blocks [`joint`](Self::joint) needs.
    pub fn roots(&self) -> [usize; 2] {
        self.roots
    }

    /// The blocks of the two nodes from those of their roots.
    pub fn joint(&self, root_blocks: &JointCovariance) -> JointCovariance {
        let [first, second] = self.ends;
        JointCovariance {
            first: self.block(first, first, root_blocks),
            cross: self.block(first, second, root_blocks),
            second: self.block(second, second, root_blocks),
        }
    }

    /// `E[δ_a δ_bᵀ]`, from the later of the two back to the roots.
    fn block(&self, mut a: usize, mut b: usize, root_blocks: &JointCovariance) -> Matrix3<f64> {
        let [mut left, mut right] = [Matrix3::<f64>::identity(); 2];
        let mut sum = Matrix3::zeros();
        loop {
            let later = a.max(b).checked_sub(self.prefix.nodes);
            let step = later.map(|k| &self.propagations[k]);
            // A common ancestor contributes its noise to both.
            let shared = match step {
                None => Some(self.root_block([a, b], root_blocks)),
                Some(step) => (a == b).then_some(step.noise),
            };
            if let Some(shared) = shared {
                sum += left * shared * right.transpose();
            }
            let Some(step) = step else {
                return sum;
            };
            let (is_left, is_right) = (a >= b, b >= a);
            for (is_later, map, node) in
                [(is_left, &mut left, &mut a), (is_right, &mut right, &mut b)]
            {
                if is_later {
                    *map *= step.map;
                    *node = step.parent;
                }
            }
        }
    }

    fn root_block(&self, nodes: [usize; 2], root_blocks: &JointCovariance) -> Matrix3<f64> {
        match nodes.map(|node| node == self.roots[0]) {
            [true, true] => root_blocks.first,
            [true, false] => root_blocks.cross,
            [false, true] => root_blocks.cross.transpose(),
            [false, false] => root_blocks.second,
        }
    }
}
