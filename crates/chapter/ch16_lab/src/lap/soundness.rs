//! Checks that all numbers of a lap are finite.

use pr_geom::SE2;

use super::record::{LapRecord, LapTrace};

impl LapRecord {
    /// Describes the first number that is not finite; `None` if all are finite.
    ///
    /// The RMSE of a registration without pairs is infinite by definition and does not count.
    #[must_use]
    pub fn first_fault(&self) -> Option<String> {
        let of = |name: &str, trace: &LapTrace| {
            let fault = trace.first_fault()?;
            Some(format!("{name}: {fault}"))
        };
        of("lap", &self.lap).or_else(|| of("front end", &self.front_end))
    }
}

impl LapTrace {
    fn first_fault(&self) -> Option<String> {
        for report in &self.reports {
            let (matched, metrics) = (&report.registration.matched, &report.metrics);
            let poses = [
                report.truth,
                report.dead_reckoning,
                report.estimate,
                matched.pose,
            ];
            let numbers = [
                report.registration.tau_m,
                report.registration.next_tau_m,
                if matched.inliers == 0 {
                    0.0
                } else {
                    matched.rmse_m
                },
                metrics.odometry_error_m,
                metrics.estimate_error_m,
                metrics.odometry_rms_m,
                metrics.keyframe_rms_m,
                metrics.keyframe_error_m,
                metrics.map_disagreement_m.unwrap_or(0.0),
                metrics.chi2,
            ];
            if !poses.iter().all(is_finite) || !numbers.iter().all(|value| value.is_finite()) {
                return Some(format!("tick {}: {report:?}", report.tick));
            }
        }
        for epoch in &self.epochs {
            if !epoch.poses.iter().all(is_finite) {
                return Some(format!("the poses from tick {} on", epoch.first_tick));
            }
        }
        let summary = &self.summary;
        let numbers = [
            summary.odometry_end_error_m,
            summary.odometry_rms_m,
            summary.keyframe_end_error_m,
            summary.keyframe_rms_m,
            summary.keyframe_max_m,
            summary.last_keyframes_m.0,
            summary.last_keyframes_m.1,
            summary.map_disagreement_m.unwrap_or(0.0),
            self.graph_summary.chi2,
        ];
        let is_sound = numbers.iter().all(|value| value.is_finite());
        (!is_sound).then(|| format!("{summary:?}"))
    }
}

fn is_finite(pose: &SE2) -> bool {
    pose.to_array().iter().all(|value| value.is_finite())
}

#[cfg(test)]
mod tests {
    use crate::lap::{LapConfig, LapRunner};

    #[test]
    fn one_figure_that_is_no_number_is_found_and_named() {
        let sound = LapRunner::new().run(&LapConfig::default());
        assert_eq!(sound.first_fault(), None);
        let mut broken = sound.clone();
        broken.front_end.reports[4].metrics.chi2 = f64::NAN;
        let fault = broken.first_fault().unwrap();
        assert!(fault.starts_with("front end: tick 5:"), "{fault}");
        let mut broken = sound;
        broken.lap.summary.keyframe_max_m = f64::INFINITY;
        assert!(broken.first_fault().unwrap().starts_with("lap: LapSummary"));
    }
}
