//! Sparse Cholesky factorization of the 3×3 blocks, by the multifrontal method.
//!
//! Supernodes are processed children first. The panel of a supernode and its update matrix (the square of rows
//! below the panel) start from the blocks of H and the updates of the children. The panel's columns are
//! factorized; their contribution to the square waits on a stack for the parent. There are two stacks: an update
//! is formed on the stack that does not hold its children's updates, and stays there. All arithmetic runs on
//! dense, contiguous memory.
//!
//! Source: Liu, "The multifrontal method for sparse matrix solution: theory and practice", 1992.

use crate::dense_kernel::{factorize_columns, subtract_product};
use crate::elimination::{NO_PARENT, elimination_tree, postorder};
use crate::error::OptimizeError;
use crate::structure::Structure;
use crate::supernodes::{Supernode, Supernodes, update_size};
use crate::system::NormalEquations;

mod solve;

use solve::LANES;

/// The factor `L` of `H = L Lᵀ`, with its symbolic analysis and workspace.
#[derive(Clone, Debug, Default)]
pub struct BlockCholesky {
    supernodes: Supernodes,
    /// The panels, column-major, own columns' rows first.
    values: Vec<f64>,
    /// Reciprocals of the diagonal entries of L.
    reciprocal: Vec<f64>,
    /// Updates waiting for their parents; see [`Supernode::stack`].
    stacks: [Vec<f64>; 2],
    /// Positions of the updates on their stacks, the latest last.
    waiting: Vec<Waiting>,
    /// Right-hand sides of one front.
    local: Vec<f64>,
    /// Right-hand sides of all rows, zero outside of a solve.
    sides: Vec<[f64; LANES]>,
}

/// The update of a supernode on its stack.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    supernode: u32,
    start: usize,
    end: usize,
}

impl BlockCholesky {
    /// Analyses the pattern of a structure that is in postorder.
    #[must_use]
    pub fn new(structure: &Structure) -> Self {
        let mut cholesky = Self::default();
        cholesky.renew(structure);
        cholesky
    }

    /// Analyses another pattern and reuses the memory.
    pub(crate) fn renew(&mut self, structure: &Structure) {
        self.supernodes = Supernodes::new(structure);
        let tallest = self.supernodes.list.iter().map(Supernode::height).max();
        self.values.resize(self.supernodes.value_count, 0.0);
        self.reciprocal.resize(3 * structure.node_count(), 0.0);
        for (stack, size) in self.stacks.iter_mut().zip(self.supernodes.stack_size) {
            stack.resize(size, 0.0);
        }
        self.local.resize(3 * tallest.unwrap_or(0) * LANES, 0.0);
    }

    /// The elimination order of `order`, renumbered so that every subtree is one run.
    #[must_use]
    pub fn postordered(structure: &Structure) -> Vec<u32> {
        postorder(&elimination_tree(structure))
            .into_iter()
            .map(|position| structure.node_at[position as usize])
            .collect()
    }

    /// The pattern of the factor.
    #[must_use]
    pub fn supernodes(&self) -> &Supernodes {
        &self.supernodes
    }

    /// The panel of a supernode, and the reciprocals of the diagonal of its columns.
    #[must_use]
    pub fn panel(&self, supernode: &Supernode) -> (&[f64], &[f64]) {
        (
            &self.values[supernode.panel()],
            &self.reciprocal[supernode.scalars()],
        )
    }

    /// Factorizes `H` with every diagonal entry multiplied by `1 + damping`.
    ///
    /// # Errors
    /// [`OptimizeError::NotPositiveDefinite`] if a pivot is not positive.
    pub fn factorize(
        &mut self,
        structure: &Structure,
        equations: &NormalEquations,
        damping: f64,
    ) -> Result<(), OptimizeError> {
        self.waiting.clear();
        let mut tops = [0; 2];
        (0..self.supernodes.list.len()).try_for_each(|number| {
            self.factorize_front(number, &mut tops, structure, equations, damping)
        })
    }

    /// Factorizes one supernode, pops its children's updates off their stack and pushes its own onto the other;
    /// `tops` is the fill level of both.
    fn factorize_front(
        &mut self,
        number: usize,
        tops: &mut [usize; 2],
        structure: &Structure,
        equations: &NormalEquations,
        damping: f64,
    ) -> Result<(), OptimizeError> {
        let list = &self.supernodes.list;
        let supernode = list[number];
        // Children come directly before their parent, so theirs are the last waiting updates.
        let first_child = self.waiting.len() - supernode.child_count as usize;
        let own = supernode.stack as usize;
        let [even, odd] = &mut self.stacks;
        let (below, above) = if own == 0 { (odd, even) } else { (even, odd) };
        let children = self.waiting[first_child..].iter().map(|waiting| {
            let child = &list[waiting.supernode as usize];
            ChildUpdate {
                values: &below[waiting.start..waiting.end],
                row_in_parent: &self.supernodes.row_in_parent[child.rows()],
            }
        });

        let panel = &mut self.values[supernode.panel()];
        let row_of_slot = &self.supernodes.row_of_slot;
        load_blocks(
            panel,
            &supernode,
            row_of_slot,
            structure,
            equations,
            damping,
        );
        for child in children.clone() {
            child.add_to_panel(panel, &supernode);
        }
        let reciprocal = &mut self.reciprocal[3 * supernode.first as usize..];
        factorize_panel(panel, &supernode, reciprocal).map_err(|column| {
            let position = supernode.first as usize + column;
            OptimizeError::NotPositiveDefinite {
                node: structure.node_at[position] as usize,
            }
        })?;
        let size = update_size(&supernode);
        let update = &mut above[tops[own]..tops[own] + size];
        form_update(update, panel, &supernode);
        for child in children {
            child.add_to_update(update, &supernode);
        }

        if let Some(child) = self.waiting.get(first_child) {
            tops[1 - own] = child.start;
        }
        self.waiting.truncate(first_child);
        if supernode.parent != NO_PARENT {
            let start = tops[own];
            tops[own] += size;
            self.waiting.push(Waiting {
                supernode: number as u32,
                start,
                end: tops[own],
            });
        }
        Ok(())
    }
}

