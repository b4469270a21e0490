//! Long runs and faulty input: standing still, no odometry, bad frames, bad loops.

use ch16_lab::lap::{Drive, DriveConfig};
use ch16_slam2d::chapter::ChapterParts;
use ch16_slam2d::graph::EdgeKind;
use ch16_slam2d::loops::{LoopCandidate, LoopDetector, LoopQuery, LoopRejection};
use ch16_slam2d::matching::{Match, MatchRequest, MatchStop, MatchSummary, Matcher};
use ch16_slam2d::metrics::position_error_m;
use ch16_slam2d::scan::FrameError;
use ch16_slam2d::slam::{MotionNoise, Slam, SlamConfig};
use pr_geom::SE2;

fn drive() -> Drive {
    Drive::simulate(&DriveConfig::default())
}

#[test]
fn a_robot_that_stands_still_for_ten_thousand_scans_keeps_its_map_and_little_memory() {
    let drive = drive();
    let mut slam = Slam::new(SlamConfig::default());
    for tick in 0..40 {
        slam.step_prepared(&drive.prepared(tick)).unwrap();
    }
    let window = slam.front_end().window().to_vec();
    let (estimate, keyframes) = (slam.front_end().estimate(), slam.keyframes().len());
    // New noise would need ten thousand simulations; odometry that creeps has the same effect.
    for count in 0_u32..10_000 {
        let mut frame = drive.prepared(39);
        let creep = if count % 2 == 0 { 1e-3 } else { -1e-3 };
        frame.odometry = Some(SE2::new(creep, 0.0, 0.0));
        frame.stamp_s += 0.25 * f64::from(count + 1);
        slam.step_prepared(&frame).unwrap();
    }
    assert_eq!(slam.front_end().window(), window);
    assert_eq!(slam.keyframes().len(), keyframes);
    let crept = position_error_m(&slam.front_end().estimate(), &estimate);
    assert!(crept < 0.02, "{crept} m");
}

#[test]
fn without_odometry_the_velocity_is_expected_to_stay() {
    let drive = drive();
    let mut slam = Slam::new(SlamConfig {
        start: drive.truth(0),
        ..SlamConfig::default()
    });
    let mut farthest: f64 = 0.0;
    for tick in 0..=drive.ticks().len() {
        let mut frame = drive.prepared(tick);
        frame.odometry = None;
        let estimate = slam.step_prepared(&frame).unwrap().estimate;
        farthest = farthest.max(position_error_m(&estimate, &drive.truth(tick)));
    }
    assert!(farthest < 1.0, "{farthest} m");
}

#[test]
fn a_frame_that_cannot_be_used_leaves_the_estimator_as_it_was() {
    let drive = drive();
    let mut slam = Slam::new(SlamConfig::default());
    slam.step(&drive.frame(0)).unwrap();
    slam.step(&drive.frame(1)).unwrap();
    let before = slam.front_end().estimate();
    assert!(matches!(
        slam.step(&drive.frame(1)),
        Err(FrameError::Stamp { .. })
    ));
    let mut frame = drive.frame(2);
    frame.odometry = Some(SE2::from_xy(f64::NAN, 0.0));
    assert!(matches!(
        slam.step(&frame),
        Err(FrameError::Odometry { .. })
    ));
    let mut frame = drive.frame(2);
    frame.scan.angle_step_rad = 0.0;
    assert_eq!(
        slam.step(&frame).unwrap_err().to_string(),
        "the scan's angle step is 0; give radians other than 0"
    );
    assert_eq!((slam.frames(), slam.front_end().estimate()), (2, before));
    slam.step(&drive.frame(2)).unwrap();
}

#[test]
fn a_rejected_registration_gives_the_edge_the_covariance_of_odometry() {
    let drive = drive();
    let config = SlamConfig::default();
    let noise = config.chapter.odometry_noise;
    let mut slam = Slam::new(config);
    slam.step(&drive.frame(0)).unwrap();
    let mut frame = drive.frame(1);
    frame.scan.ranges_m.fill(f64::NAN);
    let motion = SE2::new(0.5, 0.1, 0.2);
    frame.odometry = Some(motion);
    let report = slam.step(&frame).unwrap();
    assert!(!report.registration.unwrap().accepted);
    assert_eq!(report.new_keyframe, Some(1));
    let information = slam.graph().edges().next().unwrap().edge.information;
    let covariance = information.try_inverse().unwrap();
    // 1e-12: two inversions of a diagonal matrix with entries of 1e-3.
    assert!((covariance - noise.covariance(&motion)).amax() < 1e-12);
    assert_ne!(noise, MotionNoise::without_odometry());
}

