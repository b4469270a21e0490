//! Findings of the comparison of scans and odometry.

use core::f64::consts::{PI, TAU};

use nalgebra::Complex;
use pr_geom::{SE2, math, wrap_angle};
use serde::Serialize;

use super::Stretch;
use super::lag::{Heading, lag_s};
use crate::laser_mount::LaserMount;
use crate::remark::{NO_ODOMETRY, Part, Remark};
use crate::stamps::median;

/// Fewer segments are not evaluated.
const MIN_STRETCHES: usize = 8;
/// A shorter path or less turning is not evaluated, m and rad.
const MIN_M: f64 = 2.0;
const MIN_RAD: f64 = 1.5;
/// Turns with at least this absolute correlation agree, or are opposite.
const AGREE: f64 = 0.8;
/// Directional concentration of the displacements needed for a turned mounting, and for a small correction.
const ONE_DIRECTION: f64 = 0.85;
/// A laser whose direction differs by more is turned, rad: 25°.
const ELSEWHERE_RAD: f64 = 25.0 * PI / 180.0;
/// A scale that differs from 1 by more is reported.
const SCALE_OFF: f64 = 0.08;
/// Units of length, in metres, and their names.
const UNITS: [(f64, &str); 4] = [
    (1e-3, "millimetres"),
    (1e-2, "centimetres"),
    (0.3048, "feet"),
    (0.0254, "inches"),
];
/// Relative tolerance of a unit.
const UNIT_OFF: f64 = 0.12;
/// Odometry that covers less than this share of the path by scans stands still.
const STILL: f64 = 0.03;

/// A fault with its correction.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// Turns are opposite: the scans are mirrored.
    Mirrored {
        /// Correlation of the turns.
        correlation: f64,
    },
    /// The laser faces another direction than stated.
    Turned {
        /// Difference, rad.
        by_rad: f64,
    },
    /// Odometry is not in metres.
    Unit {
        /// Factor that converts it to metres.
        metres: f64,
        /// Name of the unit.
        name: &'static str,
    },
    /// Odometry overestimates or underestimates lengths.
    Scale {
        /// Its length per metre by scans.
        ratio: f64,
    },
    /// Odometry stands still while scans move.
    Still {
        /// Path length by scans, m.
        moved_m: f64,
    },
    /// Turns do not correlate.
    Unlike {
        /// Correlation of the turns.
        correlation: f64,
    },
}

/// Comparison of scans and odometry.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Motion {
    /// Number of segments compared.
    pub stretches: usize,
    /// Path length by scans, m.
    pub moved_m: f64,
    /// Sum of absolute turns by scans, rad.
    pub turned_rad: f64,
    /// Correlation of the turns; `None` if the robot turned too little.
    pub correlation: Option<f64>,
    /// Direction of the laser by scans and odometry, relative to the stated one, rad.
    pub direction_rad: Option<f64>,
    /// Concentration of the displacements' directions, from 0 to 1.
    pub agreement: f64,
    /// Length by odometry per metre by scans.
    pub scale: Option<f64>,
    /// Turn by odometry per turn by scans.
    pub turn_scale: Option<f64>,
    /// Median distance between both per metre, m.
    pub drift_m_per_m: Option<f64>,
    /// Lag of odometry behind the scans, s; `None` if there is none or the turns do not show it.
    pub lag_s: Option<f64>,
    #[serde(skip)]
    findings: Vec<Finding>,
}

impl Motion {
    /// Evaluates segments for a laser with this stated mounting.
    pub(super) fn from_stretches(stretches: &[Stretch], mount: SE2) -> Self {
        let mut motion = Self {
            stretches: stretches.len(),
            moved_m: stretches
                .iter()
                .map(|stretch| length(&stretch.sensor))
                .sum(),
            turned_rad: stretches
                .iter()
                .map(|stretch| stretch.sensor.theta().abs())
                .sum(),
            ..Self::default()
        };
        if stretches.len() < MIN_STRETCHES {
            return motion;
        }
        if motion.moved_m >= MIN_M {
            let by_odometry: f64 = stretches.iter().map(|stretch| length(&stretch.body)).sum();
            let turned: f64 = stretches
                .iter()
                .map(|stretch| stretch.body.theta().abs())
                .sum();
            if by_odometry < STILL * motion.moved_m && turned < STILL * motion.turned_rad.max(1.0) {
                motion.findings.push(Finding::Still {
                    moved_m: motion.moved_m,
                });
                return motion;
            }
        }
        let sum = |of: fn(&Stretch) -> f64| stretches.iter().map(of).sum::<f64>();
        let both = sum(|stretch| stretch.sensor.theta() * stretch.body.theta());
        let of_scans = sum(|stretch| stretch.sensor.theta() * stretch.sensor.theta());
        let of_body = sum(|stretch| stretch.body.theta() * stretch.body.theta());
        if motion.turned_rad >= MIN_RAD && of_body > 0.0 {
            motion.correlation = Some(both / math::sqrt(of_scans * of_body));
            motion.turn_scale = Some(both / of_scans);
        }
        let is_mirrored = motion
            .correlation
            .is_some_and(|correlation| correlation <= -AGREE);
        if let Some(correlation) = motion.correlation {
            if is_mirrored {
                motion.findings.push(Finding::Mirrored { correlation });
            } else if correlation < 0.5 {
                motion.findings.push(Finding::Unlike { correlation });
            }
        }
        let mirror = if is_mirrored { -1.0 } else { 1.0 };
        if motion.moved_m >= MIN_M {
            motion.compare_displacements(stretches, mount, mirror);
        }
        motion
    }

