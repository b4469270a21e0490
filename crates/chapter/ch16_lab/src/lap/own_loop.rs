//! A custom loop between any two keyframes of a lap, right or wrong, and where its error goes.
//!
//! The lap itself does not change. A copy of its graph at a tick gets one more edge and is solved under the
//! chosen kernel. The cost of every edge before and after shows which ones give way.

mod request;

use nalgebra::{Matrix3, Vector3};
use pr_geom::{SE2, math};

use super::record::{LapRecord, LapTrace, RecordedEdge};
use super::report::{RecordedLoopAttempt, RecordedLoopEffect};
use super::{Change, Drive, LapConfig};
use ch16_slam2d::chapter::{marginal_information, path_information};
use ch16_slam2d::graph::{EdgeKind, PoseGraph, StopReason};
use ch16_slam2d::loops::{
    GateModel, KeyframeView, LoopCandidate, LoopRejection, LoopVerification, LoopWorkspace,
    chi_squared_gate, verify_loop,
};
use ch16_slam2d::metrics::{position_error_m, rms};
use ch16_slam2d::slam;

pub use request::{Claim, GateUse, OwnKernel, OwnLoopError, OwnLoopRequest};

/// Standard deviation of an asserted loop's position, m: that of a good registration.
const ASSERTED_SIGMA_M: f64 = 0.05;

/// Standard deviation of its heading, rad: 1°.
const ASSERTED_SIGMA_RAD: f64 = core::f64::consts::PI / 180.0;

/// Largest number of reweighting rounds, and the relative change of the weight at which they stop.
const MAX_ROUNDS: usize = 60;
const WEIGHT_TOLERANCE: f64 = 1e-6;

/// Relative increase of the cost that rounding may cause.
const COST_SLACK: f64 = 1e-9;

/// Largest number of solver iterations: a loop far from the truth bends the whole graph.
const MAX_ITERATIONS: usize = 100;

/// The cost of an edge of the graph.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeStrain {
    /// The node in whose frame it was measured.
    pub from: usize,
    /// The node that was measured.
    pub to: usize,
    /// Odometry or loop.
    pub kind: EdgeKind,
    /// `log(Z⁻¹ Tᵢ⁻¹ Tⱼ)`, in m, m, rad: the error of the poses against the measurement.
    pub residual: Vector3<f64>,
    /// `eᵀΩe`.
    pub chi2: f64,
}

/// A custom loop and its effect.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnLoop {
    /// The request.
    pub request: OwnLoopRequest,
    /// The loop with its tests and its effect, as those of the lap.
    pub attempt: RecordedLoopAttempt,
    /// Its edge, closed or not.
    pub edge: RecordedEdge,
    /// Poses of all nodes after closing it, `world_from_body`; the lap's own if it was not closed.
    pub poses: Vec<SE2>,
}

/// The cost of an edge at these poses.
///
/// # Panics
/// If an end has no pose.
#[must_use]
pub fn edge_strain(edge: &RecordedEdge, poses: &[SE2]) -> EdgeStrain {
    let relative = poses[edge.from].between(&poses[edge.to]);
    let residual = edge.measurement.between(&relative).log();
    EdgeStrain {
        from: edge.from,
        to: edge.to,
        kind: edge.kind,
        residual,
        chi2: residual.dot(&(edge.information * residual)),
    }
}

impl OwnLoop {
    /// Whether it was closed.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.attempt.accepted()
    }
}

impl LapRecord {
    /// Adds a custom loop to the graph at a tick and solves it.
    ///
    /// # Errors
    /// If its ends are one keyframe, or one of them does not exist at that tick.
    pub fn own_loop(&self, request: &OwnLoopRequest) -> Result<OwnLoop, OwnLoopError> {
        self.lap.own_loop(request, &self.drive, &self.config)
    }
}