/// A detector that proposes an old keyframe at another relative pose each time.
#[derive(Clone)]
struct Liar {
    proposals: Vec<SE2>,
}

impl LoopDetector for Liar {
    fn detect(&mut self, query: &mut LoopQuery<'_>) -> Vec<LoopCandidate> {
        let proposals = self.proposals.iter().copied();
        let old_enough = query.node() >= 8;
        proposals
            .filter(|_| old_enough)
            .map(|proposal| LoopCandidate {
                node: 0,
                distance_m: 0.0,
                proposal: Some(proposal),
            })
            .collect()
    }
}

/// A matcher that accepts every guess, with plenty of pairs.
#[derive(Clone)]
struct Believer;

impl Matcher for Believer {
    fn set_target(&mut self, _: &ch16_slam2d::cloud::PointCloud) {}

    fn register(&mut self, _: &ch16_slam2d::cloud::PointCloud, request: &MatchRequest) -> Match {
        Match {
            summary: MatchSummary {
                pose: request.guess,
                rmse_m: 0.0,
                inliers: 1000,
                iterations: 0,
                score: None,
                runner_up: None,
                stop: MatchStop::Other("believed"),
            },
            pairs: Vec::new(),
        }
    }
}

fn with_a_liar(config: SlamConfig, proposals: &[SE2]) -> Slam {
    let parts = ChapterParts {
        loops: Box::new(Believer),
        detector: Box::new(Liar {
            proposals: proposals.to_vec(),
        }),
        ..ChapterParts::from_config(&config.chapter)
    };
    Slam::with_parts(config, parts)
}

#[test]
fn candidates_are_tried_in_order_up_to_the_limit_from_their_proposals() {
    let drive = drive();
    let far = SE2::from_xy(50.0, 0.0);
    for (limit, tried) in [(1, 1), (2, 2), (9, 3)] {
        let mut config = SlamConfig::default();
        config.chapter.loops.candidates_tried = limit;
        let mut slam = with_a_liar(config, &[far, far.inverse(), far]);
        let attempts = (0..60)
            .map(|tick| slam.step_prepared(&drive.prepared(tick)).unwrap())
            .find(|report| !report.loop_attempts.is_empty())
            .unwrap()
            .loop_attempts;
        assert_eq!(attempts.len(), tried);
        for (attempt, proposal) in attempts.iter().zip([far, far.inverse(), far]) {
            let found = &attempt.verification;
            assert_eq!((found.initial, found.registered), (proposal, proposal));
            // The gate tests against the graph, not against the proposal.
            assert!(found.predicted.between(&proposal).step_size() > 30.0);
            assert!(matches!(
                found.rejection,
                Some(LoopRejection::OutsideGate(_))
            ));
            assert!(attempt.effect.is_none());
        }
    }
}

#[test]
fn a_loop_that_the_graph_does_not_bear_is_taken_out_again() {
    let drive = drive();
    let mut config = SlamConfig::default();
    // A gate that accepts every loop, and a measurement that overflows the cost.
    config.chapter.loops.gate_chi2 = f64::INFINITY;
    config.chapter.loops.max_rmse_m = f64::INFINITY;
    let mut slam = with_a_liar(config, &[SE2::from_xy(1e200, 0.0)]);
    let mut taken_back = 0;
    for tick in 0..80 {
        let report = slam.step_prepared(&drive.prepared(tick)).unwrap();
        for attempt in &report.loop_attempts {
            assert!(attempt.effect.is_none());
            assert!(matches!(
                attempt.verification.rejection,
                Some(LoopRejection::OptimizationFailed(_) | LoopRejection::CostRose { .. })
            ));
            taken_back += 1;
        }
    }
    assert!(taken_back > 0);
    assert!(
        slam.graph()
            .edges()
            .all(|view| view.edge.kind == EdgeKind::Odometry)
    );
    assert!(
        slam.graph()
            .poses()
            .iter()
            .all(|pose| pose.x().abs() < 20.0)
    );
}