    /// Estimates direction and scale of the displacements.
    fn compare_displacements(&mut self, stretches: &[Stretch], mount: SE2, mirror: f64) {
        let ratios = stretches.iter().filter_map(|stretch| {
            let by_scans = length(&stretch.sensor);
            (by_scans > 0.15).then(|| length(&stretch.body) / by_scans)
        });
        let Some(ratio) = median(ratios.collect()) else {
            return;
        };
        let unit = UNITS.into_iter().find(|(metres, _)| {
            let off = ratio * metres - 1.0;
            off.abs() <= UNIT_OFF
        });
        let metres = unit.map_or(1.0, |(metres, _)| metres);
        let pairs: Vec<(Complex<f64>, Complex<f64>)> = stretches
            .iter()
            .map(|stretch| {
                // Motion of the sensor: that of the body plus the lever arm's rotation.
                let [x, y, theta] = stretch.body.to_array();
                let (sin, cos) = math::sin_cos(theta);
                let (px, py) = (mount.x(), mount.y());
                let by_body = Complex::new(
                    x * metres + (cos - 1.0) * px - sin * py,
                    y * metres + sin * px + (cos - 1.0) * py,
                );
                let by_scans = Complex::new(stretch.sensor.x(), mirror * stretch.sensor.y());
                (by_scans, by_body)
            })
            .collect();
        let sum: Complex<f64> = pairs
            .iter()
            .map(|(by_scans, by_body)| by_scans.conj() * by_body)
            .sum();
        let sizes: f64 = pairs
            .iter()
            .map(|(by_scans, by_body)| size(by_scans) * size(by_body))
            .sum();
        if sizes <= 0.0 {
            return;
        }
        self.agreement = size(&sum) / sizes;
        let direction_rad = math::atan2(sum.im, sum.re);
        let off_rad = wrap_angle(direction_rad - mount.theta());
        self.direction_rad = Some(off_rad);
        let longer = pairs.iter().filter(|(by_scans, _)| size(by_scans) > 0.15);
        let longer = longer.map(|(by_scans, by_body)| size(by_body) / size(by_scans));
        let scale = median(longer.collect()).unwrap_or(1.0);
        self.scale = Some(scale / metres);
        let (sin, cos) = math::sin_cos(direction_rad);
        let turn = Complex::new(cos, sin);
        let drifts = pairs.iter().filter_map(|(by_scans, by_body)| {
            let moved_m = size(by_scans);
            (moved_m > 0.15).then(|| size(&(by_scans * turn - by_body)) / moved_m)
        });
        self.drift_m_per_m = median(drifts.collect());
        if let Some((metres, name)) = unit {
            self.findings.push(Finding::Unit { metres, name });
        }
        if self.agreement < ONE_DIRECTION {
            return;
        }
        if off_rad.abs() >= ELSEWHERE_RAD {
            self.findings.push(Finding::Turned { by_rad: off_rad });
        }
        if unit.is_none() && (scale - 1.0).abs() > SCALE_OFF {
            self.findings.push(Finding::Scale { ratio: scale });
        }
    }

    /// Compares the times at which both turn.
    pub(super) fn compare_turns(&mut self, headings: &[Heading]) {
        self.lag_s = lag_s(headings).filter(|_| !self.is_still());
    }

    /// Keeps only the findings about the laser.
    pub(super) fn keep_mounting(&mut self) {
        self.lag_s = None;
        let is_of_laser = |finding: &Finding| {
            matches!(finding, Finding::Mirrored { .. } | Finding::Turned { .. })
        };
        self.findings.retain(is_of_laser);
    }

