//! Angles in radians, wrapped to (−π, π].

use core::f64::consts::{PI, TAU};

/// Wraps an angle to (−π, π].
///
/// An angle in the interval is returned with unchanged bits.
#[inline]
#[must_use]
pub fn wrap_angle(angle_rad: f64) -> f64 {
    if angle_rad > -PI && angle_rad <= PI {
        return angle_rad;
    }
    let remainder = libm::fmod(angle_rad, TAU);
    if remainder > PI {
        remainder - TAU
    } else if remainder <= -PI {
        remainder + TAU
    } else {
        remainder
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_turn_is_plus_pi_from_both_sides() {
        assert_eq!(wrap_angle(PI), PI);
        assert_eq!(wrap_angle(-PI), PI);
        assert_eq!(wrap_angle(3.0 * PI), PI);
    }

    #[test]
    fn wrapping_removes_whole_turns() {
        // 1e-12: twenty turns lose about twenty times the last bit of 2π.
        for turns in -20_i32..=20 {
            for angle in [-3.0, -0.5, 0.0, 1.0, 3.1] {
                let wrapped = wrap_angle(angle + f64::from(turns) * TAU);
                assert!((wrapped - angle).abs() < 1e-12, "{turns} turns of {angle}");
            }
        }
    }
}
