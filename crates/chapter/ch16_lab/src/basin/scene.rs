//! Two sweeps of one location and the registration from a start.

use pr_geom::{Point2, SE2};
use pr_sim::{Lidar, LidarConfig, Rng, World};
use serde::Serialize;

use super::{BasinOutcome, BasinPlace, fence};
use crate::scenes::{self, MAP_POINTS_PER_CELL, NORMAL_RADIUS_M};
use ch16_slam2d::cloud::{DenseMap, NearestTable, PointCloud};
use ch16_slam2d::icp::{
    Icp, IcpConfig, IcpSummary, IcpVariant, IcpWorkspace, Increment, PairRejection,
};

const RANGE_SIGMA_M: f64 = 0.012;
const TARGET_VOXEL_M: f64 = 0.06;
const SOURCE_VOXEL_M: f64 = 0.09;
const MAP_CELL_M: f64 = 0.25;
/// A basin map queries the target about a million times, so nearest neighbours are tabulated.
const TABLE_SQUARE_M: f64 = 0.08;
const TABLE_REACH_M: f64 = 2.0;

/// An initial guess, relative to the truth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BasinStart {
    /// Added to the heading, degrees.
    pub heading_deg: f64,
    /// Added to x of the translation, m.
    pub dx_m: f64,
    /// Added to y of the translation, m.
    pub dy_m: f64,
}

impl Default for BasinStart {
    fn default() -> Self {
        Self {
            heading_deg: 25.0,
            dx_m: 0.55,
            dy_m: 0.45,
        }
    }
}

impl BasinPlace {
    fn world(self) -> World {
        match self {
            Self::Room => World::apartment(),
            Self::Fence => fence::world(),
        }
    }

    fn lidar(self) -> Lidar {
        match self {
            Self::Room => scenes::lidar(RANGE_SIGMA_M, LidarConfig::default().max_range_m),
            Self::Fence => fence::lidar(RANGE_SIGMA_M),
        }
    }

    /// Largest range that is kept of the target and of the source, m.
    fn kept_m(self) -> [f64; 2] {
        match self {
            Self::Room => [f64::INFINITY; 2],
            Self::Fence => fence::KEPT_M,
        }
    }

    /// Poses of the target's and of the source's sensor, `world_from_sensor`.
    fn sensors(self) -> [SE2; 2] {
        match self {
            Self::Room => [scenes::room_a(), SE2::new(2.5, 1.55, 0.35)],
            Self::Fence => fence::sensors(),
        }
    }
}

/// Two sweeps of one location: the target with its map, and the source to be registered on it.
#[derive(Clone, Debug)]
pub struct BasinScene {
    place: BasinPlace,
    world_from_target: SE2,
    target: PointCloud,
    map: NearestTable,
    source: PointCloud,
    truth: SE2,
    walls: Vec<[Point2<f64>; 2]>,
}

impl Default for BasinScene {
    fn default() -> Self {
        Self::new()
    }
}

impl BasinScene {
    /// Seed of the chapter's range noise.
    pub const SEED: u32 = 0x1C9;
    /// Largest number of iterations of the chapter's registrations. Some starts of the correct basin need more.
    pub const MAX_ITERS: usize = 30;
    /// A number of iterations within which every start of the correct basin converges.
    pub const PATIENT_ITERS: usize = 200;

    /// The chapter's scene.
    #[must_use]
    pub fn new() -> Self {
        Self::with_seed(Self::SEED)
    }

    /// The chapter's scene with another seed of the range noise.
    #[must_use]
    pub fn with_seed(seed: u32) -> Self {
        Self::at(BasinPlace::Room, seed)
    }

    /// The scene at another location.
    #[must_use]
    pub fn at(place: BasinPlace, seed: u32) -> Self {
        Self::in_world(&place.world(), place.sensors(), place, seed)
    }

    /// A scene in any world from two poses of the sensor of a place, whose rules judge its results.
    #[must_use]
    pub fn in_world(world: &World, sensors: [SE2; 2], place: BasinPlace, seed: u32) -> Self {
        let [world_from_target, world_from_source] = sensors;
        let [target_kept_m, source_kept_m] = place.kept_m();
        let mut lidar = place.lidar();
        let mut rng = Rng::new(seed);
        let mut sweep = |world_from_sensor: &SE2, voxel_m: f64, kept_m: f64| -> PointCloud {
            let cloud = scenes::sweep(world, &mut lidar, world_from_sensor, &mut rng, voxel_m);
            let near = cloud.iter();
            near.filter(|point| point.coords.norm() < kept_m).collect()
        };
        let mut target = sweep(&world_from_target, TARGET_VOXEL_M, target_kept_m);
        let source = sweep(&world_from_source, SOURCE_VOXEL_M, source_kept_m);
        target.estimate_normals(NORMAL_RADIUS_M);
        let map = DenseMap::from_cloud(&target, MAP_CELL_M, MAP_POINTS_PER_CELL);
        Self {
            place,
            world_from_target,
            map: Self::table(map),
            target,
            source,
            truth: world_from_target.between(&world_from_source),
            walls: scenes::walls_seen_from(world, &world_from_target),
        }
    }

    /// The table for nearest-neighbour queries, built from the target's map.
    #[must_use]
    pub fn table(map: DenseMap) -> NearestTable {
        NearestTable::new(map, TABLE_SQUARE_M, TABLE_REACH_M)
    }

