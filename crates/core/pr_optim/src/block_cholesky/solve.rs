//! Triangular solves with the factor, front by front.
//!
//! Source: Davis, "Direct Methods for Sparse Linear Systems", 2006, chapter 3.

use super::BlockCholesky;
use crate::supernodes::{Supernode, Supernodes};

/// Number of right-hand sides solved together: the columns of two nodes.
pub(super) const LANES: usize = 6;

impl BlockCholesky {
    /// Overwrites `rhs`, in elimination order, with `H⁻¹ rhs`.
    pub fn solve(&mut self, rhs: &mut [f64]) {
        let fronts = self.supernodes.list.len();
        let (lanes, _) = rhs.as_chunks_mut::<1>();
        (0..fronts).for_each(|number| self.solve_lower_front(number, lanes));
        (0..fronts)
            .rev()
            .for_each(|number| self.solve_upper_front(number, lanes));
    }

    /// Overwrites interleaved right-hand sides, in elimination order, with `H⁻¹` times them.
    pub(crate) fn solve_sides<const N: usize>(&mut self, sides: &mut [[f64; N]]) {
        const { assert!(N <= LANES, "one front has room for so many") };
        let fronts = self.supernodes.list.len();
        for number in 0..fronts {
            let rows = &sides[self.supernodes.list[number].scalars()];
            if rows.iter().flatten().any(|entry| *entry != 0.0) {
                self.solve_lower_front(number, sides);
            }
        }
        (0..fronts)
            .rev()
            .for_each(|number| self.solve_upper_sides(number, sides));
    }

    /// `XᵀX` of `X = L⁻¹E`. Column k of E has a one in row `ones[k]`, in elimination order, or is zero.
    ///
    /// `fronts` ascend and contain every front with a one, and all ancestors of each. Elsewhere the solution
    /// is zero.
    pub(crate) fn gram_along(
        &mut self,
        fronts: &[usize],
        ones: [Option<usize>; LANES],
    ) -> [[f64; LANES]; LANES] {
        let mut sides = core::mem::take(&mut self.sides);
        sides.resize(self.reciprocal.len(), [0.0; LANES]);
        for (side, row) in ones.into_iter().enumerate() {
            row.into_iter().for_each(|row| sides[row][side] = 1.0);
        }
        let mut products = [[0.0; LANES]; LANES];
        for &number in fronts {
            self.solve_lower_front(number, &mut sides);
            for row in &mut sides[self.supernodes.list[number].scalars()] {
                for (sums, a) in products.iter_mut().zip(*row) {
                    for (sum, b) in sums.iter_mut().zip(*row) {
                        *sum += a * b;
                    }
                }
                *row = [0.0; LANES];
            }
        }
        self.sides = sides;
        products
    }

    /// The columns of one front in `x ← L⁻¹ x`, three at a time; children come first.
    #[inline]
    fn solve_lower_front<const N: usize>(&mut self, number: usize, x: &mut [[f64; N]]) {
        let supernode = &self.supernodes.list[number];
        let height = 3 * supernode.height();
        let run = supernode.scalars();
        let (local, _) = self.local.as_chunks_mut::<N>();
        let local = &mut local[..height];
        local[..run.len()].copy_from_slice(&x[run.clone()]);
        local[run.len()..].fill([0.0; N]);
        let blocks = self.values[supernode.panel()].chunks_exact(3 * height);
        let (reciprocals, _) = self.reciprocal[run.clone()].as_chunks::<3>();
        for (block, (columns, reciprocals)) in blocks.zip(reciprocals).enumerate() {
            let first = 3 * block;
            let column = |k: usize| &columns[k * height + first..(k + 1) * height];
            eliminate(
                &mut local[first..],
                [column(0), column(1), column(2)],
                reciprocals,
            );
        }
        x[run.clone()].copy_from_slice(&local[..run.len()]);
        let rows = &self.supernodes.rows[supernode.rows()];
        for (&row, values) in rows.iter().zip(local[run.len()..].chunks_exact(3)) {
            let row = 3 * row as usize;
            for (sums, values) in x[row..row + 3].iter_mut().zip(values) {
                for (sum, value) in sums.iter_mut().zip(values) {
                    *sum += value;
                }
            }
        }
    }

    /// The columns of one front in `x ← L⁻ᵀ x`, three at a time; parents come first.
    #[inline]
    fn solve_upper_sides<const N: usize>(&mut self, number: usize, x: &mut [[f64; N]]) {
        let supernode = &self.supernodes.list[number];
        let height = 3 * supernode.height();
        let run = supernode.scalars();
        let (local, _) = self.local.as_chunks_mut::<N>();
        let local = &mut local[..height];
        self.supernodes.gather(supernode, x, local);
        let blocks = self.values[supernode.panel()].chunks_exact(3 * height);
        let (reciprocals, _) = self.reciprocal[run.clone()].as_chunks::<3>();
        for (block, (columns, reciprocals)) in blocks.zip(reciprocals).enumerate().rev() {
            let first = 3 * block;
            let column = |k: usize| &columns[k * height + first..(k + 1) * height];
            substitute(
                &mut local[first..],
                [column(0), column(1), column(2)],
                reciprocals,
            );
        }
        x[run.clone()].copy_from_slice(&local[..run.len()]);
    }

