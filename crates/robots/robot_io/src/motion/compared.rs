//! What the comparison of scans and odometry shows, and the trial of its findings.

use core::f64::consts::PI;

use nalgebra::Complex;
use pr_geom::{SE2, math, wrap_angle};
use serde::Serialize;

use super::Costs;
use super::Stretch;
use super::finding::{Finding, Suggestion};
use super::lag::{Heading, lag_s};
use super::repairs::Repairs;
use super::trial::Trial;
use super::turns::{
    ONE_DIRECTION, SCALE_OFF, compare_turns, direction, length, opposed, size, without_outliers,
};
use crate::laser_mount::LaserMount;
use crate::ros::SWEEP_SLACK;
use crate::stamps::median;

/// Fewer segments are not evaluated.
const MIN_STRETCHES: usize = 8;
/// A shorter path or less turning is not evaluated, m and rad.
const MIN_M: f64 = 2.0;
const MIN_RAD: f64 = 1.5;
/// Turns with at least this absolute correlation agree, or are opposite.
const AGREE: f64 = 0.8;
/// Largest distance per metre between scans and odometry in a comparison that agrees with itself.
const MAX_DRIFT: f64 = 0.3;
/// A direction within this of the stated one confirms it, rad: 10°.
const CONFIRMED_RAD: f64 = 10.0 * PI / 180.0;
/// A laser whose direction differs by more is turned, rad: 25°.
const ELSEWHERE_RAD: f64 = 25.0 * PI / 180.0;
/// Units of length, in metres, and their names.
const UNITS: [(f64, &str); 4] = [
    (1e-3, "millimetres"),
    (1e-2, "centimetres"),
    (0.3048, "feet"),
    (0.0254, "inches"),
];
/// Relative tolerance of a unit.
const UNIT_OFF: f64 = 0.12;
/// Times of a sweep over that between two scans that are tried for scans whose beams have no times.
const SWEEPS: [f64; 3] = [2.0, 3.0, 4.0];
/// Odometry that covers less than this share of the path by scans stands still.
const STILL: f64 = 0.03;

/// The unit, in metres, of a length whose number is that many times its metres, and its name.
pub fn unit_of(ratio: f64) -> Option<(f64, &'static str)> {
    let mut units = UNITS.into_iter();
    units.find(|(metres, _)| (ratio * metres - 1.0).abs() <= UNIT_OFF)
}

/// Comparison of scans and odometry.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MotionComparison {
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
    /// Whether three of four turns are out of scale to the same side: noise scatters them about 1, a wrong distance between
    /// the wheels does not.
    #[serde(skip)]
    is_turn_scale_off: bool,
    /// Median distance between both per metre, m.
    pub drift_m_per_m: Option<f64>,
    /// Lag of odometry behind the scans, s; `None` if there is none or the turns do not show it.
    pub lag_s: Option<f64>,
    /// Time of a sweep over that between two scans, if it is longer: beams of different sweeps would overlap.
    #[serde(skip)]
    pub(super) long_sweep: Option<f64>,
    /// Medians of the time of a sweep and of that between two scans, s.
    #[serde(skip)]
    pub(super) sweep_s: f64,
    #[serde(skip)]
    period_s: f64,
    /// Faults whose repair won its trial, each with its costs; before the trial, those that the comparison shows.
    #[serde(skip)]
    findings: Vec<(Finding, Option<Costs>)>,
    #[serde(skip)]
    suggestions: Vec<Suggestion>,
}

