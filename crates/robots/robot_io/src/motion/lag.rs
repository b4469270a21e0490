//! Estimates the lag of odometry behind the scans from the turns of both.
//!
//! Over a few scans the sensor turns by Δθ, by scans matched alone. Odometry that is late by τ has turned by
//! θ(t₂ + τ) − θ(t₁ + τ) then. The lag is the τ that maximizes the correlation. It counts only if it is clearly better
//! than zero, and if either half of the scans confirms it. Headings by odometry are known only at the stamps of scans.
//! Interpolated headings are means, which are less noisy and correlate slightly better, so a lag must be a large part
//! of the time between two scans.

use pr_geom::{math, wrap_angle};

use crate::stamps::median;

/// With fewer scans or less turning (rad) no lag is estimated.
const MIN_SCANS: usize = 40;
const MIN_RAD: f64 = 1.5;
/// Largest lag searched, s: larger clock offsets are found by the recording's time.
const LARGEST_S: f64 = 1.0;
/// Search step, s.
const STEP_S: f64 = 0.02;
/// Smaller lags are usual for a driver, s; so is less than this share of the time between two scans.
const MIN_S: f64 = 0.1;
const MIN_PERIODS: f64 = 0.6;
/// Number of scans over which turns are compared: over more, noise matters less, but so does a lag.
const SPAN: usize = 3;
/// Least correlation at the lag.
const AGREE: f64 = 0.9;
/// 1 − correlation must be less than this share of its value without a lag.
const BETTER: f64 = 0.65;
/// Largest difference between the lags of the two halves, s; or as a share of the time between two scans.
const SAME_S: f64 = 0.1;
const SAME_PERIODS: f64 = 0.3;

/// Headings by scans and by odometry, rad, at the stamp of a scan, s.
#[derive(Clone, Copy, Debug)]
pub struct Heading {
    /// Stamp of the scan.
    pub stamp_s: f64,
    /// By scans matched alone.
    pub by_scans: f64,
    /// By odometry.
    pub by_odometry: f64,
}

/// Returns the lag of odometry, s; `None` if it is too small, or the turns do not show it.
pub fn lag_s(headings: &[Heading]) -> Option<f64> {
    if headings.len() < MIN_SCANS {
        return None;
    }
    let turns = Turns::from_headings(headings);
    let pairs = 0..turns.by_scans.len() - SPAN;
    let half = pairs.len() / 2;
    let period_s = median(
        turns
            .stamps_s
            .windows(2)
            .map(|two| two[1] - two[0])
            .collect(),
    )?;
    let (lag_s, correlation) = turns.best(pairs.clone())?;
    let without = turns.correlation(pairs.clone(), 0.0)?;
    let is_surely_better = correlation >= AGREE && 1.0 - correlation <= BETTER * (1.0 - without);
    let is_small = lag_s.abs() < MIN_S.max(MIN_PERIODS * period_s);
    let is_open = lag_s.abs() > LARGEST_S - STEP_S;
    if !is_surely_better || is_small || is_open {
        return None;
    }
    let same_s = SAME_S.max(SAME_PERIODS * period_s);
    let halves = [0..half, half..pairs.end];
    let agree = halves.into_iter().all(|pairs| {
        let best = turns.best(pairs);
        best.is_some_and(|(of_half_s, _)| (of_half_s - lag_s).abs() <= same_s)
    });
    agree.then_some(lag_s)
}

/// Unwrapped headings.
struct Turns {
    stamps_s: Vec<f64>,
    by_scans: Vec<f64>,
    by_odometry: Vec<f64>,
}

impl Turns {
    fn from_headings(headings: &[Heading]) -> Self {
        let unwrapped = |of: fn(&Heading) -> f64| {
            let mut sum = 0.0;
            let steps = headings
                .windows(2)
                .map(|two| wrap_angle(of(&two[1]) - of(&two[0])));
            let sums = steps.map(|step| {
                sum += step;
                sum
            });
            std::iter::once(0.0)
                .chain(sums.collect::<Vec<f64>>())
                .collect()
        };
        Self {
            stamps_s: headings.iter().map(|heading| heading.stamp_s).collect(),
            by_scans: unwrapped(|heading| heading.by_scans),
            by_odometry: unwrapped(|heading| heading.by_odometry),
        }
    }

