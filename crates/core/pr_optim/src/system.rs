//! The normal equations `H δ = −g` as 3×3 blocks, assembled factor by factor.

use pr_geom::SE2;

use crate::factor::{JacobianModel, Linearization, PreparedPose};
use crate::kernel::RobustKernel;
use crate::problem::Problem;
use crate::structure::{FactorSlot, Structure};

/// A 3×3 block, column-major.
pub type Block = [f64; 9];

/// Normal equations in the block pattern and elimination order of a [`Structure`].
#[derive(Clone, Debug, Default)]
pub struct NormalEquations {
    /// Diagonal blocks, full and symmetric, by elimination position.
    pub diagonal: Vec<Block>,
    /// Off-diagonal blocks by slot; rows belong to the node that is eliminated later.
    pub lower: Vec<Block>,
    /// `g = JᵀΩe`, half of the derivative of the cost, three entries per elimination position.
    pub gradient: Vec<f64>,
    /// `Σ eᵀΩe` at the poses of the assembly, kernel not applied.
    pub chi2: f64,
    /// `Σ ρ(eᵀΩe)`, the minimized cost.
    pub cost: f64,
    poses: Vec<PreparedPose>,
}

impl NormalEquations {
    /// Linearizes every factor of `problem` at its present poses and adds up the blocks.
    ///
    /// With a kernel every factor's Ω is multiplied by its weight. `ridge` is added to every diagonal
    /// entry. Fixed nodes get an identity block, plus `ridge`.
    pub fn assemble(
        &mut self,
        problem: &Problem,
        structure: &Structure,
        model: JacobianModel,
        kernel: RobustKernel,
        ridge: f64,
    ) {
        self.clear(structure, ridge);
        self.add_up(problem, structure, model, kernel, Self::add_blocks);
        self.hold_fixed(problem, structure, ridge);
    }

    /// [`assemble`](Self::assemble) of the gradient alone; the blocks are unchanged.
    pub(crate) fn assemble_gradient(
        &mut self,
        problem: &Problem,
        structure: &Structure,
        model: JacobianModel,
        kernel: RobustKernel,
    ) {
        self.clear_gradient(structure);
        self.add_up(problem, structure, model, kernel, |_, _, _, _, _| {});
        self.hold_gradient(problem, structure);
    }

    /// Linearizes every factor and adds up gradient and cost; `add_blocks` does the rest.
    #[inline]
    fn add_up(
        &mut self,
        problem: &Problem,
        structure: &Structure,
        model: JacobianModel,
        kernel: RobustKernel,
        add_blocks: impl Fn(&mut Self, &Linearization, usize, usize, FactorSlot),
    ) {
        self.prepare(problem.poses());
        for ((factor, prepared), slot) in problem
            .factors()
            .iter()
            .zip(problem.prepared())
            .zip(&structure.factor_slots)
        {
            let part = prepared.linearize(
                &self.poses[factor.from],
                &self.poses[factor.to],
                model,
                kernel,
            );
            self.chi2 += part.squared_norm;
            self.cost += kernel.cost(part.squared_norm);
            let from = structure.position_of[factor.from] as usize;
            let to = structure.position_of[factor.to] as usize;
            for axis in 0..3 {
                self.gradient[3 * from + axis] += part.gradient_from[axis];
                self.gradient[3 * to + axis] += part.gradient_to[axis];
            }
            add_blocks(self, &part, from, to, *slot);
        }
    }

    /// `Σ ρ(eᵀΩe)` at other poses of the same graph; the blocks are unchanged.
    ///
    /// Not finite if `Σ eᵀΩe` is not: no step can be computed there, even if the kernel bounds the cost.
    pub fn cost_at(&mut self, problem: &Problem, poses: &[SE2], kernel: RobustKernel) -> f64 {
        self.prepare(poses);
        let (cost, chi2) = problem.cost_and_chi2_at(&self.poses, kernel);
        if chi2.is_finite() { cost } else { chi2 }
    }