/// Fills a panel with the blocks of H.
fn load_blocks(
    panel: &mut [f64],
    supernode: &Supernode,
    row_of_slot: &[u32],
    structure: &Structure,
    equations: &NormalEquations,
    damping: f64,
) {
    let height = 3 * supernode.height();
    panel.fill(0.0);
    for (local, column) in supernode.columns().enumerate() {
        let columns = &mut panel[3 * local * height..3 * (local + 1) * height];
        let mut diagonal = equations.diagonal[column];
        for axis in 0..3 {
            diagonal[4 * axis] *= 1.0 + damping;
        }
        put_block(columns, height, 3 * local, &diagonal);
        for slot in structure.slots_of(column) {
            let row = 3 * row_of_slot[slot] as usize;
            put_block(columns, height, row, &equations.lower[slot]);
        }
    }
}

#[inline]
fn put_block(columns: &mut [f64], height: usize, row: usize, block: &[f64; 9]) {
    for (column, values) in columns.chunks_exact_mut(height).zip(block.chunks_exact(3)) {
        column[row..row + 3].copy_from_slice(values);
    }
}

/// The update of a child, and the positions of its rows in the parent.
#[derive(Clone, Copy)]
struct ChildUpdate<'a> {
    /// Lower triangle of blocks, column-major, stored as a full square.
    values: &'a [f64],
    /// Block row in the parent's panel of each of the update's block rows, ascending.
    row_in_parent: &'a [u32],
}

impl ChildUpdate<'_> {
    /// Adds the block columns that belong to the parent's run.
    fn add_to_panel(&self, panel: &mut [f64], parent: &Supernode) {
        let height = 3 * parent.height();
        for column in 0..self.columns_in_run(parent) {
            let place = self.row_in_parent[column] as usize;
            self.add_column(column, &mut panel[3 * place * height..], height, 0);
        }
    }

    /// Adds the block columns that belong to the rows below the parent's run.
    fn add_to_update(&self, update: &mut [f64], parent: &Supernode) {
        let width = parent.width as usize;
        let side = 3 * parent.rows_len as usize;
        for column in self.columns_in_run(parent)..self.row_in_parent.len() {
            let place = self.row_in_parent[column] as usize - width;
            self.add_column(column, &mut update[3 * place * side..], side, width);
        }
    }

    fn columns_in_run(&self, parent: &Supernode) -> usize {
        self.row_in_parent
            .partition_point(|&row| row < parent.width)
    }

    /// Adds one block column to the three columns at the start of `target`, `stride` values each,
    /// whose first row is block row `skipped` of the panel.
    #[inline]
    fn add_column(&self, column: usize, target: &mut [f64], stride: usize, skipped: usize) {
        let rows = 3 * self.row_in_parent.len();
        let places = &self.row_in_parent[column..];
        let columns = self.values[3 * column * rows..3 * (column + 1) * rows].chunks_exact(rows);
        for (source, target) in columns.zip(target.chunks_exact_mut(stride)) {
            for (values, &row) in source[3 * column..].chunks_exact(3).zip(places) {
                let row = 3 * (row as usize - skipped);
                let sums: &mut [f64; 3] = (&mut target[row..row + 3])
                    .try_into()
                    .expect("a block has three rows");
                sums[0] += values[0];
                sums[1] += values[1];
                sums[2] += values[2];
            }
        }
    }
}

/// Factorizes a panel, block column by block column; `Err` is the column that failed.
fn factorize_panel(
    panel: &mut [f64],
    supernode: &Supernode,
    reciprocal: &mut [f64],
) -> Result<(), usize> {
    let height = 3 * supernode.height();
    for column in 0..supernode.width as usize {
        let (done, rest) = panel.split_at_mut(3 * column * height);
        let columns = &mut rest[..3 * height];
        subtract_product::<false>(columns, height, done, height, 3 * column);
        let reciprocal = &mut reciprocal[3 * column..3 * column + 3];
        if !factorize_columns(columns, height, 3 * column, reciprocal) {
            return Err(column);
        }
    }
    Ok(())
}

/// Computes the panel's update of the rows below it: the lower triangle of `−L_RC L_RCᵀ`.
fn form_update(update: &mut [f64], panel: &[f64], supernode: &Supernode) {
    let height = 3 * supernode.height();
    let first_row = 3 * supernode.width as usize;
    let side = height - first_row;
    if side == 0 {
        return;
    }
    for (column, columns) in update.chunks_exact_mut(3 * side).enumerate() {
        subtract_product::<true>(columns, side, panel, height, first_row + 3 * column);
    }
}