    /// The columns of one front in `x ← L⁻ᵀ x`; parents come first.
    #[inline]
    fn solve_upper_front(&mut self, number: usize, x: &mut [[f64; 1]]) {
        let supernode = &self.supernodes.list[number];
        let height = 3 * supernode.height();
        let run = supernode.scalars();
        let (local, _) = self.local.as_chunks_mut::<1>();
        let local = &mut local[..height];
        self.supernodes.gather(supernode, x, local);
        let local = local.as_flattened_mut();
        let columns = self.values[supernode.panel()].chunks_exact(height);
        let reciprocal = &self.reciprocal[run.clone()];
        for (k, (column, reciprocal)) in columns.zip(reciprocal).enumerate().rev() {
            let sum = dot(&local[k + 1..], &column[k + 1..]);
            local[k] = (local[k] - sum) * reciprocal;
        }
        let (solved, _) = local[..run.len()].as_chunks::<1>();
        x[run].copy_from_slice(solved);
    }
}

impl Supernodes {
    /// Collects the rows of `x` that a front has: its own, then those below.
    #[inline]
    fn gather<const N: usize>(
        &self,
        supernode: &Supernode,
        x: &[[f64; N]],
        local: &mut [[f64; N]],
    ) {
        let (own, below) = local.split_at_mut(supernode.scalars().len());
        own.copy_from_slice(&x[supernode.scalars()]);
        let rows = &self.rows[supernode.rows()];
        for (&row, values) in rows.iter().zip(below.chunks_exact_mut(3)) {
            values.copy_from_slice(&x[3 * row as usize..3 * row as usize + 3]);
        }
    }
}

/// Solves for the three unknowns of a block column, given those below it.
///
/// `x` and the columns start at the block's diagonal.
#[inline]
fn substitute<const N: usize>(x: &mut [[f64; N]], columns: [&[f64]; 3], reciprocals: &[f64; 3]) {
    let [a, b, c] = columns;
    let (head, below) = x.split_at_mut(3);
    let mut sums = [[0.0; N]; 3];
    let entries = a[3..].iter().zip(&b[3..]).zip(&c[3..]);
    for (row, ((a, b), c)) in below.iter().zip(entries) {
        for n in 0..N {
            sums[0][n] += row[n] * a;
            sums[1][n] += row[n] * b;
            sums[2][n] += row[n] * c;
        }
    }
    for n in 0..N {
        let third = (head[2][n] - sums[2][n]) * reciprocals[2];
        let second = (head[1][n] - sums[1][n] - third * b[2]) * reciprocals[1];
        let first = (head[0][n] - sums[0][n] - second * a[1] - third * a[2]) * reciprocals[0];
        (head[0][n], head[1][n], head[2][n]) = (first, second, third);
    }
}

/// Solves for the three unknowns of a block column, and subtracts their contribution from the rows below.
///
/// `x` and the columns start at the block's diagonal.
#[inline]
fn eliminate<const N: usize>(x: &mut [[f64; N]], columns: [&[f64]; 3], reciprocals: &[f64; 3]) {
    let [a, b, c] = columns;
    let (head, below) = x.split_at_mut(3);
    let mut solved = [[0.0; N]; 3];
    for n in 0..N {
        let first = head[0][n] * reciprocals[0];
        let second = (head[1][n] - first * a[1]) * reciprocals[1];
        let third = (head[2][n] - first * a[2] - second * b[2]) * reciprocals[2];
        for (row, value) in [first, second, third].into_iter().enumerate() {
            head[row][n] = value;
            solved[row][n] = value;
        }
    }
    let [first, second, third] = solved;
    let entries = a[3..].iter().zip(&b[3..]).zip(&c[3..]);
    for (sums, ((a, b), c)) in below.iter_mut().zip(entries) {
        for n in 0..N {
            sums[n] = sums[n] - first[n] * a - second[n] * b - third[n] * c;
        }
    }
}

/// Inner product in four interleaved sums, which vector units add in parallel.
#[inline]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a_chunks, a_rest), (b_chunks, b_rest)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    let mut tail = 0.0;
    for (a, b) in a_rest.iter().zip(b_rest) {
        tail += a * b;
    }
    let mut sums = [0.0; 4];
    for (a, b) in a_chunks.iter().zip(b_chunks) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + tail
}
