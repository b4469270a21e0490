//! The chapter's computations.

use ch16_slam2d::basin::{BasinScene, BasinStart};
use ch16_slam2d::cloud::{DenseMap, NearestMap, NormalEstimator, PointCloud};
use ch16_slam2d::icp::{IcpConfig, IcpVariant, IcpWorkspace};
use ch16_slam2d::ndt::{NdtConfig, NdtMap, ndt_align};
use ch16_slam2d::slam::{LapRunner, Slam, SlamConfig};
use ch16_slam2d::terrain::{SceneKind, Terrain, TerrainScene, TerrainSettings};
use nalgebra::Vector2;
use pr_geom::SE2;
use pr_sim::{Lidar, LidarConfig, Rng, World};

use crate::{Limit, Run, Workload, digest};

const fn limit(native_ms: f64, wasm_ms: f64) -> Option<Limit> {
    Some(Limit { native_ms, wasm_ms })
}

/// The workloads, one a computation.
#[must_use]
pub fn workloads() -> Vec<Workload> {
    let workload = |id, what, limit, prepare| Workload {
        id,
        what,
        repetitions: 1,
        limit,
        prepare,
    };
    vec![
        workload(
            "lap",
            "the canonical lap, simulated and estimated, with its front end alone and all metrics",
            limit(12.0, 25.0),
            lap,
        ),
        workload(
            "register-p2p",
            "one registration, 155 points, 30 iterations, point to point",
            limit(0.15, 0.3),
            || register(IcpVariant::PointToPoint),
        ),
        workload(
            "register-p2l",
            "one registration, 155 points, 30 iterations, point to plane",
            limit(0.15, 0.3),
            || register(IcpVariant::PointToPlane),
        ),
        workload(
            "sweep-p2p",
            "basin sweep, 361 headings, point to point",
            limit(30.0, 60.0),
            || sweep(IcpVariant::PointToPoint),
        ),
        workload(
            "sweep-p2l",
            "basin sweep, 361 headings, point to plane",
            limit(30.0, 60.0),
            || sweep(IcpVariant::PointToPlane),
        ),
        workload(
            "terrain-49",
            "cost terrain of the room, 49 × 49, both objectives",
            limit(4.0, 8.0),
            || terrain(49),
        ),
        workload(
            "terrain-161",
            "cost terrain of the room, 161 × 161, both objectives",
            limit(40.0, 80.0),
            || terrain(161),
        ),
        workload(
            "ndt-build",
            "NDT of one sweep, cells of 0.5 m",
            None,
            ndt_build,
        ),
        workload(
            "ndt-align",
            "NDT registration of one sweep",
            None,
            ndt_align_run,
        ),
        Workload {
            repetitions: QUERIES as u32,
            ..workload(
                "nearest",
                "nearest neighbour within 0.5 m, map of 5,000 points, a query",
                limit(90e-6, 150e-6),
                nearest,
            )
        },
        workload("normals", "normals of 720 points", None, normals),
        workload(
            "solve",
            "pose graph of the lap, 41 nodes, 15 iterations at most",
            None,
            solve,
        ),
        workload(
            "grid",
            "occupancy grid of the lap's keyframes, drawn again",
            None,
            grid,
        ),
    ]
}

/// Queries of the nearest-neighbour workload.
const QUERIES: usize = 1000;

fn lap() -> Run {
    // A runner that has driven before would leave the simulation out.
    Box::new(|| LapRunner::new().run(&SlamConfig::default()).digest())
}

fn register(variant: IcpVariant) -> Run {
    let scene = BasinScene::new();
    let mut workspace = IcpWorkspace::new();
    // A tolerance of zero makes every run use all of its 30 iterations.
    let config = IcpConfig {
        tolerance: 0.0,
        ..BasinScene::config(variant, 0.7)
    };
    Box::new(move || {
        let outcome = scene.register_from(&BasinStart::default(), &config, &mut workspace);
        digest([outcome.error_m])
    })
}

fn sweep(variant: IcpVariant) -> Run {
    let scene = BasinScene::new();
    let mut workspace = IcpWorkspace::new();
    let config = BasinScene::config(variant, 0.7);
    Box::new(move || {
        let headings = (-180..=180).map(f64::from);
        let outcomes = scene.sweep(BasinStart::default(), headings, &config, &mut workspace);
        digest(outcomes.map(|outcome| outcome.error_m))
    })
}

