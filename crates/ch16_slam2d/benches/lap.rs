//! The workloads of the lap: `cargo bench -p ch16_slam2d --bench lap`.

use std::hint::black_box;
use std::sync::Arc;

use ch16_slam2d::slam::{Drive, LapRunner, Slam, SlamConfig};
use criterion::{Criterion, criterion_group, criterion_main};

/// Noise factors that a dragged slider passes through.
const DRAGGED: [f64; 4] = [0.9, 1.0, 1.1, 1.2];

fn lap(criterion: &mut Criterion) {
    let config = SlamConfig::default();
    let mut group = criterion.benchmark_group("lap");
    group.bench_function("drive, 129 ticks", |b| {
        b.iter(|| Drive::simulate(black_box(&config.drive)));
    });
    group.bench_function("canonical run with all metrics", |b| {
        b.iter(|| Slam::new(black_box(config.clone())).run());
    });
    let drive = Arc::new(Drive::simulate(&config.drive));
    group.bench_function("canonical run on a drive that is there", |b| {
        b.iter(|| Slam::on_drive(black_box(config.clone()), Arc::clone(&drive)).run());
    });
    group.bench_function(
        "a drag of the noise slider, front end alone included",
        |b| {
            let mut runner = LapRunner::new();
            let mut steps = DRAGGED.iter().cycle();
            b.iter(|| {
                let noise = *steps.next().unwrap_or(&1.0);
                runner.run(&SlamConfig::with_seed_and_noise(config.drive.seed, noise))
            });
        },
    );
    let record = LapRunner::new().run(&config);
    group.bench_function("occupancy grid of all keyframes", |b| {
        b.iter(|| record.occupancy_grid(black_box(record.ticks())));
    });
    group.finish();
}

criterion_group!(benches, lap);
criterion_main!(benches);
