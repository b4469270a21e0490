//! Lengths derived from the sensor: the same system for a room and for a hall.

use super::config::{ChapterConfig, NORMAL_RADIUS_CELLS, ThresholdConfig};
use crate::loops::LoopConfig;
use crate::matching::{MapConfig, TrustConfig};
use crate::metrics::rms;
use crate::scan::{LaserScan, ScanConfig};
use crate::slam::SlamConfig;

/// Cells of thinned sweeps across one cell of a map; the chapter's ratio of 0.25 to 0.12 m.
const CELLS_PER_MAP_CELL: f64 = 2.1;
/// Smallest width of a cell in standard deviations of the range noise.
const CELL_SIGMAS: f64 = 2.4;
/// Smallest width of a cell as a share of the typical range: about 100 cells around the robot.
const CELL_SHARE: f64 = 0.02;
/// Share of the typical range between two keyframes.
const KEYFRAME_SHARE: f64 = 0.2;

impl SlamConfig {
    /// The default system with all lengths derived from a scan and the noise of its ranges (a standard deviation,
    /// m).
    ///
    /// The typical range r is the root mean square of the returns: the radius of a circle with the area that a
    /// full turn sees. Cells hold one beam at r: they are `max(r · angle step, 0.02 r, 2.4 σ)` wide. Normals,
    /// maps, thresholds and keyframes follow from the cell and r by the ratios of the chapter's lap. A scan
    /// without returns gives the default.
    #[must_use]
    pub fn for_scan(scan: &LaserScan, range_sigma_m: f64) -> Self {
        let default = Self::default();
        let Some(typical_m) = typical_range_m(scan) else {
            return default;
        };
        let chapter = default.chapter.clone();
        let spacing_m = typical_m * scan.angle_step_rad.abs();
        let cell_m = spacing_m
            .max(CELL_SHARE * typical_m)
            .max(CELL_SIGMAS * range_sigma_m);
        let map = |max_per_cell| MapConfig {
            cell_m: CELLS_PER_MAP_CELL * cell_m,
            max_per_cell,
        };
        // A point's error is the noise and the sampling within its cell.
        let sigma_m = range_sigma_m.max(0.4 * cell_m);
        let keyframe_distance_m = KEYFRAME_SHARE * typical_m;
        Self {
            scan: ScanConfig {
                cell_m,
                normal_radius_m: NORMAL_RADIUS_CELLS * cell_m,
            },
            window_distance_m: 0.25 * keyframe_distance_m,
            keyframe_distance_m,
            chapter: ChapterConfig {
                local_map: map(chapter.local_map.max_per_cell),
                threshold: ThresholdConfig {
                    initial_m: 4.0 * cell_m,
                    min_motion_m: 0.25 * cell_m,
                    max_range_m: farthest_m(scan).max(typical_m),
                },
                odometry_trust: TrustConfig {
                    sigma_m,
                    ..chapter.odometry_trust
                },
                loops: LoopConfig {
                    radius_m: typical_m,
                    submap: map(chapter.loops.submap.max_per_cell),
                    min_tau_m: 5.0 * cell_m,
                    max_rmse_m: 1.3 * cell_m,
                    trust: TrustConfig {
                        sigma_m,
                        ..chapter.loops.trust
                    },
                    drift_sigma_m: 0.11 * keyframe_distance_m,
                    ..chapter.loops
                },
                ..chapter
            },
            ..default
        }
    }
}

fn returns(scan: &LaserScan) -> impl Iterator<Item = f64> + '_ {
    scan.ranges_m
        .iter()
        .copied()
        .filter(|&range_m| scan.is_return(range_m))
}

fn typical_range_m(scan: &LaserScan) -> Option<f64> {
    returns(scan).next()?;
    let typical_m = rms(returns(scan));
    // Rejects ranges whose squares overflow or underflow.
    (typical_m.is_finite() && typical_m > 0.0).then_some(typical_m)
}

fn farthest_m(scan: &LaserScan) -> f64 {
    returns(scan).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(beams: usize, radius_m: f64) -> LaserScan {
        LaserScan {
            angle_step_rad: core::f64::consts::TAU / beams as f64,
            ranges_m: vec![radius_m; beams],
            ..LaserScan::default()
        }
    }

    #[test]
    fn a_room_ten_times_as_large_has_lengths_ten_times_as_long() {
        let (small, large) = (circle(120, 2.0), circle(120, 20.0));
        let (a, b) = (
            SlamConfig::for_scan(&small, 0.02),
            SlamConfig::for_scan(&large, 0.2),
        );
        for (a, b) in [
            (a.scan.cell_m, b.scan.cell_m),
            (a.chapter.threshold.initial_m, b.chapter.threshold.initial_m),
            (a.chapter.loops.max_rmse_m, b.chapter.loops.max_rmse_m),
            (a.keyframe_distance_m, b.keyframe_distance_m),
        ] {
            assert!((10.0 * a - b).abs() < 1e-12);
        }
    }

    #[test]
    fn the_chapters_sensor_gets_about_the_chapters_lengths() {
        let config = SlamConfig::for_scan(&circle(120, 2.0), 0.05);
        let chapter = SlamConfig::chapter();
        for (of_sensor, of_chapter) in [
            (config.scan.cell_m, chapter.scan.cell_m),
            (
                config.chapter.local_map.cell_m,
                chapter.chapter.local_map.cell_m,
            ),
            (
                config.chapter.threshold.initial_m,
                chapter.chapter.threshold.initial_m,
            ),
            (
                config.chapter.threshold.min_motion_m,
                chapter.chapter.threshold.min_motion_m,
            ),
            (config.keyframe_distance_m, chapter.keyframe_distance_m),
            (
                config.chapter.odometry_trust.sigma_m,
                chapter.chapter.odometry_trust.sigma_m,
            ),
            (
                config.chapter.loops.max_rmse_m,
                chapter.chapter.loops.max_rmse_m,
            ),
            (
                config.chapter.loops.drift_sigma_m,
                chapter.chapter.loops.drift_sigma_m,
            ),
        ] {
            assert!(
                (of_sensor / of_chapter - 1.0).abs() < 0.15,
                "{of_sensor} {of_chapter}"
            );
        }
    }

    #[test]
    fn a_scan_without_returns_gives_the_default() {
        let empty = circle(40, f64::NAN);
        assert_eq!(SlamConfig::for_scan(&empty, 0.02), SlamConfig::default());
    }
}