fn terrain(n: usize) -> Run {
    let scene = TerrainScene::new(SceneKind::Room, TerrainScene::DEFAULT_NDT_CELL_M);
    let settings = TerrainSettings {
        n,
        ..TerrainSettings::default()
    };
    let mut terrain = Terrain::default();
    Box::new(move || {
        terrain.recompute(&scene, &settings);
        let row = n / 3 * n..(n / 3 + 1) * n;
        let (cost, score) = (terrain.icp_cost_m2(), terrain.ndt_score());
        digest(cost[row.clone()].iter().chain(&score[row]).copied())
    })
}

fn ndt_build() -> Run {
    let (_, target) = room_sweep();
    Box::new(move || NdtMap::build(&target, 0.5, 4).cells().len() as u64)
}

fn ndt_align_run() -> Run {
    let (cloud, target) = room_sweep();
    let map = NdtMap::build(&target, 0.5, 4);
    let init = SE2::new(2.4, 2.15, 0.05);
    Box::new(move || {
        let found = ndt_align(&cloud, &map, init, &NdtConfig::default());
        digest(found.pose.to_array())
    })
}

fn nearest() -> Run {
    let mut rng = Rng::new(5);
    let mut points = PointCloud::new();
    for k in 0..14 {
        let (column, row) = (f64::from(k % 7), f64::from(k / 7));
        let pose = SE2::new(0.9 + 1.7 * column, 2.2 + 4.6 * row, 0.3 * column);
        points.extend_transformed(&returns(&pose, 360, &mut rng), &pose);
    }
    let points: PointCloud = points.iter().take(5000).collect();
    let map = DenseMap::from_cloud(&points, 0.25, usize::MAX);
    let pose = SE2::new(3.4, 4.4, 0.2);
    let near = pose * SE2::new(0.1, 0.1, 0.03);
    let cloud = returns(&pose, QUERIES, &mut Rng::new(77)).transformed(&near);
    let queries: Vec<Vector2<f64>> = (0..QUERIES).map(|k| cloud.point(k % cloud.len())).collect();
    Box::new(move || {
        let found = queries.iter().map(|query| map.nearest(*query, 0.5));
        found.map(|found| found.map_or(0, |n| n.index as u64)).sum()
    })
}

fn normals() -> Run {
    let mut cloud = returns(&SE2::new(2.0, 1.9, 0.0), 720, &mut Rng::new(3));
    let mut estimator = NormalEstimator::default();
    Box::new(move || {
        estimator.estimate(&mut cloud, 0.3);
        cloud
            .normal(100)
            .map_or(0, |normal| normal.x.abs().to_bits())
    })
}

fn solve() -> Run {
    let mut slam = Slam::new(SlamConfig::default());
    slam.run();
    let graph = slam.graph().clone();
    let start: Vec<SE2> = slam
        .keyframes()
        .iter()
        .map(|keyframe| slam.drive().ticks().get(keyframe.tick.wrapping_sub(1)))
        .map(|tick| tick.map_or(slam.config().drive.start, |tick| tick.dead_reckoning))
        .collect();
    let mut graph = graph;
    Box::new(move || {
        for (node, pose) in start.iter().enumerate() {
            graph.set_pose(node, *pose);
        }
        graph.optimize_robust(15, 1e-7, 12.0);
        digest(graph.poses().iter().flat_map(SE2::to_array))
    })
}

fn grid() -> Run {
    let record = LapRunner::new().run(&SlamConfig::default());
    Box::new(move || {
        digest(
            record
                .occupancy_grid(record.ticks())
                .log_odds()
                .iter()
                .copied(),
        )
    })
}

/// One sweep of room A as thinned points: in the sensor's frame and in the world's.
fn room_sweep() -> (PointCloud, PointCloud) {
    let pose = SE2::new(2.0, 1.9, 0.0);
    let cloud = returns(&pose, 180, &mut Rng::new(0x5C0)).downsample(0.08);
    let target = cloud.transformed(&pose);
    (cloud, target)
}

/// The returns of one sweep of the Apartment in the sensor's frame.
fn returns(pose: &SE2, beams: usize, rng: &mut Rng) -> PointCloud {
    let mut lidar = Lidar::new(LidarConfig {
        beams,
        range_sigma_m: 0.02,
        ..LidarConfig::default()
    });
    let ranges_m = lidar.sense(&World::apartment(), pose, rng);
    lidar.project(&ranges_m).collect()
}
