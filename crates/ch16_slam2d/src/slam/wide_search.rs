//! What is done where no loop was closed for long: the whole window of the drift is searched.

use pr_geom::math;

use super::Slam;
use super::pending::PendingFrame;
use crate::loops::{
    Detection, KeyframeView, LoopCandidate, LoopConfig, LoopRejection, LoopVerification,
    LoopWorkspace, WideSearch, detect_visits, verify_loop,
};
use crate::metrics::position_error_m;

impl Slam {
    /// The search of the window, where no loop was closed for long and the last attempt had a smaller window.
    pub(super) fn search_that_is_due(
        &self,
        node: usize,
        last_attempt: Option<usize>,
    ) -> Option<WideSearch> {
        let wide = self.config.loops.search?;
        let beyond_m = |node: usize| self.way_since_loop_m(node) - wide.min_way_m;
        if beyond_m(node) <= 0.0 {
            return None;
        }
        let window = |node: usize| (beyond_m(node) / wide.every_m).ceil();
        let last_attempt = last_attempt.filter(|last| *last > self.last_loop_node);
        let is_same = last_attempt.is_some_and(|last| window(last) == window(node));
        (wide.every_m == 0.0 || !is_same).then_some(wide)
    }

    /// Searches the whole window of the drift where no candidate passed.
    pub(super) fn search_widely(
        &mut self,
        node: usize,
        wide: &WideSearch,
        pending: &mut PendingFrame,
    ) {
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
        for candidate in candidates.into_iter().take(wide.candidates) {
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
            if self.report_attempt(verification, pending) {
                return;
            }
        }
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
    fn a_window_that_was_searched_in_vain_is_searched_again_after_so_much_more_of_the_way() {
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
        let seldom = searched(5.0);
        assert!(often.len() > 6, "{often:?}");
        assert!(
            seldom
                .iter()
                .all(|way_m| *way_m > 4.0 && often.contains(way_m))
        );
        let windows = seldom
            .iter()
            .map(|way_m| ((way_m - 4.0) / 5.0).ceil() as usize);
        let windows: Vec<usize> = windows.collect();
        assert!(
            windows.windows(2).all(|pair| pair[0] < pair[1]),
            "{seldom:?}"
        );
        assert!(2 * seldom.len() <= often.len(), "{seldom:?} {often:?}");
    }
}
