//! The locations, their maps, and the settings of the landscapes.

use pr_geom::{Rotation, SE2};
use pr_sim::{Lidar, Rng, World};
use serde::Serialize;

use super::information::{PoseInformation, pose_information};
use crate::scenes::{self, MAP_POINTS_PER_CELL, NORMAL_RADIUS_M};
use ch16_slam2d::cloud::{DenseMap, PointCloud};
use ch16_slam2d::icp::{IcpConfig, correspondences};
use ch16_slam2d::ndt::NdtMap;

const MAX_RANGE_M: f64 = 3.0;
pub(super) const RANGE_SIGMA_M: f64 = 0.01;
const VOXEL_M: f64 = 0.08;
const MAP_CELL_M: f64 = 0.3;
const NDT_MIN_POINTS: usize = 4;
/// The map of the long corridor extends this much beyond a sweep on either side, m: the largest shift of the
/// landscapes, so no end of the map fixes the sweep's position.
const MAP_STEP_M: f64 = 1.3;

/// The location of the sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum SceneKind {
    /// Room A: walls on all four sides.
    #[default]
    Room,
    /// The corridor: two long walls with doors, and no wall across. As in the room, the sweep is its own map.
    Corridor,
    /// A corridor without doors or ends in view. Map and sweep have independent noise, and the map extends
    /// beyond the sweep, so the position along the corridor is unconstrained.
    LongCorridor,
}

impl SceneKind {
    /// Pose of the sensor, `world_from_sensor`.
    fn world_from_sensor(self) -> SE2 {
        match self {
            Self::Room => scenes::room_a(),
            Self::Corridor | Self::LongCorridor => scenes::corridor(),
        }
    }

    fn world(self) -> World {
        match self {
            Self::Room | Self::Corridor => World::apartment(),
            Self::LongCorridor => scenes::long_corridor(),
        }
    }
}

/// Settings of the landscapes, apart from the location.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TerrainSettings {
    /// Shifts along each axis.
    pub n: usize,
    /// Largest shift, m: the axes run from `−span_m` to `span_m` inclusive.
    pub span_m: f64,
    /// Truncation of ICP's distances, m.
    pub tau_m: f64,
    /// Rotation of the cloud about the sensor, degrees.
    pub heading_deg: f64,
}

impl Default for TerrainSettings {
    fn default() -> Self {
        Self {
            n: 49,
            span_m: 1.3,
            tau_m: 0.6,
            heading_deg: 0.0,
        }
    }
}

impl TerrainSettings {
    /// The shift of column or row `index`, m.
    #[inline]
    #[must_use]
    pub fn offset_m(&self, index: usize) -> f64 {
        if self.n < 2 {
            return 0.0;
        }
        -self.span_m + 2.0 * self.span_m * index as f64 / (self.n - 1) as f64
    }

    /// Column or row of a shift, in fractions of a cell; it may lie outside.
    #[must_use]
    pub fn index_of(&self, offset_m: f64) -> f64 {
        0.5 * (offset_m / self.span_m + 1.0) * self.n.saturating_sub(1) as f64
    }
}

/// One sweep in the world's frame, and its map, as points for ICP and as Gaussians for NDT.
#[derive(Clone, Debug)]
pub struct TerrainScene {
    kind: SceneKind,
    seed: u32,
    world_from_sensor: SE2,
    cloud: PointCloud,
    /// The points from which the maps are built.
    target: PointCloud,
    map: DenseMap,
    ndt: NdtMap,
}

impl TerrainScene {
    /// Seed of the chapter's range noise.
    pub const SEED: u32 = 0x5C0;
    /// The chapter's size of an NDT cell, m.
    pub const DEFAULT_NDT_CELL_M: f64 = 0.55;

    /// The chapter's sweep of a location, with NDT cells of `ndt_cell_m`.
    ///
    /// # Panics
    /// If the cell size is not positive and finite.
    #[must_use]
    pub fn new(kind: SceneKind, ndt_cell_m: f64) -> Self {
        Self::with_seed(kind, ndt_cell_m, Self::SEED)
    }

