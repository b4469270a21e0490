//! After the last frame: every keyframe is registered once more on all that was seen of its place.
//!
//! While frames come in, a loop is looked for now and then and the first that passes is closed. At
//! the end there is time to link every keyframe with every earlier visit to its surroundings, from
//! poses that are nearly right. The links of a pass take the place of the loops before it, so a
//! loop that the final map does not confirm is gone.

use nalgebra::{Matrix3, Vector3};

use super::{LoopClosure, Slam};
use crate::graph::{EdgeKind, EdgeView};
use crate::loops::{
    Detection, KeyframeView, LoopConfig, LoopVerification, LoopWorkspace, detect_visits,
    verify_loop,
};
use crate::matching::{MatcherKind, StagedMatcherConfig};

/// How keyframes are linked at the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RefinementConfig {
    /// Rounds of linking and optimizing; 0 leaves the graph as it is.
    pub passes: usize,
    /// What registers a keyframe on a visit, from a pose that is nearly right.
    pub matcher: MatcherKind,
    /// Keyframes within this distance are linked, m.
    pub radius_m: f64,
    /// Keyframes are linked that are at least so many nodes apart.
    pub min_gap_nodes: usize,
    /// At most so many visits are linked with a keyframe, the nearest first.
    pub visits: usize,
    /// A registration may move a keyframe by so much, a standard deviation of the gate, m.
    pub shift_sigma_m: f64,
    /// The same for the heading, rad.
    pub turn_sigma_rad: f64,
    /// Huber width of the last optimizations, in standard deviations of an edge.
    pub huber: f64,
}

impl Default for RefinementConfig {
    fn default() -> Self {
        Self {
            passes: 0,
            matcher: MatcherKind::Staged(StagedMatcherConfig {
                taus_m: [0.3, 0.15, 0.0],
                good_score: 0.0,
                ..StagedMatcherConfig::default()
            }),
            radius_m: 2.5,
            min_gap_nodes: 10,
            visits: 3,
            shift_sigma_m: 0.15,
            turn_sigma_rad: 0.05,
            huber: 3.0,
        }
    }
}

/// A refinement under way: which keyframe is next, and the links so far.
#[derive(Clone)]
pub struct Refinement {
    pass: usize,
    node: usize,
    links: Vec<LoopVerification>,
    searched: Option<LoopVerification>,
    concluded: Option<LoopVerification>,
    workspace: LoopWorkspace,
}

impl Refinement {
    /// The links of the pass under way, or of the last one, accepted or not.
    #[must_use]
    pub fn links(&self) -> &[LoopVerification] {
        &self.links
    }

    /// What was found for the newest keyframe where no loop had been closed for long, accepted or not.
    #[must_use]
    pub fn searched(&self) -> Option<&LoopVerification> {
        self.searched.as_ref()
    }

    /// The loop that was found last, or waited for others to the end, and was closed then.
    #[must_use]
    pub fn concluded(&self) -> Option<&LoopVerification> {
        self.concluded.as_ref()
    }
}

impl Slam {
    /// Registers the next keyframe on the visits around it, or optimizes at the end of a pass; false
    /// once all passes are done.
    pub fn refine_step(&mut self, refinement: &mut Refinement) -> bool {
        let config = self.config.refinement;
        if refinement.pass >= config.passes || self.config.loop_closure == LoopClosure::Off {
            return false;
        }
        if refinement.pass == 0 && refinement.node == 0 {
            refinement.searched = self.search_at_the_end();
            refinement.concluded = self.conclude(refinement.searched);
        }
        if refinement.node == 0 {
            refinement.links.clear();
        }
        if refinement.node < self.keyframes.len() {
            self.link(refinement);
            refinement.node += 1;
            return true;
        }
        self.replace_loops(&refinement.links);
        refinement.node = 0;
        refinement.pass += 1;
        refinement.pass < config.passes
    }

    /// A refinement that has not begun.
    #[must_use]
    pub fn refinement(&self) -> Refinement {
        let matcher = self.config.refinement.matcher;
        Refinement {
            pass: 0,
            node: 0,
            links: Vec::new(),
            searched: None,
            concluded: None,
            workspace: LoopWorkspace::new(matcher.build(&self.config.loops.submap)),
        }
    }

    /// All of [`Slam::refine_step`].
    pub fn refine(&mut self) -> Refinement {
        let mut refinement = self.refinement();
        while self.refine_step(&mut refinement) {}
        refinement
    }

