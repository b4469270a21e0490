//! Detection of cycles by particles on the old part of the map.

use pr_geom::{Point2, SE2};

use super::{
    CycleClosure, CycleConfig, CycleTest, CycleVerdict, IncrementalConfig, LikelihoodMap,
    PoseBelief, push_backwards,
};
use crate::field::ScanClimb;
use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::metrics::position_error_m;
use ch16_slam2d::slam::Keyframe;

/// A posterior over the pose, weighted on the old map, next to the incremental mapper.
///
/// The old map holds only keyframes at least `min_gap_nodes` back: recent scans agree with the pose by
/// construction, and would hold all particles at the wrong pose.
#[derive(Clone, Debug)]
pub struct CycleWatch {
    config: CycleConfig,
    belief: PoseBelief,
    old_map: LikelihoodMap,
    /// Number of keyframes in the old map.
    old_nodes: usize,
    /// The newest node at which a cycle was closed or confirmed: earlier nodes are not moved again.
    last_known_node: usize,
}

impl CycleWatch {
    /// Starts at the first keyframe.
    #[must_use]
    pub fn new(config: CycleConfig, start: SE2) -> Self {
        Self {
            config,
            belief: PoseBelief::new(start, config.particles, config.seed),
            old_map: LikelihoodMap::new(config.field),
            old_nodes: 0,
            last_known_node: 0,
        }
    }

    /// The posterior.
    #[must_use]
    pub fn belief(&self) -> &PoseBelief {
        &self.belief
    }

    /// Follows the mapper to its newest keyframe, and corrects `poses` if a cycle closes.
    pub(super) fn test(
        &mut self,
        poses: &mut [SE2],
        keyframes: &[Keyframe],
        mapper: &IncrementalConfig,
    ) -> CycleTest {
        let node = poses.len() - 1;
        let config = self.config;
        self.add_old(poses, keyframes);
        let motion = poses[node - 1].between(&poses[node]);
        self.belief
            .predict(&motion, config.drift_sigma_m, config.drift_sigma_rad);
        let scan = &keyframes[node].scan;
        self.belief.weigh(&self.old_map, scan, config.weight);

        let mean = self.belief.mean();
        let spread = self.belief.spread();
        let known = self.share(scan, &mean, |point| Some(self.old_map.is_known(point)));
        let mut test = CycleTest {
            node,
            spread,
            known,
            fit: None,
            verdict: CycleVerdict::NewPlace,
        };
        if known < config.min_known {
            return test;
        }
        if spread.position_m > config.max_spread_m || spread.heading_rad > config.max_spread_rad {
            test.verdict = CycleVerdict::Undecided;
            return test;
        }
        // Coarse to fine: the particles use a wide field, the map one as narrow as the mapper's.
        let mut pose = mean;
        for sigma_m in [config.field.sigma_m, mapper.map.sigma_m] {
            let field = self.old_map.field(sigma_m);
            pose = ScanClimb::new(&field, scan, pose, None, mapper.climb)
                .run()
                .pose;
        }
        let fit = self.share(scan, &pose, |point| {
            let is_known = self.old_map.is_known(point);
            is_known.then(|| self.old_map.is_at_a_wall(point))
        });
        test.fit = Some(fit);
        let is_far = position_error_m(&pose, &mean) > 2.0 * config.field.sigma_m;
        test.verdict = if fit < config.min_fit || is_far {
            CycleVerdict::PoorFit
        } else {
            self.close_or_confirm(poses, pose)
        };
        test
    }

    /// At a known location: confirms the pose, or corrects the path.
    fn close_or_confirm(&mut self, poses: &mut [SE2], pose: SE2) -> CycleVerdict {
        let node = poses.len() - 1;
        let before = poses[node];
        let off = before.between(&pose);
        let is_off = position_error_m(&before, &pose) >= self.config.min_shift_m
            || off.theta().abs() >= self.config.min_turn_rad;
        let first = self.last_known_node.max(self.nearest_old(poses, &pose));
        self.last_known_node = node;
        if !is_off {
            return CycleVerdict::Confirmed;
        }
        let max_shift_m = push_backwards(&mut poses[first..], &pose);
        self.old_map.clear();
        self.old_nodes = 0;
        CycleVerdict::Closed(CycleClosure {
            from_node: first,
            to_node: node,
            before,
            after: pose,
            max_shift_m,
        })
    }

    /// The old keyframe nearest to `pose`, at which the cycle began.
    fn nearest_old(&self, poses: &[SE2], pose: &SE2) -> usize {
        let old = poses[..self.old_nodes].iter().enumerate();
        old.min_by(|(_, a), (_, b)| position_error_m(a, pose).total_cmp(&position_error_m(b, pose)))
            .map_or(0, |(node, _)| node)
    }

    /// Adds the keyframes that have become old; all of them after a correction.
    fn add_old(&mut self, poses: &[SE2], keyframes: &[Keyframe]) {
        let old = poses.len().saturating_sub(self.config.min_gap_nodes);
        for node in self.old_nodes..old {
            self.old_map.insert(&keyframes[node].scan, &poses[node]);
        }
        self.old_nodes = self.old_nodes.max(old);
    }

    /// Share of the points for which `test` is true, among those for which it is `Some`.
    fn share(
        &self,
        scan: &PointCloud,
        pose: &SE2,
        test: impl Fn(Point2<f64>) -> Option<bool>,
    ) -> f64 {
        let (mut counted, mut passed) = (0_usize, 0_usize);
        for passes in scan.iter().filter_map(|point| test(pose.transform(point))) {
            counted += 1;
            passed += usize::from(passes);
        }
        if counted == 0 {
            return 0.0;
        }
        passed as f64 / counted as f64
    }
}
