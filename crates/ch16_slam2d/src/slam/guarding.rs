//! Loops that wait until others agree with them.

use nalgebra::Matrix3;
use pr_geom::{SE2, math};
use pr_optim::{OptimizeError, StopReason};

use super::Slam;
use crate::graph::EdgeKind;
use crate::loops::{
    Detection, HeldLoop, KeyframeView, LoopConfig, LoopGuard, LoopRejection, LoopVerification,
    LoopWorkspace, chi_squared_gate, verify_loop, widest_variance,
};
use crate::metrics::position_error_m;

/// Where the graph's errors vary at least so many times as much as stated, loops may contradict each other.
const CONTRADICTION: f64 = 1.0;

/// Two searches found the same place where they end so near, m and rad.
const SAME_PLACE: (f64, f64) = (0.5, 0.35);

impl Slam {
    /// Whether loops wait for others at this node.
    pub(super) fn is_waiting(&self, node: usize) -> bool {
        let Some(guard) = self.config.loops.guard else {
            return false;
        };
        let here_m = self.way_between_m(0, node);
        let newest = self.held.last();
        newest.is_some_and(|held| here_m - held.way_m <= 0.5 * guard.patience_m)
    }

    /// What the guard says of a loop that passed the other tests.
    ///
    /// A loop with a margin has been looked for in the whole window already.
    pub(super) fn guarded(&mut self, found: LoopVerification) -> LoopVerification {
        let Some(guard) = self.config.loops.guard.filter(|_| found.accepted()) else {
            return found;
        };
        let (old, node) = (found.candidate.node, found.from_node);
        let drift_m = self.blind_drift_m(self.last_loop_node, node);
        let expected = match self.graph.relative_covariance(old, node) {
            Ok(marginal) => guard.expected(&marginal, drift_m),
            Err(error) => return rejected(found, LoopRejection::NoCovariance(error)),
        };
        let Some(information) = expected.try_inverse() else {
            let error = OptimizeError::NotPositiveDefinite { node };
            return rejected(found, LoopRejection::NoCovariance(error));
        };
        let gate = chi_squared_gate(&found.innovation, &information, guard.gate_chi2);
        let reach_m = guard.reach_m(&expected);
        let mut found = LoopVerification {
            gate,
            gate_information: information,
            ..found
        };
        if gate.passes() && reach_m <= guard.sure_m {
            return found;
        }
        if found.margin.is_none() {
            let held = self.as_held(found);
            if let Some(rejection) = self.says_nothing_new(&held, &guard) {
                return rejected(found, rejection);
            }
            let shift_m = math::norm2(found.innovation.x, found.innovation.y);
            let half_m = math::max(reach_m, shift_m + 2.0 * SAME_PLACE.0);
            let half_m = math::min(half_m, self.config.loops.max_radius_m);
            found.margin = Some(self.lead(&found, half_m).unwrap_or(0.0));
        }
        let margin = found.margin.unwrap_or_default();
        if margin < guard.min_margin {
            let min_margin = guard.min_margin;
            return rejected(found, LoopRejection::Ambiguous { margin, min_margin });
        }
        self.hold(found, &guard)
    }

    /// What a loop between two keyframes is tested against that somebody asks for: the information of their
    /// relative pose that the graph holds, less what the guard adds for drift.
    ///
    /// # Errors
    /// Where the graph has no covariance.
    ///
    /// # Panics
    /// Where a node does not exist.
    pub fn expected_information(
        &mut self,
        old: usize,
        new: usize,
    ) -> Result<Matrix3<f64>, OptimizeError> {
        let covariance = match self.config.loops.guard {
            Some(guard) => self.way_covariance(old, new, &guard)?,
            None => self.graph.relative_covariance(old, new)?,
        };
        covariance
            .try_inverse()
            .ok_or(OptimizeError::NotPositiveDefinite { node: new })
    }

