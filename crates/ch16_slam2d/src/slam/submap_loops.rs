//! The back end of submaps: a keyframe is looked for on the finished ones near it.

use pr_geom::SE2;

use super::Slam;
use super::pending::PendingFrame;
use crate::graph::EdgeKind;

impl Slam {
    /// Adds the edges of a new keyframe: one registration, shared by the submaps that it is tied to, and
    /// what the wheels measured since the last keyframe.
    pub(super) fn tie_to_submaps(
        &mut self,
        last_node: usize,
        node: usize,
        relative: SE2,
        ties: &[(usize, SE2)],
    ) {
        if let Some(wheels) = self.front_end.take_wheels() {
            self.graph
                .add_edge(last_node, node, relative, wheels, EdgeKind::Odometry);
        }
        for (anchor, anchor_from_node) in ties {
            let theta = self.graph.pose(*anchor).theta();
            let information = self.front_end.information(theta, &self.config);
            self.graph.add_edge(
                *anchor,
                node,
                *anchor_from_node,
                information * (self.config.confidence / ties.len() as f64),
                EdgeKind::Odometry,
            );
        }
    }

    /// Keeps the submap that the front end has finished.
    pub(super) fn keep_finished(&mut self) {
        if let Some(submap) = self.front_end.take_finished()
            && let Some(submaps) = &mut self.submap_loops
        {
            submaps.add(submap);
        }
    }

