//! Turns and directions of the segments by scans and by odometry.

use nalgebra::Complex;
use pr_geom::{SE2, math};

use super::Stretch;
use crate::stamps::median;

/// Least concentration of the displacements' directions in a comparison that agrees with itself.
pub(super) const ONE_DIRECTION: f64 = 0.85;
/// A scale that differs from 1 by more is reported.
pub(super) const SCALE_OFF: f64 = 0.08;
/// The same for turns: wheels that scrub turn less evenly than they roll.
const TURNS_OFF: f64 = 2.0 * SCALE_OFF;
/// A shorter turn has no ratio, rad.
const MIN_TURN_RAD: f64 = 0.1;
/// One of this many segments may be wrong.
const OUTLIERS: usize = 10;
/// A sign of the odometry is tried if it reduces the spread of these directions to less than this share.
const OPPOSED: f64 = 0.5;

/// Turns by odometry and by scans.
pub(super) struct Turns {
    /// Correlation; a mirror image is tried as well.
    pub correlation: f64,
    /// Median of those by odometry per turn by scans.
    pub ratio: f64,
    /// Whether the quartile of the ratios on the side of 1 is out of scale.
    pub is_off: bool,
}

pub(super) fn compare_turns(stretches: &[Stretch]) -> Option<Turns> {
    // Few segments of a long path turn: among all of them, turns that differ would be the outliers.
    let turns = |mirror: f64| {
        let both = stretches.iter();
        let both = both.map(|stretch| (stretch.sensor.theta(), stretch.body.theta()));
        let both = both.filter(|(scans, body)| scans.abs().max(body.abs()) > MIN_TURN_RAD);
        let both = without_outliers(both.collect(), |(scans, body)| {
            (scans - mirror * body).abs()
        });
        let sum = |of: fn(&(f64, f64)) -> f64| both.iter().map(of).sum::<f64>();
        let product = sum(|(scans, body)| scans * body);
        let size = math::sqrt(sum(|both| both.0 * both.0) * sum(|both| both.1 * both.1));
        (size > 0.0).then_some(product / size)
    };
    let (plain, mirrored) = (turns(1.0)?, turns(-1.0)?);
    let correlation = if mirrored.abs() > plain.abs() {
        mirrored
    } else {
        plain
    };
    let turning = stretches
        .iter()
        .filter(|stretch| stretch.sensor.theta().abs() > MIN_TURN_RAD);
    let ratios = turning.map(|stretch| stretch.body.theta() / stretch.sensor.theta());
    let mut ratios: Vec<f64> = ratios.collect();
    ratios.sort_by(f64::total_cmp);
    let low = ratios.len() / 4;
    let high = ratios.len().checked_sub(1 + low)?;
    let is_off = *ratios.get(low)? > 1.0 + TURNS_OFF || *ratios.get(high)? < 1.0 - TURNS_OFF;
    Some(Turns {
        correlation,
        ratio: median(ratios)?,
        is_off,
    })
}

/// Whether the heading or y of the odometry has the wrong sign, and the segments with the other: only then do the
/// displacements have one direction.
pub(super) fn opposed(stretches: &[Stretch]) -> Option<(bool, Vec<Stretch>)> {
    let agreement = |stretches: &[Stretch], mirror: f64| {
        let pairs = stretches.iter().map(|Stretch { sensor, body, .. }| {
            (
                Complex::new(sensor.x(), mirror * sensor.y()),
                Complex::new(body.x(), body.y()),
            )
        });
        direction(&pairs.collect::<Vec<_>>()).map_or(0.0, |(_, agreement)| agreement)
    };
    let is_heading = compare_turns(stretches)?.correlation < 0.0;
    let with: Vec<Stretch> = stretches
        .iter()
        .map(|stretch| stretch.opposed(is_heading))
        .collect();
    let plain = agreement(stretches, 1.0).max(agreement(stretches, -1.0));
    let opposed = agreement(&with, 1.0);
    let is_proposed = opposed >= ONE_DIRECTION && 1.0 - opposed < OPPOSED * (1.0 - plain);
    is_proposed.then_some((is_heading, with))
}

/// Direction from displacements by scans to those by odometry, as a unit number, and how concentrated it is, 0 to 1.
pub(super) fn direction(pairs: &[(Complex<f64>, Complex<f64>)]) -> Option<(Complex<f64>, f64)> {
    let pairs = pairs.iter();
    let sum: Complex<f64> = pairs
        .clone()
        .map(|(by_scans, by_body)| by_scans.conj() * by_body)
        .sum();
    let sizes: f64 = pairs
        .map(|(by_scans, by_body)| size(by_scans) * size(by_body))
        .sum();
    let length = size(&sum);
    (length > 0.0).then(|| (sum / length, length / sizes))
}

/// Without the tenth of largest residuals: a scan that matched a wrong place must not decide.
pub(super) fn without_outliers<T>(mut items: Vec<T>, residual: impl Fn(&T) -> f64) -> Vec<T> {
    items.sort_by(|a, b| residual(a).total_cmp(&residual(b)));
    items.truncate(items.len() - items.len() / OUTLIERS);
    items
}

pub(super) fn length(motion: &SE2) -> f64 {
    math::norm2(motion.x(), motion.y())
}

pub(super) fn size(displacement: &Complex<f64>) -> f64 {
    math::norm2(displacement.re, displacement.im)
}
