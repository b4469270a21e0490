//! The prefix of a graph: everything up to the last loop when a pose was last moved.

use crate::problem::Problem;

/// The prefix is extended after this many loop closures: fewer cost more factorizations, more make each update
/// slower.
const LOOPS_PER_PREFIX: usize = 8;

/// The factorized prefix of a graph, by its size.
///
/// Every node from `nodes` on is free. Each factor from `factors` on either connects the next node to an earlier
/// one or closes a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Prefix {
    /// Nodes of the prefix.
    pub nodes: usize,
    /// Factors of the prefix.
    pub factors: usize,
}

impl Prefix {
    /// The whole graph.
    pub fn whole(problem: &Problem) -> Self {
        Self {
            nodes: problem.node_count(),
            factors: problem.factors().len(),
        }
    }

    /// The prefix of a graph; all of it if the rest does not have the described structure.
    pub fn from_problem(problem: &Problem) -> Self {
        let whole = Self::whole(problem);
        let Some(last_fixed) = problem.fixed().iter().rposition(|&fixed| fixed) else {
            return whole;
        };
        let first = Self {
            nodes: 1,
            factors: 0,
        };
        let (mut seen, mut prefix) = (first, first);
        // Factors up to the last one whose node is out of order.
        let mut out_of_order_end = 0;
        let mut loops_since = 0;
        for factor in problem.factors() {
            let later = factor.from.max(factor.to);
            seen.factors += 1;
            if later >= seen.nodes {
                if later > seen.nodes {
                    out_of_order_end = seen.factors;
                }
                seen.nodes = later + 1;
                continue;
            }
            loops_since = if seen.factors > problem.optimized_factors() {
                loops_since + 1
            } else {
                0
            };
            if loops_since % LOOPS_PER_PREFIX == 0 {
                prefix = seen;
            }
        }
        let is_ordered = out_of_order_end <= prefix.factors
            && seen.nodes == whole.nodes
            && last_fixed < prefix.nodes;
        let is_connected = out_of_order_end == 0
            || problem
                .first_loose_in_prefix(prefix.nodes, prefix.factors)
                .is_none();
        if is_ordered && is_connected {
            prefix
        } else {
            whole
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Matrix3;
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

    fn prefix(nodes: usize, ends: &[(usize, usize)]) -> (usize, usize) {
        let Prefix { nodes, factors } = Prefix::from_problem(&graph(nodes, ends));
        (nodes, factors)
    }

    #[test]
    fn nodes_with_one_measurement_are_not_in_the_prefix() {
        assert_eq!(prefix(4, &[(0, 1), (1, 2), (2, 3)]), (1, 0), "a chain");
        assert_eq!(prefix(4, &[(0, 1), (2, 0), (1, 3)]), (1, 0), "a tree");
        let looped = [(0, 1), (1, 2), (0, 2), (2, 3), (4, 3)];
        assert_eq!(prefix(5, &looped), (1, 0), "a loop");
        assert_eq!(prefix(4, &[(0, 1), (1, 2)]), (4, 2), "a loose node");
        assert_eq!(prefix(4, &[(0, 2), (1, 2), (2, 3)]), (4, 3), "out of turn");
        let mut held = graph(4, &[(0, 1), (1, 2), (2, 3)]);
        held.fix(2);
        assert_eq!(
            Prefix::from_problem(&held),
            Prefix::whole(&held),
            "held later"
        );
    }

    #[test]
    fn the_prefix_ends_at_the_last_loop_before_a_pose_moved() {
        let ends = [
            (0, 1),
            (1, 2),
            (0, 2),
            (2, 3),
            (0, 3),
            (3, 4),
            (4, 0),
            (4, 5),
        ];
        let of = |optimized: usize| {
            let mut problem = graph(6, &ends);
            problem.mark_optimized(optimized);
            let Prefix { nodes, factors } = Prefix::from_problem(&problem);
            (nodes, factors)
        };
        assert_eq!([of(0), of(2)], [(1, 0); 2], "no loop was closed then");
        assert_eq!([of(3), of(4)], [(3, 3); 2], "one was");
        assert_eq!([of(5), of(6)], [(4, 5); 2], "two were");
        assert_eq!([of(7), of(100)], [(5, 7); 2], "all were");
        let mut moved = graph(6, &ends);
        moved.poses_mut()[3] = SE2::from_xy(1.0, 0.0);
        assert_eq!(moved.optimized_factors(), 8);
        moved.pop_factor();
        assert_eq!(moved.optimized_factors(), 7);
    }

    #[test]
    fn the_prefix_is_extended_every_eighth_loop() {
        // Two nodes a loop: factors 3k + 1 and 3k + 2 add nodes 2k + 1 and 2k + 2, factor 3k + 3 closes the
        // loop.
        let rounds = |loops: usize| -> Vec<(usize, usize)> {
            (0..loops)
                .flat_map(|k| {
                    [
                        (2 * k, 2 * k + 1),
                        (2 * k + 1, 2 * k + 2),
                        (2 * k + 2, 2 * k),
                    ]
                })
                .collect()
        };
        let of = |loops: usize| prefix(2 * loops + 1, &rounds(loops));
        assert_eq!(of(7), (1, 0));
        assert_eq!(of(8), (17, 24));
        assert_eq!(of(15), (17, 24));
        assert_eq!(of(17), (33, 48));
        // A node out of order counts as connected in the prefix; the factor that connects it is one more
        // loop.
        let mut out_of_order = rounds(17);
        out_of_order.swap(0, 1);
        assert_eq!(prefix(35, &out_of_order), (31, 45));
        out_of_order.swap(48, 49);
        assert_eq!(prefix(35, &out_of_order), (35, 51));
    }
}
