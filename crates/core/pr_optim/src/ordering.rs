//! Fill-reducing elimination order of the nodes.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMat;
use faer::sparse::linalg::amd;

use crate::problem::Problem;
use crate::structure::Structure;

/// Approximate minimum degree on the graph of free nodes: element `k` is eliminated at position `k`.
///
/// Nodes are ordered, not scalars: the graph has a third of the rows and a ninth of the entries.
/// Amestoy, Davis, Duff, "An approximate minimum degree ordering algorithm", 1996.
#[must_use]
pub fn minimum_degree(problem: &Problem) -> Vec<u32> {
    let nodes = problem.node_count();
    let natural = Structure::new(problem, (0..nodes as u32).collect());
    let column_start = natural.column_start.iter().map(|&k| k as usize).collect();
    let row = natural.row.iter().map(|&k| k as usize).collect();
    let pattern = SymbolicSparseColMat::new_checked(nodes, nodes, column_start, None, row);
    let mut order = vec![0_usize; nodes];
    let mut inverse = vec![0_usize; nodes];
    let mut memory = MemBuffer::new(amd::order_scratch::<usize>(nodes, natural.row.len()));
    amd::order(
        &mut order,
        &mut inverse,
        pattern.as_ref(),
        amd::Control::default(),
        MemStack::new(&mut memory),
    )
    .expect("memory for the ordering");
    order.into_iter().map(|node| node as u32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block_cholesky::BlockCholesky;
    use crate::factor::Between;
    use nalgebra::Matrix3;
    use pr_geom::SE2;

    fn star(centre: usize, leaves: usize) -> Problem {
        let mut problem = Problem::new();
        for _ in 0..=leaves {
            problem.add_pose(SE2::identity());
        }
        for leaf in (0..=leaves).filter(|&leaf| leaf != centre) {
            problem.add_factor(Between {
                from: centre,
                to: leaf,
                measurement: SE2::identity(),
                information: Matrix3::identity(),
            });
        }
        problem
    }

    #[test]
    fn every_node_is_eliminated_once() {
        let mut order = minimum_degree(&star(3, 40));
        order.sort_unstable();
        assert_eq!(order, (0..=40).collect::<Vec<u32>>());
    }

    #[test]
    fn the_centre_of_a_star_waits_for_its_leaves() {
        // Centre first would connect all leaves to each other; leaves first causes no fill-in.
        let problem = star(0, 40);
        let order = minimum_degree(&problem);
        let place = order.iter().position(|&node| node == 0).unwrap();
        assert!(place >= 39, "the centre is eliminated in place {place}");
        let structure = Structure::new(&problem, order);
        let order = BlockCholesky::postordered(&structure);
        let cholesky = BlockCholesky::new(&Structure::new(&problem, order));
        let blocks = cholesky.supernodes().value_count / 9;
        // 41 on the diagonal and 40 below, and a few zeros of a merged panel. Centre first: 861.
        assert!(blocks < 100, "{blocks} blocks");
    }
}
