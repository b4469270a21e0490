//! One number for all bits of a lap, to compare machines.

use pr_geom::SE2;

use super::record::{LapRecord, LapTrace};
use super::{LapRunner, SlamConfig};

/// FNV-1a over 64-bit words (Fowler, Noll, Vo 1991).
#[derive(Clone, Copy, Debug)]
struct Digest(u64);

impl Digest {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn add(&mut self, value: f64) {
        for byte in value.to_bits().to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    fn add_pose(&mut self, pose: &SE2) {
        pose.to_array()
            .into_iter()
            .for_each(|value| self.add(value));
    }

    fn add_trace(&mut self, trace: &LapTrace) {
        for report in &trace.reports {
            self.add_pose(&report.truth);
            self.add_pose(&report.dead_reckoning);
            self.add_pose(&report.registration.icp.pose);
            self.add_pose(&report.estimate);
            self.add(report.registration.icp.rmse);
            self.add(report.metrics.map_disagreement_m.unwrap_or(-1.0));
            self.add(report.metrics.chi2);
        }
        for epoch in &trace.epochs {
            epoch.poses.iter().for_each(|pose| self.add_pose(pose));
        }
    }
}

impl LapTrace {
    /// A digest of all poses and metrics of one estimator, bit by bit.
    #[must_use]
    pub fn digest(&self) -> u64 {
        let mut digest = Digest::new();
        digest.add_trace(self);
        digest.0
    }
}

impl LapRecord {
    /// A digest of all poses and metrics, with loops and without, bit by bit.
    #[must_use]
    pub fn digest(&self) -> u64 {
        let mut digest = Digest::new();
        digest.add_trace(&self.lap);
        digest.add_trace(&self.front_end);
        digest.0
    }
}

/// The digest of the chapter's lap at this seed and noise factor.
///
/// Equal on every machine whose floating point is IEEE 754, natively and in WebAssembly.
#[must_use]
pub fn lap_digest(seed: u32, noise_factor: f64) -> u64 {
    LapRunner::new()
        .run(&SlamConfig::with_seed_and_noise(seed, noise_factor))
        .digest()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_changed_bit_changes_the_digest() {
        let mut record = LapRunner::new().run(&SlamConfig::default());
        let before = record.digest();
        assert_eq!(before, record.clone().digest());
        let rmse = &mut record.lap.reports[77].registration.icp.rmse;
        *rmse = f64::from_bits(rmse.to_bits() ^ 1);
        assert_ne!(before, record.digest());
    }
}
