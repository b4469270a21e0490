//! A world with a true cycle, and other matchers, run through the same code as the chapter's lap.

use ch16_lab::lap::{BuiltInWorld, Choice, Lap, LapConfig, LapMatcher, LapRecord, LapRunner};

/// The lap around the ring with the estimator that is not the chapter's.
fn ring(seed: u32, matcher: LapMatcher) -> LapRecord {
    let config = LapConfig::in_world(BuiltInWorld::Ring, seed, 1.0).with_matcher(matcher);
    LapRunner::new().run(&config)
}

#[test]
fn ndt_closes_the_cycle_of_the_ring_and_the_whole_way_around_gets_better() {
    for seed in 1..=4 {
        let record = ring(seed, LapMatcher::Ndt);
        let (lap, alone) = (record.lap.summary, record.front_end.summary);
        assert!(lap.loops > 0, "seed {seed}");
        assert_eq!(record.lap.false_acceptances().count(), 0, "seed {seed}");
        // Not the end alone, as on the way back through a corridor: the middle of the way, too.
        assert!(lap.keyframe_rms_m < alone.keyframe_rms_m, "seed {seed}");
        // The map of the first corridor is compared with itself, seen from the other side.
        assert!(lap.map_disagreement_m < alone.map_disagreement_m);
    }
}

#[test]
fn point_to_point_turns_so_far_on_the_ring_that_its_end_is_not_found() {
    let record = ring(1, LapMatcher::PointToPoint);
    let end = record.lap.reports.last().unwrap();
    // Old keyframes are near again and tried, and the fit turns them away.
    assert!(record.lap.loop_attempts().count() > 0);
    assert_eq!(record.lap.summary.loops, 0);
    let turned_rad = end.truth.between(&end.estimate).theta();
    assert!(turned_rad.abs() > 0.5, "{turned_rad}");
}

#[test]
fn every_matcher_drives_the_lap_better_than_the_wheels() {
    for &matcher in LapMatcher::ALL {
        let mut lap = Lap::new(LapConfig::default().with_matcher(matcher));
        let end = lap.run().last().unwrap().metrics;
        assert!(
            end.keyframe_error_m < 0.7 * end.odometry_error_m,
            "{matcher:?}"
        );
    }
}
