//! Incremental mapping on the ring, over the frames of the laps: what it can do and what it cannot.

use std::sync::Arc;

use ch16_lab::incremental::IncrementalTrace;
use ch16_lab::lap::{BuiltInWorld, Drive, IncrementalKind, LapConfig, LapMatcher};
use ch16_slam2d::scan::FrameError;
use incremental_mapping::{CycleVerdict, IncrementalMapper};
use pr_geom::SE2;

/// Odometry noise at which climbing alone does not close the ring; `docs/worlds.md` has a hundred seeds of
/// it.
const NOISE: f64 = 4.0;
const SEEDS: u32 = 8;

fn ring(seed: u32, noise: f64) -> LapConfig {
    LapConfig::in_world(BuiltInWorld::Ring, seed, noise).with_matcher(LapMatcher::PointToPlane)
}

fn run(kind: IncrementalKind, lap: &LapConfig) -> IncrementalTrace {
    IncrementalTrace::run(kind, lap, &Drive::simulate(&lap.drive))
}

#[test]
fn the_cycle_of_the_ring_is_closed_with_particles_and_not_by_climbing_alone() {
    let runs = |kind| (1..=SEEDS).map(move |seed| run(kind, &ring(seed, NOISE)));
    let alone: Vec<IncrementalTrace> = runs(IncrementalKind::MaximumLikelihood).collect();
    let cycles: Vec<IncrementalTrace> = runs(IncrementalKind::WithCycles).collect();
    let met = |laps: &[IncrementalTrace]| {
        let disagreements = laps
            .iter()
            .map(|lap| lap.outcome.summary.map_disagreement_m);
        // The sensor's noise is 0.05 m: a larger distance means that walls are mapped twice.
        disagreements.filter(|value| value.unwrap() < 0.05).count()
    };
    assert!(met(&cycles) >= 7, "{}", met(&cycles));
    assert!(met(&alone) <= 2, "{}", met(&alone));
    let worst_m = |laps: &[IncrementalTrace]| {
        let errors = laps.iter().map(|lap| lap.outcome.summary.keyframe_rms_m);
        errors.fold(0.0, f64::max)
    };
    // The correction reduces the error of the whole path, not of its end alone.
    assert!(worst_m(&alone) > 1.0 && worst_m(&cycles) < 0.5);
    assert!(alone.iter().all(|lap| lap.tests.is_empty()));
    assert!(cycles.iter().all(|lap| lap.outcome.cycles > 0));
}

#[test]
fn a_drift_beyond_the_particles_is_not_closed() {
    // Particles with little spread, next to a pose that drifts: they never reach the old map.
    let lap = ring(5, NOISE);
    let drive = Drive::simulate(&lap.drive);
    let mut config = IncrementalKind::WithCycles.config(&lap);
    let cycles = config.cycles.as_mut().unwrap();
    (cycles.drift_sigma_m, cycles.drift_sigma_rad) = (0.002, 0.0005);
    let narrow = IncrementalTrace::from_mapper(IncrementalMapper::new(config), &drive);
    let whole = IncrementalTrace::run(IncrementalKind::WithCycles, &lap, &drive);
    let error_m = |trace: &IncrementalTrace| trace.outcome.summary.keyframe_rms_m;
    assert!(error_m(&narrow) > 1.0, "{}", error_m(&narrow));
    assert!(error_m(&whole) < 0.4, "{}", error_m(&whole));
}

#[test]
fn the_same_seed_gives_the_same_bits_on_raw_frames_and_on_prepared_ones() {
    let lap = LapConfig::with_seed_and_noise(3, 1.0);
    let drive = Arc::new(Drive::simulate(&lap.drive));
    let trace = IncrementalTrace::run(IncrementalKind::WithCycles, &lap, &drive);
    let mut mapper = IncrementalMapper::new(IncrementalKind::WithCycles.config(&lap));
    mapper.step(&drive.frame(0)).unwrap();
    for (k, estimate) in trace.estimates.iter().enumerate() {
        assert_eq!(
            mapper.step(&drive.frame(k + 1)).unwrap().estimate,
            *estimate
        );
    }
    assert_eq!(mapper.poses(), trace.poses);
    let mut other = IncrementalKind::WithCycles.config(&lap);
    other.cycles.as_mut().unwrap().seed = 4;
    let other = IncrementalTrace::from_mapper(IncrementalMapper::new(other), &drive);
    assert_ne!(other.tests, trace.tests);
    // In the Apartment the return path is known from the turn on.
    let known = trace.tests.iter().filter(|test| {
        matches!(
            test.verdict,
            CycleVerdict::Confirmed | CycleVerdict::Closed(_)
        )
    });
    assert!(known.count() > 3);
}

#[test]
fn an_unusable_frame_is_an_error_and_changes_no_state() {
    let lap = LapConfig::with_seed_and_noise(3, 1.0);
    let drive = Drive::simulate(&lap.drive);
    let mut mapper = IncrementalMapper::new(IncrementalKind::MaximumLikelihood.config(&lap));
    mapper.step(&drive.frame(0)).unwrap();
    mapper.step(&drive.frame(1)).unwrap();
    let (estimate, map) = (mapper.estimate(), mapper.map().cell_count());
    let stale = mapper.step(&drive.frame(1)).unwrap_err();
    assert!(matches!(stale, FrameError::Stamp { .. }), "{stale}");
    let mut wild = drive.frame(2);
    wild.odometry = Some(SE2::new(f64::NAN, 0.0, 0.0));
    assert!(mapper.step(&wild).is_err());
    assert_eq!(
        (mapper.estimate(), mapper.map().cell_count()),
        (estimate, map)
    );
    // A scan without returns leaves the prediction unchanged.
    let mut blind = drive.frame(2);
    blind.scan.ranges_m.fill(f64::NAN);
    let report = mapper.step(&blind).unwrap();
    assert!(report.prediction.between(&report.estimate).step_size() < 1e-9);
}