    fn link(&mut self, refinement: &mut Refinement) {
        let node = refinement.node;
        let config = self.config.refinement;
        let loops = LoopConfig {
            detection: Detection::Visits,
            radius_m: config.radius_m,
            min_gap_nodes: config.min_gap_nodes,
            ..self.config.loops
        };
        let square = |sigma: f64| 1.0 / (sigma * sigma);
        let shift = square(config.shift_sigma_m);
        let believed =
            Matrix3::from_diagonal(&Vector3::new(shift, shift, square(config.turn_sigma_rad)));
        let view = KeyframeView {
            poses: self.graph.poses(),
            keyframes: &self.keyframes,
        };
        let visits = detect_visits(view.poses, node, &loops);
        let frame = self.config.information_frame;
        let workspace = &mut refinement.workspace;
        refinement
            .links
            .extend(visits.into_iter().take(config.visits).map(|candidate| {
                verify_loop(
                    view,
                    node,
                    candidate,
                    Ok(believed),
                    frame,
                    &loops,
                    workspace,
                )
            }));
    }

    /// The graph with its odometry and these links, optimized.
    fn replace_loops(&mut self, links: &[LoopVerification]) {
        let is_odometry = |view: &EdgeView| view.edge.kind == EdgeKind::Odometry;
        let mut graph = self.graph.with_edges(is_odometry);
        for link in links.iter().filter(|link| link.accepted()) {
            graph.add_edge(
                link.candidate.node,
                link.from_node,
                link.registered,
                link.information * self.config.confidence,
                EdgeKind::Loop,
            );
        }
        let report = graph.optimize_robust(
            self.config.optimizer_iterations,
            self.config.optimizer_tolerance,
            self.config.refinement.huber,
        );
        if !matches!(report.stop, pr_optim::StopReason::Failed { .. }) {
            self.graph = graph;
            self.chi2 = self.graph.chi2();
        }
    }
}

#[cfg(test)]
mod tests {
    use pr_geom::SE2;

    use super::*;
    use crate::loops::LoopRejection;
    use crate::metrics::position_error_m;
    use crate::slam::SlamConfig;
    use crate::slam::test_room::{frame, truth};

    fn two_laps() -> Slam {
        let mut config = SlamConfig::for_robot(&frame(0).scan);
        config.start = truth(0);
        let mut slam = Slam::new(config);
        for step in 0..=210 {
            slam.step(&frame(step)).unwrap();
        }
        slam
    }

    fn worst_m(slam: &Slam) -> f64 {
        let nodes = slam.keyframes().iter().zip(slam.graph().poses());
        nodes
            .map(|(keyframe, pose)| position_error_m(pose, &truth(keyframe.frame)))
            .fold(0.0, f64::max)
    }

    #[test]
    fn a_loop_that_the_final_map_does_not_confirm_is_gone() {
        let mut slam = two_laps();
        let newest = slam.keyframes().len() - 1;
        let right = slam.graph().pose(3).between(&slam.graph().pose(newest));
        let wrong = right * SE2::new(0.3, 0.1, 0.05);
        // As sure of itself as the right ones.
        let trust = Matrix3::identity() * (100.0 * slam.config.confidence);
        slam.graph_mut()
            .add_edge(3, newest, wrong, trust, EdgeKind::Loop);
        slam.graph_mut().optimize(10, 1e-9);
        let before_m = worst_m(&slam);
        let refinement = slam.refine();
        assert!(before_m > 0.1, "the wrong loop bends the map: {before_m} m");
        // A point of a thinned scan may lie anywhere in its cell.
        let half_a_cell_m = 0.5 * slam.config.scan.cell_m;
        assert!(worst_m(&slam) < half_a_cell_m, "{} m", worst_m(&slam));
        let accepted = refinement.links().iter().filter(|link| link.accepted());
        assert!(accepted.count() > 10);
        let is_wrong = |view: &crate::graph::EdgeView| view.edge.measurement == wrong;
        assert!(!slam.graph().edges().any(|view| is_wrong(&view)));
    }

    #[test]
    fn without_passes_the_graph_stays_as_it_is() {
        let mut slam = two_laps();
        slam.config.refinement.passes = 0;
        let (poses, edges) = (slam.graph().poses().to_vec(), slam.graph().edge_count());
        assert!(slam.refine().links().is_empty());
        assert_eq!(
            (slam.graph().poses(), slam.graph().edge_count()),
            (&poses[..], edges)
        );
    }

    #[test]
    fn a_link_that_moves_a_keyframe_too_far_is_turned_away() {
        let mut slam = two_laps();
        slam.config.refinement.shift_sigma_m = 1e-6;
        let refinement = slam.refine();
        let outside = |link: &&LoopVerification| {
            matches!(link.rejection, Some(LoopRejection::OutsideGate(_)))
        };
        assert!(refinement.links().iter().filter(outside).count() > 10);
    }
}
