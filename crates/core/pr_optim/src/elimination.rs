//! The elimination tree: which column depends on which.
//!
//! Column `p` is the parent of column `j` if `p` is the first row below the diagonal of column `j` of the factor.
//! Source: Davis, "Direct Methods for Sparse Linear Systems", 2006, chapter 4.

use crate::structure::Structure;

/// The parent of a root.
pub const NO_PARENT: u32 = u32::MAX;

/// Parent of every column, [`NO_PARENT`] for roots. Liu's algorithm with path compression.
#[must_use]
pub fn elimination_tree(structure: &Structure) -> Vec<u32> {
    let nodes = structure.node_count();
    let (row_start, columns) = columns_by_row(structure);
    let mut parent = vec![NO_PARENT; nodes];
    let mut ancestor = vec![NO_PARENT; nodes];
    for row in 0..nodes {
        for &column in &columns[row_start[row] as usize..row_start[row + 1] as usize] {
            let mut at = column as usize;
            while ancestor[at] != row as u32 {
                let next = ancestor[at];
                ancestor[at] = row as u32;
                if next == NO_PARENT {
                    parent[at] = row as u32;
                    break;
                }
                at = next as usize;
            }
        }
    }
    parent
}

/// A renumbering in which every column follows all of its descendants, which are contiguous.
///
/// Element `k` is the old number of the new column `k`. The fill-in does not change.
#[must_use]
pub fn postorder(parent: &[u32]) -> Vec<u32> {
    let nodes = parent.len();
    let mut first_child = vec![NO_PARENT; nodes];
    let mut next_sibling = vec![NO_PARENT; nodes];
    let mut roots = Vec::new();
    for column in (0..nodes).rev() {
        match parent[column] {
            NO_PARENT => roots.push(column as u32),
            p => {
                next_sibling[column] = first_child[p as usize];
                first_child[p as usize] = column as u32;
            }
        }
    }
    let mut order = Vec::with_capacity(nodes);
    let mut stack = Vec::new();
    for root in roots.into_iter().rev() {
        stack.push(root);
        while let Some(&top) = stack.last() {
            let child = first_child[top as usize];
            if child == NO_PARENT {
                order.push(top);
                stack.pop();
            } else {
                first_child[top as usize] = next_sibling[child as usize];
                stack.push(child);
            }
        }
    }
    order
}

/// The lower triangle by rows: starts, and columns in ascending order.
fn columns_by_row(structure: &Structure) -> (Vec<u32>, Vec<u32>) {
    let nodes = structure.node_count();
    let mut start = vec![0_u32; nodes + 2];
    for &row in &structure.row {
        start[row as usize + 2] += 1;
    }
    for row in 0..nodes {
        start[row + 2] += start[row + 1];
    }
    let mut columns = vec![0_u32; structure.row.len()];
    for column in 0..nodes {
        for &row in structure.rows_of(column) {
            let place = &mut start[row as usize + 1];
            columns[*place as usize] = column as u32;
            *place += 1;
        }
    }
    (start, columns)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn postorder_puts_children_in_one_run_before_their_parent() {
        // 0 → 3 ← 2, 1 → 4 ← 3.
        let order = postorder(&[3, 4, 3, 4, NO_PARENT]);
        assert_eq!(order, [1, 0, 2, 3, 4]);
    }

    #[test]
    fn postorder_keeps_every_column_of_a_forest() {
        let mut order = postorder(&[2, NO_PARENT, NO_PARENT, 2]);
        order.sort_unstable();
        assert_eq!(order, [0, 1, 2, 3]);
    }
}
