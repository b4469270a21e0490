//! Which directions are occupied at which distance, and the rotation between two scans.

use core::f64::consts::TAU;

use pr_geom::{math, wrap_angle};

use crate::cloud::PointCloud;

/// Rings and sectors of a [`ScanContext`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContextConfig {
    /// Number of rings of equal width.
    pub rings: usize,
    /// Number of sectors of equal angle, which is the resolution of the heading.
    pub sectors: usize,
    /// End of the last ring, m; farther points are left out.
    pub max_range_m: f64,
}

impl Default for ContextConfig {
    fn default() -> Self {
        Self {
            rings: 12,
            sectors: 60,
            max_range_m: 6.0,
        }
    }
}

/// Result of comparing two contexts.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ContextMatch {
    /// Mean cosine distance of the sectors at the best rotation, 0 to 1.
    pub distance: f64,
    /// Rotation of the second scan relative to the first, `first_from_second`, rad.
    pub turn_rad: f64,
}

/// A scan as rings × sectors around its sensor, 1 if a bin contains a point.
///
/// Kim & Kim, "Scan Context: egocentric spatial descriptor for place recognition within 3D point
/// cloud map", IROS 2018, store the maximum height of each bin; in the plane a bin is occupied or
/// not. The key of a ring is the share of its occupied bins, which is invariant to rotation.
#[derive(Clone, Debug, PartialEq)]
pub struct ScanContext {
    rings: usize,
    /// Sector by sector, each from the inner ring to the outer one.
    bins: Vec<f64>,
    /// Euclidean norm of each sector.
    norms: Vec<f64>,
    ring_key: Vec<f64>,
}

impl ScanContext {
    /// The context of a scan in its sensor's frame.
    #[must_use]
    pub fn new(scan: &PointCloud, config: &ContextConfig) -> Self {
        let ContextConfig { rings, sectors, .. } = *config;
        let mut bins = vec![0.0; rings * sectors];
        for point in scan.iter() {
            let ring = math::norm2(point.x, point.y) / config.max_range_m * rings as f64;
            let turn = math::atan2(point.y, point.x) / TAU;
            // A bearing just below 0 may be a whole turn after rounding.
            let sector = ((turn - turn.floor()) * sectors as f64) as usize % sectors.max(1);
            if ring < rings as f64 {
                bins[sector * rings + ring as usize] = 1.0;
            }
        }
        let key = |ring: usize| bins.iter().skip(ring).step_by(rings).sum::<f64>() / sectors as f64;
        let norm = |sector: &[f64]| math::sqrt(sector.iter().sum());
        Self {
            rings,
            ring_key: (0..rings).map(key).collect(),
            norms: bins.chunks_exact(rings.max(1)).map(norm).collect(),
            bins,
        }
    }

    /// Share of the occupied bins of every ring, the inner one first.
    #[must_use]
    pub fn ring_key(&self) -> &[f64] {
        &self.ring_key
    }

    /// Sector by sector, each from the inner ring to the outer one: 1 if occupied.
    #[must_use]
    pub fn bins(&self) -> &[f64] {
        &self.bins
    }

    /// Difference of the ring keys, `Σ |a − b|`: cheap, and invariant to rotation.
    #[must_use]
    pub fn key_distance(&self, other: &Self) -> f64 {
        let rings = self.ring_key.iter().zip(&other.ring_key);
        rings.map(|(a, b)| (a - b).abs()).sum()
    }

    /// The rotation at which the sectors agree best, and the distance there; of equals the first.
    ///
    /// Kim & Kim 2018, eqs. (6) and (7): `1 − a·b/(|a||b|)` averaged over the sectors that hold a
    /// point in either scan; one that is empty in one of them counts 1.
    #[must_use]
    pub fn compare(&self, other: &Self) -> ContextMatch {
        let sectors = self.norms.len();
        let mut best = ContextMatch {
            distance: 1.0,
            turn_rad: 0.0,
        };
        for shift in 0..sectors {
            let distance = self.distance_at(other, shift);
            if distance < best.distance {
                best = ContextMatch {
                    distance,
                    turn_rad: wrap_angle(shift as f64 * TAU / sectors as f64),
                };
            }
        }
        best
    }

    /// Distance with the other scan rotated by `shift` sectors, fewer than there are.
    #[must_use]
    pub fn distance_at(&self, other: &Self, shift: usize) -> f64 {
        let sectors = self.norms.len();
        let (mut agreement, mut seen) = (0.0, 0.0);
        for here in 0..sectors {
            let there = (here + sectors - shift) % sectors;
            let norms = self.norms[here] * other.norms[there];
            if norms > 0.0 {
                agreement += dot(self.sector(here), other.sector(there)) / norms;
            }
            if self.norms[here] + other.norms[there] > 0.0 {
                seen += 1.0;
            }
        }
        if seen > 0.0 {
            1.0 - agreement / seen
        } else {
            1.0
        }
    }

    fn sector(&self, sector: usize) -> &[f64] {
        &self.bins[sector * self.rings..][..self.rings]
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_3;

    use pr_geom::{Point2, SE2};

    use super::*;

    /// A room without rotational symmetry, from a position within it.
    fn room() -> PointCloud {
        let long = (0..50).map(|k| Point2::new(-2.0 + 0.1 * f64::from(k), 1.3));
        let short = (0..25).map(|k| Point2::new(3.0, -1.2 + 0.1 * f64::from(k)));
        long.chain(short).chain([Point2::new(-1.0, -1.6)]).collect()
    }

    #[test]
    fn the_turn_is_first_from_second_to_a_sector() {
        let config = ContextConfig::default();
        let first = ScanContext::new(&room(), &config);
        for turn in [0.0, FRAC_PI_3, -2.0, 3.0] {
            let first_from_second = SE2::new(0.0, 0.0, turn);
            let seen = room().transformed(&first_from_second.inverse());
            let found = first.compare(&ScanContext::new(&seen, &config));
            let off = wrap_angle(found.turn_rad - turn);
            // One of 60 sectors is 0.105 rad.
            assert!(off.abs() < 0.105, "{turn}: {found:?}");
            assert!(found.distance < 0.3, "{turn}: {found:?}");
        }
    }

    #[test]
    fn a_turn_by_whole_sectors_shifts_the_sectors_and_keeps_the_rings() {
        let config = ContextConfig::default();
        let turned = room().transformed(&SE2::new(0.0, 0.0, 7.0 * TAU / 60.0));
        let (a, b) = (
            ScanContext::new(&room(), &config),
            ScanContext::new(&turned, &config),
        );
        assert_eq!(a.ring_key(), b.ring_key());
        let found = b.compare(&a);
        assert!((found.turn_rad - 7.0 * TAU / 60.0).abs() < 1e-12);
        // 1e-15: sums of sixty quotients that are 1 up to rounding.
        assert!(found.distance.abs() < 1e-15);
    }

    #[test]
    fn an_empty_scan_is_unlike_any_other() {
        let config = ContextConfig::default();
        let nothing = ScanContext::new(&PointCloud::default(), &config);
        assert_eq!(nothing.compare(&nothing).distance, 1.0);
        let room = ScanContext::new(&room(), &config);
        assert_eq!(room.compare(&nothing).distance, 1.0);
    }
}
