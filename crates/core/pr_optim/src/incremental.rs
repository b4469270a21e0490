//! Covariances of a growing graph, without a new factorization of the normal equations H.
//!
//! A robot that explores adds nodes with one measurement each, to an earlier node, and now and then a loop
//! closure. Neither needs a new factor:
//!
//! - the covariance of a node with a single measurement follows from that of its parent: the [tail];
//! - a measurement between existing nodes is a low-rank update of `C = H⁻¹` by three columns: a [loop
//!   update].
//!
//! The blocks of `C` so come from the factor of a [prefix] of the graph, which is kept while the poses are
//! unchanged. All decisions depend on the graph alone, so the results have the same bits whatever was queried
//! before.
//!
//! [tail]: Propagation
//! [loop update]: LoopUpdate
//! [prefix]: Prefix

mod loop_update;
mod prefix;
mod tail;

use nalgebra::Vector3;
use pr_geom::{math, twist_size};

use crate::error::OptimizeError;
use crate::linear::LinearSolver;
use crate::marginals::JointCovariance;
use crate::problem::Problem;
use loop_update::LoopUpdate;
pub(crate) use prefix::Prefix;
use tail::{Propagation, Tail};

/// Blocks of `C = H⁻¹` of a graph at its poses, with exact Jacobians and neither kernel nor damping.
#[derive(Debug)]
pub(crate) struct IncrementalCovariances {
    /// The graph.
    problem: Problem,
    prefix: Prefix,
    ridge: f64,
    /// Position of each node in a vector: first the prefix, in elimination order.
    positions: Vec<u32>,
    /// By node, from the first after the prefix.
    tail: Vec<Propagation>,
    loop_updates: Vec<LoopUpdate>,
}

impl IncrementalCovariances {
    /// Starts from a prefix that `linear` has factorized.
    pub fn new(problem: Problem, prefix: Prefix, ridge: f64, linear: &LinearSolver) -> Self {
        Self {
            problem,
            prefix,
            ridge,
            positions: linear.structure().position_of.clone(),
            tail: Vec::new(),
            loop_updates: Vec::new(),
        }
    }

    /// Whether its graph is a prefix of `problem`, or all of it.
    pub fn is_prefix_of(&self, problem: &Problem, prefix: Prefix, ridge: f64) -> bool {
        self.prefix == prefix && self.ridge == ridge && problem.has_prefix(&self.problem)
    }

    /// The prefix.
    pub fn prefix(&self) -> Prefix {
        self.prefix
    }

    /// Adds the nodes and measurements that `problem` has in addition; `linear` holds the factor of the
    /// prefix.
    ///
    /// # Errors
    /// If one cannot be added; the covariances are unusable then.
    pub fn extend(
        &mut self,
        problem: &Problem,
        linear: &mut LinearSolver,
    ) -> Result<(), OptimizeError> {
        let known = self.problem.factors().len();
        let nodes = self.problem.node_count()..problem.node_count();
        self.problem.append_from(problem);
        self.positions.extend(nodes.map(|node| node as u32));
        for factor in known..problem.factors().len() {
            let ends = &problem.factors()[factor];
            let node = self.prefix.nodes + self.tail.len();
            if ends.from.max(ends.to) == node {
                let link = Propagation::new(problem, factor, self.ridge)?;
                let parent = self.positions[link.parent] as usize;
                for update in &mut self.loop_updates {
                    update.propagate(&link, parent);
                }
                self.tail.push(link);
            } else {
                let update = self.loop_update(factor, linear)?;
                self.loop_updates.push(update);
            }
        }
        Ok(())
    }

    /// The blocks of C of two nodes; `linear` holds the factor of the prefix.
    pub fn joint_covariance(
        &self,
        linear: &mut LinearSolver,
        first: usize,
        second: usize,
    ) -> JointCovariance {
        let tail = Tail::new(self.prefix, &self.tail, [first, second]);
        let [first_root, second_root] = tail.roots();
        let root_blocks = linear.joint_covariance(&self.problem, first_root, second_root);
        let mut joint = tail.joint(&root_blocks);
        let [first, second] = [first, second].map(|node| self.positions[node] as usize);
        for update in &self.loop_updates {
            joint.first -= update.block([first, first]);
            joint.cross -= update.block([first, second]);
            joint.second -= update.block([second, second]);
        }
        joint
    }

    /// Largest correction of any node, m and rad added, by the loops closed since the prefix: to first order,
    /// from poses that are optimal without these loops.
    pub fn largest_move(&self) -> f64 {
        let mut moves = vec![Vector3::zeros(); self.problem.node_count()];
        for update in &self.loop_updates {
            update.correct(&mut moves);
        }
        let sizes = moves.iter().map(twist_size);
        sizes.fold(0.0, math::max)
    }

    /// Linearizes a measurement between existing nodes and computes its update.
    fn loop_update(
        &self,
        factor: usize,
        linear: &mut LinearSolver,
    ) -> Result<LoopUpdate, OptimizeError> {
        let mut update = LoopUpdate::new(&self.problem, factor, &self.positions);
        // Later nodes are not connected yet.
        let nodes = self.prefix.nodes + self.tail.len();
        let mut columns = vec![[0.0; 3]; 3 * nodes];
        update.write_columns(&mut columns);
        let parent = |link: &Propagation| self.positions[link.parent] as usize;
        for (link, node) in self.tail.iter().zip(self.prefix.nodes..nodes).rev() {
            link.push_back(&mut columns, [parent(link), node]);
        }
        linear.solve_columns(&mut columns[..3 * self.prefix.nodes]);
        for (link, node) in self.tail.iter().zip(self.prefix.nodes..nodes) {
            link.propagate(&mut columns, [parent(link), node]);
        }
        update.set_columns(&columns);
        for earlier in &self.loop_updates {
            earlier.subtract_from(&mut update);
        }
        update.compute_gain()?;
        Ok(update)
    }
}
