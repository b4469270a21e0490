//! Poses by breadth-first propagation from the fixed ones.

use std::collections::VecDeque;

use pr_geom::SE2;

use crate::factor::Between;
use crate::problem::Problem;

/// Poses along a breadth-first tree of measurements from the fixed nodes.
///
/// Fixed poses stay. A node that is not connected to a fixed one keeps its pose.
#[must_use]
pub fn spanning_tree(problem: &Problem) -> Vec<SE2> {
    let mut poses = problem.poses().to_vec();
    let neighbours = Neighbours::new(problem);
    let mut reached = problem.fixed().to_vec();
    let mut queue: VecDeque<usize> = (0..poses.len()).filter(|&node| reached[node]).collect();
    while let Some(node) = queue.pop_front() {
        for &factor in neighbours.of(node) {
            let Between {
                from,
                to,
                measurement,
                ..
            } = &problem.factors()[factor as usize];
            let next = if *from == node { *to } else { *from };
            if reached[next] {
                continue;
            }
            reached[next] = true;
            poses[next] = if *from == node {
                poses[node] * *measurement
            } else {
                poses[node] * measurement.inverse()
            };
            queue.push_back(next);
        }
    }
    poses
}

/// The factors at every node, all lists in one array.
struct Neighbours {
    /// Where every node's list starts, and the end of the last.
    start: Vec<u32>,
    factors: Vec<u32>,
}

impl Neighbours {
    fn new(problem: &Problem) -> Self {
        // Counts are stored one position later: filling the lists moves every start to its final value.
        let mut start = vec![0_u32; problem.node_count() + 2];
        let ends = || {
            problem
                .factors()
                .iter()
                .map(|factor| [factor.from, factor.to])
        };
        for node in ends().flatten() {
            start[node + 2] += 1;
        }
        for node in 2..start.len() {
            start[node] += start[node - 1];
        }
        let mut factors = vec![0_u32; 2 * problem.factors().len()];
        for (factor, nodes) in (0_u32..).zip(ends()) {
            for node in nodes {
                factors[start[node + 1] as usize] = factor;
                start[node + 1] += 1;
            }
        }
        Self { start, factors }
    }

    /// The factors at a node, in the order in which they were added.
    fn of(&self, node: usize) -> &[u32] {
        &self.factors[self.start[node] as usize..self.start[node + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    #[test]
    fn poses_follow_the_shortest_chain_of_measurements() {
        let mut problem = Problem::new();
        problem.add_fixed_pose(SE2::new(1.0, 0.0, 0.5));
        problem.add_pose(SE2::identity());
        problem.add_pose(SE2::identity());
        let mut measure = |from, to, measurement| {
            problem.add_factor(Between {
                from,
                to,
                measurement,
                information: Matrix3::identity(),
            });
        };
        let (a, b) = (SE2::new(1.0, 0.2, 0.3), SE2::new(0.4, 0.5, -0.6));
        measure(0, 1, a);
        measure(1, 2, SE2::new(9.0, 9.0, 1.0));
        // Node 2 is connected to node 0 by one measurement, taken from node 2.
        measure(2, 0, b);
        let poses = spanning_tree(&problem);
        let start = SE2::new(1.0, 0.0, 0.5);
        assert_eq!(poses[1], start * a);
        assert_eq!(poses[2], start * b.inverse());
    }
}
