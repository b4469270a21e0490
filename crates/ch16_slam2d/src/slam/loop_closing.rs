//! The back end: candidates are verified in order, and the first that passes corrects the graph.

use nalgebra::{Matrix3, Vector3};
use pr_geom::SE2;
use pr_optim::OptimizeError;

use super::pending::PendingFrame;
use super::{Change, LoopAttempt, LoopClosure, LoopEffect, Slam};
use crate::graph::EdgeKind;
use crate::loops::{
    GateModel, KeyframeView, LoopCandidate, LoopQuery, LoopRejection, LoopVerification,
    marginal_information, path_information, verify_loop,
};
use crate::metrics::position_error_m;

impl Slam {
    /// Second part: looks for loops at a new keyframe and verifies the candidates in order, until
    /// one passes or the limit is reached.
    pub fn verify_loops(&mut self, pending: &mut PendingFrame) {
        let Some(node) = pending.new_keyframe else {
            return;
        };
        // The first keyframe has none before it, and does not count as an attempt.
        if self.config.loop_closure == LoopClosure::Off || node == 0 {
            return;
        }
        let loops = self.config.loops;
        if let Some(last) = self.last_attempt_node
            && node - last < loops.attempt_every_nodes
            && !self.is_waiting(node)
        {
            return;
        }
        self.last_attempt_node = Some(node);
        if self.submap_loops.is_some() {
            self.verify_on_submaps(node, pending);
            return;
        }
        let mut query = LoopQuery::new(&mut self.graph, &self.keyframes);
        let mut candidates = self.detector.detect(&mut query);
        candidates.retain(|candidate| candidate.node < node);
        for candidate in candidates.into_iter().take(loops.candidates_tried) {
            let verification = self.verify(node, candidate);
            let verification = self.guarded(verification);
            // The whole window is searched once at a node, if it tells anything new.
            let is_settled = verification.margin.is_some()
                || matches!(verification.rejection, Some(LoopRejection::Waiting { .. }));
            if self.report_attempt(verification, pending) || is_settled {
                return;
            }
        }
        if let Some(wide) = self.search_that_is_due(node) {
            for found in self.search_widely(node, &wide) {
                self.report_attempt(found, pending);
            }
        }
    }

    /// Adds an attempt to the frame's report; whether it was accepted.
    pub(super) fn report_attempt(
        &self,
        verification: LoopVerification,
        pending: &mut PendingFrame,
    ) -> bool {
        let is_accepted = verification.accepted();
        pending.loop_attempts.push(LoopAttempt {
            frame: self.frames - 1,
            verification,
            effect: None,
        });
        is_accepted
    }

    /// Length of the way of the keyframes since the last loop, m.
    pub(super) fn way_since_loop_m(&self, node: usize) -> f64 {
        self.way_between_m(self.last_loop_node, node)
    }

    /// The S⁻¹ of the gate between two nodes.
    pub(super) fn gate_information(
        &mut self,
        node: usize,
        candidate: usize,
    ) -> Result<Matrix3<f64>, OptimizeError> {
        let loops = &self.config.loops;
        let information = match loops.gate_model {
            GateModel::PathApproximation => path_information(node - candidate, loops),
            GateModel::ExactMarginal => marginal_information(&mut self.graph, candidate, node)?,
        };
        if self.config.loops.drift_share == 0.0 {
            return Ok(information);
        }
        let drift_m = 0.5 * self.config.loops.drift_share * self.way_since_loop_m(node);
        let drift = Matrix3::from_diagonal(&Vector3::new(drift_m, drift_m, 0.0).map(|s| s * s));
        let covariance = information.try_inverse().unwrap_or_default() + drift;
        covariance
            .try_inverse()
            .ok_or(OptimizeError::NotPositiveDefinite { node })
    }

    /// Third part: adds the edge of a loop that passed and spreads the correction; takes it back where
    /// the graph does not bear it.
    pub fn close_loop(&mut self, pending: &mut PendingFrame) {
        let Some(attempt) = pending.loop_attempts.last_mut() else {
            return;
        };
        if !attempt.verification.accepted() {
            return;
        }
        match self.optimize_with(&attempt.verification) {
            Ok(effect) => attempt.effect = Some(effect),
            Err(rejection) => attempt.verification.rejection = Some(rejection),
        }
    }

    pub(super) fn verify(&mut self, node: usize, candidate: LoopCandidate) -> LoopVerification {
        let gate_information = self.gate_information(node, candidate.node);
        let loops = &self.config.loops;
        let view = KeyframeView {
            poses: self.graph.poses(),
            keyframes: &self.keyframes,
        };
        verify_loop(
            view,
            node,
            candidate,
            gate_information,
            self.config.information_frame,
            loops,
            &mut self.loop_workspace,
        )
    }