    /// Fills the workspace of poses with their sines and cosines; unchanged headings keep theirs.
    fn prepare(&mut self, poses: &[SE2]) {
        let kept = self.poses.len().min(poses.len());
        self.poses.truncate(kept);
        for (prepared, pose) in self.poses.iter_mut().zip(poses) {
            if prepared.theta.to_bits() == pose.theta().to_bits() {
                (prepared.x, prepared.y) = (pose.x(), pose.y());
            } else {
                *prepared = PreparedPose::new(pose);
            }
        }
        self.poses
            .extend(poses[kept..].iter().map(PreparedPose::new));
    }

    /// The poses of the last assembly or cost, with their sines and cosines.
    pub(crate) fn prepared_poses(&self) -> &[PreparedPose] {
        &self.poses
    }

    /// `vᵀDv` with the diagonal entries D of H, `vector` in elimination order.
    pub(crate) fn diagonal_square(&self, vector: &[f64]) -> f64 {
        self.diagonal
            .iter()
            .zip(vector.chunks_exact(3))
            .map(|(block, v)| {
                block[0] * v[0] * v[0] + block[4] * v[1] * v[1] + block[8] * v[2] * v[2]
            })
            .sum()
    }

    /// Empties the blocks; every diagonal entry becomes `ridge`.
    pub(crate) fn clear(&mut self, structure: &Structure, ridge: f64) {
        let nodes = structure.node_count();
        self.diagonal.clear();
        self.diagonal
            .resize(nodes, [ridge, 0.0, 0.0, 0.0, ridge, 0.0, 0.0, 0.0, ridge]);
        self.lower.clear();
        self.lower.resize(structure.row.len(), [0.0; 9]);
        self.clear_gradient(structure);
    }

    fn clear_gradient(&mut self, structure: &Structure) {
        self.gradient.clear();
        self.gradient.resize(3 * structure.node_count(), 0.0);
        self.chi2 = 0.0;
        self.cost = 0.0;
    }

    #[inline]
    fn add_blocks(&mut self, part: &Linearization, from: usize, to: usize, slot: FactorSlot) {
        add_symmetric(&mut self.diagonal[from], &part.from_from);
        add_symmetric(&mut self.diagonal[to], &part.to_to);
        self.add_off_diagonal(slot, &part.to_from);
    }

    /// Adds a block whose rows belong to the pose that was measured, `to`.
    #[inline]
    pub(crate) fn add_off_diagonal(&mut self, slot: FactorSlot, to_from: &Block) {
        if slot.slot == FactorSlot::NONE {
            return;
        }
        let block = &mut self.lower[slot.slot as usize];
        if slot.transposed {
            for column in 0..3 {
                for row in 0..3 {
                    block[3 * column + row] += to_from[3 * row + column];
                }
            }
        } else {
            for (sum, entry) in block.iter_mut().zip(to_from) {
                *sum += entry;
            }
        }
    }

    /// Gives every fixed node an identity block, plus `ridge`, and zero gradient, so that it does not move.
    pub(crate) fn hold_fixed(&mut self, problem: &Problem, structure: &Structure, ridge: f64) {
        let one = 1.0 + ridge;
        for position in fixed_positions(problem, structure) {
            self.diagonal[position] = [one, 0.0, 0.0, 0.0, one, 0.0, 0.0, 0.0, one];
        }
        self.hold_gradient(problem, structure);
    }

    fn hold_gradient(&mut self, problem: &Problem, structure: &Structure) {
        for position in fixed_positions(problem, structure) {
            self.gradient[3 * position..3 * position + 3].fill(0.0);
        }
    }
}

/// Positions of the fixed nodes in the elimination order.
fn fixed_positions(problem: &Problem, structure: &Structure) -> impl Iterator<Item = usize> {
    let nodes = problem.fixed().iter().zip(&structure.position_of);
    nodes
        .filter(|(fixed, _)| **fixed)
        .map(|(_, &position)| position as usize)
}

#[inline]
fn add_symmetric(block: &mut Block, upper: &[f64; 6]) {
    let [xx, xy, xt, yy, yt, tt] = *upper;
    for (sum, entry) in block.iter_mut().zip([xx, xy, xt, xy, yy, yt, xt, yt, tt]) {
        *sum += entry;
    }
}
