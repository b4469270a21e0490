//! Recomputes the details of one tick: its local map, its registration iteration by iteration, and the graph
//! before a loop.
//!
//! A record does not store these.

use pr_geom::SE2;

use super::record::{LapRecord, LapTrace, RecordedEdge};
use super::{Drive, LapConfig, RecordedLoopAttempt, RecordedWindowScan};
use ch16_slam2d::cloud::{DenseMap, PointCloud};
use ch16_slam2d::graph::{EdgeKind, PoseGraph};
use ch16_slam2d::icp::{IcpConfig, IcpResult, icp};

/// The complete registration of one sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct RegistrationView {
    /// The sweeps of the local map, oldest first.
    pub window: Vec<RecordedWindowScan>,
    /// Points of the local map, world frame; its cells keep only some of them.
    pub local_cloud: PointCloud,
    /// Initial guess of the registration: `world_from_body`.
    pub prediction: SE2,
    /// The registration with its history and last pairs, world frame.
    pub icp: IcpResult,
}

impl LapRecord {
    /// The registration of `tick` in the lap; `None` at the start.
    #[must_use]
    pub fn registration(&self, tick: usize) -> Option<RegistrationView> {
        self.lap.registration(tick, &self.drive, &self.config)
    }
}

impl LapTrace {
    /// The registration of `tick`; `None` at the start. `drive` and `config` are those of the lap.
    ///
    /// Matchers other than ICP return the pairs at their result, without iterations.
    #[must_use]
    pub fn registration(
        &self,
        tick: usize,
        drive: &Drive,
        config: &LapConfig,
    ) -> Option<RegistrationView> {
        let recorded = &self.report(tick)?.registration;
        let slam = &config.slam;
        let window = self.window(tick, config);
        let mut local_cloud = PointCloud::default();
        for sweep in &window {
            local_cloud.extend_transformed(&drive.sweep(sweep.tick).cloud, &sweep.pose);
        }
        let map = DenseMap::from_cloud(
            &local_cloud,
            slam.chapter.local_map.cell_m,
            slam.chapter.local_map.max_per_cell,
        );
        let (init, max_iterations) = match slam.chapter.matcher.icp() {
            Some(_) => (recorded.prediction, slam.chapter.max_iterations),
            None => (recorded.matched.pose, 0),
        };
        let settings = IcpConfig {
            max_iterations,
            tau_m: recorded.tau_m,
            ..slam.chapter.matcher.icp().unwrap_or_default()
        };
        Some(RegistrationView {
            icp: icp(&drive.sweep(tick).cloud, &map, init, &settings),
            window,
            local_cloud,
            prediction: recorded.prediction,
        })
    }

    /// The graph before `attempt`: with the new keyframe, without the candidate loop.
    #[must_use]
    pub fn graph_before(&self, attempt: &RecordedLoopAttempt) -> PoseGraph {
        let tick = attempt.tick;
        let poses = match self.loop_motion(tick) {
            Some((before, _)) => before,
            None => self.poses(tick),
        };
        let edges = self.edges(tick).iter();
        graph_of(
            poses,
            edges.filter(|edge| edge.kind == EdgeKind::Odometry || edge.tick < tick),
        )
    }

    /// The graph at the end of `tick`.
    #[must_use]
    pub fn graph(&self, tick: usize) -> PoseGraph {
        graph_of(self.poses(tick), self.edges(tick).iter())
    }
}

/// The graph at these poses, the first of them fixed.
pub(super) fn graph_of<'a>(
    poses: &[SE2],
    edges: impl Iterator<Item = &'a RecordedEdge>,
) -> PoseGraph {
    let mut graph = PoseGraph::new();
    for (node, pose) in poses.iter().enumerate() {
        match node {
            0 => graph.add_fixed_node(*pose),
            _ => graph.add_node(*pose),
        };
    }
    for edge in edges {
        graph.add_edge(
            edge.from,
            edge.to,
            edge.measurement,
            edge.information,
            edge.kind,
        );
    }
    graph.mark_optimized(graph.edge_count());
    graph
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lap::LapRunner;
    use ch16_slam2d::chapter::marginal_information;
    use ch16_slam2d::loops::GateModel;

    #[test]
    fn a_replayed_registration_has_the_bits_of_the_recorded_one() {
        let record = LapRunner::new().run(&LapConfig::default());
        for tick in 1..=record.ticks() {
            let view = record.registration(tick).unwrap();
            let recorded = record.lap.report(tick).unwrap().registration;
            assert_eq!(view.icp.pose, recorded.matched.pose, "tick {tick}");
            assert_eq!(view.icp.rmse_m, recorded.matched.rmse_m, "tick {tick}");
        }
        assert_eq!(record.registration(0), None);
    }

    #[test]
    fn the_graph_before_a_loop_gives_the_exact_gate_its_covariance() {
        let mut config = LapConfig::default();
        config.slam.chapter.loops.gate_model = GateModel::ExactMarginal;
        let lap = LapRunner::new().run(&config).lap;
        let attempts: Vec<_> = lap.loop_attempts().collect();
        assert!(attempts.iter().filter(|a| a.accepted()).count() > 1);
        for attempt in attempts {
            let loop_ = &attempt.verification;
            let (old, new) = (loop_.candidate.node, loop_.from_node);
            let mut graph = lap.graph_before(attempt);
            assert_eq!(graph.pose(old).between(&graph.pose(new)), loop_.predicted);
            assert_eq!(
                marginal_information(&mut graph, old, new),
                Ok(loop_.gate_information)
            );
        }
    }
}
