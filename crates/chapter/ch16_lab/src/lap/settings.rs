//! The settings that a reader of the page may change.

use ch16_slam2d::chapter::InformationFrame;
use ch16_slam2d::loops::GateModel;
use pr_sim::Course;

use super::{BuiltInWorld, LapConfig, LapMatcher, LoopClosure};

/// The settings on which a lap depends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LapSettings {
    /// The world; `None` is the reader's own.
    pub world: Option<BuiltInWorld>,
    /// Seed of all noise.
    pub seed: u32,
    /// Multiplies the variances of the odometry.
    pub noise_factor: f64,
    /// Whether loops are closed.
    pub loop_closure: LoopClosure,
    /// Threshold of the squared innovation.
    pub gate_chi2: f64,
    /// Drift model of the gate.
    pub gate_model: GateModel,
    /// Matcher of the front end and of the loops.
    pub matcher: LapMatcher,
    /// The frame in which an edge holds its information.
    pub information_frame: InformationFrame,
    /// Radius of the neighbours for a normal, in cells; `None` is the matcher's own.
    pub normals_cells: Option<f64>,
    /// Whether the information of edges is bounded.
    pub is_capped: bool,
    /// Whether readings at the maximum range count as returns.
    pub keeps_misses: bool,
}

impl LapSettings {
    /// The configuration for the core; `own` is the reader's own course. `None` if that cannot be driven.
    #[must_use]
    pub fn config(&self, own: Option<&Course>) -> Option<LapConfig> {
        let mut config = match self.world {
            Some(world) => LapConfig::in_world(world, self.seed, self.noise_factor),
            None => LapConfig::with_seed_and_noise(self.seed, self.noise_factor).elsewhere(own?),
        };
        config.slam.loop_closure = self.loop_closure;
        config.slam.chapter.loops.gate_chi2 = self.gate_chi2;
        config.slam.chapter.loops.gate_model = self.gate_model;
        config.drive.lidar.keeps_misses = self.keeps_misses;
        let mut config = config.with_matcher(self.matcher);
        if let Some(cells) = self.normals_cells {
            config = config.with_normals(cells);
        }
        if !self.is_capped {
            config = config.with_information_cap(f64::INFINITY);
        }
        Some(config.with_information(self.information_frame))
    }
}