    /// By how much the registered place is ahead of any other in a window of ± `half_width_m` around
    /// the graph's belief, as far as it is looked for; none where the best place is another one.
    fn lead(&self, found: &LoopVerification, half_width_m: f64) -> Option<f64> {
        let loops = self.config.loops;
        let known = Some(found.registered);
        let mut workspace = LoopWorkspace::searching(&loops, &loops.search?, half_width_m, known);
        let wider = LoopConfig {
            detection: Detection::Visits,
            radius_m: half_width_m,
            // The score is that of the search, not that of the registration.
            min_score: 0.0,
            ..loops
        };
        let view = KeyframeView {
            poses: self.graph.poses(),
            keyframes: &self.keyframes,
        };
        let candidate = crate::loops::LoopCandidate {
            proposal: None,
            ..found.candidate
        };
        let best = verify_loop(
            view,
            found.from_node,
            candidate,
            Ok(found.gate_information),
            self.config.information_frame,
            &wider,
            &mut workspace,
        );
        let apart = best.registered.between(&found.registered);
        let is_same = math::norm2(apart.x(), apart.y()) <= SAME_PLACE.0
            && apart.theta().abs() <= SAME_PLACE.1;
        is_same.then(|| best.margin.unwrap_or(loops.max_margin()))
    }

    /// Why a loop waits that is beside a held one, agrees with it and does not bring enough of them together.
    ///
    /// Loops beside each other count as one, so nothing is lost where the window is not searched again.
    fn says_nothing_new(&mut self, found: &HeldLoop, guard: &LoopGuard) -> Option<LoopRejection> {
        let beside = self.held.clone();
        let mut beside = beside.iter().filter(|held| !held.is_apart(found, guard));
        if !beside.any(|held| self.do_agree(held, found, guard)) {
            return None;
        }
        let agreeing = self.agreeing(found, guard).len();
        let needed = found.needed(guard);
        (agreeing < needed).then_some(LoopRejection::Waiting { agreeing, needed })
    }

    /// Holds a loop back until enough others agree.
    fn hold(&mut self, found: LoopVerification, guard: &LoopGuard) -> LoopVerification {
        let held = self.as_held(found);
        self.held
            .retain(|older| held.way_m - older.way_m <= guard.patience_m);
        let agreeing = self.agreeing(&held, guard).len();
        self.held.push(held);
        let needed = held.needed(guard);
        if agreeing >= needed {
            return found;
        }
        rejected(found, LoopRejection::Waiting { agreeing, needed })
    }

    fn as_held(&self, verification: LoopVerification) -> HeldLoop {
        HeldLoop {
            verification,
            way_m: self.way_between_m(0, verification.from_node),
            is_expected: verification.gate.passes(),
        }
    }

    /// Of the held loops those that agree with this one and with each other, itself among them.
    fn agreeing(&mut self, held: &HeldLoop, guard: &LoopGuard) -> Vec<HeldLoop> {
        let mut set = vec![*held];
        for other in self.held.clone().iter().rev() {
            if set.iter().all(|one| one.is_apart(other, guard))
                && set.iter().all(|one| self.do_agree(other, one, guard))
            {
                set.push(*other);
            }
        }
        set
    }

    fn do_agree(&mut self, first: &HeldLoop, second: &HeldLoop, guard: &LoopGuard) -> bool {
        let (first, second) = (first.verification, second.verification);
        let way = self.way_covariance(first.from_node, second.from_node, guard);
        way.is_ok_and(|way| guard.agree(self.graph.poses(), &first, &second, &way))
    }

    fn way_covariance(
        &mut self,
        old: usize,
        new: usize,
        guard: &LoopGuard,
    ) -> Result<Matrix3<f64>, OptimizeError> {
        let drift_m = self.blind_drift_m(old, new);
        let marginal = self.graph.relative_covariance(old, new)?;
        Ok(guard.expected(&marginal, drift_m))
    }

    /// At the end: closes what the last search found, or what still waits, where most of it agrees.
    pub(super) fn conclude(
        &mut self,
        searched: Option<LoopVerification>,
    ) -> Option<LoopVerification> {
        if let Some(found) = searched.filter(LoopVerification::accepted) {
            return self.optimize_with(&found).is_ok().then_some(found);
        }
        let guard = self.config.loops.guard?;
        let held = core::mem::take(&mut self.held);
        let mut best: Vec<HeldLoop> = Vec::new();
        for one in held.iter().filter(|one| one.is_expected) {
            let mut others = held.clone();
            others.retain(|other| other != one);
            self.held = others;
            let set = self.agreeing(one, &guard);
            if set.len() > best.len() {
                best = set;
            }
        }
        self.held.clear();
        let found = best.first()?.verification;
        let is_most = 2 * best.len() > held.len();
        // An error leaves the graph as it was.
        (is_most && self.optimize_with(&found).is_ok()).then_some(found)
    }

