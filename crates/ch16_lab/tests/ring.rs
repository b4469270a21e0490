//! A world with a true cycle, and other matchers, run through the same code as the chapter's lap.

use ch16_lab::lap::{DriveConfig, Lap, LapConfig};
use ch16_slam2d::matching::{MatcherKind, NdtMatcherConfig};
use ch16_slam2d::slam::SlamConfig;
use pr_sim::Course;

#[test]
fn the_apartment_as_a_course_is_the_chapters_drive() {
    let drive = DriveConfig::default();
    assert_eq!(drive.clone().on_course(&Course::apartment()), drive);
}

/// The lap around the ring with the estimator that is not the chapter's.
fn ring(seed: u32) -> Lap {
    let config = LapConfig::with_seed_and_noise(seed, 1.0);
    Lap::new(LapConfig {
        drive: config.drive.on_course(&Course::ring()),
        slam: SlamConfig {
            threshold: config.slam.threshold,
            ..SlamConfig::default()
        },
    })
}

#[test]
fn a_ring_is_driven_and_its_end_compared_with_its_start() {
    let reports = ring(1).run();
    // Back in the first corridor, old keyframes are near again and tried. Here the drift around the
    // ring is larger than the search believes, and the fit turns them away.
    assert!(reports.iter().any(|report| report.loop_attempt.is_some()));
    let end = reports.last().unwrap().metrics;
    assert!(end.keyframe_error_m < 0.7 * end.odometry_error_m);
    // The map of the first corridor is compared with itself, seen from the other side.
    assert!(end.map_disagreement_m.is_some());
}

#[test]
fn every_matcher_drives_the_lap_better_than_the_wheels() {
    for matcher in [
        MatcherKind::PointToPoint,
        MatcherKind::PointToPlane,
        MatcherKind::Ndt(NdtMatcherConfig::default()),
    ] {
        let chapter = LapConfig::default();
        let mut lap = Lap::new(LapConfig {
            slam: chapter.slam.with_matcher(matcher),
            ..chapter
        });
        let end = lap.run().last().unwrap().metrics;
        assert!(
            end.keyframe_error_m < 0.7 * end.odometry_error_m,
            "{matcher:?}"
        );
    }
}