    /// The scene's registration settings: 30 iterations, everything else as in the chapter.
    #[must_use]
    pub fn config(variant: IcpVariant, tau_m: f64) -> IcpConfig {
        IcpConfig {
            variant,
            tau_m,
            max_iterations: Self::MAX_ITERS,
            ..IcpConfig::default()
        }
    }

    /// The location of the sweeps.
    #[must_use]
    pub fn place(&self) -> BasinPlace {
        self.place
    }

    /// Points of the target in its sensor's frame, with normals.
    #[must_use]
    pub fn target(&self) -> &PointCloud {
        &self.target
    }

    /// The target's map.
    #[must_use]
    pub fn map(&self) -> &NearestTable {
        &self.map
    }

    /// The walls in the frame of the target's sensor, as pictures draw them.
    #[must_use]
    pub fn walls(&self) -> &[[Point2<f64>; 2]] {
        &self.walls
    }

    /// Points of the source in its sensor's frame.
    #[must_use]
    pub fn source(&self) -> &PointCloud {
        &self.source
    }

    /// The true `target_from_source`.
    #[must_use]
    pub fn truth(&self) -> SE2 {
        self.truth
    }

    /// Pose of the target's sensor, `world_from_target`.
    #[must_use]
    pub fn world_from_target(&self) -> SE2 {
        self.world_from_target
    }

    /// The initial guess of a start, `target_from_source`.
    #[must_use]
    pub fn guess(&self, start: &BasinStart) -> SE2 {
        SE2::new(
            self.truth.x() + start.dx_m,
            self.truth.y() + start.dy_m,
            self.truth.theta() + start.heading_deg.to_radians(),
        )
    }

    /// The start whose guess is `target_from_source`: the inverse of [`BasinScene::guess`].
    #[must_use]
    pub fn start_of(&self, target_from_source: &SE2) -> BasinStart {
        let turn = SE2::new(0.0, 0.0, target_from_source.theta() - self.truth.theta());
        BasinStart {
            heading_deg: turn.theta().to_degrees(),
            dx_m: target_from_source.x() - self.truth.x(),
            dy_m: target_from_source.y() - self.truth.y(),
        }
    }

    /// Registers the source from `start`; the trace stays in the workspace.
    pub fn register_from(
        &self,
        start: &BasinStart,
        config: &IcpConfig,
        workspace: &mut IcpWorkspace,
    ) -> BasinOutcome {
        let guess = self.guess(start);
        let found = Icp::new(&self.source, &self.map, guess, config, workspace).run();
        self.judge(&found)
    }

    /// The same with a custom increment or rejection.
    pub fn register_with(
        &self,
        start: &BasinStart,
        config: &IcpConfig,
        (increment, rejection): (Option<&dyn Increment>, Option<&dyn PairRejection>),
        workspace: &mut IcpWorkspace,
    ) -> BasinOutcome {
        let guess = self.guess(start);
        let mut icp = Icp::new(&self.source, &self.map, guess, config, workspace);
        if let Some(rule) = increment {
            icp = icp.with_increment(rule);
        }
        if let Some(rule) = rejection {
            icp = icp.with_rejection(rule);
        }
        self.judge(&icp.run())
    }

    fn judge(&self, found: &IcpSummary) -> BasinOutcome {
        match self.place {
            BasinPlace::Room => BasinOutcome::judge(&self.truth, found),
            BasinPlace::Fence => BasinOutcome::judge_at_fence(&self.truth, found),
        }
    }

    /// Outcomes of a sweep over headings at the offsets of `start`, in order.
    pub fn sweep<'a>(
        &'a self,
        start: BasinStart,
        headings_deg: impl IntoIterator<Item = f64> + 'a,
        config: &'a IcpConfig,
        workspace: &'a mut IcpWorkspace,
    ) -> impl Iterator<Item = BasinOutcome> + 'a {
        headings_deg.into_iter().map(move |heading_deg| {
            let start = BasinStart {
                heading_deg,
                ..start
            };
            self.register_from(&start, config, workspace)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::basin::{FENCE_SPACING_M, Minimum};

    #[test]
    fn before_the_fence_there_is_a_minimum_at_each_spacing() {
        let scene = BasinScene::at(BasinPlace::Fence, BasinScene::SEED);
        let config = BasinScene::config(IcpVariant::PointToPoint, 0.7);
        let mut workspace = IcpWorkspace::new();
        for posts in -2_i32..=2 {
            let start = BasinStart {
                heading_deg: 0.0,
                // Beside the minimum, by less than half a spacing.
                dx_m: f64::from(posts) * FENCE_SPACING_M + 0.15,
                dy_m: 0.1,
            };
            let end = scene.register_from(&start, &config, &mut workspace);
            let expected = [Minimum::Right, Minimum::OnePost, Minimum::MorePosts];
            assert_eq!(
                end.ending,
                expected[posts.unsigned_abs() as usize],
                "{end:?}"
            );
            let off_m = f64::from(posts.abs()) * FENCE_SPACING_M;
            // 3 cm: noise of 1.2 cm a point, and posts that only one of the sweeps sees.
            assert!((end.error_m - off_m).abs() < 0.03, "{posts}: {end:?}");
            assert!(end.rmse_m < 0.06, "it fits as well as at home: {end:?}");
        }
    }
}
