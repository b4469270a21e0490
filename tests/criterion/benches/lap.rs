//! The parts of the lap and the computations that a drag repeats.
//!
//! The whole lap, its warm solve and its grid are workloads.

use std::hint::black_box;
use std::sync::Arc;

use ch16_lab::lap::{Drive, Lap, LapConfig, LapRunner};
use ch16_lab::samples;
use criterion::Criterion;

/// Noise factors during a drag of the slider.
const DRAGGED: [f64; 4] = [0.9, 1.0, 1.1, 1.2];

pub fn parts(criterion: &mut Criterion) {
    let config = LapConfig::default();
    let mut group = criterion.benchmark_group("lap");
    group.bench_function("drive, 129 ticks", |b| {
        b.iter(|| Drive::simulate(black_box(&config.drive)));
    });
    group.bench_function("canonical run without its front end alone", |b| {
        b.iter(|| Lap::new(black_box(config.clone())).run());
    });
    let drive = Arc::new(Drive::simulate(&config.drive));
    group.bench_function("canonical run on a drive that is there", |b| {
        b.iter(|| Lap::on_drive(black_box(config.clone()), Arc::clone(&drive)).run());
    });
    group.bench_function(
        "a drag of the noise slider, front end alone included",
        |b| {
            let mut runner = LapRunner::new();
            let mut steps = DRAGGED.iter().cycle();
            b.iter(|| {
                let noise = *steps.next().unwrap_or(&1.0);
                runner.run(&LapConfig::with_seed_and_noise(config.drive.seed, noise))
            });
        },
    );
    group.finish();
}

/// The lap's own graph, solved with a new ordering and symbolic analysis.
pub fn cold_solve(criterion: &mut Criterion) {
    let graph = samples::lap_graph();
    criterion.bench_function("lap_41 cold", |b| {
        b.iter(|| {
            // A clone does not copy the analysis.
            let mut graph = graph.clone();
            graph.optimize_robust(15, 1e-7, 12.0)
        });
    });
}
