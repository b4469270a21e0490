//! Scan matching that the table of workloads does not cover: the sizes at which published libraries are
//! timed, the other map, the other location, and the parts.

use std::hint::black_box;

use ch16_lab::samples::{self, RegistrationSample};
use ch16_lab::terrain::{SceneKind, Terrain, TerrainScene, TerrainSettings};
use ch16_slam2d::cloud::{DenseMap, NearestMap, PointCloud, VoxelMap};
use ch16_slam2d::icp::{Icp, IcpConfig, IcpVariant, IcpWorkspace};
use criterion::Criterion;
use pr_geom::SE2;
use pr_sim::Rng;

const VARIANTS: [(&str, IcpVariant); 2] = [
    ("p2p", IcpVariant::PointToPoint),
    ("p2l", IcpVariant::PointToPlane),
];
/// Width of a map cell: half of τ, as `slam2d register` chooses it, m.
const CELL_M: f64 = 0.25;

fn dense(cloud: &PointCloud) -> DenseMap {
    DenseMap::from_cloud(cloud, CELL_M, usize::MAX)
}

pub fn register(c: &mut Criterion) {
    let (large, small) = (RegistrationSample::large(), RegistrationSample::small());
    let map = dense(&large.map);
    let mut workspace = IcpWorkspace::new();
    for (name, variant) in VARIANTS {
        let config = IcpConfig {
            variant,
            tau_m: 2.0 * CELL_M,
            ..IcpConfig::default()
        };
        c.bench_function(&format!("register 720 on 5000 points {name}"), |b| {
            let guess = large.guess;
            b.iter(|| Icp::new(&large.scan, &map, black_box(guess), &config, &mut workspace).run());
        });
        c.bench_function(&format!("build and register 180 on 180 {name}"), |b| {
            b.iter(|| {
                let map = dense(black_box(&small.map));
                Icp::new(&small.scan, &map, small.guess, &config, &mut workspace).run()
            });
        });
    }
}

pub fn maps(c: &mut Criterion) {
    let sample = RegistrationSample::large();
    let voxel = VoxelMap::from_cloud(&sample.map, CELL_M, usize::MAX);
    let scan = sample.scan.transformed(&sample.guess);
    c.bench_function("nearest of 5000 in a voxel map, 720 queries", |b| {
        b.iter(|| {
            let found = scan.iter().map(|query| voxel.neighbor(query, 0.5));
            found
                .map(|found| found.map_or(0, |found| found.index))
                .sum::<usize>()
        });
    });
    c.bench_function("build dense map of 5000", |b| {
        let mut map = DenseMap::new(CELL_M, usize::MAX);
        b.iter(|| map.rebuild(black_box(&sample.map)));
    });
    let sweep = samples::sweep(&SE2::new(2.0, 1.9, 0.0), 720, &mut Rng::new(3));
    c.bench_function("downsample 720 points", |b| {
        b.iter(|| black_box(&sweep).downsample(0.12));
    });
}

pub fn corridor(c: &mut Criterion) {
    let scene = TerrainScene::new(SceneKind::Corridor, TerrainScene::DEFAULT_NDT_CELL_M);
    let mut terrain = Terrain::default();
    for n in [49, 161] {
        let settings = TerrainSettings {
            n,
            ..TerrainSettings::default()
        };
        c.bench_function(&format!("terrain corridor {n}x{n}"), |b| {
            b.iter(|| terrain.recompute(black_box(&scene), &settings));
        });
    }
}
