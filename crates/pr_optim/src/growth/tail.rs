//! Nodes that hang on one measurement each, to a node before them.
//!
//! Such a *tail* tells nothing of the nodes before it, so it leaves their covariances as they are, and has its
//! own by propagation: with the blocks `H_tt` and `H_tp` that the measurement of node t from its parent p
//! adds to the normal equations, and the ridge in `H_tt`,
//!
//! ```text
//! δ_t = A δ_p + w,   A = −H_tt⁻¹ H_tp,   w ~ N(0, H_tt⁻¹),
//! ```
//!
//! so that `Σ_tx = A Σ_px` for every node x but t and what follows it, and `Σ_tt = A Σ_pp Aᵀ + H_tt⁻¹`.
//!
//! Source: Kaess & Dellaert, "Covariance recovery from a square root information matrix for data
//! association", 2009, whose recursion this is for nodes that are eliminated first.

use nalgebra::Matrix3;

use super::start::GrowthStart;
use crate::error::OptimizeError;
use crate::factor::{JacobianModel, PreparedPose};
use crate::kernel::RobustKernel;
use crate::marginals::JointCovariance;
use crate::problem::Problem;

/// How the pose of a node of the tail follows from another: `δ = A δ_parent + w`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Propagation {
    /// The node that it hangs on.
    pub parent: usize,
    /// A.
    pub map: Matrix3<f64>,
    /// Covariance of w.
    noise: Matrix3<f64>,
}

impl Propagation {
    /// Linearizes the factor that a node hangs on.
    ///
    /// # Errors
    /// Where it leaves the node loose.
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

    /// Eliminates the node: the columns of its parent take what it has, both given by their places.
    pub fn push_back(&self, columns: &mut [[f64; 3]], [parent, node]: [usize; 2]) {
        let own = at(columns, node);
        put(columns, parent, at(columns, parent) + self.map.tr_mul(&own));
        put(columns, node, self.noise * own);
    }

    /// Adds what follows from the solution of its parent.
    pub fn carry_on(&self, columns: &mut [[f64; 3]], [parent, node]: [usize; 2]) {
        let own = at(columns, node) + self.map * at(columns, parent);
        put(columns, node, own);
    }
}

/// The three rows of a place.
pub(super) fn at(columns: &[[f64; 3]], place: usize) -> Matrix3<f64> {
    Matrix3::from_fn(|row, column| columns[3 * place + row][column])
}

/// Sets the three rows of a place.
pub(super) fn put(columns: &mut [[f64; 3]], place: usize, block: Matrix3<f64>) {
    for (row, entries) in columns[3 * place..3 * place + 3].iter_mut().enumerate() {
        *entries = core::array::from_fn(|column| block[(row, column)]);
    }
}

/// What two nodes depend on beyond the beginning of a graph.
pub(super) struct Tail<'a> {
    start: GrowthStart,
    /// By node, from the first of the tail.
    propagations: &'a [Propagation],
    ends: [usize; 2],
    /// The nodes of the beginning that the two hang on; one of the beginning hangs on itself.
    roots: [usize; 2],
}

impl<'a> Tail<'a> {
    /// The way of two nodes back to the beginning.
    pub fn new(start: GrowthStart, propagations: &'a [Propagation], ends: [usize; 2]) -> Self {
        let root = |mut node: usize| {
            while node >= start.nodes {
                node = propagations[node - start.nodes].parent;
            }
            node
        };
        Self {
            start,
            roots: ends.map(root),
            propagations,
            ends,
        }
    }

    /// The nodes whose blocks [`joint`](Self::joint) asks for.
    pub fn roots(&self) -> [usize; 2] {
        self.roots
    }

    /// The blocks of the two nodes from those of their roots.
    pub fn joint(&self, of_roots: &JointCovariance) -> JointCovariance {
        let [first, second] = self.ends;
        JointCovariance {
            first: self.block(first, first, of_roots),
            cross: self.block(first, second, of_roots),
            second: self.block(second, second, of_roots),
        }
    }

    /// `E[δ_a δ_bᵀ]`, from the later of the two back to the roots.
    fn block(&self, mut a: usize, mut b: usize, of_roots: &JointCovariance) -> Matrix3<f64> {
        let [mut left, mut right] = [Matrix3::<f64>::identity(); 2];
        let mut sum = Matrix3::zeros();
        loop {
            let later = a.max(b).checked_sub(self.start.nodes);
            let step = later.map(|k| &self.propagations[k]);
            // Both depend on the noise of a node that they share.
            let shared = match step {
                None => Some(self.block_of_roots([a, b], of_roots)),
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

    fn block_of_roots(&self, nodes: [usize; 2], of_roots: &JointCovariance) -> Matrix3<f64> {
        match nodes.map(|node| node == self.roots[0]) {
            [true, true] => of_roots.first,
            [true, false] => of_roots.cross,
            [false, true] => of_roots.cross.transpose(),
            [false, false] => of_roots.second,
        }
    }
}
