//! The inverse of H at the blocks that its factor has: the selected inverse.
//!
//! `Σ = H⁻¹` is dense and never formed. Its blocks inside a front follow from those of the parent's front:
//! `Σ_RC = −Σ_RR Y` and `Σ_CC = (L_CC L_CCᵀ)⁻¹ − Yᵀ Σ_RC` with `Y = L_RC L_CC⁻¹`. C are the columns of a supernode
//! and R its rows below, which lie in its parent's front. The recursion therefore runs from the roots of the
//! elimination tree to the leaves. Units are those of H, inverted.
//!
//! Source: Takahashi, Fagan, Chin, "Formation of a sparse bus impedance matrix", 1973.

use nalgebra::Matrix3;

use crate::block_cholesky::BlockCholesky;
use crate::elimination::NO_PARENT;
use crate::supernodes::{Supernode, Supernodes};

/// Blocks of `H⁻¹`, front by front.
pub(crate) struct SelectedInverse<'a> {
    supernodes: &'a Supernodes,
    /// By supernode: a full square, column-major, own columns' rows first.
    fronts: Vec<Vec<f64>>,
}

impl<'a> SelectedInverse<'a> {
    /// Computes all blocks; `cholesky` has factorized H.
    pub fn new(cholesky: &'a BlockCholesky) -> Self {
        let supernodes = cholesky.supernodes();
        let list = &supernodes.list;
        let mut fronts: Vec<Vec<f64>> = vec![Vec::new(); list.len()];
        for (number, supernode) in list.iter().enumerate().rev() {
            let mut front = vec![0.0; 9 * supernode.height() * supernode.height()];
            if supernode.parent != NO_PARENT {
                take_rows(
                    &mut front,
                    supernode,
                    &fronts[supernode.parent as usize],
                    &list[supernode.parent as usize],
                    &supernodes.row_in_parent[supernode.rows()],
                );
            }
            invert_front(&mut front, supernode, cholesky);
            fronts[number] = front;
        }
        Self { supernodes, fronts }
    }

    /// The block of two elimination positions, `None` if the factor has none.
    pub fn block(&self, positions: [usize; 2]) -> Option<Matrix3<f64>> {
        let shared = self.supernodes.shared_front(positions)?;
        let front = &self.fronts[shared.supernode];
        let height = 3 * self.supernodes.list[shared.supernode].height();
        let [row, column] = shared.rows;
        Some(Matrix3::from_fn(|r, c| {
            front[(3 * column + c) * height + 3 * row + r]
        }))
    }
}

/// Copies `Σ_RR` out of the front of the parent.
fn take_rows(
    front: &mut [f64],
    supernode: &Supernode,
    parent_front: &[f64],
    parent: &Supernode,
    places: &[u32],
) {
    let height = 3 * supernode.height();
    let parent_height = 3 * parent.height();
    let width = 3 * supernode.width as usize;
    let place = |local: usize| 3 * places[local / 3] as usize + local % 3;
    for column in 0..height - width {
        for row in 0..height - width {
            front[(width + column) * height + width + row] =
                parent_front[place(column) * parent_height + place(row)];
        }
    }
}

/// Fills in `Σ_RC`, its transpose and `Σ_CC`, own columns from the last to the first.
fn invert_front(front: &mut [f64], supernode: &Supernode, cholesky: &BlockCholesky) {
    let height = 3 * supernode.height();
    let width = 3 * supernode.width as usize;
    let (panel, reciprocal) = cholesky.panel(supernode);
    let mut sums = Vec::with_capacity(height);
    for column in (0..width).rev() {
        let factor = &panel[column * height..(column + 1) * height];
        // Σ L = L⁻ᵀ in this column: below the diagonal the right side is zero.
        sums.clear();
        sums.resize(height - column - 1, 0.0);
        for k in column + 1..height {
            let source = &front[k * height + column + 1..(k + 1) * height];
            for (sum, entry) in sums.iter_mut().zip(source) {
                *sum += entry * factor[k];
            }
        }
        for (row, sum) in (column + 1..height).zip(&sums) {
            let value = -sum * reciprocal[column];
            front[column * height + row] = value;
            front[row * height + column] = value;
        }
        let sum: f64 = (column + 1..height)
            .map(|k| front[column * height + k] * factor[k])
            .sum();
        front[column * height + column] = (reciprocal[column] - sum) * reciprocal[column];
    }
}
