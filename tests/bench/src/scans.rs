//! The runs of scan matching: registration, landscapes, maps and normals.

use ch16_lab::basin::{BasinOutcome, BasinScene, BasinStart};
use ch16_lab::samples;
use ch16_lab::terrain::{SceneKind, Terrain, TerrainScene, TerrainSettings};
use ch16_slam2d::cloud::{
    DenseMap, NearestMap, NearestTable, Neighbor, NormalEstimator, PointCloud, VoxelMap,
};
use ch16_slam2d::digest::Digest;
use ch16_slam2d::icp::{Icp, IcpConfig, IcpVariant, IcpWorkspace};
use ch16_slam2d::ndt::{NdtConfig, NdtMap, ndt_align};
use pr_geom::{Point2, SE2};
use pr_sim::Rng;

use crate::{Run, prepared};

/// Queries of the nearest-neighbour workload.
pub(crate) const QUERIES: usize = 1000;
/// Correspondence distance of the basin explorer, m.
const TAU_M: f64 = 0.7;
/// Width of an NDT cell, m, and the smallest number of points in it.
const NDT_CELL_M: f64 = 0.5;
const NDT_MIN_POINTS: usize = 4;

/// A scene of the basin explorer with the inputs and results of a registration.
struct Basin {
    scene: BasinScene,
    config: IcpConfig,
    workspace: IcpWorkspace,
    outcomes: Vec<BasinOutcome>,
}

impl Basin {
    fn new(config: IcpConfig) -> Self {
        Self {
            scene: BasinScene::new(),
            config,
            workspace: IcpWorkspace::new(),
            outcomes: Vec::new(),
        }
    }

    fn add_to(&self, digest: &mut Digest) {
        for outcome in &self.outcomes {
            digest.add_pose(&outcome.pose);
            digest.add_all(&[outcome.error_m, outcome.error_deg, outcome.rmse_m]);
            digest.add_bits(outcome.inliers as u64);
            digest.add_bits(outcome.iterations as u64);
        }
    }
}

/// Settings with which every run needs all of its 30 iterations.
fn all_iterations(variant: IcpVariant) -> IcpConfig {
    IcpConfig {
        tolerance: 0.0,
        ..BasinScene::config(variant, TAU_M)
    }
}

/// A registration that looks neighbours up in the scene's table, which was built before.
pub(crate) fn register_with_table(variant: IcpVariant) -> Box<dyn Run> {
    prepared(
        Basin::new(all_iterations(variant)),
        |basin| {
            let (start, workspace) = (BasinStart::default(), &mut basin.workspace);
            let outcome = basin.scene.register_from(&start, &basin.config, workspace);
            basin.outcomes.clear();
            basin.outcomes.push(outcome);
        },
        Basin::add_to,
    )
}

/// The same registration on the dense map, without a table.
pub(crate) fn register_without_table(variant: IcpVariant) -> Box<dyn Run> {
    prepared(
        Basin::new(all_iterations(variant)),
        |basin| {
            let (scene, workspace) = (&basin.scene, &mut basin.workspace);
            let guess = scene.guess(&BasinStart::default());
            let map = scene.map().map();
            let found = Icp::new(scene.source(), map, guess, &basin.config, workspace).run();
            basin.outcomes.clear();
            let outcome = BasinOutcome::judge(&basin.scene.truth(), &found);
            basin.outcomes.push(outcome);
        },
        Basin::add_to,
    )
}

/// Builds the scene's table of nearest neighbours.
pub(crate) fn table() -> Box<dyn Run> {
    let scene = BasinScene::new();
    prepared(
        (scene, None),
        |(scene, table)| *table = Some(BasinScene::table(scene.map().map().clone())),
        |(scene, table), digest| {
            if let Some(table) = table {
                let found = scene
                    .source()
                    .iter()
                    .map(|point| table.neighbor(point, TAU_M));
                found.for_each(|found| add_neighbor(found, digest));
            }
        },
    )
}

/// A whole sweep over headings: the scene with its table, and a registration for each degree.
pub(crate) fn sweep(variant: IcpVariant) -> Box<dyn Run> {
    prepared(
        Basin::new(BasinScene::config(variant, TAU_M)),
        |basin| {
            basin.scene = BasinScene::new();
            let headings = (-180..=180).map(f64::from);
            let (start, workspace) = (BasinStart::default(), &mut basin.workspace);
            let outcomes = basin.scene.sweep(start, headings, &basin.config, workspace);
            basin.outcomes.clear();
            basin.outcomes.extend(outcomes);
        },
        Basin::add_to,
    )
}