    /// The faults found.
    #[must_use]
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// The mounting by the findings, given the stated `mount`; `None` if that is right.
    #[must_use]
    pub fn mended_mount(&self, mount: LaserMount) -> Option<LaserMount> {
        let mut mended = mount;
        for finding in &self.findings {
            match finding {
                Finding::Mirrored { .. } => mended.is_flipped = !mended.is_flipped,
                Finding::Turned { by_rad } => {
                    let [x, y, theta] = mended.body_from_sensor.to_array();
                    // Lasers are mounted at right angles, or at an angle that this cannot estimate exactly.
                    let looks = wrap_angle(theta + by_rad);
                    let quarter = (looks / (TAU / 4.0)).round() * (TAU / 4.0);
                    let is_square = wrap_angle(looks - quarter).abs() < 12.0 * PI / 180.0;
                    let theta = if is_square { quarter } else { looks };
                    mended.body_from_sensor = SE2::new(x, y, theta);
                }
                _ => {}
            }
        }
        (mended != mount).then_some(mended)
    }

    /// The factor for odometry's unit, and whether odometry is dropped.
    #[must_use]
    pub fn metres(&self) -> Option<f64> {
        self.findings.iter().find_map(|finding| match finding {
            Finding::Unit { metres, .. } => Some(*metres),
            _ => None,
        })
    }

    /// Whether odometry stands still while the robot moves.
    #[must_use]
    pub fn is_still(&self) -> bool {
        self.findings
            .iter()
            .any(|finding| matches!(finding, Finding::Still { .. }))
    }

    /// The findings, one remark each; `mount` is the stated mounting, and `is_mended` whether it was corrected.
    #[must_use]
    pub fn remarks(&self, mount: LaserMount, is_mended: bool) -> Vec<Remark> {
        let option = self
            .mended_mount(mount)
            .map(|mended| mended.option())
            .unwrap_or_default();
        let (of_mount, mount_options) = if is_mended {
            let own = mount.option();
            let text = format!(
                "it was corrected; keep the correction with {option}, or the recording's mounting with {own}"
            );
            (text, vec![option, own])
        } else {
            (format!("correct it with {option}"), vec![option])
        };
        let sentence = |finding: &Finding| match finding {
            Finding::Mirrored { correlation } => format!(
                "the scans are mirrored: they turn opposite to odometry (correlation {correlation:.2}), so the laser is mounted upside down or its driver lists the beams clockwise; {of_mount}"
            ),
            Finding::Turned { by_rad } => format!(
                "the laser faces {:.0}° away from its stated direction ({}), as the comparison of scans and odometry shows; {of_mount}",
                by_rad.to_degrees().abs(),
                if by_rad.abs() > 0.8 * PI {
                    "backward"
                } else if *by_rad > 0.0 {
                    "to the left"
                } else {
                    "to the right"
                },
            ),
            Finding::Unit { name, metres } => format!(
                "odometry is in {name}: it moves {:.0} per metre by scans; it was converted. Publish metres",
                1.0 / metres
            ),
            Finding::Scale { ratio } => format!(
                "odometry measures {:.2} m per metre by scans; check the wheel radius, or use scans alone with --no-odometry",
                ratio
            ),
            Finding::Still { moved_m } => format!(
                "odometry stands still while the scans move by {moved_m:.1} m; it is ignored and scans are matched alone. Check its topic"
            ),
            Finding::Unlike { correlation } => format!(
                "the turns of scans matched alone and of odometry differ (correlation {correlation:.2}): the scans have too few features to be matched alone, or the odometry is not this robot's; compare with a map made with --no-odometry"
            ),
        };
        let remark = |finding: &Finding| {
            let text = sentence(finding);
            match finding {
                Finding::Mirrored { .. } | Finding::Turned { .. } => {
                    let remark = if is_mended {
                        Remark::mended(Part::Mounting, text)
                    } else {
                        Remark::wrong(Part::Mounting, text)
                    };
                    mount_options.iter().fold(remark, Remark::with_option)
                }
                Finding::Unit { .. } => {
                    Remark::mended(Part::Odometry, text).with_option(NO_ODOMETRY)
                }
                Finding::Still { .. } => Remark::mended(Part::Odometry, text),
                Finding::Scale { .. } | Finding::Unlike { .. } => {
                    Remark::wrong(Part::Odometry, text).with_option(NO_ODOMETRY)
                }
            }
        };
        let late = self.lag_s.map(|lag_s| {
            let way = if lag_s > 0.0 { "late" } else { "early" };
            let text = format!(
                "odometry is {:.2} s {way} relative to the scans, by the turns of both; it was shifted by that. Synchronize both clocks by NTP, and stamp each message when it is measured",
                lag_s.abs()
            );
            Remark::mended(Part::Clocks, text)
        });
        self.findings.iter().map(remark).chain(late).collect()
    }
}

fn length(motion: &SE2) -> f64 {
    math::norm2(motion.x(), motion.y())
}

fn size(displacement: &Complex<f64>) -> f64 {
    math::norm2(displacement.re, displacement.im)
}
