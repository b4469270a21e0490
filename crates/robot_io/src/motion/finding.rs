//! What the comparison of scans and odometry finds.

use core::f64::consts::{PI, TAU};

use nalgebra::Complex;
use pr_geom::{SE2, math, wrap_angle};
use serde::Serialize;

use super::Stretch;
use super::lag::{Heading, lag_s};
use crate::laser_mount::LaserMount;
use crate::remark::{NO_ODOMETRY, Part, Remark};
use crate::stamps::median;

/// Fewer stretches show nothing.
const LEAST_STRETCHES: usize = 8;
/// Less path or less turning shows nothing, m and rad.
const LEAST_M: f64 = 2.0;
const LEAST_RAD: f64 = 1.5;
/// Turns whose correlation is at least this large agree, or are opposite.
const AGREE: f64 = 0.8;
/// So well have displacements to agree on one direction for a finding, and for a small one.
const ONE_DIRECTION: f64 = 0.85;
/// A laser that looks elsewhere by more is not where it is said to be, rad: 25°.
const ELSEWHERE_RAD: f64 = 25.0 * PI / 180.0;
/// Odometry whose scale is farther from 1 is told.
const SCALE_OFF: f64 = 0.08;
/// Lengths that programs measure in, in metres, and their names.
const UNITS: [(f64, &str); 4] = [
    (1e-3, "millimetres"),
    (1e-2, "centimetres"),
    (0.3048, "feet"),
    (0.0254, "inches"),
];
/// A unit is believed this near to its size.
const UNIT_OFF: f64 = 0.12;
/// Odometry that covers less than this share of the scans' path stands still.
const STILL: f64 = 0.03;

/// One thing that is wrong, and its mend.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// Turns are opposite: the scans are a mirror image.
    Mirrored {
        /// Correlation of the turns.
        correlation: f64,
    },
    /// The laser looks elsewhere than it is said to.
    Turned {
        /// By how much, rad.
        by_rad: f64,
    },
    /// Odometry has another unit of length.
    Unit {
        /// What it is multiplied by to be metres.
        metres: f64,
        /// Its name.
        name: &'static str,
    },
    /// Odometry measures too long or too short.
    Scale {
        /// Its length for a metre by scans.
        ratio: f64,
    },
    /// Odometry does not move while scans do.
    Still {
        /// Path by scans, m.
        moved_m: f64,
    },
    /// Turns agree with no hypothesis.
    Unlike {
        /// Correlation of the turns.
        correlation: f64,
    },
}

/// Scans against odometry, in numbers.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Motion {
    /// Stretches of the path that were compared.
    pub stretches: usize,
    /// Path by scans over them, m.
    pub moved_m: f64,
    /// Turns by scans over them, rad.
    pub turned_rad: f64,
    /// Correlation of the turns; none where too little was turned.
    pub correlation: Option<f64>,
    /// Where the laser looks, by scans and odometry, against where it is said to look, rad.
    pub direction_rad: Option<f64>,
    /// How well the displacements agree on that direction, from 0 to 1.
    pub agreement: f64,
    /// Length by odometry for a metre by scans.
    pub scale: Option<f64>,
    /// Turn by odometry for a turn by scans.
    pub turn_scale: Option<f64>,
    /// Median distance between both after a metre, m.
    pub drift_m_per_m: Option<f64>,
    /// How late odometry is against the scans, s; none if it is not, or the turns do not show it.
    pub lag_s: Option<f64>,
    #[serde(skip)]
    findings: Vec<Finding>,
}

impl Motion {
    /// What stretches show of a laser that is said to sit so.
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
        if stretches.len() < LEAST_STRETCHES {
            return motion;
        }
        if motion.moved_m >= LEAST_M {
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
        if motion.turned_rad >= LEAST_RAD && of_body > 0.0 {
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
        if motion.moved_m >= LEAST_M {
            motion.compare_displacements(stretches, mount, mirror);
        }
        motion
    }

    /// Direction and scale of the displacements.
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
                // The sensor moves as the body does, and about it where it turns.
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

    /// Compares when both turn.
    pub(super) fn compare_turns(&mut self, headings: &[Heading]) {
        self.lag_s = lag_s(headings).filter(|_| !self.is_still());
    }

    /// Leaves the findings about the laser alone.
    pub(super) fn keep_mounting(&mut self) {
        self.lag_s = None;
        let is_of_laser = |finding: &Finding| {
            matches!(finding, Finding::Mirrored { .. } | Finding::Turned { .. })
        };
        self.findings.retain(is_of_laser);
    }

    /// What is wrong.
    #[must_use]
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// Where the laser sits by the findings, if it was said to sit at `mount`; none where that holds.
    #[must_use]
    pub fn mended_mount(&self, mount: LaserMount) -> Option<LaserMount> {
        let mut mended = mount;
        for finding in &self.findings {
            match finding {
                Finding::Mirrored { .. } => mended.is_flipped = !mended.is_flipped,
                Finding::Turned { by_rad } => {
                    let [x, y, theta] = mended.body_from_sensor.to_array();
                    // A laser is mounted at a right angle, or at an angle that this cannot tell exactly.
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

    /// What odometry is multiplied by, and whether it is left out.
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

    /// The findings, a sentence each; `mount` is where the laser was said to sit, and `is_mended` whether it is
    /// taken to sit where they say.
    #[must_use]
    pub fn remarks(&self, mount: LaserMount, is_mended: bool) -> Vec<Remark> {
        let option = self
            .mended_mount(mount)
            .map(|mended| mended.option())
            .unwrap_or_default();
        let (of_mount, mount_options) = if is_mended {
            let own = mount.option();
            let said = format!(
                "it is taken so; keep that with {option}, or the recording's own with {own}"
            );
            (said, vec![option, own])
        } else {
            (format!("mend it with {option}"), vec![option])
        };
        let sentence = |finding: &Finding| match finding {
            Finding::Mirrored { correlation } => format!(
                "the scans are a mirror image: they turn against odometry (correlation {correlation:.2}), so the laser hangs upside down or its driver lists the beams clockwise; {of_mount}"
            ),
            Finding::Turned { by_rad } => format!(
                "the laser looks {:.0}° away from where it is said to look ({}), as scans and odometry show; {of_mount}",
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
                "odometry is in {name}: it moves {:.0} for each metre by scans; it is divided. Publish metres",
                1.0 / metres
            ),
            Finding::Scale { ratio } => format!(
                "odometry measures {:.2} m for each metre by scans; check the radius of the wheels, or go by scans alone with --no-odometry",
                ratio
            ),
            Finding::Still { moved_m } => format!(
                "odometry stands still while the scans move by {moved_m:.1} m; it is left out, and scans go alone. Check its topic"
            ),
            Finding::Unlike { correlation } => format!(
                "scans matched alone and odometry turn differently (correlation {correlation:.2}): the scans see too little to be matched alone, or the odometry is not this robot's; compare with a map by --no-odometry"
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
                "odometry is {:.2} s {way} against the scans, as the turns of both show; it is moved by that. Set both clocks by NTP, and stamp each message when it is measured",
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
