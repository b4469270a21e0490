//! After the last frame: every keyframe is registered once more on the visits to its surroundings.
//!
//! While frames come in, a loop is looked for at every few keyframes. At the end each keyframe is linked with
//! every earlier visit around it, from poses that are nearly right. The links of a pass take the place of
//! the loops before it: a loop that the final map does not confirm is gone.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};
use pr_optim::StopReason;

use super::config::SlamConfig;
use super::mapper::Mapper;
use super::robots::RobotConfig;
use crate::graph::{EdgeKind, EdgeView};
use crate::local_map::{LocalMap, RangeProfile};
use crate::loops::{
    Detection, LoopConfig, LoopRejection, LoopVerification, chi_squared_gate, detect_visits,
};

/// Rounds of linking and optimizing.
const PASSES: usize = 2;
/// Keyframes within this distance are linked, m.
const RADIUS_M: f64 = 4.0;
/// Keyframes are linked that are at least so many nodes apart.
const MIN_GAP_NODES: usize = 10;
/// At most so many visits are linked with a keyframe, the nearest first.
const VISITS: usize = 3;
/// A visit is the nearest keyframe with so many on either side.
const HALF_SUBMAP: usize = 3;
/// A registration may move a keyframe by so much, standard deviations of a gate: m and rad.
const SHIFT: (f64, f64) = (0.15, 0.05);
/// The largest squared shift: 95 of 100 lie below, of three degrees of freedom.
const GATE_CHI2: f64 = 7.815;
/// Score below which a keyframe does not fit, 0 to 1.
const MIN_SCORE: f64 = 0.7;
/// Width of the robust cost of a pass, in standard deviations of an edge.
const HUBER: f64 = 3.0;

impl Mapper {
    /// Links all keyframes with the visits around them, and optimizes: the links of the last pass, accepted
    /// or not. A graph that cannot be solved stays as it was.
    pub(super) fn refine(
        &mut self,
        robot: &RobotConfig,
        config: &SlamConfig,
    ) -> Vec<LoopVerification> {
        let scans = self.keyframes.iter().map(|keyframe| &keyframe.scan);
        let profiles: Vec<_> = scans
            .map(|scan| Arc::new(RangeProfile::new(scan)))
            .collect();
        let mut map = LocalMap::default();
        let mut last = Vec::new();
        for _ in 0..PASSES {
            let nodes = 0..self.keyframes.len();
            let links: Vec<LoopVerification> = nodes
                .flat_map(|node| self.links(node, &profiles, &mut map, robot))
                .collect();
            let is_odometry = |view: &EdgeView| view.edge.kind == EdgeKind::Odometry;
            let mut graph = self.graph.with_edges(is_odometry);
            for link in links.iter().filter(|link| link.accepted()) {
                let (old, new) = (link.candidate.node, link.from_node);
                graph.add_edge(old, new, link.registered, link.information, EdgeKind::Loop);
            }
            let (steps, tolerance) = (config.optimizer_iterations, config.optimizer_tolerance);
            let report = graph.optimize_robust(steps, tolerance, HUBER);
            if matches!(report.stop, StopReason::Failed { .. }) {
                return last;
            }
            self.graph = graph;
            self.chi2 = self.graph.chi2();
            last = links;
        }
        last
    }

    /// The registrations of a keyframe on the visits around it.
    fn links(
        &self,
        node: usize,
        profiles: &[Arc<RangeProfile>],
        map: &mut LocalMap,
        robot: &RobotConfig,
    ) -> Vec<LoopVerification> {
        let nearby = LoopConfig {
            detection: Detection::Visits,
            radius_m: RADIUS_M,
            min_gap_nodes: MIN_GAP_NODES,
            ..LoopConfig::default()
        };
        let settings = robot.registration();
        let poses = self.graph.poses();
        let square = |sigma: f64| 1.0 / (sigma * sigma);
        let (shift, turn) = (square(SHIFT.0), square(SHIFT.1));
        let expected = Matrix3::from_diagonal(&Vector3::new(shift, shift, turn));
        let mut links = Vec::new();
        for visit in detect_visits(poses, node, &nearby).into_iter().take(VISITS) {
            let center = visit.node;
            let last = (center + HALF_SUBMAP).min(node - 1);
            let around = center.saturating_sub(HALF_SUBMAP)..=last;
            map.rebuild(around.map(|near| {
                let pose = poses[center].between(&poses[near]);
                (pose, &*self.keyframes[near].scan, &profiles[near])
            }));
            let belief = poses[center].between(&poses[node]);
            let stages = [settings.reach_m, settings.fit_m];
            let scan = &self.keyframes[node].scan;
            let found = map.register(scan, belief, &stages, None, &settings);
            let registered = found.registered.pose;
            let innovation = belief.between(&registered).log();
            let gate = chi_squared_gate(&innovation, &expected, GATE_CHI2);
            let score = found.fit.score;
            let rejection = if score < MIN_SCORE {
                let min_score = MIN_SCORE;
                Some(LoopRejection::LowScore { score, min_score })
            } else {
                (!gate.passes()).then_some(LoopRejection::OutsideGate(gate))
            };
            links.push(LoopVerification {
                from_node: node,
                candidate: visit,
                belief,
                initial: belief,
                registered,
                rmse_m: found.fit.rmse_m,
                inliers: found.fit.inliers,
                iterations: found.registered.iterations,
                score: Some(score),
                margin: None,
                innovation,
                gate_information: expected,
                gate,
                information: found.information(),
                rejection,
            });
        }
        links
    }
}
