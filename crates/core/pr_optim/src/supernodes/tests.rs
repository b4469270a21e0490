use super::*;
use crate::factor::Between;
use crate::problem::Problem;
use nalgebra::Matrix3;
use pr_geom::SE2;

fn graph(nodes: usize, edges: &[(usize, usize)]) -> Structure {
    let mut problem = Problem::new();
    for _ in 0..nodes {
        problem.add_pose(SE2::identity());
    }
    for &(from, to) in edges {
        problem.add_factor(Between {
            from,
            to,
            measurement: SE2::identity(),
            information: Matrix3::identity(),
        });
    }
    Structure::new(&problem, (0..nodes as u32).collect())
}

#[test]
fn a_dense_graph_is_one_supernode() {
    let structure = graph(4, &[(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]);
    let supernodes = Supernodes::new(&structure);
    assert_eq!(supernodes.list.len(), 1);
    assert_eq!(supernodes.list[0].width, 4);
    assert_eq!(supernodes.value_count, 9 * 16);
}

#[test]
fn eliminating_a_node_ties_its_neighbours_together() {
    // A star with its centre first: all others become one dense block.
    let structure = graph(4, &[(0, 1), (0, 2), (0, 3)]);
    let drafts = find_fundamental(&structure, &elimination_tree(&structure));
    assert_eq!(drafts.list.len(), 1);
    assert_eq!(drafts.list[0].width, 4);
}

#[test]
fn the_work_of_a_front_beyond_32_bits_is_counted_exactly() {
    // n columns over n rows, n = 2000. The panel: Σ (k+1)(2n−k) over k < n, which is
    // (2n+1)·n(n+1)/2 − n(n+1)(2n+1)/6 = n(n+1)(2n+1)/3. The update: n(n+1)/2 · (n+2).
    let panel: u64 = 2000 * 2001 * 4001 / 3;
    let update: u64 = 2000 * 2001 / 2 * 2002;
    assert_eq!(work(2000, 2000), 8 + panel + update);
    assert!(work(2000, 2000) > u64::from(u32::MAX));
}

#[test]
fn rows_are_placed_in_the_panel_of_the_parent() {
    // Two arms, 0–1 and 2–3, that meet in 4.
    let structure = graph(5, &[(0, 1), (1, 4), (2, 3), (3, 4)]);
    let drafts = find_fundamental(&structure, &elimination_tree(&structure));
    let mut supernodes = Supernodes::lay_out(&drafts, 5);
    supernodes.locate_rows(&structure);
    let shapes: Vec<_> = supernodes
        .list
        .iter()
        .map(|supernode| (supernode.first, supernode.width, supernode.rows_len))
        .collect();
    assert_eq!(
        shapes,
        [(0, 1, 1), (1, 1, 1), (2, 1, 1), (3, 1, 1), (4, 1, 0)]
    );
    assert_eq!(supernodes.rows, [1, 4, 3, 4]);
    let parents: Vec<_> = supernodes
        .list
        .iter()
        .map(|supernode| supernode.parent)
        .collect();
    assert_eq!(parents, [1, 4, 3, 4, NO_PARENT]);
    assert_eq!(supernodes.row_in_parent, [0; 4]);
}

#[test]
fn two_columns_share_a_front_where_the_factor_has_their_block() {
    // Two arms, 0–1 and 2–3, that meet in 4.
    let structure = graph(5, &[(0, 1), (1, 4), (2, 3), (3, 4)]);
    let drafts = find_fundamental(&structure, &elimination_tree(&structure));
    let supernodes = Supernodes::lay_out(&drafts, 5);
    let shared = |a, b| supernodes.shared_front([a, b]);
    let front = |supernode, rows| Some(SharedFront { supernode, rows });
    assert_eq!(shared(1, 4), front(1, [0, 1]));
    assert_eq!(shared(4, 1), front(1, [1, 0]));
    assert_eq!(shared(3, 3), front(3, [0, 0]));
    // On one path, and on two: neither has a block.
    assert_eq!(shared(0, 4), None);
    assert_eq!(shared(1, 3), None);
    assert_eq!(supernodes.path_to_root(0).collect::<Vec<_>>(), [0, 1, 4]);
}
