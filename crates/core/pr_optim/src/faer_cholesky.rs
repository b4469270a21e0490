//! Sparse Cholesky factorization of the normal equations by `faer`.
//!
//! The block pattern is expanded to scalars once, and all numeric factorizations share one symbolic analysis. The
//! simplicial algorithm is forced: it does the same operations in the same order natively and in WebAssembly, so
//! both give the same bits.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltError;
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side};

use crate::error::OptimizeError;
use crate::structure::Structure;
use crate::system::NormalEquations;

/// Factorization of one [`Structure`], with its workspace.
pub struct FaerCholesky {
    pattern: SymbolicSparseColMat<usize>,
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
    factor: Vec<f64>,
    memory: MemBuffer,
    node_at: Vec<u32>,
}

impl FaerCholesky {
    /// Analyses the pattern. The elimination order is that of `structure`.
    #[must_use]
    pub fn new(structure: &Structure) -> Self {
        let pattern = scalar_pattern(structure);
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
            ..CholeskySymbolicParams::default()
        };
        // `SymmetricOrdering::Identity` reads an upper triangle whichever side is named.
        let in_place: Vec<usize> = (0..3 * structure.node_count()).collect();
        let symbolic = factorize_symbolic_cholesky(
            pattern.as_ref(),
            Side::Lower,
            SymmetricOrdering::Custom(PermRef::new_checked(&in_place, &in_place, in_place.len())),
            params,
        )
        .expect("memory for the symbolic factorization");
        let scratch = symbolic
            .factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default())
            .or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        Self {
            values: vec![0.0; pattern.row_idx().len()],
            factor: vec![0.0; symbolic.len_val()],
            memory: MemBuffer::new(scratch),
            pattern,
            symbolic,
            node_at: structure.node_at.clone(),
        }
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
        self.fill(structure, equations, damping);
        let matrix = SparseColMatRef::new(self.pattern.as_ref(), &self.values);
        let outcome = self.symbolic.factorize_numeric_llt(
            &mut self.factor,
            matrix,
            Side::Lower,
            Default::default(),
            Par::Seq,
            MemStack::new(&mut self.memory),
            Default::default(),
        );
        match outcome {
            Ok(_) => Ok(()),
            Err(LltError::NonPositivePivot { index }) => Err(OptimizeError::NotPositiveDefinite {
                node: self.node_at[index.min(3 * self.node_at.len() - 1) / 3] as usize,
            }),
        }
    }

    /// Overwrites `rhs`, in elimination order, with `H⁻¹ rhs`.
    pub fn solve(&mut self, rhs: &mut [f64]) {
        let rows = rhs.len();
        LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(rhs, rows, 1),
            Par::Seq,
            MemStack::new(&mut self.memory),
        );
    }

    /// Writes the blocks into the scalar columns, in the order of [`scalar_pattern`].
    fn fill(&mut self, structure: &Structure, equations: &NormalEquations, damping: f64) {
        let mut values = self.values.iter_mut();
        let mut put =
            |value: f64| *values.next().expect("as many values as the pattern has") = value;
        for column in 0..structure.node_count() {
            let diagonal = &equations.diagonal[column];
            for axis in 0..3 {
                put(diagonal[4 * axis] * (1.0 + damping));
                for row in axis + 1..3 {
                    put(diagonal[3 * axis + row]);
                }
                for block in &equations.lower[structure.slots_of(column)] {
                    for entry in &block[3 * axis..3 * axis + 3] {
                        put(*entry);
                    }
                }
            }
        }
    }
}

impl core::fmt::Debug for FaerCholesky {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("FaerCholesky")
            .field("rows", &(3 * self.node_at.len()))
            .field("values", &self.values.len())
            .field("factor", &self.factor.len())
            .finish_non_exhaustive()
    }
}

/// The lower triangle of the block pattern as a scalar one.
fn scalar_pattern(structure: &Structure) -> SymbolicSparseColMat<usize> {
    let nodes = structure.node_count();
    let mut column_start = Vec::with_capacity(3 * nodes + 1);
    let mut row_index = Vec::with_capacity(6 * nodes + 9 * structure.row.len());
    column_start.push(0);
    for column in 0..nodes {
        for axis in 0..3 {
            row_index.extend(3 * column + axis..3 * column + 3);
            for &row in structure.rows_of(column) {
                row_index.extend(3 * row as usize..3 * row as usize + 3);
            }
            column_start.push(row_index.len());
        }
    }
    SymbolicSparseColMat::new_checked(3 * nodes, 3 * nodes, column_start, None, row_index)
}
