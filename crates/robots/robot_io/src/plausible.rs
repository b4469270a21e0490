//! Plausibility bounds for poses and times: values beyond them are garbage and would overflow later.

use pr_geom::SE2;

/// Earth's circumference, m: no frame of odometry, mounting or map has its origin farther away.
const FARTHEST_M: f64 = 4.1e7;

/// More beams than any planar laser has.
pub const MAX_BEAMS: usize = 100_000;

/// Thirty thousand years, s: no robot's clock counts from so long ago.
const LONGEST_S: f64 = 1e12;

/// Returns the stamp if it is plausible, s.
///
/// # Errors
/// If it is not finite or out of bounds.
pub fn plausible_stamp_s(stamp_s: f64) -> Result<f64, String> {
    if stamp_s.abs() <= LONGEST_S {
        Ok(stamp_s)
    } else {
        Err(format!(
            "a time must be within {LONGEST_S:e} s of zero, and is {stamp_s:e} s"
        ))
    }
}

/// Whether a length is plausible.
pub fn is_plausible_length(value_m: f64) -> bool {
    value_m.abs() <= FARTHEST_M
}

/// Returns the pose if it is plausible.
///
/// # Errors
/// If a number is not finite or out of bounds.
pub fn plausible_pose(pose: SE2) -> Result<SE2, String> {
    let [x, y, theta] = pose.to_array();
    if is_plausible_length(x) && is_plausible_length(y) && theta.is_finite() {
        Ok(pose)
    } else {
        Err(format!(
            "a pose must be within {:.0} km of its origin, and is at {x:e} m, {y:e} m",
            FARTHEST_M / 1e3
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_on_earth_are_accepted_and_others_rejected() {
        // Northern end of a UTM zone, in metres from the equator.
        let far = SE2::new(834_000.0, 9_328_000.0, 3.0);
        assert_eq!(plausible_pose(far), Ok(far));
        for x in [1e300, f64::INFINITY, f64::NAN] {
            let error = plausible_pose(SE2::new(x, 0.0, 0.0)).unwrap_err();
            assert!(
                error.starts_with("a pose must be within 41000 km"),
                "{error}"
            );
        }
    }

    #[test]
    fn times_of_any_clock_are_accepted_and_others_rejected() {
        // Nanoseconds since 1970 read as milliseconds are rejected.
        assert_eq!(plausible_stamp_s(1.7e9), Ok(1.7e9));
        assert_eq!(plausible_stamp_s(-1.0), Ok(-1.0));
        for stamp_s in [1.7e15, f64::NAN] {
            let error = plausible_stamp_s(stamp_s).unwrap_err();
            assert!(error.starts_with("a time must be within 1e12 s"), "{error}");
        }
    }
}
