//! Verification of a loop: whether the sweeps of two keyframes agree, and the tests of the result.

use nalgebra::{Matrix3, Vector3};
use pr_geom::SE2;
use pr_optim::{OptimizeError, StopReason};
use serde::{Deserialize, Serialize};

use super::gate::{GateTest, chi_squared_gate};
use super::{LoopCandidate, LoopConfig};
use crate::cloud::PointCloud;
use crate::graph::{Keyframe, LoopId};
use crate::icp::{INFORMATION_RIDGE, Pair, regularize};
use crate::matching::{
    InformationFrame, MatchRequest, MatchStop, MatchSummary, Matcher, chapter_information,
};

/// Why a loop was rejected, with the measured value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LoopRejection {
    /// The sweeps do not fit.
    PoorFit {
        /// Root mean square distance of the pairs, m.
        rmse_m: f64,
        /// The largest that is accepted.
        max_rmse_m: f64,
    },
    /// Too few points are paired.
    FewInliers {
        /// Pairs of the registration.
        inliers: usize,
        /// The fewest that are accepted.
        min_inliers: usize,
    },
    /// The registration has no result: its pose is the guess.
    NotRegistered(MatchStop),
    /// Too little of the sweep fits.
    LowScore {
        /// The matcher's score.
        score: f64,
        /// The lowest that is accepted.
        min_score: f64,
    },
    /// No pose of the searched window fits.
    NoPlace {
        /// Half of the window's width, m.
        half_width_m: f64,
        /// The smallest accepted score.
        min_score: f64,
    },
    /// Another pose fits about as well.
    Ambiguous {
        /// Margin to the best distinct pose, in the unit of the matcher's score.
        margin: f64,
        /// The smallest that is accepted.
        min_margin: f64,
    },
    /// The innovation is larger than the drift explains.
    OutsideGate(GateTest),
    /// The graph has no covariance for the test.
    NoCovariance(OptimizeError),
    /// It passed, but the outlier test over all loops dropped it.
    Outlier,
    /// It passed, but the graph could not be optimized with it, so it was reverted.
    OptimizationFailed(StopReason),
    /// It passed, but the optimization raised the robust cost, so it was reverted.
    CostRose {
        /// `Σ ρ(eᵀΩe)` with the loop, before the optimization.
        before: f64,
        /// `Σ ρ(eᵀΩe)` after the optimization.
        after: f64,
    },
}

impl LoopRejection {
    /// The reason in a word or two, for tables.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::PoorFit { .. } => "RMSE",
            Self::FewInliers { .. } => "inliers",
            Self::NotRegistered(_) => "not registered",
            Self::LowScore { .. } => "score",
            Self::NoPlace { .. } => "no place",
            Self::Ambiguous { .. } => "ambiguous",
            Self::OutsideGate(_) => "gate",
            Self::NoCovariance(_) => "no covariance",
            Self::Outlier => "outlier",
            Self::OptimizationFailed(_) => "no optimum",
            Self::CostRose { .. } => "cost rose",
        }
    }
}

impl core::fmt::Display for LoopRejection {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::PoorFit { rmse_m, max_rmse_m } => {
                write!(
                    f,
                    "the inliers' RMSE is {rmse_m:.3} m, above {max_rmse_m:.3} m"
                )
            }
            Self::FewInliers {
                inliers,
                min_inliers,
            } => write!(f, "{inliers} inliers, at least {min_inliers} are needed"),
            Self::NotRegistered(stop) => write!(f, "not registered: {stop}"),
            Self::LowScore { score, min_score } => {
                write!(
                    f,
                    "a score of {score:.2}, at least {min_score:.2} is needed"
                )
            }
            Self::NoPlace {
                half_width_m,
                min_score,
            } => write!(
                f,
                "no pose within {half_width_m:.1} m has a score of at least {min_score:.2}"
            ),
            Self::Ambiguous { margin, min_margin } => write!(
                f,
                "ambiguous: the margin over the next best pose is {margin:.2}, at least {min_margin:.2} is needed"
            ),
            Self::OutsideGate(gate) => {
                write!(
                    f,
                    "chi-squared {:.1} is above {:.1}",
                    gate.chi2, gate.gate_chi2
                )
            }
            Self::NoCovariance(error) => write!(f, "the graph has no covariance: {error}"),
            Self::Outlier => write!(f, "the graph and the other loops contradict it"),
            Self::OptimizationFailed(stop) => {
                write!(f, "the graph cannot be optimized with it: {stop}")
            }
            Self::CostRose { before, after } => {
                write!(f, "the cost rose from {before:.1} to {after:.1}")
            }
        }
    }
}