impl MotionComparison {
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
        let opposed = opposed(stretches);
        if let Some((is_heading, _)) = opposed {
            motion.propose(Finding::Opposed { is_heading });
        }
        let stretches = opposed.as_ref().map_or(stretches, |(_, with)| &with[..]);
        if motion.moved_m >= MIN_M {
            let by_odometry: f64 = stretches.iter().map(|stretch| length(&stretch.body)).sum();
            let turned: f64 = stretches
                .iter()
                .map(|stretch| stretch.body.theta().abs())
                .sum();
            if by_odometry < STILL * motion.moved_m && turned < STILL * motion.turned_rad.max(1.0) {
                motion.propose(Finding::Still {
                    moved_m: motion.moved_m,
                });
                return motion;
            }
        }
        if motion.turned_rad >= MIN_RAD {
            let turns = compare_turns(stretches);
            motion.correlation = turns.as_ref().map(|turns| turns.correlation);
            motion.turn_scale = turns.as_ref().map(|turns| turns.ratio);
            motion.is_turn_scale_off = turns.is_some_and(|turns| turns.is_off);
        }
        let is_mirrored = motion
            .correlation
            .is_some_and(|correlation| correlation <= -AGREE);
        if let Some(correlation) = motion.correlation {
            if is_mirrored {
                motion.propose(Finding::Mirrored { correlation });
            } else if correlation < 0.5 {
                motion.propose(Finding::Unlike { correlation });
            }
        }
        let is_alike = motion
            .correlation
            .is_some_and(|correlation| correlation >= AGREE);
        let is_off = is_alike && motion.is_turn_scale_off;
        if let Some(ratio) = motion.turn_scale.filter(|_| is_off) {
            motion.propose(Finding::TurnScale { ratio });
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
        let unit = unit_of(ratio);
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
        let Some((turn, _)) = direction(&pairs) else {
            return;
        };
        let pairs = without_outliers(pairs, |(by_scans, by_body)| {
            size(&(by_scans * turn - by_body))
        });
        let Some((turn, agreement)) = direction(&pairs) else {
            return;
        };
        self.agreement = agreement;
        let direction_rad = math::atan2(turn.im, turn.re);
        let off_rad = wrap_angle(direction_rad - mount.theta());
        self.direction_rad = Some(off_rad);
        let longer = pairs.iter().filter(|(by_scans, _)| size(by_scans) > 0.15);
        let longer = longer.map(|(by_scans, by_body)| size(by_body) / size(by_scans));
        let scale = median(longer.collect()).unwrap_or(1.0);
        self.scale = Some(scale / metres);
        let drifts = pairs.iter().filter_map(|(by_scans, by_body)| {
            let moved_m = size(by_scans);
            (moved_m > 0.15).then(|| size(&(by_scans * turn - by_body)) / moved_m)
        });
        self.drift_m_per_m = median(drifts.collect());
        if let Some((metres, name)) = unit {
            self.propose(Finding::Unit { metres, name });
        }
        if !self.agrees_with_itself() {
            return;
        }
        if off_rad.abs() >= ELSEWHERE_RAD {
            self.propose(Finding::Turned { by_rad: off_rad });
        }
        if unit.is_none() && (scale - 1.0).abs() > SCALE_OFF {
            self.propose(Finding::Scale { ratio: scale });
        }
    }

    fn propose(&mut self, finding: Finding) {
        self.findings.push((finding, None));
    }

    /// Whether the segments agree with each other on the direction of the laser and on the turns.
    #[must_use]
    pub fn agrees_with_itself(&self) -> bool {
        self.agreement >= ONE_DIRECTION
            && self.drift_m_per_m.is_some_and(|drift| drift <= MAX_DRIFT)
            && (self.correlation).is_none_or(|correlation| correlation.abs() >= AGREE)
    }

    /// Whether scans and odometry confirm the stated mounting.
    #[must_use]
    pub fn confirms_mounting(&self) -> bool {
        self.agrees_with_itself()
            && self
                .correlation
                .is_some_and(|correlation| correlation >= AGREE)
            && (self.direction_rad)
                .is_some_and(|direction_rad| direction_rad.abs() <= CONFIRMED_RAD)
    }

    /// Compares the times at which both turn.
    pub(super) fn compare_turns(&mut self, headings: &[Heading]) {
        self.lag_s = lag_s(headings).filter(|_| !self.is_still());
        if let Some(by_s) = self.lag_s {
            self.propose(Finding::Late { by_s });
        }
    }

    /// Tries the opposite order of the beams in time, if the robot turned by more than the step between two beams (a
    /// `skew` of 1) during a sweep. `sweeps` are the times of the sweeps and those between two scans, s.
    pub(super) fn compare_sweeps(&mut self, skew: f64, sweeps: &[(f64, f64)]) {
        let middle = |of: fn(&(f64, f64)) -> f64| median(sweeps.iter().map(of).collect());
        self.sweep_s = middle(|sweep| sweep.0).unwrap_or_default();
        self.period_s = middle(|sweep| sweep.1).unwrap_or_default();
        self.long_sweep = middle(|sweep| sweep.0 / sweep.1).filter(|&share| share > SWEEP_SLACK);
        if skew > 1.0 {
            self.propose(Finding::Backward);
        }
    }

    /// Drops the findings about odometry that is not used, or that the user trusts.
    pub(super) fn keep_mounting(&mut self) {
        self.findings.retain(|(finding, _)| finding.is_of_laser());
        self.lag_s = None;
    }

