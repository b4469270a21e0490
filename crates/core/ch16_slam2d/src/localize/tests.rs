use std::sync::Arc;

use pr_geom::SE2;

use super::*;
use crate::metrics::position_error_m;
use crate::scan::Frame;
use crate::slam::test_room::{frame, truth};
use crate::slam::{Slam, SlamConfig};

fn known() -> (Arc<KnownMap>, SlamConfig) {
    let mut config = SlamConfig::for_robot(&frame(0).scan);
    config.start = truth(0);
    let mut slam = Slam::new(config.clone());
    for step in 0..=110 {
        slam.step(&frame(step)).unwrap();
    }
    slam.conclude();
    let poses = slam.graph().poses().to_vec();
    let keyframes = slam.keyframes().to_vec();
    let map = KnownMap::new(keyframes, poses, &LocalizeConfig::default());
    (Arc::new(map.unwrap()), config)
}

fn localizer(map: &Arc<KnownMap>, config: &SlamConfig, start: StartPose) -> Localizer {
    Localizer::new(
        Arc::clone(map),
        config.clone(),
        LocalizeConfig::default(),
        start,
    )
}

fn error_m(report: &LocalizeReport, step: usize) -> f64 {
    position_error_m(&report.pose.unwrap(), &truth(step))
}

#[test]
fn a_given_start_is_corrected_tracked_and_has_a_covariance() {
    let (map, config) = known();
    let off = truth(40) * SE2::new(0.3, -0.4, 0.2);
    let mut localizer = localizer(&map, &config, StartPose::Near(off));
    for step in 40..100 {
        let report = localizer.step(&frame(step)).unwrap();
        let expected = if step == 40 {
            Verdict::Found
        } else {
            Verdict::Tracking
        };
        assert_eq!(report.verdict, expected, "{step}");
        // 0.05: a cell of the thinned scans, and the error of the map itself.
        assert!(
            error_m(&report, step) < 0.05,
            "{step}: {}",
            error_m(&report, step)
        );
        let sigma_m = report.covariance.unwrap()[(0, 0)].sqrt();
        assert!((0.001..0.1).contains(&sigma_m), "{sigma_m}");
    }
}

#[test]
fn a_rectangular_room_is_ambiguous_and_not_localized() {
    let (map, config) = known();
    let mut localizer = localizer(&map, &config, StartPose::Anywhere);
    for step in 40..60 {
        let report = localizer.step(&frame(step)).unwrap();
        assert!(!report.verdict.is_localized(), "{step}: {report:?}");
        if let Some(result) = report.search {
            let turn = result
                .best
                .pose
                .between(&result.runner_up.unwrap().pose)
                .theta();
            assert!((turn.abs() - core::f64::consts::PI).abs() < 0.1, "{turn}");
        }
    }
}

#[test]
fn frames_out_of_order_are_rejected_and_change_no_state() {
    let (map, config) = known();
    let mut localizer = localizer(&map, &config, StartPose::Near(truth(40)));
    localizer.step(&frame(40)).unwrap();
    assert!(localizer.step(&frame(39)).is_err());
    let report = localizer.step(&frame(41)).unwrap();
    assert_eq!((report.frame, report.verdict), (1, Verdict::Tracking));
}

/// The measurements of a step with `beams` of its returns, evenly spread.
fn thin(step: usize, beams: usize) -> Frame {
    let mut frame = frame(step);
    let count = frame.scan.ranges_m.len();
    for (beam, range_m) in frame.scan.ranges_m.iter_mut().enumerate() {
        let is_kept = beams > 0 && (beam * beams) % count < beams;
        if !is_kept {
            *range_m = f64::NAN;
        }
    }
    frame
}

/// With three beams the robot was called found 4 m off, with a standard deviation of 0.2 m: three points fit in many places.
#[test]
fn a_pose_that_too_few_points_measure_is_not_claimed() {
    let (map, config) = known();
    for (beams, is_enough) in [
        (0, false),
        (1, false),
        (2, false),
        (3, false),
        (7, false),
        (12, true),
        (90, true),
    ] {
        for off in 0..6 {
            let a = f64::from(off);
            let off = SE2::new(0.5 * (2.1 * a).sin(), 0.5 * (1.3 * a).cos(), 0.1 * a - 0.2);
            let start = StartPose::Near(truth(40) * off);
            let mut localizer = localizer(&map, &config, start);
            for step in 40..60 {
                let report = localizer.step(&thin(step, beams)).unwrap();
                let is_localized = report.verdict.is_localized();
                assert_eq!(is_localized, is_enough, "{beams} beams: {report:?}");
                assert!(!is_localized || error_m(&report, step) < 0.05);
            }
        }
        // The returns vanish once it is localized, and come back.
        let mut localizer = localizer(&map, &config, StartPose::Near(truth(40)));
        let mut last_sigma_m = 0.0;
        for step in 40..80 {
            let is_thin = (50..70).contains(&step);
            let frame = if is_thin {
                thin(step, beams)
            } else {
                frame(step)
            };
            let report = localizer.step(&frame).unwrap();
            assert_eq!(
                report.verdict.is_localized(),
                is_enough || !is_thin,
                "{beams} beams, step {step}: {report:?}"
            );
            if is_thin && beams == 0 {
                let sigma_m = report.covariance.unwrap()[(0, 0)].sqrt();
                assert!(
                    sigma_m > last_sigma_m && report.score.is_none(),
                    "{report:?}"
                );
                last_sigma_m = sigma_m;
            }
        }
    }
}