impl LapTrace {
    /// Like [`LapRecord::own_loop`], from the parts of a record: `drive` and `config` are those of the lap.
    ///
    /// # Errors
    /// If its ends are one keyframe, or one of them does not exist at that tick.
    pub fn own_loop(
        &self,
        request: &OwnLoopRequest,
        drive: &Drive,
        config: &LapConfig,
    ) -> Result<OwnLoop, OwnLoopError> {
        Site {
            lap: self,
            drive,
            config,
        }
        .add(request)
    }
}

/// The lap to which the loop is added.
struct Site<'a> {
    lap: &'a LapTrace,
    drive: &'a Drive,
    config: &'a LapConfig,
}

impl Site<'_> {
    fn add(&self, request: &OwnLoopRequest) -> Result<OwnLoop, OwnLoopError> {
        let [a, b] = request.nodes;
        let (old, new) = (a.min(b), a.max(b));
        let newest = self.lap.node_count(request.tick) - 1;
        if new > newest {
            return Err(OwnLoopError::NotYet { node: new, newest });
        }
        if old == new {
            return Err(OwnLoopError::OneNode { node: new });
        }
        let mut graph = self.lap.graph(request.tick);
        let mut verification = self.verify_own(&mut graph, old, new, request);
        if request.gate == GateUse::Bypassed {
            verification.rejection = None;
        }
        let effect = match verification.rejection {
            None => self.close_own(&mut graph, &verification, request),
            Some(rejection) => Err(rejection),
        };
        verification.rejection = effect.as_ref().err().copied();
        Ok(OwnLoop {
            request: *request,
            edge: RecordedEdge {
                tick: request.tick,
                from: old,
                to: new,
                measurement: verification.registered,
                information: verification.information,
                kind: EdgeKind::Loop,
            },
            attempt: RecordedLoopAttempt {
                tick: request.tick,
                verification,
                effect: effect.ok(),
            },
            poses: graph.poses().to_vec(),
        })
    }

    fn verify_own(
        &self,
        graph: &mut PoseGraph,
        old: usize,
        new: usize,
        request: &OwnLoopRequest,
    ) -> LoopVerification {
        let config = &self.config.slam.chapter.loops;
        let gate_information = match config.gate_model {
            GateModel::PathApproximation => Ok(path_information(new - old, config)),
            GateModel::ExactMarginal => marginal_information(graph, old, new),
        };
        let (from, to) = (graph.pose(old), graph.pose(new));
        let predicted = from.between(&to);
        let candidate = LoopCandidate {
            node: old,
            distance_m: position_error_m(&from, &to),
            proposal: None,
        };
        let truth_of = |node: usize| self.lap.keyframes[node].truth;
        let claimed = match request.claim {
            Claim::Registered => {
                let keyframes = self.slam_keyframes(graph.node_count());
                let view = KeyframeView {
                    poses: graph.poses(),
                    keyframes: &keyframes,
                };
                let mut workspace = LoopWorkspace::new(config.matcher.build(&config.submap));
                let frame = self.config.slam.chapter.information_frame;
                return verify_loop(
                    view,
                    new,
                    candidate,
                    gate_information,
                    frame,
                    config,
                    &mut workspace,
                );
            }
            Claim::Truth => truth_of(old).between(&truth_of(new)),
            Claim::SamePlace => SE2::new(0.0, 0.0, predicted.theta()),
        };
        let innovation = predicted.between(&claimed).log();
        let assumed = gate_information.unwrap_or_default();
        let gate = chi_squared_gate(&innovation, &assumed, config.gate_chi2);
        let rejected = (!gate.passes()).then_some(LoopRejection::OutsideGate(gate));
        let (place, turn) = (ASSERTED_SIGMA_M, ASSERTED_SIGMA_RAD);
        let sigmas = Vector3::new(place, place, turn);
        LoopVerification {
            from_node: new,
            candidate,
            predicted,
            initial: predicted,
            registered: claimed,
            rmse_m: f64::NAN,
            inliers: 0,
            iterations: 0,
            score: None,
            margin: None,
            innovation,
            gate_information: assumed,
            gate,
            information: Matrix3::from_diagonal(&sigmas.map(|sigma| 1.0 / (sigma * sigma))),
            waits: None,
            rejection: gate_information
                .err()
                .map(LoopRejection::NoCovariance)
                .or(rejected),
        }
    }

    /// The first keyframes as the estimator stored them.
    fn slam_keyframes(&self, count: usize) -> Vec<slam::Keyframe> {
        let keyframes = self.lap.keyframes[..count].iter();
        let dt_s = self.config.drive.dt_s;
        keyframes
            .map(|keyframe| slam::Keyframe {
                node: keyframe.node,
                frame: keyframe.tick,
                stamp_s: keyframe.tick as f64 * dt_s,
                scan: self.drive.sweep(keyframe.tick).cloud.clone(),
            })
            .collect()
    }

    /// Adds the edge and solves. If that fails or raises the cost, the poses are restored.
    ///
    /// The kernel applies to the loop alone, because odometry has no wrong associations. Its weight `w(s)`
    /// scales the loop's information, the graph is solved, and both repeat until the weight converges.
    fn close_own(
        &self,
        graph: &mut PoseGraph,
        verification: &LoopVerification,
        request: &OwnLoopRequest,
    ) -> Result<RecordedLoopEffect, LoopRejection> {
        let before = graph.poses().to_vec();
        let kernel = request.kernel.kernel();
        let mut loop_chi2 = put(graph, verification, 1.0);
        let chi2_before = graph.chi2();
        let cost_before = chi2_before - loop_chi2 + kernel.cost(loop_chi2);
        let mut iterations = 0;
        let mut rejection = None;
        for _ in 0..MAX_ROUNDS {
            let weight = kernel.weight(loop_chi2);
            graph.pop_edge();
            put(graph, verification, weight);
            let tolerance = self.config.slam.optimizer_tolerance;
            let report = graph.optimize(MAX_ITERATIONS, tolerance);
            iterations += report.iterations;
            graph.pop_edge();
            loop_chi2 = put(graph, verification, 1.0);
            if let stop @ StopReason::Failed { .. } = report.stop {
                rejection = Some(LoopRejection::OptimizationFailed(stop));
            }
            let change = (kernel.weight(loop_chi2) - weight).abs();
            if rejection.is_some() || change <= WEIGHT_TOLERANCE * weight {
                break;
            }
        }
        let chi2_after = graph.chi2();
        let cost = chi2_after - loop_chi2 + kernel.cost(loop_chi2);
        // If the kernel gives the loop almost no weight, the cost changes by rounding only.
        let slack = COST_SLACK * cost_before;
        if rejection.is_none() && (cost > cost_before + slack || cost.is_nan()) {
            rejection = Some(LoopRejection::CostRose {
                before: cost_before,
                after: cost,
            });
        }
        if let Some(rejection) = rejection {
            for (node, pose) in before.iter().enumerate() {
                graph.set_pose(node, *pose);
            }
            return Err(rejection);
        }
        let after = graph.poses();
        let newest = after.len() - 1;
        let rms_m = |poses: &[SE2]| {
            let pairs = poses.iter().zip(&self.lap.keyframes);
            rms(pairs.map(|(pose, keyframe)| position_error_m(pose, &keyframe.truth)))
        };
        let moved = before.iter().zip(after);
        Ok(RecordedLoopEffect {
            correction: after[newest] * before[newest].inverse(),
            max_shift_m: moved
                .map(|(old, new)| position_error_m(new, old))
                .fold(0.0, math::max),
            iterations,
            chi2: Change {
                before: chi2_before,
                after: chi2_after,
            },
            keyframe_rms_m: Change {
                before: rms_m(&before),
                after: rms_m(after),
            },
        })
    }
}

/// Adds the edge of a loop with its information scaled; returns its χ² at the present poses.
fn put(graph: &mut PoseGraph, loop_: &LoopVerification, weight: f64) -> f64 {
    let edge = graph.add_edge(
        loop_.candidate.node,
        loop_.from_node,
        loop_.registered,
        loop_.information * weight,
        EdgeKind::Loop,
    );
    graph.edge_chi2(edge)
}

#[cfg(test)]
mod tests;
