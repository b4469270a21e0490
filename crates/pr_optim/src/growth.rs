//! A graph that grows, by the factor of its beginning.
//!
//! A robot that drives on adds nodes with one measurement each, to a node before it, and now and then a
//! measurement that closes a loop. Neither needs a new factor of the normal equations H:
//!
//! - what hangs on one measurement follows from what it hangs on: the [tail];
//! - a measurement between nodes that are there takes three columns of `C = H⁻¹` off it: a [closing].
//!
//! So the blocks of `C` come from a factor of the graph's [beginning], which is kept while the poses stay. All
//! is told from the graph alone: what is read has the same bits, whatever was asked for before.
//!
//! [tail]: Propagation
//! [closing]: Closing
//! [beginning]: GrowthStart

mod closing;
mod start;
mod tail;

use nalgebra::Vector3;
use pr_geom::{math, twist_size};

use crate::error::OptimizeError;
use crate::linear::LinearSolver;
use crate::marginals::JointCovariance;
use crate::problem::Problem;
use closing::Closing;
pub(crate) use start::GrowthStart;
use tail::{Propagation, Tail};

/// Blocks of `C = H⁻¹` of a graph at its poses, with exact Jacobians and neither kernel nor damping.
#[derive(Debug)]
pub(crate) struct Growth {
    /// The graph.
    of: Problem,
    start: GrowthStart,
    ridge: f64,
    /// Where each node is in a vector: first those of the beginning in their order of elimination.
    positions: Vec<u32>,
    /// By node, from the first after the beginning.
    tail: Vec<Propagation>,
    closings: Vec<Closing>,
}

impl Growth {
    /// A beginning, which `linear` has factorized.
    pub fn new(of: Problem, start: GrowthStart, ridge: f64, linear: &LinearSolver) -> Self {
        Self {
            of,
            start,
            ridge,
            positions: linear.structure().position_of.clone(),
            tail: Vec::new(),
            closings: Vec::new(),
        }
    }

    /// Whether it stands for the beginning of a graph, or for all of it.
    pub fn goes_on_to(&self, problem: &Problem, start: GrowthStart, ridge: f64) -> bool {
        self.start == start && self.ridge == ridge && problem.begins_with(&self.of)
    }

    /// Where the beginning ends.
    pub fn start(&self) -> GrowthStart {
        self.start
    }

    /// Adds what the graph has beyond it; `linear` holds the factor of the beginning.
    ///
    /// # Errors
    /// Where something cannot be added; nothing can be read then.
    pub fn extend(
        &mut self,
        problem: &Problem,
        linear: &mut LinearSolver,
    ) -> Result<(), OptimizeError> {
        let known = self.of.factors().len();
        let nodes = self.of.node_count()..problem.node_count();
        self.of.follow(problem);
        self.positions.extend(nodes.map(|node| node as u32));
        for factor in known..problem.factors().len() {
            let ends = &problem.factors()[factor];
            let node = self.start.nodes + self.tail.len();
            if ends.from.max(ends.to) == node {
                let link = Propagation::new(problem, factor, self.ridge)?;
                let parent = self.positions[link.parent] as usize;
                for closing in &mut self.closings {
                    closing.carry_on(&link, parent);
                }
                self.tail.push(link);
            } else {
                let closing = self.closing(factor, linear)?;
                self.closings.push(closing);
            }
        }
        Ok(())
    }

    /// The blocks of C of two nodes; `linear` holds the factor of the beginning.
    pub fn joint_covariance(
        &self,
        linear: &mut LinearSolver,
        first: usize,
        second: usize,
    ) -> JointCovariance {
        let tail = Tail::new(self.start, &self.tail, [first, second]);
        let [first_root, second_root] = tail.roots();
        let of_roots = linear
            .joint_covariance(&self.of, first_root, second_root)
            .expect("the block factorization shows its factor");
        let mut joint = tail.joint(&of_roots);
        let [first, second] = [first, second].map(|node| self.positions[node] as usize);
        for closing in &self.closings {
            joint.first -= closing.block([first, first]);
            joint.cross -= closing.block([first, second]);
            joint.second -= closing.block([second, second]);
        }
        joint
    }

    /// How far the farthest node would move, m and rad added, where loops closed since the beginning correct
    /// the graph: to first order, from poses that are the best ones without these loops.
    pub fn largest_move(&self) -> f64 {
        let mut moves = vec![Vector3::zeros(); self.of.node_count()];
        for closing in &self.closings {
            closing.correct(&mut moves);
        }
        let sizes = moves.iter().map(twist_size);
        sizes.fold(0.0, math::max)
    }

    /// A measurement between nodes that are there.
    fn closing(&self, factor: usize, linear: &mut LinearSolver) -> Result<Closing, OptimizeError> {
        let mut closing = Closing::new(&self.of, factor, &self.positions);
        // Nodes that are yet to be tied follow.
        let nodes = self.start.nodes + self.tail.len();
        let mut columns = vec![[0.0; 3]; 3 * nodes];
        closing.put_columns(&mut columns);
        let parent = |link: &Propagation| self.positions[link.parent] as usize;
        for (link, node) in self.tail.iter().zip(self.start.nodes..nodes).rev() {
            link.push_back(&mut columns, [parent(link), node]);
        }
        linear
            .solve_columns(&mut columns[..3 * self.start.nodes])
            .expect("the block factorization solves side by side");
        for (link, node) in self.tail.iter().zip(self.start.nodes..nodes) {
            link.carry_on(&mut columns, [parent(link), node]);
        }
        closing.take_columns(&columns);
        for earlier in &self.closings {
            earlier.take_off(&mut closing);
        }
        closing.weigh()?;
        Ok(closing)
    }
}