/// Agreement of a loop that passed its own tests with others; it waits until enough confirm it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Agreement {
    /// Number of loops that agree, including itself.
    pub agreeing: usize,
    /// Required number.
    pub needed: usize,
}

impl core::fmt::Display for Agreement {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { agreeing, needed } = self;
        write!(f, "pending: {agreeing} loops agree, {needed} are needed")
    }
}

/// A verified loop: the registration and the results of the tests.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LoopVerification {
    /// The new node.
    pub from_node: usize,
    /// The old node.
    pub candidate: LoopCandidate,
    /// `candidate_from_new` by the graph, T₀: the reference of the gate.
    pub predicted: SE2,
    /// `candidate_from_new` at the start of the registration: the candidate's proposal, or T₀.
    pub initial: SE2,
    /// `candidate_from_new` by the registration, T̂.
    pub registered: SE2,
    /// Root mean square distance of the pairs, m.
    pub rmse_m: f64,
    /// Pairs of the registration.
    pub inliers: usize,
    /// Iterations of the registration.
    pub iterations: usize,
    /// The matcher's score, if it has one.
    pub score: Option<f64>,
    /// Margin to the best distinct pose, in the unit of the matcher's score, within the searched range;
    /// `None` if there was no search.
    pub margin: Option<f64>,
    /// `log(T₀⁻¹ T̂)`, in m, m, rad.
    pub innovation: Vector3<f64>,
    /// The information that the gate assumed for the innovation, S⁻¹; zero if the graph has none.
    pub gate_information: Matrix3<f64>,
    /// Result of the gate.
    pub gate: GateTest,
    /// Information of the loop edge.
    pub information: Matrix3<f64>,
    /// Why it was rejected. Not serialized: a pending loop has none.
    #[serde(skip)]
    pub rejection: Option<LoopRejection>,
    /// What it waits for, if it passed its own tests and needs others to confirm it.
    #[serde(skip)]
    pub waits: Option<Agreement>,
}

impl LoopVerification {
    /// The same loop, with `chi2` of another gate in place of that of its own.
    pub(crate) fn with_gate_chi2(mut self, chi2: f64) -> Self {
        self.gate.chi2 = chi2;
        if matches!(
            self.rejection,
            None | Some(LoopRejection::OutsideGate(_) | LoopRejection::NoCovariance(_))
        ) {
            self.rejection = (!self.gate.passes()).then_some(LoopRejection::OutsideGate(self.gate));
        }
        self
    }

    /// Whether all tests passed, and it waits for nothing.
    #[must_use]
    pub fn accepted(&self) -> bool {
        self.rejection.is_none() && self.waits.is_none()
    }

    /// Why it is not in the graph; `None` if it was accepted.
    #[must_use]
    pub fn reason(&self) -> Option<String> {
        let rejected = self.rejection.map(|rejection| rejection.to_string());
        rejected.or_else(|| self.waits.map(|agreement| agreement.to_string()))
    }

    /// The loop by its keyframes.
    #[must_use]
    pub fn id(&self) -> LoopId {
        LoopId {
            old: self.candidate.node,
            new: self.from_node,
        }
    }

    /// Nodes between the two ends.
    #[must_use]
    pub fn gap(&self) -> usize {
        self.from_node - self.candidate.node
    }
}

/// The graph and the sweeps for [`verify_loop`].
#[derive(Clone, Copy)]
pub struct KeyframeView<'a> {
    /// Poses of all nodes in the graph, `world_from_body`.
    pub poses: &'a [SE2],
    /// The keyframes with their thinned scans, by node.
    pub keyframes: &'a [Keyframe],
}

/// The memory of [`verify_loop`], reused between attempts.
#[derive(Clone)]
pub struct LoopWorkspace {
    world: PointCloud,
    submap: PointCloud,
    matcher: Box<dyn Matcher>,
    pairs: Vec<Pair>,
}

