//! Converts a filtered scan back to rays, for a map with free space.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::scan::LaserScan;
use pr_geom::{math, sort_pairs};

/// Neighbouring points of a wall are at most this many cells apart.
const NEIGHBOR_CELLS: f64 = 2.5;
/// Ray spacing if the sensor's is unknown, rad.
const STEP_RAD: f64 = TAU / 720.0;
/// Plausible ray spacings, rad.
const STEPS_RAD: core::ops::Range<f64> = TAU / 7200.0..0.2;

/// Rays of `sensor` to the points of `scan` (body frame), which was filtered to cells of `cell_m` (m).
///
/// Between two neighbouring points at the bearings α and β and the ranges a and b, the ray
/// at φ ends on the line through them: `a b sin(β − α) / (a sin(φ − α) + b sin(β − φ))`. A ray without
/// a point is NaN.
#[must_use]
pub fn rays(scan: &PointCloud, sensor: &LaserScan, cell_m: f64) -> LaserScan {
    let step_rad = sensor.angle_step_rad.abs();
    let step_rad = if STEPS_RAD.contains(&step_rad) {
        step_rad
    } else {
        STEP_RAD
    };
    let count = (TAU / step_rad) as usize;
    let mut ranges_m = vec![f64::NAN; count];
    let mut shorten = |ray: usize, range_m: f64| {
        let known_m = &mut ranges_m[ray % count];
        if known_m.is_nan() || range_m < *known_m {
            *known_m = range_m;
        }
    };
    let sensor_from_body = sensor.body_from_sensor.inverse();
    let mut seen: Vec<(f64, f64)> = scan
        .iter()
        .map(|point| sensor_from_body.transform(point))
        .map(|point| (math::atan2(point.y, point.x), math::norm2(point.x, point.y)))
        .filter(|(_, range_m)| *range_m > 0.0)
        .collect();
    sort_pairs(&mut seen);
    for (index, &(bearing, range_m)) in seen.iter().enumerate() {
        shorten(((bearing + PI) / step_rad).round() as usize, range_m);
        let Some(&(next, next_m)) = seen.get(index + 1) else {
            continue;
        };
        let turn = next - bearing;
        let (sin, cos) = math::sin_cos(turn);
        let gap_m = math::norm2(next_m * cos - range_m, next_m * sin);
        if gap_m > NEIGHBOR_CELLS * cell_m || turn >= FRAC_PI_2 {
            continue;
        }
        let first = ((bearing + PI) / step_rad).ceil() as usize;
        let last = ((next + PI) / step_rad).floor() as usize;
        for ray in first..=last {
            let at = ray as f64 * step_rad - PI;
            let span_m = range_m * math::sin(at - bearing) + next_m * math::sin(next - at);
            let on_line_m = range_m * next_m * sin / span_m;
            if on_line_m.is_finite() && on_line_m > 0.0 {
                shorten(ray, on_line_m);
            }
        }
    }
    LaserScan {
        first_angle_rad: -PI,
        angle_step_rad: step_rad,
        body_from_sensor: sensor.body_from_sensor,
        ranges_m,
        ..LaserScan::default()
    }
}