    pub(super) fn optimize_with(
        &mut self,
        verification: &LoopVerification,
    ) -> Result<LoopEffect, LoopRejection> {
        let poses_before = self.graph.poses().to_vec();
        self.graph.add_edge(
            verification.candidate.node,
            verification.from_node,
            verification.registered,
            verification.information * self.config.confidence,
            EdgeKind::Loop,
        );
        let chi2_before = self.graph.chi2();
        let (iterations, correction) = if self.can_wait() {
            (0, SE2::identity())
        } else {
            self.correct_graph(&poses_before)?
        };
        self.chi2 = self.graph.chi2();
        self.last_loop_node = verification.from_node;
        self.held.clear();
        let max_shift_m = poses_before
            .iter()
            .zip(self.graph.poses())
            .map(|(old, new)| position_error_m(new, old))
            .fold(0.0, f64::max);
        Ok(LoopEffect {
            correction,
            max_shift_m,
            iterations,
            chi2: Change {
                before: chi2_before,
                after: self.chi2,
            },
            poses_before,
        })
    }

    /// Whether the graph is nearly where its loops would have it, so that the next one may correct it.
    fn can_wait(&mut self) -> bool {
        let least = self.config.least_correction;
        let mut largest_move = || self.graph.largest_move_since();
        least > 0.0 && largest_move().is_ok_and(|largest| largest < least)
    }

    /// Optimizes the graph with its newest edge, a loop, and takes the estimate along: the iterations, and the
    /// newest node's pose ∘ that before, inverted.
    ///
    /// # Errors
    /// Where that fails: the edge is gone then, and the nodes are where they were.
    fn correct_graph(&mut self, poses_before: &[SE2]) -> Result<(usize, SE2), LoopRejection> {
        let settled = self.graph.settled_edges();
        let report = self.graph.optimize_robust(
            self.config.optimizer_iterations,
            self.config.optimizer_tolerance,
            self.config.huber,
        );
        let cost_before = report
            .steps
            .first()
            .map_or(report.cost, |step| step.cost_before);
        let rejection = match report.stop {
            stop @ pr_optim::StopReason::Failed { .. } => {
                Some(LoopRejection::OptimizationFailed(stop))
            }
            _ if report.cost > cost_before || report.cost.is_nan() => {
                Some(LoopRejection::CostRose {
                    before: cost_before,
                    after: report.cost,
                })
            }
            _ => None,
        };
        if let Some(rejection) = rejection {
            self.graph.pop_edge();
            for (node, pose) in poses_before.iter().enumerate() {
                self.graph.set_pose(node, *pose);
            }
            self.graph.settle(settled);
            return Err(rejection);
        }
        self.take_back_refuted();
        let newest = poses_before.len() - 1;
        let correction = self.graph.pose(newest) * poses_before[newest].inverse();
        self.front_end.correct(&correction);
        Ok((report.iterations, correction))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slam::SlamConfig;
    use crate::slam::test_room::frame;

    /// Three laps of a room, and the loops that were closed.
    fn driven(least_correction: f64) -> (Slam, Vec<LoopEffect>) {
        let mut config = SlamConfig::for_robot(&frame(0).scan);
        config.least_correction = least_correction;
        let mut slam = Slam::new(config);
        let mut closed = Vec::new();
        for step in 0..315 {
            let report = slam.step(&frame(step)).unwrap();
            closed.extend(report.loop_attempts.into_iter().filter_map(|a| a.effect));
        }
        (slam, closed)
    }

    #[test]
    fn a_loop_that_would_hardly_move_the_map_waits_for_one_that_does() {
        let (_, all) = driven(0.0);
        assert!(all.iter().all(|effect| effect.iterations > 0));
        let least = 0.02;
        let (mut slam, some) = driven(least);
        let waits = |effect: &&LoopEffect| effect.iterations == 0;
        let waiting = some.iter().filter(waits).count();
        assert!((1..some.len()).contains(&waiting), "{waiting}");
        for effect in some.iter().filter(waits) {
            assert_eq!(effect.correction, SE2::identity());
            assert_eq!(effect.max_shift_m, 0.0);
        }
        // The graph is where it would be, but for that.
        let before = slam.graph().poses().to_vec();
        let waited = slam.graph().edge_count() - slam.graph().settled_edges();
        assert!(waited > 0);
        slam.graph_mut().optimize_robust(15, 1e-9, 12.0);
        for (old, new) in before.iter().zip(slam.graph().poses()) {
            // 1e-3: what is of second order in the move.
            assert!(old.between(new).step_size() < least + 1e-3);
        }
        // More than seven are not kept beside a factor: the eighth corrects the map with them.
        let (_, few) = driven(10.0);
        let waits: Vec<bool> = few.iter().map(|effect| effect.iterations == 0).collect();
        let runs = waits.chunk_by(|a, b| a == b).filter(|run| run[0]);
        assert_eq!(runs.map(<[bool]>::len).max(), Some(7));
    }
}