impl LoopWorkspace {
    /// A workspace that registers with `matcher`.
    #[must_use]
    pub fn new(matcher: Box<dyn Matcher>) -> Self {
        Self {
            world: PointCloud::default(),
            submap: PointCloud::default(),
            matcher,
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

    /// Builds the submap around `candidate` in its frame.
    fn build_submap(&mut self, view: KeyframeView<'_>, candidate: usize, half_width: usize) {
        let first = candidate.saturating_sub(half_width);
        let last = (candidate + half_width).min(view.poses.len() - 1);
        self.world.clear();
        for near in first..=last {
            self.world
                .extend_transformed(&view.keyframes[near].scan, &view.poses[near]);
        }
        // Through the world frame, not by relative poses: the beams straight ahead and abeam of the
        // candidate lie on the edge of a cell, and their last bits decide which cell they belong to.
        self.submap.clear();
        self.submap
            .extend_transformed(&self.world, &view.poses[candidate].inverse());
        self.matcher.set_target(&self.submap);
    }
}

/// Registers the sweep of `node` on the submap around `candidate` and tests the result.
///
/// The submap is built in the candidate's frame from the keyframes around it; registration starts
/// at the candidate's proposal, or at the graph's relative pose. `gate_information` is the S⁻¹ of the
/// gate: that of [`path_information`](crate::chapter::path_information), or the graph's own; an error rejects
/// the loop.
#[must_use]
pub fn verify_loop(
    view: KeyframeView<'_>,
    node: usize,
    candidate: LoopCandidate,
    gate_information: Result<Matrix3<f64>, OptimizeError>,
    frame: InformationFrame,
    config: &LoopConfig,
    workspace: &mut LoopWorkspace,
) -> LoopVerification {
    workspace.build_submap(view, candidate.node, config.submap_half_width);
    let center = view.poses[candidate.node];
    let predicted = center.between(&view.poses[node]);
    let initial = candidate.proposal.unwrap_or(predicted);
    let tau_m = (config.radius_m / 2.0).max(config.min_tau_m);
    let answer = workspace.matcher.register(
        &view.keyframes[node].scan,
        &MatchRequest::new(initial, tau_m, config.max_iterations).with_min_score(config.min_score),
    );
    let information = match frame {
        InformationFrame::Chapter => {
            chapter_information(&answer.pairs, center.theta(), &config.trust)
        }
        InformationFrame::Exact => answer.information(&config.trust),
    };
    let found = answer.summary;
    workspace.pairs = answer.pairs;
    let innovation = predicted.between(&found.pose).log();
    let assumed = gate_information.unwrap_or_default();
    let gate = chi_squared_gate(&innovation, &assumed, config.gate_chi2);
    LoopVerification {
        from_node: node,
        candidate,
        predicted,
        initial,
        registered: found.pose,
        rmse_m: found.rmse_m,
        inliers: found.inliers,
        iterations: found.iterations,
        score: found.score,
        margin: found.margin(),
        innovation,
        gate_information: assumed,
        gate,
        information: regularize(information, INFORMATION_RIDGE, config.trust.information_cap),
        rejection: rejection(&found, gate, config)
            .or(gate_information.err().map(LoopRejection::NoCovariance)),
        waits: None,
    }
}

fn rejection(found: &MatchSummary, gate: GateTest, config: &LoopConfig) -> Option<LoopRejection> {
    if found.rmse_m > config.max_rmse_m || found.rmse_m.is_nan() {
        Some(LoopRejection::PoorFit {
            rmse_m: found.rmse_m,
            max_rmse_m: config.max_rmse_m,
        })
    } else if found.inliers < config.min_inliers {
        Some(LoopRejection::FewInliers {
            inliers: found.inliers,
            min_inliers: config.min_inliers,
        })
    } else if !found.stop.is_supported() {
        Some(LoopRejection::NotRegistered(found.stop))
    } else if let Some(score) = found.score
        && score < config.min_score
    {
        Some(LoopRejection::LowScore {
            score,
            min_score: config.min_score,
        })
    } else if !gate.passes() {
        Some(LoopRejection::OutsideGate(gate))
    } else {
        None
    }
}
