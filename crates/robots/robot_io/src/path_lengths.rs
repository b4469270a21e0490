//! Length of a path on the map and by odometry.

use core::ops::Range;

use ch16_slam2d::metrics::position_error_m;
use ch16_slam2d::slam::Slam;
use pr_geom::SE2;

use crate::motion::unit_of;
use crate::remark::{NO_ODOMETRY, Part, Remark};

/// Lengths that differ by more than this factor are reported, if one of them is at least this long, m.
const DIFFERENT: f64 = 1.25;
const MIN_M: f64 = 5.0;
/// Odometry stands still if it moves by less than this share of the motion on the map.
const STILL: f64 = 0.1;

/// The odometry at each keyframe: between keyframes the jitter of a robot at rest adds no length.
#[derive(Clone, Debug, Default)]
pub struct PathLengths {
    odometry: Vec<Option<SE2>>,
}

impl PathLengths {
    /// The odometry at each keyframe until the last one that has any.
    #[must_use]
    pub fn odometry(&self) -> &[Option<SE2>] {
        &self.odometry
    }

    /// Takes the odometry at keyframe `number`.
    pub fn add(&mut self, number: usize, odometry: Option<SE2>) {
        self.odometry.resize(number, None);
        self.odometry.push(odometry);
    }

    /// Drops keyframes that were left out; later ones have lower numbers since.
    pub fn forget(&mut self, keyframes: &Range<usize>) {
        let known = self.odometry.len();
        self.odometry
            .drain(keyframes.start.min(known)..keyframes.end.min(known));
    }

    /// A remark if the lengths differ.
    #[must_use]
    pub fn remark(&self, slam: &Slam) -> Option<Remark> {
        let poses = slam.graph().poses();
        // The keyframe at its end, the length on the map, and that by odometry.
        let steps: Vec<(usize, f64, f64)> = self
            .odometry
            .windows(2)
            .zip(poses.windows(2))
            .enumerate()
            .filter_map(|(before, (odometry, poses))| {
                let [from, to] = [odometry[0]?, odometry[1]?];
                let on_map_m = position_error_m(&poses[0], &poses[1]);
                Some((before + 1, on_map_m, position_error_m(&from, &to)))
            })
            .collect();
        let (on_map_m, by_odometry_m) = lengths(&steps);
        if !differ((on_map_m, by_odometry_m)) {
            return None;
        }
        let (still, moving): (Vec<_>, Vec<_>) = steps
            .iter()
            .partition(|(_, on_map_m, by_odometry_m)| *by_odometry_m < STILL * on_map_m);
        let (still_m, _) = lengths(&still);
        if let Some((first, ..)) = still.first()
            && still_m >= MIN_M
            && !moving.is_empty()
            && !differ(lengths(&moving))
        {
            let stamp_s = slam
                .keyframes()
                .get(*first)
                .map(|keyframe| keyframe.stamp_s);
            let text = format!(
                "odometry stands still for {still_m:.1} m of the path on the map{}, and agrees with it elsewhere; check the encoders and the driver of the wheels, or map with {NO_ODOMETRY}",
                stamp_s.map_or(String::new(), |stamp_s| format!(
                    ", first before {stamp_s:.2} s"
                ))
            );
            return Some(Remark::wrong(Part::Odometry, text).with_option(NO_ODOMETRY));
        }
        let text = format!(
            "the path is {on_map_m:.1} m long on the map and {by_odometry_m:.1} m by odometry, which is {}; one of them is wrong; compare with a map made with {NO_ODOMETRY}",
            factor(by_odometry_m / on_map_m.max(1e-3))
        );
        Some(Remark::wrong(Part::Odometry, text).with_option(NO_ODOMETRY))
    }
}

/// Lengths on the map and by odometry.
fn lengths(steps: &[(usize, f64, f64)]) -> (f64, f64) {
    steps
        .iter()
        .fold((0.0, 0.0), |sum, step| (sum.0 + step.1, sum.1 + step.2))
}

fn differ((on_map_m, by_odometry_m): (f64, f64)) -> bool {
    let (shorter_m, longer_m) = (on_map_m.min(by_odometry_m), on_map_m.max(by_odometry_m));
    longer_m >= MIN_M && longer_m > DIFFERENT * shorter_m
}

/// A ratio of lengths by odometry to those by scans, with the unit that explains it.
pub fn factor(ratio: f64) -> String {
    let cause = match (unit_of(ratio), unit_of(1.0 / ratio)) {
        (Some((_, name)), _) => format!(": odometry may be in {name}"),
        (_, Some((_, name))) => format!(": the ranges may be in {name}"),
        _ if !(0.67..=1.5).contains(&ratio) => ", as a wrong unit of the ranges, a wrong step between beams or a wrong wheel radius causes".to_owned(),
        _ => String::new(),
    };
    format!("{ratio:.2} times as long as by scans{cause}")
}

#[cfg(test)]
mod tests {
    use ch16_slam2d::slam::SlamConfig;

    use super::*;

    /// A map with a keyframe every metre.
    fn straight(keyframes: u8) -> Slam {
        let mut slam = Slam::new(SlamConfig::default());
        slam.graph_mut().add_fixed_node(SE2::identity());
        for number in 1..keyframes {
            slam.graph_mut()
                .add_node(SE2::from_xy(f64::from(number), 0.0));
        }
        slam
    }

    #[test]
    fn a_path_much_longer_by_odometry_is_reported_and_one_a_tenth_longer_is_not() {
        let slam = straight(10);
        let sentence = |scale: f64| {
            let mut lengths = PathLengths::default();
            for number in 0..10_u8 {
                let at = SE2::from_xy(scale * f64::from(number), 0.0);
                // The odometry starts at the second keyframe.
                lengths.add(usize::from(number), (number > 0).then_some(at));
            }
            lengths.remark(&slam).map(|remark| remark.text)
        };
        assert_eq!(sentence(1.1), None);
        let feet = sentence(3.3).unwrap();
        assert!(
            feet.contains("3.30 times as long as by scans: odometry may be in feet"),
            "{feet}"
        );
        let feet = sentence(0.3).unwrap();
        assert!(feet.contains(": the ranges may be in feet"), "{feet}");
        let said = sentence(1.5).unwrap();
        assert!(said.contains("8.0 m long on the map and 12.0 m"), "{said}");
    }

    #[test]
    fn odometry_that_stands_still_half_way_is_named_and_a_robot_at_rest_is_not() {
        let slam = straight(20);
        let sentence = |last: u8, scale: f64| {
            let mut lengths = PathLengths::default();
            for number in 0..20_u8 {
                let at = SE2::from_xy(scale * f64::from(number.min(last)), 0.0);
                lengths.add(usize::from(number), Some(at));
            }
            lengths.remark(&slam).map(|remark| remark.text)
        };
        let said = sentence(9, 1.0).unwrap();
        assert!(said.contains("stands still for 10.0 m"), "{said}");
        // Wheels of the wrong size are the larger fault, and 3 m are too few.
        let said = sentence(9, 2.0).unwrap_or_default();
        assert!(!said.contains("stands still"), "{said}");
        assert_eq!(sentence(16, 1.0), None);
    }
}
