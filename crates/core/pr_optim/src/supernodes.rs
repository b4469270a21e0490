//! Symbolic factorization: which columns of the factor share their rows.
//!
//! A supernode is a run of columns with the same rows below the run. It is stored as one dense panel, and
//! factorized with dense kernels. A child is merged into its parent even if that stores a few zeros, as long as
//! the estimated work falls (relaxed amalgamation).
//!
//! Sources: Liu, "The multifrontal method for sparse matrix solution", 1992; Ashcraft & Grimes,
//! "The influence of relaxed supernode partitions on the multifrontal method", 1989.

use crate::elimination::{NO_PARENT, elimination_tree};
use crate::structure::Structure;

/// A run of block columns with common rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Supernode {
    /// First block column.
    pub first: u32,
    /// Number of block columns.
    pub width: u32,
    /// Start of its rows below the run in [`Supernodes::rows`].
    pub rows_start: u32,
    /// Number of block rows below the run.
    pub rows_len: u32,
    /// Start of its panel among the factor's values.
    pub panel_start: usize,
    /// The supernode that receives its update, `u32::MAX` for a root.
    pub parent: u32,
    /// Number of supernodes with this one as parent.
    pub child_count: u32,
    /// Which of the two stacks holds its update: the one that does not hold its children's.
    pub stack: u8,
}

impl Supernode {
    /// Block rows of the panel: the run itself and the rows below.
    #[must_use]
    pub fn height(&self) -> usize {
        (self.width + self.rows_len) as usize
    }

    /// The block columns of the run.
    #[must_use]
    pub fn columns(&self) -> core::ops::Range<usize> {
        self.first as usize..(self.first + self.width) as usize
    }

    /// The scalar columns of the run, three to a block.
    #[must_use]
    pub fn scalars(&self) -> core::ops::Range<usize> {
        let columns = self.columns();
        3 * columns.start..3 * columns.end
    }

    /// Range of the rows below the run.
    #[must_use]
    pub fn rows(&self) -> core::ops::Range<usize> {
        self.rows_start as usize..(self.rows_start + self.rows_len) as usize
    }

    /// Range of the panel's values.
    #[must_use]
    pub fn panel(&self) -> core::ops::Range<usize> {
        self.panel_start..self.panel_start + 9 * self.height() * self.width as usize
    }
}

/// The pattern of the factor, supernode by supernode, children before parents.
#[derive(Clone, Debug, Default)]
pub struct Supernodes {
    /// The supernodes; their columns ascend without gaps.
    pub list: Vec<Supernode>,
    /// Block rows below the runs, ascending within each.
    pub rows: Vec<u32>,
    /// For every entry of `rows`, its block row in the parent's panel.
    pub row_in_parent: Vec<u32>,
    /// For every off-diagonal slot of the structure, its block row in its panel.
    pub row_of_slot: Vec<u32>,
    /// Number of values of all panels.
    pub value_count: usize,
    /// Largest number of values of waiting updates on each stack.
    pub stack_size: [usize; 2],
}

/// A front that contains two block columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SharedFront {
    /// Number of the supernode.
    pub supernode: usize,
    /// Block row of each of the two in its panel.
    pub rows: [usize; 2],
}

/// A supernode under construction.
struct Draft {
    first: u32,
    width: u32,
    /// Range of its rows below the run among all rows.
    rows: core::ops::Range<usize>,
}

/// All drafts and their rows; merging leaves a child's rows unused.
struct Drafts {
    list: Vec<Draft>,
    rows: Vec<u32>,
}

impl Supernodes {
    /// Analyses a structure whose columns are in postorder of its elimination tree.
    #[must_use]
    pub fn new(structure: &Structure) -> Self {
        let parent = elimination_tree(structure);
        let drafts = merge(find_fundamental(structure, &parent));
        let mut supernodes = Self::lay_out(&drafts, structure.node_count());
        supernodes.locate_rows(structure);
        supernodes
    }

    /// Number of the supernode whose run contains a block column.
    #[must_use]
    pub fn holding(&self, column: usize) -> usize {
        self.list
            .partition_point(|supernode| supernode.columns().end <= column)
    }

