//! What registration adds to the motion that odometry predicted: the only number of a lap that warns of a bias.
//!
//! Per tick, with `T̄` the predicted and `T̂` the registered pose, the innovation is `T̄⁻¹ T̂` in the body frame. If the
//! errors of wheels and matcher have no bias, its mean is zero; a mean that its own scatter does not explain shows
//! that one of the two is biased, without any truth.

use pr_geom::math;

use super::record::LapTrace;

/// Innovations along the direction of travel, over the ticks in which the robot drives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepInnovations {
    /// Their number.
    pub count: usize,
    /// Mean, m.
    pub mean_m: f64,
    /// Standard deviation of one, m.
    pub deviation_m: f64,
    /// Length of the registered steps over that of the predicted ones.
    pub ratio: f64,
}

impl StepInnovations {
    /// Mean over its standard error: beyond 2 it is seldom chance.
    #[must_use]
    pub fn t(&self) -> f64 {
        self.mean_m * math::sqrt(self.count as f64) / self.deviation_m
    }
}

/// Steps shorter than this are turns on the spot, m.
const DRIVING_M: f64 = 0.02;

impl LapTrace {
    /// Registered minus predicted step along the direction of travel, m, and the predicted step, m, of each tick up to
    /// `tick` in which the robot drives.
    pub fn step_innovations(&self, tick: usize) -> impl Iterator<Item = [f64; 2]> + '_ {
        let before = core::iter::once(None).chain(self.reports.iter().map(Some));
        let reports = self.reports.iter().zip(before).take(tick);
        reports.filter_map(|(report, before)| {
            let registration = &report.registration;
            let start = before.map_or(self.epochs[0].poses[0], |before| before.estimate);
            let predicted_m = start.between(&registration.prediction).translation().norm();
            let innovation_m = registration.prediction.between(&registration.estimate).x();
            (predicted_m > DRIVING_M).then_some([innovation_m, predicted_m])
        })
    }

    /// Statistics of them; `None` for fewer than two.
    #[must_use]
    pub fn innovations(&self, tick: usize) -> Option<StepInnovations> {
        let steps: Vec<[f64; 2]> = self.step_innovations(tick).collect();
        if steps.len() < 2 {
            return None;
        }
        let count = steps.len() as f64;
        let mean_m = steps.iter().map(|step| step[0]).sum::<f64>() / count;
        let square = |step: &[f64; 2]| (step[0] - mean_m) * (step[0] - mean_m);
        let variance = steps.iter().map(square).sum::<f64>() / (count - 1.0);
        let predicted_m: f64 = steps.iter().map(|step| step[1]).sum();
        Some(StepInnovations {
            count: steps.len(),
            mean_m,
            deviation_m: math::sqrt(variance),
            ratio: 1.0 + mean_m * count / predicted_m,
        })
    }
}
