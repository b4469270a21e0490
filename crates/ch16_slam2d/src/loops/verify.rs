//! Whether the sweeps of two keyframes agree, and what the tests say of it.

use nalgebra::{Matrix3, Vector3};
use pr_geom::SE2;

use super::gate::{GateTest, chi_squared_gate};
use super::{LoopCandidate, LoopConfig, MapConfig};
use crate::cloud::{DenseMap, PointCloud};
use crate::icp::{
    INFORMATION_CAP, INFORMATION_RIDGE, Icp, IcpConfig, IcpVariant, IcpWorkspace, Pair,
    icp_information_along, regularize,
};

/// Why a loop was turned away, with what was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LoopRejection {
    /// The sweeps do not fit.
    PoorFit {
        /// Root mean square distance of the pairs, m.
        rmse_m: f64,
        /// The largest that is accepted.
        max_rmse_m: f64,
    },
    /// Too few points take part.
    FewInliers {
        /// Pairs of the registration.
        inliers: usize,
        /// The fewest that are accepted.
        min_inliers: usize,
    },
    /// The innovation is larger than the drift explains.
    OutsideGate(GateTest),
}

/// A verified loop: what the registration found and what the tests say of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopVerification {
    /// The new node.
    pub from_node: usize,
    /// The old node.
    pub candidate: LoopCandidate,
    /// `candidate_from_new` by the graph, T₀.
    pub initial: SE2,
    /// `candidate_from_new` by the registration, T̂.
    pub registered: SE2,
    /// Root mean square distance of the pairs, m.
    pub rmse_m: f64,
    /// Pairs of the registration.
    pub inliers: usize,
    /// Iterations of the registration.
    pub iterations: usize,
    /// `log(T₀⁻¹ T̂)`, in m, m, rad.
    pub innovation: Vector3<f64>,
    /// The information that the gate assumed of the innovation, S⁻¹.
    pub gate_information: Matrix3<f64>,
    /// The gate's verdict.
    pub gate: GateTest,
    /// Information of the loop edge, should it be added.
    pub information: Matrix3<f64>,
    /// Why it was turned away; none where it was accepted.
    pub rejection: Option<LoopRejection>,
}

impl LoopVerification {
    /// Whether all three tests were passed.
    #[must_use]
    pub fn accepted(&self) -> bool {
        self.rejection.is_none()
    }

    /// Nodes between the two ends.
    #[must_use]
    pub fn gap(&self) -> usize {
        self.from_node - self.candidate.node
    }
}

/// The graph and the sweeps as [`verify_loop`] needs them.
#[derive(Clone, Copy)]
pub struct KeyframeView<'a> {
    /// Poses of all nodes in the graph, `world_from_body`.
    pub poses: &'a [SE2],
    /// The thinned sweep of every node with its normals, sensor frame.
    pub clouds: &'a [&'a PointCloud],
}

/// The memory of [`verify_loop`], kept between attempts.
#[derive(Clone)]
pub struct LoopWorkspace {
    world: PointCloud,
    submap: PointCloud,
    map: DenseMap,
    icp: IcpWorkspace,
    pairs: Vec<Pair>,
}

impl LoopWorkspace {
    /// A workspace for submaps of this make.
    #[must_use]
    pub fn new(submap: &MapConfig) -> Self {
        Self {
            world: PointCloud::default(),
            submap: PointCloud::default(),
            map: DenseMap::new(submap.cell_m, submap.max_per_cell),
            icp: IcpWorkspace::new(),
            pairs: Vec::new(),
        }
    }

    /// The submap of the last attempt in the candidate's frame.
    #[must_use]
    pub fn submap(&self) -> &PointCloud {
        &self.submap
    }

    /// The last pairs of the last attempt, in the candidate's frame, with normals.
    #[must_use]
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }
}

/// Registers the sweep of `node` on the submap around `candidate` and tests the result.
///
/// The submap is built in the candidate's frame from the keyframes around it; registration starts
/// at the graph's relative pose. `gate_information` is the S⁻¹ of the gate: that of
/// [`path_information`](super::path_information), or the graph's own.
#[must_use]
pub fn verify_loop(
    keyframes: KeyframeView<'_>,
    node: usize,
    candidate: LoopCandidate,
    gate_information: &Matrix3<f64>,
    config: &LoopConfig,
    workspace: &mut LoopWorkspace,
) -> LoopVerification {
    let center = keyframes.poses[candidate.node];
    let first = candidate.node.saturating_sub(config.submap_half_width);
    let last = (candidate.node + config.submap_half_width).min(keyframes.poses.len() - 1);
    workspace.world.clear();
    for near in first..=last {
        workspace
            .world
            .extend_transformed(keyframes.clouds[near], &keyframes.poses[near]);
    }
    // Through the world frame, not by relative poses: the beams straight ahead and abeam of the
    // candidate lie on an edge of a cell, and their last bits decide which cell they fill.
    workspace.submap.clear();
    workspace
        .submap
        .extend_transformed(&workspace.world, &center.inverse());
    workspace.map.rebuild(&workspace.submap);

    let initial = center.between(&keyframes.poses[node]);
    let registration = IcpConfig {
        variant: IcpVariant::PointToPoint,
        max_iters: config.max_iterations,
        tau: (config.radius_m / 2.0).max(config.min_tau_m),
        ..IcpConfig::default()
    };
    let summary = Icp::new(
        keyframes.clouds[node],
        &workspace.map,
        initial,
        &registration,
        &mut workspace.icp,
    )
    .run();
    workspace.pairs.clear();
    workspace.pairs.extend(workspace.icp.pairs(&workspace.map));
    let information = icp_information_along(
        &workspace.pairs,
        config.trust.sigma_m,
        config.trust.inflate,
        center.theta(),
    );

    let innovation = initial.between(&summary.pose).log();
    let gate = chi_squared_gate(&innovation, gate_information, config.gate_chi2);
    LoopVerification {
        from_node: node,
        candidate,
        initial,
        registered: summary.pose,
        rmse_m: summary.rmse,
        inliers: summary.inliers,
        iterations: summary.iterations,
        innovation,
        gate_information: *gate_information,
        gate,
        information: regularize(information, INFORMATION_RIDGE, INFORMATION_CAP),
        rejection: rejection(summary.rmse, summary.inliers, gate, config),
    }
}

fn rejection(
    rmse_m: f64,
    inliers: usize,
    gate: GateTest,
    config: &LoopConfig,
) -> Option<LoopRejection> {
    if rmse_m > config.max_rmse_m {
        Some(LoopRejection::PoorFit {
            rmse_m,
            max_rmse_m: config.max_rmse_m,
        })
    } else if inliers < config.min_inliers {
        Some(LoopRejection::FewInliers {
            inliers,
            min_inliers: config.min_inliers,
        })
    } else if !gate.passes() {
        Some(LoopRejection::OutsideGate(gate))
    } else {
        None
    }
}
