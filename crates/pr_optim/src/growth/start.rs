//! How much of a graph is its beginning: all that was there when a pose was last moved, up to the last loop.

use crate::problem::Problem;

/// With every so many-th loop that was closed since, a new beginning ends: fewer take more factors, more take
/// longer to add.
const CLOSINGS: usize = 8;

/// Where the beginning of a graph ends.
///
/// Every node from `nodes` on is free, and the factors from `factors` on tie one after the other to a node
/// before it. The other ones among them close loops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct GrowthStart {
    /// Nodes of the beginning.
    pub nodes: usize,
    /// Factors of the beginning.
    pub factors: usize,
}

impl GrowthStart {
    /// That of a graph that does not grow: all of it.
    pub fn whole(problem: &Problem) -> Self {
        Self {
            nodes: problem.node_count(),
            factors: problem.factors().len(),
        }
    }

    /// The beginning of a graph; all of it where what follows would not be as described.
    pub fn from_problem(problem: &Problem) -> Self {
        let whole = Self::whole(problem);
        let Some(last_fixed) = problem.fixed().iter().rposition(|&fixed| fixed) else {
            return whole;
        };
        let first = Self {
            nodes: 1,
            factors: 0,
        };
        let (mut met, mut start) = (first, first);
        // Factors up to the last one whose node comes before its turn.
        let mut unruly = 0;
        let mut closings = 0;
        for factor in problem.factors() {
            let later = factor.from.max(factor.to);
            met.factors += 1;
            if later >= met.nodes {
                if later > met.nodes {
                    unruly = met.factors;
                }
                met.nodes = later + 1;
                continue;
            }
            closings = if met.factors > problem.optimized_factors() {
                closings + 1
            } else {
                0
            };
            if closings % CLOSINGS == 0 {
                start = met;
            }
        }
        let is_ruly =
            unruly <= start.factors && met.nodes == whole.nodes && last_fixed < start.nodes;
        let is_tied = unruly == 0 || problem.first_loose_of(start.nodes, start.factors).is_none();
        if is_ruly && is_tied { start } else { whole }
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

    fn start(nodes: usize, ends: &[(usize, usize)]) -> (usize, usize) {
        let GrowthStart { nodes, factors } = GrowthStart::from_problem(&graph(nodes, ends));
        (nodes, factors)
    }

    #[test]
    fn what_hangs_on_one_measurement_each_is_no_beginning() {
        assert_eq!(start(4, &[(0, 1), (1, 2), (2, 3)]), (1, 0), "a chain");
        assert_eq!(start(4, &[(0, 1), (2, 0), (1, 3)]), (1, 0), "a tree");
        let looped = [(0, 1), (1, 2), (0, 2), (2, 3), (4, 3)];
        assert_eq!(start(5, &looped), (1, 0), "a loop");
        assert_eq!(start(4, &[(0, 1), (1, 2)]), (4, 2), "a loose node");
        assert_eq!(start(4, &[(0, 2), (1, 2), (2, 3)]), (4, 3), "out of turn");
        let mut held = graph(4, &[(0, 1), (1, 2), (2, 3)]);
        held.fix(2);
        assert_eq!(
            GrowthStart::from_problem(&held),
            GrowthStart::whole(&held),
            "held later"
        );
    }

    #[test]
    fn what_was_there_when_a_pose_moved_is_the_beginning_up_to_its_last_loop() {
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
        let of = |settled: usize| {
            let mut problem = graph(6, &ends);
            problem.mark_optimized(settled);
            let GrowthStart { nodes, factors } = GrowthStart::from_problem(&problem);
            (nodes, factors)
        };
        assert_eq!([of(0), of(2)], [(1, 0); 2], "no loop was closed then");
        assert_eq!([of(3), of(4)], [(3, 3); 2], "one was");
        assert_eq!([of(5), of(6)], [(4, 5); 2], "two were");
        assert_eq!([of(7), of(100)], [(5, 7); 2], "all were");
        let mut moved = graph(6, &ends);
        moved.poses_mut()[3] = SE2::translation(1.0, 0.0);
        assert_eq!(moved.optimized_factors(), 8);
        moved.pop_factor();
        assert_eq!(moved.optimized_factors(), 7);
    }

    #[test]
    fn a_beginning_ends_with_every_eighth_loop() {
        // Two nodes a loop: factors 3k + 1 and 3k + 2 tie nodes 2k + 1 and 2k + 2, factor 3k + 3 closes.
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
        let of = |loops: usize| start(2 * loops + 1, &rounds(loops));
        assert_eq!(of(7), (1, 0));
        assert_eq!(of(8), (17, 24));
        assert_eq!(of(15), (17, 24));
        assert_eq!(of(17), (33, 48));
        // A node that came before its turn is as good as tied in the beginning; what ties it is one loop more.
        let mut unruly = rounds(17);
        unruly.swap(0, 1);
        assert_eq!(start(35, &unruly), (31, 45));
        unruly.swap(48, 49);
        assert_eq!(start(35, &unruly), (35, 51));
    }
}
