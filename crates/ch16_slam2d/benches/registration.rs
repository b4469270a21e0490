//! The workloads of scan matching: `cargo bench -p ch16_slam2d`.

use std::hint::black_box;

use ch16_slam2d::basin::{BasinScene, BasinStart};
use ch16_slam2d::cloud::{DenseMap, NearestMap, NormalEstimator, PointCloud, VoxelMap};
use ch16_slam2d::icp::{Icp, IcpConfig, IcpVariant, IcpWorkspace};
use ch16_slam2d::ndt::{NdtConfig, NdtMap, ndt_align};
use ch16_slam2d::terrain::{SceneKind, Terrain, TerrainScene, TerrainSettings};
use criterion::{Criterion, criterion_group, criterion_main};
use pr_geom::{SE2, Vector2};
use pr_sim::{Lidar, LidarConfig, Rng, World};

const VARIANTS: [(&str, IcpVariant); 2] = [
    ("p2p", IcpVariant::PointToPoint),
    ("p2l", IcpVariant::PointToPlane),
];

/// `beams` returns of one sweep of the Apartment, in the sensor's frame.
fn sweep(pose: &SE2, beams: usize, rng: &mut Rng) -> PointCloud {
    let mut lidar = Lidar::new(LidarConfig {
        beams,
        range_sigma_m: 0.02,
        ..LidarConfig::default()
    });
    let ranges_m = lidar.sense(&World::apartment(), pose, rng);
    lidar.project(&ranges_m).collect()
}

/// 5,000 points of the Apartment with normals, seen from 14 places.
fn apartment_points() -> PointCloud {
    let mut rng = Rng::new(5);
    let mut points = PointCloud::new();
    for k in 0..14 {
        let (column, row) = (f64::from(k % 7), f64::from(k / 7));
        let pose = SE2::new(0.9 + 1.7 * column, 2.2 + 4.6 * row, 0.3 * column);
        points.extend_transformed(&sweep(&pose, 360, &mut rng), &pose);
    }
    let mut points: PointCloud = points.iter().take(5000).collect();
    assert_eq!(points.len(), 5000);
    points.estimate_normals(0.2);
    points
}

fn register(c: &mut Criterion) {
    let scene = BasinScene::new();
    let mut workspace = IcpWorkspace::new();
    for (name, variant) in VARIANTS {
        // A tolerance of zero makes every run use all of its 30 iterations.
        let config = IcpConfig {
            tolerance: 0.0,
            ..BasinScene::config(variant, 0.7)
        };
        c.bench_function(&format!("register 155 points 30 iterations {name}"), |b| {
            let start = BasinStart::default();
            b.iter(|| scene.register_from(black_box(&start), &config, &mut workspace));
        });
    }
    for (name, variant) in VARIANTS {
        let config = BasinScene::config(variant, 0.7);
        c.bench_function(&format!("basin sweep 361 headings {name}"), |b| {
            let start = BasinStart::default();
            b.iter(|| {
                let headings = (-180..=180).map(f64::from);
                scene
                    .sweep(start, headings, &config, &mut workspace)
                    .map(|outcome| outcome.iterations)
                    .sum::<usize>()
            });
        });
    }
}

fn register_against_peers(c: &mut Criterion) {
    let points = apartment_points();
    let map = DenseMap::from_cloud(&points, 0.25, usize::MAX);
    let pose = SE2::new(3.4, 4.4, 0.2);
    let scan = sweep(&pose, 720, &mut Rng::new(77));
    let small = sweep(&pose, 180, &mut Rng::new(78));
    let small_target = {
        let near = SE2::new(3.3, 4.45, 0.15);
        let mut cloud = sweep(&near, 180, &mut Rng::new(79)).transformed(&near);
        cloud.estimate_normals(0.3);
        cloud
    };
    let init = pose * SE2::new(0.15, -0.1, 0.05);
    let mut workspace = IcpWorkspace::new();
    for (name, variant) in VARIANTS {
        let config = IcpConfig {
            variant,
            tau: 0.5,
            ..IcpConfig::default()
        };
        c.bench_function(&format!("register 720 on 5000 points {name}"), |b| {
            b.iter(|| Icp::new(&scan, &map, black_box(init), &config, &mut workspace).run());
        });
        c.bench_function(&format!("build and register 180 on 180 {name}"), |b| {
            b.iter(|| {
                let map = DenseMap::from_cloud(black_box(&small_target), 0.25, usize::MAX);
                Icp::new(&small, &map, init, &config, &mut workspace).run()
            });
        });
    }
}