    /// The front that contains both block columns, or `None` if the factor has no block of the two.
    ///
    /// It is the front of the column eliminated first: the other is in its run, in its rows below, or
    /// nowhere.
    #[must_use]
    pub fn shared_front(&self, columns: [usize; 2]) -> Option<SharedFront> {
        let supernode = self.holding(columns[0].min(columns[1]));
        let [first, second] = columns.map(|column| self.row_in_front(supernode, column));
        Some(SharedFront {
            supernode,
            rows: [first?, second?],
        })
    }

    fn row_in_front(&self, number: usize, column: usize) -> Option<usize> {
        let supernode = &self.list[number];
        if supernode.columns().contains(&column) {
            return Some(column - supernode.first as usize);
        }
        let below = self.rows[supernode.rows()].binary_search(&(column as u32));
        below.ok().map(|row| supernode.width as usize + row)
    }

    /// A supernode, its parent, and so on to the root.
    pub fn path_to_root(&self, number: usize) -> impl Iterator<Item = usize> {
        core::iter::successors(Some(number), |&number| {
            let parent = self.list[number].parent;
            (parent != NO_PARENT).then_some(parent as usize)
        })
    }

    /// Stores the drafts one after the other, and finds every parent.
    fn lay_out(drafts: &Drafts, nodes: usize) -> Self {
        let mut supernode_of = vec![NO_PARENT; nodes];
        for (number, draft) in (0_u32..).zip(&drafts.list) {
            supernode_of[draft.first as usize..(draft.first + draft.width) as usize].fill(number);
        }
        let mut supernodes = Self::default();
        for draft in &drafts.list {
            let rows = &drafts.rows[draft.rows.clone()];
            let supernode = Supernode {
                first: draft.first,
                width: draft.width,
                rows_start: supernodes.rows.len() as u32,
                rows_len: rows.len() as u32,
                panel_start: supernodes.value_count,
                parent: rows
                    .first()
                    .map_or(NO_PARENT, |&row| supernode_of[row as usize]),
                child_count: 0,
                stack: 0,
            };
            supernodes.value_count = supernode.panel().end;
            supernodes.rows.extend_from_slice(rows);
            supernodes.list.push(supernode);
        }
        for number in (0..supernodes.list.len()).rev() {
            let parent = supernodes.list[number].parent;
            if parent != NO_PARENT {
                supernodes.list[parent as usize].child_count += 1;
                // Parents come later, so theirs is known.
                supernodes.list[number].stack = 1 - supernodes.list[parent as usize].stack;
            }
        }
        supernodes
    }

    /// Finds the position of every row in the parent's panel, and of every slot in its own.
    fn locate_rows(&mut self, structure: &Structure) {
        let mut place = vec![0_u32; structure.node_count()];
        self.row_in_parent = vec![0; self.rows.len()];
        self.row_of_slot = vec![0; structure.row.len()];
        // Children come directly before their parent, so theirs are the last waiting ones.
        let mut waiting: Vec<usize> = Vec::new();
        let mut height = [0; 2];
        for (number, supernode) in self.list.iter().enumerate() {
            let below = self.rows[supernode.rows()].iter().copied();
            let rows = (supernode.first..supernode.first + supernode.width).chain(below);
            for (local, row) in (0_u32..).zip(rows) {
                place[row as usize] = local;
            }
            for column in supernode.columns() {
                for slot in structure.slots_of(column) {
                    self.row_of_slot[slot] = place[structure.row[slot] as usize];
                }
            }
            let stack = supernode.stack as usize;
            height[stack] += update_size(supernode);
            self.stack_size[stack] = self.stack_size[stack].max(height[stack]);
            let first_child = waiting.len() - supernode.child_count as usize;
            for child in waiting.drain(first_child..) {
                let child = &self.list[child];
                for entry in child.rows() {
                    self.row_in_parent[entry] = place[self.rows[entry] as usize];
                }
                height[1 - stack] -= update_size(child);
            }
            if supernode.parent == NO_PARENT {
                height[stack] -= update_size(supernode);
            } else {
                waiting.push(number);
            }
        }
    }
}

