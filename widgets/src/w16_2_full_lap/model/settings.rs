//! Converts the values of the parameters to the types of the core.

use ch16_lab::lap::{BuiltInWorld, LapConfig, LapMatcher, LoopClosure};
use ch16_slam2d::chapter::InformationFrame;
use ch16_slam2d::chi_squared::gate_threshold;
use ch16_slam2d::loops::GateModel;
use pr_sim::Course;
use widget_kit::param::ParamError;
use widget_kit::run::LOOPS;
use widget_kit::run::NOISE;
use widget_kit::values::Values;

use crate::w16_2_full_lap::spec::{
    CAP, GATE, GATE_MODEL, INFORMATION, MATCHER, MISSES, NORMALS, PARAMS, SEED, SPEC, WORLD,
};

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
    /// Reads the values.
    pub fn read(values: &Values) -> Self {
        Self {
            world: values.get(&WORLD),
            seed: values.get(&SEED),
            noise_factor: values.get(&NOISE),
            loop_closure: if values.get(&LOOPS) {
                LoopClosure::On
            } else {
                LoopClosure::Off
            },
            gate_chi2: gate_threshold(values.get(&GATE)),
            gate_model: values.get(&GATE_MODEL),
            matcher: values.get(&MATCHER),
            information_frame: values.get(&INFORMATION),
            normals_cells: Some(values.get(&NORMALS)).filter(|cells| *cells > 0.0),
            is_capped: values.get(&CAP),
            keeps_misses: values.get(&MISSES),
        }
    }

    /// The configuration for the core; `own` is the reader's own course. `None` if that cannot be driven.
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

/// The lap of a link to the widget: `seed=6&matcher=p2l`, in a built-in world.
///
/// # Errors
/// If a parameter does not exist or its value is invalid; `None` for the reader's own flat.
pub fn lap_of_link(link: &str) -> Result<Option<LapConfig>, ParamError> {
    let mut values = Values::defaults(PARAMS);
    for (id, text) in link.split('&').filter_map(|pair| pair.split_once('=')) {
        let (param, _) = values.find_for(SPEC.id, id)?;
        values.set(SPEC.id, id, param.parse(text)?)?;
    }
    Ok(LapSettings::read(&values).config(None))
}