    /// The lag (s) that maximizes the correlation of the turns over these pairs of scans, and that correlation.
    fn best(&self, pairs: std::ops::Range<usize>) -> Option<(f64, f64)> {
        let most = (LARGEST_S / STEP_S).round() as i32;
        let lags = (-most..=most).map(|step| f64::from(step) * STEP_S);
        let tried = lags.filter_map(|lag_s| Some((lag_s, self.correlation(pairs.clone(), lag_s)?)));
        tried.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Absolute correlation of the turns over these pairs of scans if odometry is late by `lag_s`.
    fn correlation(&self, pairs: std::ops::Range<usize>, lag_s: f64) -> Option<f64> {
        let (mut both, mut of_scans, mut of_odometry, mut turned) = (0.0, 0.0, 0.0, 0.0);
        for k in pairs {
            let turns = [k, k + SPAN].map(|k| self.heading(self.stamps_s[k] + lag_s));
            let [Some(before), Some(after)] = turns else {
                continue;
            };
            let (scan, wheel) = (self.by_scans[k + SPAN] - self.by_scans[k], after - before);
            both += scan * wheel;
            of_scans += scan * scan;
            of_odometry += wheel * wheel;
            turned += scan.abs() / SPAN as f64;
        }
        let size = math::sqrt(of_scans * of_odometry);
        (turned >= MIN_RAD / 2.0 && size > 0.0).then(|| (both / size).abs())
    }

    /// Interpolated heading by odometry.
    fn heading(&self, at_s: f64) -> Option<f64> {
        let after = self.stamps_s.partition_point(|&stamp_s| stamp_s < at_s);
        let (from, to) = (after.checked_sub(1)?, after);
        let (from_s, to_s) = (self.stamps_s[from], *self.stamps_s.get(to)?);
        let share = (at_s - from_s) / (to_s - from_s);
        Some(self.by_odometry[from] + share * (self.by_odometry[to] - self.by_odometry[from]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A weaving robot whose odometry is late by `late_s`.
    fn weaving(late_s: f64, mirror: f64) -> Vec<Heading> {
        let heading = |at_s: f64| math::sin_cos(0.9 * at_s).0 + 0.5 * math::sin_cos(2.3 * at_s).0;
        let stamps = (0..200).map(|k| 0.1 * f64::from(k));
        let headings = stamps.map(|stamp_s| Heading {
            stamp_s,
            by_scans: heading(stamp_s),
            by_odometry: mirror * heading(stamp_s - late_s),
        });
        headings.collect()
    }

    #[test]
    fn the_lag_of_odometry_is_found_in_either_direction_and_in_a_mirror() {
        for late_s in [-0.6, -0.2, 0.2, 0.44, 0.8] {
            for mirror in [1.0, -1.0] {
                let found = lag_s(&weaving(late_s, mirror)).unwrap();
                assert!((found - late_s).abs() <= STEP_S, "{late_s}: {found}");
            }
        }
    }

    #[test]
    fn usual_delays_noise_and_straight_paths_give_no_lag() {
        assert_eq!(lag_s(&weaving(0.04, 1.0)), None);
        assert_eq!(lag_s(&weaving(1.4, 1.0)), None);
        assert_eq!(lag_s(&weaving(0.4, 1.0)[..30]), None);
        let mut straight = weaving(0.4, 1.0);
        straight
            .iter_mut()
            .for_each(|heading| heading.by_scans *= 0.01);
        assert_eq!(lag_s(&straight), None);
        // The halves have different lags: a clock that drifts, or chance.
        let (first, second) = (weaving(0.5, 1.0), weaving(-0.5, 1.0));
        let apart: Vec<Heading> = first[..100].iter().chain(&second[100..]).copied().collect();
        assert_eq!(lag_s(&apart), None);
    }
}
