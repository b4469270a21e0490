//! Merges points of several sensors, or of a height band, into one scan at the body's origin.

use core::f64::consts::{PI, TAU};

use ch16_slam2d::scan::LaserScan;
use pr_geom::math;

/// Beams of a merged scan are denser than those of its sensors by this factor: a point moves by at most an eighth of
/// their step.
const FINER: f64 = 4.0;
/// More beams add no information.
const MAX_BEAMS: f64 = 7200.0;

/// Keeps the nearest point in each direction from the body's origin; `step_rad` is the beam spacing of the finest
/// sensor.
pub fn binned(points: impl Iterator<Item = (f64, f64)>, step_rad: f64) -> LaserScan {
    let beams = math::min((FINER * TAU / step_rad.abs()).round(), MAX_BEAMS).max(1.0);
    let step = TAU / beams;
    let mut ranges_m = vec![0.0; beams as usize];
    for (x, y) in points {
        let range_m = math::norm2(x, y);
        if !range_m.is_finite() || range_m <= 0.0 {
            continue;
        }
        let beam = ((math::atan2(y, x) + PI) / step).round() as usize % ranges_m.len();
        if ranges_m[beam] == 0.0 || range_m < ranges_m[beam] {
            ranges_m[beam] = range_m;
        }
    }
    LaserScan {
        first_angle_rad: -PI,
        angle_step_rad: step,
        ranges_m,
        ..LaserScan::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_point_of_each_direction_stays() {
        let scan = binned(
            [(2.0, 0.0), (1.0, 0.0), (0.0, 3.0), (-4.0, -0.0)].into_iter(),
            0.1,
        );
        let seen: Vec<(f64, f64)> = scan
            .ranges_m
            .iter()
            .enumerate()
            .filter(|(_, range_m)| **range_m > 0.0)
            .map(|(beam, &range_m)| (scan.bearing_rad(beam), range_m))
            .collect();
        assert_eq!(seen.len(), 3);
        for ((bearing, range_m), (expected, expected_m)) in
            seen.into_iter()
                .zip([(-PI, 4.0), (0.0, 1.0), (PI / 2.0, 3.0)])
        {
            // Half a beam.
            assert!((bearing - expected).abs() <= 0.0126 && range_m == expected_m);
        }
    }
}
