//! Any sensor input gives a report or a typed error.

use ch16_slam2d::matching::{MatcherKind, NdtMatcherConfig, SearchMatcherConfig};
use ch16_slam2d::prelude::*;
use ch16_slam2d::scan::{Frame, LaserScan};
use ch16_slam2d::slam::{Slam, SlamConfig};

/// Numbers that provoke failures, among common ones.
const NUMBERS: [f64; 14] = [
    0.0,
    -0.0,
    1.0,
    -2.5,
    3.9,
    0.7,
    5.1,
    1e-310,
    1e9,
    -1e9,
    1e200,
    f64::MAX,
    f64::INFINITY,
    f64::NAN,
];

/// Numbers in an order without a pattern (Knuth, "The Art of Computer Programming" 2, 3.3.4: MMIX).
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, count: usize) -> usize {
        self.0 = (self.0)
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % count
    }

    fn any(&mut self) -> f64 {
        NUMBERS[self.below(NUMBERS.len())]
    }

    /// A plausible value, three times of four.
    fn mostly(&mut self, usual: f64) -> f64 {
        match self.below(4) {
            0 => self.any(),
            _ => usual,
        }
    }

    fn frame(&mut self, stamp_s: f64) -> Frame {
        let beams = [0, 1, 40, 360][self.below(4)];
        let has_odometry = self.below(3) > 0;
        Frame {
            stamp_s: if self.below(9) == 0 {
                self.any()
            } else {
                stamp_s
            },
            odometry: has_odometry.then(|| SE2::new(self.mostly(0.1), 0.0, self.mostly(0.05))),
            scan: LaserScan {
                angle_step_rad: self.mostly(0.1),
                range_max_m: self.mostly(f64::INFINITY),
                beam_interval_s: self.mostly(1e-3),
                ranges_m: (0..beams).map(|_| self.mostly(2.0)).collect(),
                ..LaserScan::default()
            },
        }
    }
}

#[test]
fn no_frame_makes_the_estimator_panic_or_lose_its_pose() {
    for (seed, matcher) in [
        MatcherKind::PointToPoint,
        MatcherKind::PointToPlane,
        MatcherKind::Ndt(NdtMatcherConfig::default()),
        MatcherKind::Search(SearchMatcherConfig {
            half_width_m: 0.5,
            half_turn_rad: 0.3,
            ..SearchMatcherConfig::default()
        }),
    ]
    .into_iter()
    .enumerate()
    {
        let mut numbers = Numbers(seed as u64);
        let (mut taken, mut rejected, mut unbelieved) = (0, 0, 0);
        for start in 0..12 {
            let mut slam = Slam::new(SlamConfig::default().with_matcher(matcher));
            for step in 0..40 {
                match slam.step(&numbers.frame(0.1 * f64::from(step))) {
                    Ok(report) => {
                        taken += 1;
                        let found = report.registration;
                        unbelieved += usize::from(found.is_some_and(|found| !found.accepted));
                        let pose = report.estimate.to_array();
                        let is_finite = pose.iter().all(|number| number.is_finite());
                        assert!(is_finite, "{matcher:?}, {start}, {step}: {pose:?}");
                    }
                    Err(error) => {
                        rejected += 1;
                        assert!(!error.to_string().is_empty());
                    }
                }
            }
        }
        assert!(taken > 100 && rejected > 100 && unbelieved > 10);
    }
}

#[test]
fn a_jump_between_nearly_equal_stamps_gives_no_velocity() {
    let scan = LaserScan {
        angle_step_rad: 0.15,
        ranges_m: vec![2.0; 40],
        ..LaserScan::default()
    };
    let mut slam = Slam::new(SlamConfig::for_robot(&scan));
    // The view after the jump is unseen space: otherwise the odometry would be rejected.
    let frame = |stamp_s, odometry, range_m| Frame {
        stamp_s,
        odometry,
        scan: LaserScan {
            ranges_m: vec![range_m; 40],
            ..scan.clone()
        },
    };
    let jump = SE2::new(3e7, 0.0, 0.0);
    slam.step(&frame(0.0, None, 2.0)).unwrap();
    slam.step(&frame(f64::from_bits(1), Some(jump), 5.0))
        .unwrap();
    let snapshot = slam.snapshot();
    assert_eq!(snapshot.check(), Ok(()));
    let mut slam = Slam::restore(&snapshot).unwrap();
    let here = slam.step(&frame(1.0, None, 5.0)).unwrap().estimate;
    assert!((here.x() - 3e7).abs() < 1.0, "{here:?}");
}
