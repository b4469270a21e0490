//! Triangular solves with the factor, front by front.
//!
//! Source: Davis, "Direct Methods for Sparse Linear Systems", 2006, chapter 3.

use super::BlockCholesky;

impl BlockCholesky {
    /// Overwrites `rhs`, in elimination order, with `H⁻¹ rhs`.
    pub fn solve(&mut self, rhs: &mut [f64]) {
        let fronts = self.supernodes.list.len();
        (0..fronts).for_each(|number| self.solve_lower_front(number, rhs));
        (0..fronts)
            .rev()
            .for_each(|number| self.solve_upper_front(number, rhs));
    }

    /// Overwrites `rhs`, in elimination order, with `L⁻¹ rhs`, passing through some fronts only.
    ///
    /// `fronts` ascend. They hold every front where `rhs` has an entry that is not zero, and all
    /// ancestors of each: elsewhere the solution stays zero.
    pub fn solve_lower_along(&mut self, fronts: &[usize], rhs: &mut [f64]) {
        fronts
            .iter()
            .for_each(|&number| self.solve_lower_front(number, rhs));
    }

    /// The columns of one front in `x ← L⁻¹ x`; children come first.
    #[inline]
    fn solve_lower_front(&mut self, number: usize, x: &mut [f64]) {
        let supernode = &self.supernodes.list[number];
        let height = 3 * supernode.height();
        let run = 3 * supernode.columns().start..3 * supernode.columns().end;
        let local = &mut self.local[..height];
        local[..run.len()].copy_from_slice(&x[run.clone()]);
        local[run.len()..].fill(0.0);
        let columns = self.values[supernode.panel()].chunks_exact(height);
        let reciprocal = &self.reciprocal[run.clone()];
        for (k, (column, reciprocal)) in columns.zip(reciprocal).enumerate() {
            let value = local[k] * reciprocal;
            local[k] = value;
            for (sum, entry) in local[k + 1..].iter_mut().zip(&column[k + 1..]) {
                *sum -= value * entry;
            }
        }
        x[run.clone()].copy_from_slice(&local[..run.len()]);
        let rows = &self.supernodes.rows[supernode.rows()];
        for (&row, values) in rows.iter().zip(local[run.len()..].chunks_exact(3)) {
            let row = 3 * row as usize;
            for (sum, value) in x[row..row + 3].iter_mut().zip(values) {
                *sum += value;
            }
        }
    }

    /// The columns of one front in `x ← L⁻ᵀ x`; parents come first.
    #[inline]
    fn solve_upper_front(&mut self, number: usize, x: &mut [f64]) {
        let supernode = &self.supernodes.list[number];
        let height = 3 * supernode.height();
        let run = 3 * supernode.columns().start..3 * supernode.columns().end;
        let local = &mut self.local[..height];
        local[..run.len()].copy_from_slice(&x[run.clone()]);
        let rows = &self.supernodes.rows[supernode.rows()];
        for (&row, values) in rows.iter().zip(local[run.len()..].chunks_exact_mut(3)) {
            values.copy_from_slice(&x[3 * row as usize..3 * row as usize + 3]);
        }
        let columns = self.values[supernode.panel()].chunks_exact(height);
        let reciprocal = &self.reciprocal[run.clone()];
        for (k, (column, reciprocal)) in columns.zip(reciprocal).enumerate().rev() {
            let sum = dot(&local[k + 1..], &column[k + 1..]);
            local[k] = (local[k] - sum) * reciprocal;
        }
        x[run.clone()].copy_from_slice(&local[..run.len()]);
    }
}

/// Inner product in four interleaved sums, which the machine adds side by side.
#[inline]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a_chunks, b_chunks) = (a.chunks_exact(4), b.chunks_exact(4));
    let mut tail = 0.0;
    for (a, b) in a_chunks.remainder().iter().zip(b_chunks.remainder()) {
        tail += a * b;
    }
    let mut sums = [0.0; 4];
    for (a, b) in a_chunks.zip(b_chunks) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + tail
}
