//! What is done where no loop was closed for long: the whole window of the drift is searched.

use pr_geom::math;

use super::Slam;
use crate::loops::{
    Detection, KeyframeView, LoopCandidate, LoopConfig, LoopRejection, LoopVerification,
    LoopWorkspace, WideSearch, detect_visits, verify_loop,
};
use crate::metrics::position_error_m;

impl Slam {
    /// The search of the window, where no loop was closed for long and the last search was made so long ago.
    pub(super) fn search_that_is_due(&self, node: usize) -> Option<WideSearch> {
        let wide = self.config.loops.search?;
        let is_long_ago = |last: usize| self.way_between_m(last, node) >= wide.every_m;
        let is_due = self.way_since_loop_m(node) > wide.min_way_m
            && self.last_search_node.is_none_or(is_long_ago);
        is_due.then_some(wide)
    }

    /// Searches the whole window of the drift where no candidate passed: what was found, up to the first that passes.
    pub(super) fn search_widely(
        &mut self,
        node: usize,
        wide: &WideSearch,
    ) -> Vec<LoopVerification> {
        let loops = self.config.loops;
        let way_m = self.way_since_loop_m(node);
        let half_width_m = math::min(
            loops.radius_m + loops.drift_share * way_m,
            loops.max_radius_m,
        );
        let wider = LoopConfig {
            detection: Detection::Visits,
            radius_m: half_width_m,
            min_gap_nodes: self
                .nodes_since(wide.min_way_m, node)
                .max(loops.min_gap_nodes),
            min_score: wide.min_score,
            // The fit is measured once the place is found.
            max_rmse_m: f64::INFINITY,
            ..loops
        };
        let mut workspace = LoopWorkspace::searching(&loops, wide, half_width_m, None);
        let candidates = detect_visits(self.graph.poses(), node, &wider);
        let mut found = Vec::new();
        for candidate in candidates.into_iter().take(wide.candidates) {
            self.last_search_node = Some(node);
            let gate_information = self.gate_information(node, candidate.node);
            let view = KeyframeView {
                poses: self.graph.poses(),
                keyframes: &self.keyframes,
            };
            let mut verification = verify_loop(
                view,
                node,
                candidate,
                gate_information,
                self.config.information_frame,
                &wider,
                &mut workspace,
            );
            // A window that could not be searched is left with what fits at the belief.
            if verification.score.is_none() && verification.inliers == 0 {
                verification.rejection = Some(LoopRejection::NoPlace {
                    half_width_m,
                    min_score: wide.min_score,
                });
            }
            let margin = verification.margin.unwrap_or(loops.max_margin());
            if verification.accepted() && margin < wide.min_margin {
                verification.rejection = Some(LoopRejection::Ambiguous {
                    margin,
                    min_margin: wide.min_margin,
                });
            }
            if verification.accepted() {
                // The search proposes; what decides is what decides on every loop.
                let proposal = Some(verification.registered);
                let proposed = LoopCandidate {
                    proposal,
                    ..candidate
                };
                let decided = LoopVerification {
                    margin: Some(margin),
                    ..self.verify(node, proposed)
                };
                verification = self.guarded(decided);
            }
            found.push(verification);
            if verification.accepted() {
                break;
            }
        }
        found
    }

    /// What a search at the newest keyframe finds once no frame follows: a robot that comes back to where it
    /// began is often switched off there.
    pub(super) fn search_at_the_end(&mut self) -> Option<LoopVerification> {
        let wide = self.config.loops.search?;
        let node = self.keyframes.len().checked_sub(1)?;
        let is_searched = self.submap_loops.is_some() || self.last_search_node == Some(node);
        if is_searched || self.way_since_loop_m(node) <= wide.min_way_m {
            return None;
        }
        self.search_widely(node, &wide).pop()
    }

    /// Keyframes within so much of the way before a node.
    fn nodes_since(&self, way_m: f64, node: usize) -> usize {
        let way = &self.graph.poses()[..=node];
        let steps = way.windows(2).rev();
        let lengths = steps.map(|pair| position_error_m(&pair[0], &pair[1]));
        let ways = lengths.scan(0.0, |sum_m, step_m| {
            *sum_m += step_m;
            Some(*sum_m)
        });
        ways.take_while(|sum_m| *sum_m <= way_m).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slam::SlamConfig;
    use crate::slam::test_room::frame;

    #[test]
    fn a_window_is_searched_again_so_much_of_the_way_after_the_last_search() {
        // Ways of the keyframes at which the window is searched, m; nothing is ever found there.
        let searched = |every_m: f64| -> Vec<f64> {
            let mut config = SlamConfig::for_robot(&frame(0).scan);
            config.loops.min_score = 1.1;
            let search = config.loops.search.as_mut().unwrap();
            (search.min_way_m, search.every_m, search.min_score) = (4.0, every_m, 1.1);
            let mut slam = Slam::new(config);
            let mut ways_m = Vec::new();
            for step in 0..315 {
                let report = slam.step(&frame(step)).unwrap();
                let mut tried = report
                    .loop_attempts
                    .iter()
                    .map(|a| &a.verification.rejection);
                if tried.any(|why| matches!(why, Some(LoopRejection::NoPlace { .. }))) {
                    ways_m.push(slam.way_since_loop_m(report.new_keyframe.unwrap()));
                }
            }
            ways_m
        };
        let often = searched(0.0);
        assert!(often.len() > 6, "{often:?}");
        let mut expected = Vec::new();
        for way_m in &often {
            if expected.last().is_none_or(|last_m| way_m - last_m >= 5.0) {
                expected.push(*way_m);
            }
        }
        let seldom = searched(5.0);
        assert_eq!(seldom, expected);
        assert!(2 * seldom.len() <= often.len(), "{seldom:?} {often:?}");
    }

    #[test]
    fn a_robot_that_is_switched_off_where_it_began_closes_its_loop() {
        let driven = |is_searching: bool| {
            let mut config = SlamConfig::for_robot(&frame(0).scan);
            let search = config.loops.search.as_mut().unwrap();
            search.min_way_m = 4.0;
            if !is_searching {
                config.loops.search = None;
            }
            // A lap of which no attempt sees the end.
            config.loops.attempt_every_nodes = 1000;
            let mut slam = Slam::new(config);
            for step in 0..106 {
                let report = slam.step(&frame(step)).unwrap();
                assert_eq!(report.closed_loop(), None, "step {step}");
            }
            let newest = slam.keyframes().len() - 1;
            (slam.refine(), newest)
        };
        let (refinement, newest) = driven(true);
        let searched = refinement.searched().unwrap();
        assert_eq!(searched.from_node, newest);
        let concluded = refinement.concluded().unwrap();
        assert_eq!(concluded.registered, searched.registered);
        let (refinement, _) = driven(false);
        assert!(refinement.searched().is_none() && refinement.concluded().is_none());
    }
}
