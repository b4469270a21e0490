//! Covariances at the end of a graph that grows: the factor of what came before is enough.
//!
//! A robot that drives on adds nodes with one measurement each, to a node before it. Such a *tail* tells
//! nothing of the nodes before it, so it leaves their covariances as they are, and has its own by
//! propagation: with the blocks `H_tt` and `H_tp` that the measurement of node t from its parent p
//! adds to the normal equations, and the ridge in `H_tt`,
//!
//! ```text
//! δ_t = A δ_p + w,   A = −H_tt⁻¹ H_tp,   w ~ N(0, H_tt⁻¹),
//! ```
//!
//! so that `Σ_tx = A Σ_px` for every node x but t and what follows it, and `Σ_tt = A Σ_pp Aᵀ + H_tt⁻¹`.
//! The tail is told from the graph alone. What is read from it has the same bits, whatever was asked
//! for before.
//!
//! Source: Kaess & Dellaert, "Covariance recovery from a square root information matrix for data
//! association", 2009, whose recursion this is for nodes that are eliminated first.

use nalgebra::Matrix3;

use crate::error::OptimizeError;
use crate::factor::{JacobianModel, PreparedPose};
use crate::kernel::RobustKernel;
use crate::marginals::JointCovariance;
use crate::problem::Problem;

/// Where the tail of a graph begins.
///
/// Node `nodes + k` is free, and factor `factors + k` is the only one between it and a node before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TailStart {
    /// Nodes before the tail.
    pub nodes: usize,
    /// Factors before the tail.
    pub factors: usize,
}

impl TailStart {
    /// The start of the longest tail of a graph.
    pub fn of(problem: &Problem) -> Self {
        let (nodes, factors) = (problem.node_count(), problem.factors());
        let newest_first = (0..nodes).rev().zip(factors.iter().rev());
        let single = newest_first
            .take_while(|(node, factor)| {
                factor.from.max(factor.to) == *node && !problem.fixed()[*node]
            })
            .count();
        let rest = &factors[..factors.len() - single];
        let tied = rest.iter().map(|factor| 1 + factor.from.max(factor.to));
        let first = tied.max().unwrap_or(0).max(nodes - single);
        Self {
            nodes: first,
            factors: factors.len() - (nodes - first),
        }
    }
}

/// How the pose of a node of the tail follows from another: `δ = A δ_parent + w`.
#[derive(Clone, Copy, Debug)]
struct Propagation {
    parent: usize,
    /// A.
    map: Matrix3<f64>,
    /// Covariance of w.
    noise: Matrix3<f64>,
}

impl Propagation {
    fn new(problem: &Problem, factor: usize, ridge: f64) -> Result<Self, OptimizeError> {
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
        Ok(Self {
            parent: ends.from.min(ends.to),
            map: -(noise * to_parent),
            noise,
        })
    }
}

/// What two nodes depend on beyond the beginning of a graph.
pub(crate) struct Tail {
    start: TailStart,
    /// By node, from the first of the tail to the later of the two.
    propagations: Vec<Propagation>,
    ends: [usize; 2],
    /// The nodes of the beginning that the two hang on; one before the tail hangs on itself.
    roots: [usize; 2],
}

impl Tail {
    /// Linearizes the tail as far as the nodes `ends` need it.
    ///
    /// # Errors
    /// Where a measurement on the way is not positive definite.
    pub fn new(
        problem: &Problem,
        start: TailStart,
        ends: [usize; 2],
        ridge: f64,
    ) -> Result<Self, OptimizeError> {
        let later = ends[0].max(ends[1]);
        let propagations: Vec<Propagation> = (start.nodes..=later)
            .zip(start.factors..)
            .map(|(_, factor)| Propagation::new(problem, factor, ridge))
            .collect::<Result<_, _>>()?;
        let root = |mut node: usize| {
            while node >= start.nodes {
                node = propagations[node - start.nodes].parent;
            }
            node
        };
        Ok(Self {
            start,
            roots: ends.map(root),
            propagations,
            ends,
        })
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

#[cfg(test)]
mod tests {
    use pr_geom::SE2;

    use super::*;
    use crate::factor::Between;

    fn graph(nodes: usize, ends: &[(usize, usize)]) -> Problem {
        let mut problem = Problem::new();
        problem.add_fixed_pose(SE2::identity());
        (1..nodes).for_each(|_| {
            problem.add_pose(SE2::identity());
        });
        for &(from, to) in ends {
            problem.add_factor(Between {
                from,
                to,
                measurement: SE2::identity(),
                information: Matrix3::identity(),
            });
        }
        problem
    }

    #[test]
    fn a_tail_is_what_hangs_on_one_measurement_each() {
        let start = |nodes, ends: &[(usize, usize)]| {
            let TailStart { nodes, factors } = TailStart::of(&graph(nodes, ends));
            (nodes, factors)
        };
        assert_eq!(start(4, &[(0, 1), (1, 2), (2, 3)]), (1, 0), "a chain");
        assert_eq!(start(4, &[(0, 1), (2, 0), (1, 3)]), (1, 0), "a tree");
        let looped = [(0, 1), (1, 2), (0, 2), (2, 3), (4, 3)];
        assert_eq!(start(5, &looped), (3, 3), "behind a loop");
        assert_eq!(start(3, &looped[..3]), (3, 3), "at a loop");
        let late = [(0, 1), (1, 2), (2, 3), (3, 4), (0, 3), (4, 5)];
        assert_eq!(
            start(6, &late),
            (5, 5),
            "behind a loop that was closed late"
        );
        assert_eq!(
            start(4, &[(0, 1), (1, 2)]),
            (4, 2),
            "a loose node at the end"
        );
        let mut held = graph(4, &[(0, 1), (1, 2), (2, 3)]);
        held.fix(2);
        assert_eq!(TailStart::of(&held).nodes, 3, "behind a fixed node");
    }
}