    /// The same location with another seed of the range noise.
    ///
    /// # Panics
    /// If the cell size is not positive and finite.
    #[must_use]
    pub fn with_seed(kind: SceneKind, ndt_cell_m: f64, seed: u32) -> Self {
        let mut sweeper = Sweeper::new(kind);
        let mut rng = Rng::new(seed);
        let world_from_sensor = kind.world_from_sensor();
        let (target, cloud) = match kind {
            SceneKind::Room | SceneKind::Corridor => {
                let mut cloud = sweeper.sweep(&world_from_sensor, &mut rng);
                cloud.estimate_normals(NORMAL_RADIUS_M);
                (cloud.clone(), cloud)
            }
            SceneKind::LongCorridor => {
                let mut target = PointCloud::default();
                for step_m in [-MAP_STEP_M, 0.0, MAP_STEP_M] {
                    let beside = SE2::from_xy(step_m, 0.0) * world_from_sensor;
                    let sweep = sweeper.fresh_sweep(&beside, &mut rng);
                    target.extend_transformed(&sweep, &SE2::identity());
                }
                let mut target = target.downsample(VOXEL_M);
                target.estimate_normals(NORMAL_RADIUS_M);
                let mut cloud = sweeper.fresh_sweep(&world_from_sensor, &mut rng);
                cloud.estimate_normals(NORMAL_RADIUS_M);
                (target, cloud)
            }
        };
        Self {
            kind,
            seed,
            world_from_sensor,
            map: DenseMap::from_cloud(&target, MAP_CELL_M, MAP_POINTS_PER_CELL),
            ndt: NdtMap::build(&target, ndt_cell_m, NDT_MIN_POINTS),
            cloud,
            target,
        }
    }

    /// Rebuilds the NDT with cells of `ndt_cell_m`.
    ///
    /// # Panics
    /// If the cell size is not positive and finite.
    pub fn set_ndt_cell(&mut self, ndt_cell_m: f64) {
        self.ndt = NdtMap::build(&self.target, ndt_cell_m, NDT_MIN_POINTS);
    }

    /// The location.
    #[must_use]
    pub fn kind(&self) -> SceneKind {
        self.kind
    }

    /// The seed of the range noise.
    #[must_use]
    pub fn seed(&self) -> u32 {
        self.seed
    }

    /// The pose of the sensor.
    #[must_use]
    pub fn world_from_sensor(&self) -> SE2 {
        self.world_from_sensor
    }

    /// The points in the world's frame, with normals.
    #[must_use]
    pub fn cloud(&self) -> &PointCloud {
        &self.cloud
    }

    /// The map of ICP.
    #[must_use]
    pub fn map(&self) -> &DenseMap {
        &self.map
    }

    /// The map of NDT.
    #[must_use]
    pub fn ndt(&self) -> &NdtMap {
        &self.ndt
    }

    /// The point-to-plane information about the pose at the truth, for the scene's range noise.
    ///
    /// Only points with normals count. In the corridor all normals point across it, so the direction along it
    /// is unconstrained.
    #[must_use]
    pub fn information(&self, tau_m: f64) -> PoseInformation {
        let config = IcpConfig {
            tau_m,
            ..IcpConfig::default()
        };
        let mut pairs = correspondences(&self.cloud, &self.map, SE2::identity(), &config);
        pairs.retain(|pair| pair.normal.is_some());
        pose_information(&pairs, RANGE_SIGMA_M)
    }

    /// Writes the points, turned about the sensor by `heading_deg`, to `xs` and `ys`.
    pub(super) fn turned_into(&self, heading_deg: f64, xs: &mut Vec<f64>, ys: &mut Vec<f64>) {
        xs.clear();
        ys.clear();
        if heading_deg == 0.0 {
            xs.extend_from_slice(self.cloud.xs());
            ys.extend_from_slice(self.cloud.ys());
            return;
        }
        let rotation = Rotation::new(heading_deg.to_radians());
        let (sx, sy) = (self.world_from_sensor.x(), self.world_from_sensor.y());
        for (x, y) in self.cloud.xs().iter().zip(self.cloud.ys()) {
            let (x, y) = rotation.rotate(x - sx, y - sy);
            xs.push(x + sx);
            ys.push(y + sy);
        }
    }
}

/// Takes sweeps of a location, in the world's frame and thinned.
pub(super) struct Sweeper {
    world: World,
    lidar: Lidar,
}

impl Sweeper {
    pub(super) fn new(kind: SceneKind) -> Self {
        Self {
            world: kind.world(),
            lidar: scenes::lidar(RANGE_SIGMA_M, MAX_RANGE_M),
        }
    }

    fn sweep(&mut self, world_from_sensor: &SE2, rng: &mut Rng) -> PointCloud {
        let sweep = scenes::sweep(
            &self.world,
            &mut self.lidar,
            world_from_sensor,
            rng,
            VOXEL_M,
        );
        sweep.transformed(world_from_sensor)
    }

    /// A sweep whose beams point between those of any other: two of them share walls, not points.
    pub(super) fn fresh_sweep(&mut self, world_from_sensor: &SE2, rng: &mut Rng) -> PointCloud {
        let between_beams_rad = rng.uniform(0.0, self.lidar.config().angle_step_rad());
        let turned = *world_from_sensor * SE2::new(0.0, 0.0, between_beams_rad);
        self.sweep(&turned, rng)
    }
}