    /// Keeps the findings whose repair wins against leaving it out, all others being repaired; the rest are
    /// suggestions.
    pub(super) fn decide(&mut self, trial: &Trial, mount: LaserMount) {
        loop {
            let all = self.faults();
            let with = trial.costs(&Repairs::of(&all, mount));
            let mut worst: Option<(usize, Costs)> = None;
            for index in 0..all.len() {
                let mut others = all.clone();
                others.remove(index);
                let without = trial.costs(&Repairs::of(&others, mount));
                let costs = trial.compare(&with, &without);
                self.findings[index].1 = Some(costs);
                let gain = |costs: &Costs| costs.without - costs.with;
                if !costs.wins && worst.is_none_or(|(_, worst)| gain(&costs) < gain(&worst)) {
                    worst = Some((index, costs));
                }
            }
            let Some((index, costs)) = worst else { break };
            let (finding, _) = self.findings.remove(index);
            // The order of the beams is always tried: nothing suggests it.
            if finding != Finding::Backward {
                self.suggestions.push(Suggestion { finding, costs });
            }
        }
        let is_late = |(finding, _): &(Finding, _)| matches!(finding, Finding::Late { .. });
        let late = self.findings.iter().position(is_late);
        if late.is_none_or(|at| self.is_swept(at, trial, mount)) {
            self.lag_s = None;
        }
    }

    /// Whether sweeps of several times the time between two scans explain the lag, the finding `at`: the middle of such a
    /// sweep is measured after its stamp. Then they take the place of the lag.
    fn is_swept(&mut self, at: usize, trial: &Trial, mount: LaserMount) -> bool {
        let is_candidate = self.lag_s.is_some_and(|by_s| by_s > 0.0) && self.sweep_s == 0.0;
        if !is_candidate {
            return false;
        }
        let mut faults = self.faults();
        let late = trial.costs(&Repairs::of(&faults, mount));
        let tried = SWEEPS.map(|share| {
            let sweep_s = share * self.period_s;
            faults[at] = Finding::Swept { share, sweep_s };
            let swept = trial.costs(&Repairs::of(&faults, mount));
            (faults[at].clone(), trial.compare(&swept, &late))
        });
        let best = tried
            .into_iter()
            .filter(|(_, costs)| costs.wins)
            .min_by(|a, b| a.1.with.total_cmp(&b.1.with));
        let is_swept = best.is_some();
        if let Some((finding, costs)) = best {
            self.findings[at] = (finding, Some(costs));
        }
        is_swept
    }

    /// The faults found.
    #[must_use]
    pub fn faults(&self) -> Vec<Finding> {
        let findings = self.findings.iter();
        findings.map(|(finding, _)| finding.clone()).collect()
    }

    /// The faults found, each with the costs of its trial.
    #[must_use]
    pub fn findings(&self) -> &[(Finding, Option<Costs>)] {
        &self.findings
    }

    /// What the comparison shows and the trial refuted.
    #[must_use]
    pub fn suggestions(&self) -> &[Suggestion] {
        &self.suggestions
    }

    /// What corrects the frames of a laser at `mount`.
    pub(super) fn repairs(&self, mount: LaserMount, is_mount_fixed: bool) -> Repairs {
        let mut faults = self.faults();
        faults.retain(|fault| !(fault.is_left() || is_mount_fixed && fault.is_of_mount()));
        Repairs::of(&faults, mount)
    }

    /// Whether odometry stands still while the robot moves.
    #[must_use]
    pub fn is_still(&self) -> bool {
        let is_still = |(finding, _): &(Finding, _)| matches!(finding, Finding::Still { .. });
        self.findings.iter().any(is_still)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A path of straight segments with a few that turn, whose turns by odometry are scaled.
    fn stretches(factor: f64) -> Vec<Stretch> {
        let turns = (0..160).map(|k| if k % 32 < 3 { 0.3 } else { 0.001 });
        turns
            .map(|turn| Stretch {
                sensor: SE2::new(0.3, 0.0, turn),
                body: SE2::new(0.3, 0.0, factor * turn),
                heading_rad: 0.0,
            })
            .collect()
    }

    #[test]
    fn turns_that_are_few_are_compared_and_their_scale_is_found() {
        let found =
            |factor: f64| MotionComparison::from_stretches(&stretches(factor), SE2::identity());
        assert_eq!(found(1.0).faults(), []);
        assert!(found(1.0).confirms_mounting());
        let [Finding::TurnScale { ratio }] = found(1.6).faults()[..] else {
            panic!("{:?}", found(1.6).faults())
        };
        assert!((ratio - 1.6).abs() < 1e-9);
        // A tenth is within what tyres do, and a mirror image is another fault.
        assert_eq!(found(1.05).faults(), []);
        assert!(matches!(
            found(-1.0).faults()[..],
            [Finding::Mirrored { .. }]
        ));
    }
}
