use std::sync::Arc;

use pr_geom::SE2;

use super::*;
use crate::metrics::position_error_m;
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