fn nearest(c: &mut Criterion) {
    let points = apartment_points();
    let dense = DenseMap::from_cloud(&points, 0.25, usize::MAX);
    let voxel = VoxelMap::from_cloud(&points, 0.25, usize::MAX);
    let pose = SE2::new(3.4, 4.4, 0.2);
    let scan =
        sweep(&pose, 1000, &mut Rng::new(77)).transformed(&(pose * SE2::new(0.1, 0.1, 0.03)));
    let queries: Vec<Vector2<f64>> = scan.iter().collect();
    let ask = |map: &dyn Fn(Vector2<f64>) -> usize| {
        queries.iter().map(|&query| map(query)).sum::<usize>()
    };
    c.bench_function(
        &format!("nearest of 5000 dense, {} queries", queries.len()),
        |b| {
            b.iter(|| ask(&|query| dense.nearest(query, 0.5).map_or(0, |found| found.index)));
        },
    );
    c.bench_function(
        &format!("nearest of 5000 voxel, {} queries", queries.len()),
        |b| {
            b.iter(|| ask(&|query| voxel.nearest(query, 0.5).map_or(0, |found| found.index)));
        },
    );
    c.bench_function("build dense map of 5000", |b| {
        let mut map = DenseMap::new(0.25, usize::MAX);
        b.iter(|| map.rebuild(black_box(&points)));
    });
}

fn terrain(c: &mut Criterion) {
    for (name, kind) in [("room", SceneKind::Room), ("corridor", SceneKind::Corridor)] {
        let scene = TerrainScene::new(kind, TerrainScene::DEFAULT_NDT_CELL_M);
        let mut terrain = Terrain::default();
        for n in [49, 161] {
            let settings = TerrainSettings {
                n,
                ..TerrainSettings::default()
            };
            c.bench_function(&format!("terrain {name} {n}x{n}"), |b| {
                b.iter(|| terrain.recompute(black_box(&scene), &settings));
            });
        }
    }
}

fn ndt(c: &mut Criterion) {
    let pose = SE2::new(2.0, 1.9, 0.0);
    let cloud = sweep(&pose, 180, &mut Rng::new(0x5C0)).downsample(0.08);
    let target = cloud.transformed(&pose);
    let map = NdtMap::build(&target, 0.5, 4);
    c.bench_function("ndt build", |b| {
        b.iter(|| NdtMap::build(black_box(&target), 0.5, 4));
    });
    c.bench_function("ndt align", |b| {
        let init = SE2::new(2.4, 2.15, 0.05);
        b.iter(|| ndt_align(&cloud, &map, black_box(init), &NdtConfig::default()));
    });
}

fn clouds(c: &mut Criterion) {
    let pose = SE2::new(2.0, 1.9, 0.0);
    let mut cloud = sweep(&pose, 720, &mut Rng::new(3));
    let mut estimator = NormalEstimator::default();
    c.bench_function("normals of 720 points", |b| {
        b.iter(|| estimator.estimate(black_box(&mut cloud), 0.3));
    });
    c.bench_function("downsample 720 points", |b| {
        b.iter(|| black_box(&cloud).downsample(0.12));
    });
}

criterion_group!(
    benches,
    register,
    register_against_peers,
    nearest,
    terrain,
    ndt,
    clouds
);
criterion_main!(benches);