    /// Takes loops out again that the newest one refutes together with others.
    ///
    /// One place may look like another until the way around a corner shows which is right. Then the loops on
    /// either side contradict each other, and the truncated cost says which side has more to show. While
    /// that is the older one, both stay: the newest loop waits for others in the graph.
    pub(super) fn take_back_refuted(&mut self) {
        let Some(guard) = self.config.loops.guard else {
            return;
        };
        let newest = self.graph.edge_count().checked_sub(1);
        let Some(newest) = newest.filter(|_| self.variance_factor() >= CONTRADICTION) else {
            return;
        };
        let Some(Ok(belief)) = guard.referee.judge(&self.graph) else {
            return;
        };
        if !belief.believed[newest] || belief.believed.iter().all(|believed| *believed) {
            return;
        }
        let mut graph = self
            .graph
            .with_edges(|view| belief.believed[view.id.index()]);
        for (node, pose) in belief.poses.iter().enumerate() {
            graph.set_pose(node, *pose);
        }
        let report = graph.optimize_robust(
            self.config.optimizer_iterations,
            self.config.optimizer_tolerance,
            self.config.huber,
        );
        if !matches!(report.stop, StopReason::Failed { .. }) {
            self.graph = graph;
        }
    }

    /// Drift of what goes one way between two nodes, a standard deviation, m.
    ///
    /// Each step counts by the share of it that the wheels alone tell: where the scans say where the robot
    /// is, wheels of the wrong size do no harm.
    pub(super) fn blind_drift_m(&self, old: usize, new: usize) -> f64 {
        let (first, last) = (old.min(new), old.max(new));
        let blind_m: f64 = if self.submap_loops.is_some() {
            self.blind_steps_m(first, last).sum()
        } else {
            let steps = self.graph.edges().filter(|view| {
                let (from, to) = (view.from.index(), view.to.index());
                view.edge.kind == EdgeKind::Odometry && first <= from && to <= last
            });
            steps
                .map(|view| self.blind_m(&view.edge.measurement, &view.edge.information))
                .sum()
        };
        0.5 * self.config.loops.drift_share * blind_m
    }

    /// The blind part of each step between two nodes of a map on submaps, m.
    ///
    /// There the edges start at anchors, metres back, and two submaps share what one registration
    /// tells: so a step is known by all edges that end with it, and is as long as the way.
    fn blind_steps_m(&self, first: usize, last: usize) -> impl Iterator<Item = f64> {
        let mut known = vec![Matrix3::zeros(); last - first];
        for view in self.graph.edges() {
            let to = view.to.index();
            if view.edge.kind == EdgeKind::Odometry && first < to && to <= last {
                known[to - first - 1] += view.edge.information;
            }
        }
        let steps = self.graph.poses()[first..=last].windows(2);
        steps
            .zip(known)
            .map(|(step, information)| self.blind_m(&step[0].between(&step[1]), &information))
    }

    /// How much of a motion the wheels alone tell, m, where so much is known of it.
    fn blind_m(&self, motion: &SE2, information: &Matrix3<f64>) -> f64 {
        let wheels = self.config.odometry_noise.covariance(motion);
        let claimed = information / self.config.confidence;
        let known = claimed.try_inverse().unwrap_or(wheels);
        let share = math::sqrt(widest_variance(&known) / wheels[(0, 0)]);
        math::min(share, 1.0) * math::norm2(motion.x(), motion.y())
    }

    /// Length of the way of the keyframes between two nodes, m.
    pub(super) fn way_between_m(&self, old: usize, new: usize) -> f64 {
        let way = &self.graph.poses()[old.min(new)..=old.max(new)];
        let steps = way.windows(2);
        steps.map(|pair| position_error_m(&pair[0], &pair[1])).sum()
    }
}

fn rejected(found: LoopVerification, rejection: LoopRejection) -> LoopVerification {
    LoopVerification {
        rejection: Some(rejection),
        ..found
    }
}

#[cfg(test)]
mod tests;