/// Number of values of a supernode's update matrix, stored as a full square.
#[must_use]
pub fn update_size(supernode: &Supernode) -> usize {
    9 * (supernode.rows_len as usize) * (supernode.rows_len as usize)
}

/// Maximal runs of columns with exactly the same rows, each the only child of the next.
fn find_fundamental(structure: &Structure, parent: &[u32]) -> Drafts {
    let nodes = structure.node_count();
    let mut list: Vec<Draft> = Vec::new();
    let mut rows: Vec<u32> = Vec::new();
    // Drafts whose rows a column will merge, as a linked list from the last to the first.
    let mut last_waiting = vec![NO_PARENT; nodes];
    let mut waiting_before: Vec<u32> = Vec::new();
    let mut mark = vec![NO_PARENT; nodes];
    for column in 0..nodes {
        let start = rows.len();
        mark[column] = column as u32;
        let mut add = |rows: &mut Vec<u32>, row: u32| {
            if mark[row as usize] != column as u32 {
                mark[row as usize] = column as u32;
                rows.push(row);
            }
        };
        for &row in structure.rows_of(column) {
            add(&mut rows, row);
        }
        let newest = last_waiting[column];
        let mut child = newest;
        while child != NO_PARENT {
            for entry in list[child as usize].rows.clone() {
                let row = rows[entry];
                add(&mut rows, row);
            }
            child = waiting_before[child as usize];
        }
        let is_only = newest != NO_PARENT && waiting_before[newest as usize] == NO_PARENT;
        let height = rows.len() - start;
        match list.last_mut() {
            Some(last)
                if is_only
                    && newest as usize + 1 == waiting_before.len()
                    && last.rows.len() == height + 1 =>
            {
                // The column itself is the first of the rows below: the others remain.
                rows.truncate(start);
                last.width += 1;
                last.rows.start += 1;
            }
            _ => {
                rows[start..].sort_unstable();
                list.push(Draft {
                    first: column as u32,
                    width: 1,
                    rows: start..rows.len(),
                });
                waiting_before.push(NO_PARENT);
            }
        }
        if parent[column] != NO_PARENT {
            let slot = &mut last_waiting[parent[column] as usize];
            let number = list.len() - 1;
            waiting_before[number] = *slot;
            *slot = number as u32;
        }
    }
    Drafts { list, rows }
}

/// Merges a supernode into the next one if that is its parent and the work falls.
fn merge(drafts: Drafts) -> Drafts {
    let Drafts { list, rows } = drafts;
    let mut merged: Vec<Draft> = Vec::with_capacity(list.len());
    for mut draft in list {
        while let Some(child) = merged.last() {
            let is_child = rows[child.rows.clone()]
                .first()
                .is_some_and(|&row| (draft.first..draft.first + draft.width).contains(&row));
            let (height, width) = (draft.rows.len() as u32, draft.width + child.width);
            let apart = work(child.width, child.rows.len() as u32) + work(draft.width, height);
            if !is_child || work(width, height) > apart {
                break;
            }
            draft.first = child.first;
            draft.width = width;
            merged.pop();
        }
        merged.push(draft);
    }
    Drafts { list: merged, rows }
}

/// Estimated work of a front with `width` columns and `rows` rows below, in block products.
///
/// A front costs a constant; every block of its update is written, read and added to the parent.
fn work(width: u32, rows: u32) -> u64 {
    const PER_FRONT: u64 = 8;
    const PER_UPDATE_BLOCK: u64 = 2;
    // 64 bits: the products of two thousand columns over two thousand rows pass 2³².
    let (width, rows) = (u64::from(width), u64::from(rows));
    let update_blocks = rows * (rows + 1) / 2;
    // Σ (k + 1)(width − k + rows) over the columns k.
    let columns = width * (width + 1) / 2;
    let panel_products = columns * (width + 2) / 3 + columns * rows;
    PER_FRONT + panel_products + update_blocks * (width + PER_UPDATE_BLOCK)
}

#[cfg(test)]
mod tests;
