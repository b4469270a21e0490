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
        let (mut on_map_m, mut by_odometry_m) = (0.0, 0.0);
        let poses = slam.graph().poses();
        for (odometry, poses) in self.odometry.windows(2).zip(poses.windows(2)) {
            if let [Some(before), Some(after)] = odometry {
                by_odometry_m += position_error_m(before, after);
                on_map_m += position_error_m(&poses[0], &poses[1]);
            }
        }
        let (shorter_m, longer_m) = if on_map_m < by_odometry_m {
            (on_map_m, by_odometry_m)
        } else {
            (by_odometry_m, on_map_m)
        };
        (longer_m >= MIN_M && longer_m > DIFFERENT * shorter_m).then(|| {
            let text = format!(
                "the path is {on_map_m:.1} m long on the map and {by_odometry_m:.1} m by odometry, which is {}; one of them is wrong; compare with a map made with {NO_ODOMETRY}",
                factor(by_odometry_m / on_map_m.max(1e-3))
            );
            Remark::wrong(Part::Odometry, text).with_option(NO_ODOMETRY)
        })
    }
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

    #[test]
    fn a_path_much_longer_by_odometry_is_reported_and_one_a_tenth_longer_is_not() {
        let mut slam = Slam::new(SlamConfig::default());
        slam.graph_mut().add_fixed_node(SE2::identity());
        for number in 1..10_u8 {
            slam.graph_mut()
                .add_node(SE2::from_xy(f64::from(number), 0.0));
        }
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
}
