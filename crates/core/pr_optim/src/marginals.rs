//! Exact covariances from the factor of the normal equations.
//!
//! At the optimum the poses' covariance is `Σ = H⁻¹`, to first order, in the tangent space of right
//! perturbations: order x, y, θ, units m² and rad². It is dense and never formed.
//!
//! - The blocks of all nodes, and of the two ends of every measurement, come from the
//!   [selected inverse](SelectedInverse), all at once.
//! - The blocks of any two nodes come from three triangular solves for each, along the paths from
//!   the two to the root of the elimination tree. For a single pair this is cheaper than the
//!   selected inverse, which squares every front, and the nodes need not share a front.
//!
//! Source: Kaess & Dellaert, "Covariance recovery from a square root information matrix for data
//! association", 2009.

use nalgebra::Matrix3;
use pr_geom::SE2;

use crate::block_cholesky::BlockCholesky;
use crate::problem::Problem;
use crate::selected_inverse::SelectedInverse;
use crate::structure::Structure;

/// Covariance blocks of two nodes: `E[δ_a δ_aᵀ]`, `E[δ_a δ_bᵀ]`, `E[δ_b δ_bᵀ]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointCovariance {
    /// The block of the first node.
    pub first: Matrix3<f64>,
    /// The cross block: rows of the first node, columns of the second.
    pub cross: Matrix3<f64>,
    /// The block of the second node.
    pub second: Matrix3<f64>,
}

impl JointCovariance {
    /// Covariance of the relative pose `T_a⁻¹ T_b`, in the tangent space at that pose.
    ///
    /// Perturbing both poses changes the relative pose by `δ = δ_b − A δ_a`, `A = Ad((T_a⁻¹T_b)⁻¹)`. Its
    /// covariance is `Σ = Σ_bb + A Σ_aa Aᵀ − A Σ_ab − (A Σ_ab)ᵀ`. Solà, Deray, Atchuthan 2018, eq. (62) and (65).
    #[must_use]
    pub fn relative(&self, first: &SE2, second: &SE2) -> Matrix3<f64> {
        let adjoint = second.between(first).adjoint();
        let cross = adjoint * self.cross;
        self.second + adjoint * self.first * adjoint.transpose() - cross - cross.transpose()
    }
}

/// Covariance blocks of two nodes; `cholesky` has factorized H without damping.
///
/// `Σ_ab = (L⁻¹E_a)ᵀ (L⁻¹E_b)`, with `E_a` the three unit columns of node `a`. `L⁻¹E_a` has entries only on the
/// path from `a` to the root, so only those are solved for. A fixed node has no uncertainty: its blocks are zero.
pub(crate) fn joint_covariance(
    structure: &Structure,
    fixed: &[bool],
    cholesky: &mut BlockCholesky,
    nodes: [usize; 2],
) -> JointCovariance {
    let positions = nodes.map(|node| structure.position_of[node] as usize);
    let supernodes = cholesky.supernodes();
    let mut path: Vec<usize> = positions
        .iter()
        .flat_map(|&position| supernodes.path_to_root(supernodes.holding(position)))
        .collect();
    path.sort_unstable();
    path.dedup();
    let ones = core::array::from_fn(|side| {
        (!fixed[nodes[side / 3]]).then_some(3 * positions[side / 3] + side % 3)
    });
    let products = cholesky.gram_along(&path, ones);
    let block =
        |at: [usize; 2]| Matrix3::from_fn(|row, column| products[at[0] + row][at[1] + column]);
    JointCovariance {
        first: block([0, 0]),
        cross: block([0, 3]),
        second: block([3, 3]),
    }
}

/// The covariance block of every node, by node, from the selected inverse of the factor.
pub(crate) fn all_marginals(
    structure: &Structure,
    fixed: &[bool],
    cholesky: &BlockCholesky,
) -> Vec<Matrix3<f64>> {
    let inverse = SelectedInverse::new(cholesky);
    (0..structure.node_count())
        .map(|node| block_of(&inverse, structure, fixed, [node, node]))
        .collect()
}

/// Covariance blocks of the ends of every measurement, from the selected inverse of the factor.
pub(crate) fn all_measured(
    structure: &Structure,
    problem: &Problem,
    cholesky: &BlockCholesky,
) -> Vec<JointCovariance> {
    let inverse = SelectedInverse::new(cholesky);
    let block = |nodes| block_of(&inverse, structure, problem.fixed(), nodes);
    problem
        .factors()
        .iter()
        .map(|factor| JointCovariance {
            first: block([factor.from, factor.from]),
            cross: block([factor.from, factor.to]),
            second: block([factor.to, factor.to]),
        })
        .collect()
}

/// The block of a node, or of two nodes with a measurement between them; zero if one is fixed.
fn block_of(
    inverse: &SelectedInverse,
    structure: &Structure,
    fixed: &[bool],
    nodes: [usize; 2],
) -> Matrix3<f64> {
    if nodes.iter().any(|&node| fixed[node]) {
        return Matrix3::zeros();
    }
    inverse
        .block(nodes.map(|node| structure.position_of[node] as usize))
        .expect("the factor has a block where H has one")
}
