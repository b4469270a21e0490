//! Observed free space of a scan, by bearing.

use core::f64::consts::TAU;

use nalgebra::Point2;
use pr_geom::math;

use crate::cloud::PointCloud;

/// Number of sectors: 2° each.
const SECTORS: usize = 180;

/// The range of the nearest return in each sector around the body.
///
/// The space in front of it is free. A sector without a return gives no information: the beam may have hit
/// glass.
#[derive(Clone, Debug, PartialEq)]
pub struct RangeProfile {
    /// Squared ranges, m²; 0 without a return.
    nearest_m2: Vec<f64>,
}

impl RangeProfile {
    /// The profile of a scan, body frame.
    #[must_use]
    pub fn new(scan: &PointCloud) -> Self {
        let mut nearest_m2 = vec![0.0; SECTORS];
        for point in scan.iter() {
            let nearest_m2: &mut f64 = &mut nearest_m2[sector(point)];
            let range_m2 = point.coords.norm_squared();
            if *nearest_m2 == 0.0 || range_m2 < *nearest_m2 {
                *nearest_m2 = range_m2;
            }
        }
        Self { nearest_m2 }
    }

    /// Whether the scan has observed a point as free, body frame.
    #[must_use]
    pub fn sees_through(&self, point: Point2<f64>) -> bool {
        point.coords.norm_squared() < self.nearest_m2[sector(point)]
    }
}

fn sector(point: Point2<f64>) -> usize {
    let turn = math::atan2(point.y, point.x) / TAU + 0.5;
    // NaN included: `as` saturates.
    ((turn * SECTORS as f64) as usize).min(SECTORS - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn space_in_front_of_returns_is_observed_as_free() {
        let scan = [Point2::new(3.0, 0.05), Point2::new(2.0, 0.04)];
        let profile = RangeProfile::new(&scan.into_iter().collect());
        assert!(profile.sees_through(Point2::new(1.9, 0.02)));
        // Behind the nearer of two returns, and in a sector without a return.
        assert!(!profile.sees_through(Point2::new(2.5, 0.05)));
        assert!(!profile.sees_through(Point2::new(0.0, 1.0)));
        assert!(!profile.sees_through(Point2::new(f64::NAN, 1.0)));
    }
}
