//! Sweeps that take a large part of the time between two scans.

use ch16_lab::sweeping::{EARLY, FULL, LATE, SweepCase, SweepErrors};
use ch16_slam2d::pipeline::Pipeline;
use ch16_slam2d::scan::{Frame, LaserScan};
use ch16_slam2d::slam::{LoopClosure, Slam, SlamConfig};

/// How a recording is mapped.
#[derive(Clone, Copy)]
struct Mapping {
    estimator: fn(&LaserScan) -> SlamConfig,
    /// Whether the velocity is found together with the pose.
    is_joint: bool,
}

/// The estimator for recorded logs, as it is.
const ROBOT: Mapping = Mapping {
    estimator: SlamConfig::for_robot,
    is_joint: true,
};

fn mapped(case: &SweepCase, mapping: Mapping) -> SweepErrors {
    let (frames, truth) = case.recording();
    let mut slam = Slam::new(SlamConfig {
        start: truth[0],
        ..(mapping.estimator)(&frames[0].scan)
    });
    slam.set_loop_closure(LoopClosure::Off);
    let estimates = frames.into_iter().map(|frame| {
        let frame = Frame {
            stamp_s: frame.stamp_s,
            odometry: None,
            scan: frame.scan,
        };
        let mut prepared = slam.prepare(&frame).unwrap();
        if !mapping.is_joint {
            prepared.sweep = None;
        }
        slam.step_prepared(&prepared).unwrap().estimate
    });
    SweepErrors::new(&estimates.collect::<Vec<_>>(), &truth)
}

/// Slow and fast sensors of few and many beams, whose walls are seen early or late, and one with poor stamps.
const SENSORS: [(f64, usize, (f64, f64), f64); 7] = [
    (2.0, 360, FULL, 0.0),
    (5.0, 1440, FULL, 0.0),
    (10.0, 360, FULL, 0.0),
    (12.0, 90, FULL, 0.0),
    (10.0, 360, EARLY, 0.0),
    (10.0, 360, LATE, 0.0),
    (5.0, 360, FULL, 0.45),
];

fn cases(turn_rad_s: f64) -> impl Iterator<Item = SweepCase> {
    let of_share = move |share| {
        SENSORS.map(|(rate_hz, beams, view, jitter)| SweepCase {
            share,
            rate_hz,
            beams,
            view,
            turn_rad_s,
            jitter,
            ..SweepCase::default()
        })
    };
    [0.0, 0.5, 1.0, 1.25].into_iter().flat_map(of_share)
}

#[test]
fn the_pose_is_stable_however_much_of_the_period_a_sweep_takes() {
    for case in cases(0.0).chain(cases(0.6)) {
        let run = mapped(&case, ROBOT);
        // 5 cm: twice the motion that an acceleration of 0.45 m/s² hides in half a second. 20 cm: the sum of 72 steps of
        // 3 mm, which is the noise of instantaneous scans.
        assert!(run.worst_m < 0.05, "{case:?}: {run:?}");
        assert!(run.path_m - run.true_m < 0.2, "{case:?}: {run:?}");
    }
}

#[test]
fn the_velocity_of_the_last_scan_alone_makes_a_robot_at_rest_move() {
    let case = SweepCase {
        share: 1.0,
        view: LATE,
        ..SweepCase::default()
    };
    let run = mapped(
        &case,
        Mapping {
            is_joint: false,
            ..ROBOT
        },
    );
    assert!(run.path_m > 2.0, "{run:?}");
}

#[test]
fn the_chapter_s_matcher_is_as_accurate_with_sweeps_that_fill_the_period() {
    let chapter = Mapping {
        estimator: |_| SlamConfig::default(),
        ..ROBOT
    };
    for (view, turn_rad_s) in [(FULL, 0.0), (LATE, 0.0), (FULL, 0.6), (EARLY, 0.6)] {
        let run = |share| {
            let case = SweepCase {
                share,
                view,
                turn_rad_s,
                ..SweepCase::default()
            };
            mapped(&case, chapter)
        };
        let (instant, full) = (run(0.0), run(1.0));
        assert!(
            full.worst_m < instant.worst_m + 0.01,
            "{instant:?} {full:?}"
        );
        assert!(full.path_m < instant.path_m + 0.05, "{instant:?} {full:?}");
    }
}

#[test]
fn the_velocity_up_to_the_next_scan_deskews_a_turning_robot_better_than_that_since_the_last() {
    // Turns to and fro at up to 2.1 rad/s, which change by 8.8 rad/s².
    let case = SweepCase {
        share: 1.0,
        weave_rad: 0.5,
        ..SweepCase::default()
    };
    let (frames, truth) = case.recording();
    let mapped = |knows_next: bool| {
        let mut pipeline = Pipeline::default();
        let estimates = (0..frames.len() - 1).map(|number| {
            let mut frame = frames[number].clone();
            if knows_next {
                frame.scan.velocity = frame.velocity_until(&frames[number + 1]);
            }
            truth[0] * pipeline.step(&frame).unwrap().estimate
        });
        SweepErrors::new(&estimates.collect::<Vec<_>>(), &truth)
    };
    let (late, timely) = (mapped(false), mapped(true));
    assert!(timely.worst_m < 0.7 * late.worst_m, "{late:?} {timely:?}");
}
