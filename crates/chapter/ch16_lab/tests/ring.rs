//! A world with a true cycle, and other matchers, in the same code as the chapter's lap.

use ch16_lab::lap::{BuiltInWorld, Lap, LapConfig, LapMatcher, LapRecord, LapRunner, NamedChoice};
use ch16_slam2d::scan::ScanConfig;
use ch16_slam2d::slam::SlamConfig;
use pr_geom::{Point2, SE2};
use pr_sim::{Course, World};

/// The lap around the ring with the default estimator.
fn ring(seed: u32, matcher: LapMatcher) -> LapRecord {
    let config = LapConfig::in_world(BuiltInWorld::Ring, seed, 1.0).with_matcher(matcher);
    LapRunner::new().run(&config)
}

#[test]
fn ndt_closes_the_cycle_of_the_ring_and_reduces_the_error_all_around() {
    for seed in 1..=4 {
        let record = ring(seed, LapMatcher::Ndt);
        let (lap, alone) = (record.lap.summary, record.front_end.summary);
        assert!(record.lap.graph_summary.loops > 0, "seed {seed}");
        assert_eq!(record.lap.false_acceptances().count(), 0, "seed {seed}");
        // Unlike on the way back through a corridor, the error in the middle of the path falls, too.
        assert!(lap.keyframe_rms_m < alone.keyframe_rms_m, "seed {seed}");
        // The map of the first corridor is compared with a second one, seen from the other side.
        assert!(lap.map_disagreement_m < alone.map_disagreement_m);
    }
}

/// The ring driven clockwise, from the end of the usual path to its start.
fn clockwise() -> Course {
    let (west, east, south, north) = (0.7, 11.3, 0.7, 8.3);
    let stops = [
        (west, south),
        (west, north),
        (east, north),
        (east, south),
        (8.0, south),
        (2.0, south),
    ];
    let way_points = stops.map(|(x, y)| Point2::new(x, y)).to_vec();
    let start = SE2::new(8.0, south, core::f64::consts::PI);
    Course::new(World::ring(), start, way_points, Some(4)).expect("the ring is clear either way")
}

/// Heading error of the front end to the left, in degrees: while turning, and while driving straight.
fn turned_too_far_deg(config: &LapConfig) -> [f64; 2] {
    let record = LapRunner::new().run(config);
    let (mut truth, mut estimate) = (config.drive.start, config.drive.start);
    let mut turned = [0.0, 0.0];
    for report in &record.front_end.reports {
        let (true_step, step) = (
            truth.between(&report.truth),
            estimate.between(&report.estimate),
        );
        let drives = usize::from(report.command.omega_radps.abs() < 0.3);
        turned[drives] += true_step.between(&step).theta().to_degrees();
        (truth, estimate) = (report.truth, report.estimate);
    }
    turned
}

#[test]
fn point_to_point_turns_toward_the_outer_wall_of_the_ring_in_both_directions() {
    let mean_deg = |course: &Course| {
        let seeds = 8;
        let sums = (1..=seeds).map(|seed| {
            let config = LapConfig::with_seed_and_noise(seed, 1.0).elsewhere(course);
            turned_too_far_deg(&config)
        });
        let sums = sums.fold([0.0, 0.0], |sum, turned| {
            [sum[0] + turned[0], sum[1] + turned[1]]
        });
        sums.map(|sum| sum / f64::from(seeds))
    };
    let [in_turns, driving] = mean_deg(&Course::ring());
    assert!(
        in_turns.abs() < 4.0 && (-60.0..-40.0).contains(&driving),
        "{in_turns} {driving}"
    );
    let [in_turns, driving] = mean_deg(&clockwise());
    assert!(
        in_turns.abs() < 4.0 && (30.0..50.0).contains(&driving),
        "{in_turns} {driving}"
    );
    // So the loop is not closed: old keyframes are close again and tried, but rejected for their fit.
    let record = ring(1, LapMatcher::PointToPoint);
    assert!(record.lap.loop_attempts().count() > 0);
    assert_eq!(record.lap.graph_summary.loops, 0);
}

#[test]
fn point_to_plane_closes_on_the_ring_more_often_by_normals_of_the_defaults_radius_than_of_the_chapters()
 {
    let closed = |scan: ScanConfig| {
        (1..=12)
            .filter(|&seed| {
                let config = LapConfig::in_world(BuiltInWorld::Ring, seed, 1.0);
                let config = config
                    .with_matcher(LapMatcher::PointToPlane)
                    .with_scan(scan);
                let lap = LapRunner::new().run(&config).lap;
                lap.graph_summary.loops > 0 && lap.false_acceptances().count() == 0
            })
            .count()
    };
    let of_defaults = closed(SlamConfig::default().scan);
    let of_chapter = closed(SlamConfig::chapter().scan);
    assert!(
        of_defaults >= 11 && of_defaults > of_chapter,
        "{of_defaults} and {of_chapter} of 12"
    );
}

#[test]
fn every_matcher_beats_odometry_on_the_lap() {
    for matcher in LapMatcher::all() {
        let mut lap = Lap::new(LapConfig::default().with_matcher(matcher));
        let end = lap.run().last().unwrap().metrics;
        assert!(
            end.keyframe_error_m < 0.7 * end.odometry_error_m,
            "{matcher:?}"
        );
    }
}