    /// Looks for keyframe `node` on the finished submaps around it, the nearest first, until it is
    /// found on one or the limit is reached.
    pub(super) fn verify_on_submaps(&mut self, node: usize, pending: &mut PendingFrame) {
        let loops = self.config.loops;
        let radius_m = loops.radius_m + loops.drift_share * self.way_since_loop_m(node);
        let radius_m = pr_geom::math::min(radius_m, loops.max_radius_m);
        let Some(submaps) = &self.submap_loops else {
            return;
        };
        let candidates =
            submaps.candidates(self.graph.poses(), node, radius_m, loops.min_gap_nodes);
        for (index, candidate) in candidates.into_iter().take(loops.candidates_tried) {
            let gate_information = self.gate_information(node, candidate.node);
            let belief = self
                .graph
                .pose(candidate.node)
                .between(&self.graph.pose(node));
            let Some(submaps) = &mut self.submap_loops else {
                return;
            };
            let verification = submaps.verify(
                index,
                (node, &self.keyframes[node].scan),
                (candidate, belief),
                gate_information,
                &loops,
            );
            let verification = self.guarded(verification);
            if self.report_attempt(verification, pending) {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {

    use crate::graph::EdgeKind;
    use crate::loops::{LoopCandidate, LoopRejection};
    use crate::metrics::position_error_m;
    use crate::slam::test_room::{frame, truth};
    use crate::slam::{Slam, SlamConfig};
    use crate::submaps::{FinishedSubmap, FrontEndKind, SubmapConfig};

    fn slam(scans: usize) -> Slam {
        let mut config = SlamConfig::for_robot(&frame(0).scan);
        config.start = truth(0);
        with_submaps(config, scans)
    }

    fn with_submaps(mut config: SlamConfig, scans: usize) -> Slam {
        let submaps = SubmapConfig {
            scans,
            ..SubmapConfig::of(&config)
        };
        config.front_end = FrontEndKind::Submaps(submaps);
        Slam::new(config)
    }

    fn two_laps(scans: usize) -> Slam {
        let mut slam = slam(scans);
        for step in 0..=210 {
            slam.step(&frame(step)).unwrap();
        }
        slam
    }

    #[test]
    fn a_submap_is_finished_by_its_last_scan_and_never_changes_again() {
        let mut slam = slam(20);
        let mut last: Option<FinishedSubmap> = None;
        for step in 0..=210 {
            slam.step(&frame(step)).unwrap();
            let finished = slam.submap_loops().unwrap().finished();
            assert!(finished.iter().all(|submap| submap.scans == 20));
            if let Some(last) = &last {
                assert!(finished.contains(last));
            }
            last = finished.first().cloned();
            let active = slam.front_end().submaps().unwrap().submaps();
            assert!((1..=2).contains(&active.len()));
            assert!(active.iter().all(|submap| submap.grid().scans() < 20));
        }
        let finished = slam.submap_loops().unwrap().finished();
        assert!(finished.len() >= 8, "{}", finished.len());
        // They overlap: the next one's anchor belongs to the one before.
        for pair in finished.windows(2) {
            assert!(pair[0].nodes.contains(&pair[1].anchor));
        }
    }

    #[test]
    fn every_keyframe_is_tied_to_the_submaps_that_it_was_added_to() {
        let slam = two_laps(20);
        for submap in slam.submap_loops().unwrap().finished() {
            for &node in submap.nodes.iter().filter(|node| **node != submap.anchor) {
                let tied = slam.graph().edges().any(|view| {
                    view.edge.kind == EdgeKind::Odometry
                        && (view.from.index(), view.to.index()) == (submap.anchor, node)
                });
                assert!(tied, "{node} to {}", submap.anchor);
            }
        }
    }

    #[test]
    fn loops_tie_keyframes_to_finished_submaps_that_do_not_hold_them() {
        let slam = two_laps(20);
        let finished = slam.submap_loops().unwrap().finished();
        let loops: Vec<_> = slam
            .graph()
            .edges()
            .filter(|view| view.edge.kind == EdgeKind::Loop)
            .collect();
        assert!(loops.len() >= 2, "{}", loops.len());
        for view in &loops {
            let (anchor, node) = (view.from.index(), view.to.index());
            let submap = finished.iter().find(|submap| submap.anchor == anchor);
            assert!(!submap.unwrap().nodes.contains(&node));
            // Where it truly is in the submap's frame.
            let at = |node: usize| truth(slam.keyframes()[node].frame);
            let error = at(anchor)
                .between(&at(node))
                .between(&view.edge.measurement)
                .log();
            // A cell: half of it by the search's walls, as much by the anchor when it began.
            assert!(error.norm() < 0.065, "{anchor} to {node}: {error}");
        }
        let keyframes = slam.keyframes().iter().zip(slam.graph().poses());
        let worst_m = keyframes
            .map(|(keyframe, pose)| position_error_m(pose, &truth(keyframe.frame)))
            .fold(0.0, f64::max);
        // A cell and a half.
        assert!(worst_m < 0.1, "{worst_m} m");
    }

    #[test]
    fn loops_on_submaps_wait_for_others_where_the_guard_says_so() {
        let mut config = SlamConfig::for_robot(&frame(0).scan);
        config.start = truth(0);
        let guard = config.loops.guard.as_mut().unwrap();
        guard.sure_m = 0.0;
        (guard.agreeing, guard.agreeing_outside) = (usize::MAX, usize::MAX);
        let mut slam = with_submaps(config, 20);
        let mut attempts = Vec::new();
        for step in 0..=210 {
            attempts.extend(slam.step(&frame(step)).unwrap().loop_attempts);
        }
        let waits = |rejection| matches!(rejection, Some(LoopRejection::Waiting { .. }));
        let found = attempts.iter().map(|attempt| &attempt.verification);
        assert!(found.clone().all(|found| !found.accepted()));
        assert!(found.filter(|found| waits(found.rejection)).count() >= 2);
    }

    #[test]
    fn drift_counts_a_step_once_however_many_submaps_it_is_tied_to() {
        let slam = two_laps(20);
        let last = slam.keyframes().len() - 1;
        let way_m = slam.way_between_m(0, last);
        let edges = slam.graph().edges();
        let edges_m: f64 = edges
            .filter(|view| view.edge.kind == EdgeKind::Odometry)
            .map(|view| position_error_m(&view.edge.measurement, &pr_geom::SE2::identity()))
            .sum();
        // Anchors lie metres back.
        assert!(edges_m > 2.0 * way_m, "{edges_m} m on {way_m} m");
        let drift_m = slam.blind_drift_m(0, last);
        let most_m = 0.5 * slam.config().loops.drift_share * way_m;
        assert!(
            drift_m > 0.0 && drift_m < most_m,
            "{drift_m} m of {most_m} m"
        );
    }

    #[test]
    fn few_submaps_are_kept_ready_and_the_answer_does_not_depend_on_which() {
        let mut slam = two_laps(20);
        let node = slam.keyframes().len() - 1;
        let scan = std::sync::Arc::clone(&slam.keyframes()[node].scan);
        let poses = slam.graph().poses().to_vec();
        let loops = slam.config().loops;
        let information = crate::loops::path_information(node, &loops);
        let mut submaps = slam.submap_loops.take().unwrap();
        let mut ask = |index: usize| {
            let anchor = submaps.finished()[index].anchor;
            let candidate = LoopCandidate {
                node: anchor,
                distance_m: 0.0,
                proposal: None,
            };
            let belief = poses[anchor].between(&poses[node]);
            let found = submaps.verify(
                index,
                (node, &scan),
                (candidate, belief),
                Ok(information),
                &loops,
            );
            assert!(submaps.ready_count() <= 4);
            found
        };
        let first = ask(0);
        (1..8).for_each(|index| {
            ask(index);
        });
        assert_eq!(ask(0), first);
    }
}