pub(crate) fn terrain(n: usize) -> Box<dyn Run> {
    let scene = TerrainScene::new(SceneKind::Room, TerrainScene::DEFAULT_NDT_CELL_M);
    let settings = TerrainSettings {
        n,
        ..TerrainSettings::default()
    };
    prepared(
        (scene, settings, Terrain::default()),
        |(scene, settings, terrain)| terrain.recompute(scene, settings),
        |(_, _, terrain), digest| {
            digest.add_all(terrain.icp_cost_m2());
            digest.add_all(terrain.ndt_score());
        },
    )
}

pub(crate) fn ndt_build() -> Box<dyn Run> {
    let (_, target) = room_sweep();
    prepared(
        (target, None),
        |(target, map)| *map = Some(NdtMap::build(target, NDT_CELL_M, NDT_MIN_POINTS)),
        |(_, map), digest| {
            for cell in map.iter().flat_map(NdtMap::cells) {
                digest.add_all([cell.cell.0, cell.cell.1].map(f64::from).iter());
                digest.add_bits(cell.count as u64);
                digest.add_all(&cell.mean.coords);
                digest.add_all(&cell.covariance);
                digest.add_all(&cell.information);
            }
        },
    )
}

pub(crate) fn ndt_registration() -> Box<dyn Run> {
    let (cloud, target) = room_sweep();
    let map = NdtMap::build(&target, NDT_CELL_M, NDT_MIN_POINTS);
    prepared(
        (cloud, map, None),
        |(cloud, map, found)| {
            let init = SE2::new(2.4, 2.15, 0.05);
            *found = Some(ndt_align(cloud, map, init, &NdtConfig::default()));
        },
        |(_, _, found), digest| {
            if let Some(found) = found {
                digest.add_pose(&found.pose);
                digest.add(found.score);
                found.trace.iter().for_each(|pose| digest.add_pose(pose));
            }
        },
    )
}

/// Queries of neighbouring beams in a table of nearest neighbours, which was built before.
pub(crate) fn nearest_in_table() -> Box<dyn Run> {
    let map = DenseMap::from_cloud(&samples::apartment_map(), 0.25, usize::MAX);
    nearest_in(NearestTable::new(map, 0.08, 1.0))
}

/// The same queries in the dense map.
pub(crate) fn nearest_in_dense_map() -> Box<dyn Run> {
    nearest_in(DenseMap::from_cloud(
        &samples::apartment_map(),
        0.25,
        usize::MAX,
    ))
}

/// The same queries in the chapter's voxel map.
pub(crate) fn nearest_in_voxel_map() -> Box<dyn Run> {
    nearest_in(VoxelMap::from_cloud(
        &samples::apartment_map(),
        0.25,
        usize::MAX,
    ))
}

fn nearest_in<M: NearestMap + 'static>(map: M) -> Box<dyn Run> {
    let pose = SE2::new(3.4, 4.4, 0.2);
    let near = pose * SE2::new(0.1, 0.1, 0.03);
    let cloud = samples::sweep(&pose, QUERIES, &mut Rng::new(77)).transformed(&near);
    let queries: Vec<Point2<f64>> = (0..QUERIES).map(|k| cloud.point(k % cloud.len())).collect();
    prepared(
        (map, queries, Vec::with_capacity(QUERIES)),
        |(map, queries, found)| {
            found.clear();
            found.extend(queries.iter().map(|query| map.neighbor(*query, 0.5)));
        },
        |(map, _, found), digest| {
            for found in found {
                add_neighbor(*found, digest);
                // Each map numbers its points in its own order.
                let point = found.map(|found| map.point(found.index));
                digest.add_all(&point.unwrap_or_default().coords);
            }
        },
    )
}

fn add_neighbor(found: Option<Neighbor>, digest: &mut Digest) {
    digest.add_bits(found.map_or(u64::MAX, |found| found.index as u64));
    digest.add(found.map_or(-1.0, |found| found.distance_squared_m2));
}

pub(crate) fn normals() -> Box<dyn Run> {
    let cloud = samples::sweep(&room_pose(), 720, &mut Rng::new(3));
    prepared(
        (cloud, NormalEstimator::default()),
        |(cloud, estimator)| estimator.estimate(cloud, 0.3),
        |(cloud, _), digest| {
            for normal in (0..cloud.len()).map(|index| cloud.normal(index)) {
                digest.add_all(&normal.unwrap_or_default());
            }
        },
    )
}

/// One sweep of room A as thinned points, in the sensor's frame and in the world's.
fn room_sweep() -> (PointCloud, PointCloud) {
    let cloud = samples::sweep(&room_pose(), 180, &mut Rng::new(0x5C0)).downsample(0.08);
    let target = cloud.transformed(&room_pose());
    (cloud, target)
}

/// The middle of room A.
fn room_pose() -> SE2 {
    SE2::new(2.0, 1.9, 0.0)
}
