//! A checksum over all bits of a lap, to compare machines.

use super::record::{LapRecord, LapTrace};
use super::{LapConfig, LapRunner};
use ch16_slam2d::digest::Digest;

fn add_trace(digest: &mut Digest, trace: &LapTrace) {
    for report in &trace.reports {
        digest.add_pose(&report.truth);
        digest.add_pose(&report.dead_reckoning);
        digest.add_pose(&report.registration.matched.pose);
        digest.add_pose(&report.estimate);
        digest.add(report.registration.matched.rmse_m);
        digest.add(report.metrics.map_disagreement_m.unwrap_or(-1.0));
        digest.add(report.metrics.chi2);
    }
    for epoch in &trace.epochs {
        epoch.poses.iter().for_each(|pose| digest.add_pose(pose));
    }
}

impl LapTrace {
    /// Digest of all poses and metrics of one estimator, bit by bit.
    #[must_use]
    pub fn digest(&self) -> u64 {
        let mut digest = Digest::new();
        add_trace(&mut digest, self);
        digest.value()
    }
}

impl LapRecord {
    /// Digest of all poses and metrics, with loops and without, bit by bit.
    #[must_use]
    pub fn digest(&self) -> u64 {
        let mut digest = Digest::new();
        add_trace(&mut digest, &self.lap);
        add_trace(&mut digest, &self.front_end);
        digest.value()
    }
}

/// Digest of the chapter's lap with this seed and noise factor.
///
/// It is equal on every machine with IEEE 754 floating point, natively and in WebAssembly.
#[must_use]
pub fn lap_digest(seed: u32, noise_factor: f64) -> u64 {
    LapRunner::new()
        .run(&LapConfig::with_seed_and_noise(seed, noise_factor))
        .digest()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_changed_bit_changes_the_digest() {
        let mut record = LapRunner::new().run(&LapConfig::default());
        let before = record.digest();
        assert_eq!(before, record.clone().digest());
        let rmse = &mut record.lap.reports[77].registration.matched.rmse_m;
        *rmse = f64::from_bits(rmse.to_bits() ^ 1);
        assert_ne!(before, record.digest());
    }
}
