//! The widgets that there are, and one that only listens.

use kit::model::{Activity, Model, Outcome, Standing, Table, unknown_button};
use kit::param::ParamError;
use kit::scene::Scene;
use kit::spec::WidgetSpec;
use kit::values::Values;
use w16_1_basin_explorer::model::BasinExplorer;
use w16_2_full_lap::model::FullLap;
use w16_3_cost_terraces::model::CostTerraces;
use w16_4_control_room::model::ControlRoom;
use w16_5_pose_graph_toy::model::PoseGraphToy;
use w16_6_whole_window::model::WholeWindow;
use w16_7_been_here::model::BeenHere;
use w16_8_moving_box::model::MovingBox;
use w16_9_come_back::model::ComeBack;
use w16_10_own_robot::model::OwnRobot;
use w16_11_procrustes::model::ProcrustesTrace;
use w16_12_jacobians::model::WrongJacobians;

/// How a model is made.
pub type Maker = fn() -> Box<dyn Model>;

/// A fresh model of every widget.
pub const MODELS: [Maker; 12] = [
    || Box::new(BasinExplorer::new()),
    || Box::new(FullLap::new()),
    || Box::new(CostTerraces::new()),
    || Box::new(ControlRoom::new()),
    || Box::new(PoseGraphToy::new()),
    || Box::new(WholeWindow::new()),
    || Box::new(BeenHere::new()),
    || Box::new(MovingBox::new()),
    || Box::new(ComeBack::new()),
    || Box::new(OwnRobot::new()),
    || Box::new(ProcrustesTrace::new()),
    || Box::new(WrongJacobians::new()),
];

/// What never changes about each widget, in the order of [`MODELS`].
///
/// Written out, so that a program which only reads texts holds no estimator.
pub static SPECS: [&WidgetSpec; 12] = [
    &w16_1_basin_explorer::spec::SPEC,
    &w16_2_full_lap::spec::SPEC,
    &w16_3_cost_terraces::spec::SPEC,
    &w16_4_control_room::spec::SPEC,
    &w16_5_pose_graph_toy::spec::SPEC,
    &w16_6_whole_window::spec::SPEC,
    &w16_7_been_here::spec::SPEC,
    &w16_8_moving_box::spec::SPEC,
    &w16_9_come_back::spec::SPEC,
    &w16_10_own_robot::spec::SPEC,
    &w16_11_procrustes::spec::SPEC,
    &w16_12_jacobians::spec::SPEC,
];

/// A widget that takes values and presses by the rules of another, and computes nothing.
pub struct Listener {
    spec: &'static WidgetSpec,
    values: Values,
    /// Buttons pressed so far.
    pub presses: usize,
}

impl Listener {
    /// A listener with the parameters and buttons of that widget.
    pub fn new(spec: &'static WidgetSpec) -> Self {
        Self {
            spec,
            values: Values::defaults(spec.params),
            presses: 0,
        }
    }
}

impl Model for Listener {
    fn spec(&self) -> &'static WidgetSpec {
        self.spec
    }

    fn values(&self) -> &Values {
        &self.values
    }

    fn set(&mut self, id: &str, value: f64) -> Result<(), ParamError> {
        self.values.set(self.spec.id, id, value).map(|_| ())
    }

    fn press(&mut self, id: &str) -> Result<(), ParamError> {
        let buttons = self.spec.buttons.iter().map(|button| button.id);
        let presets = self.spec.presets.iter().map(|preset| preset.id);
        if !buttons.chain(presets).any(|known| known == id) {
            return Err(unknown_button(self.spec, id));
        }
        self.presses += 1;
        Ok(())
    }

    fn advance(&mut self, _elapsed_s: f64) -> Activity {
        Activity::Idle
    }

    fn scene(&self) -> Scene {
        Scene { panels: Vec::new() }
    }

    fn outcome(&self) -> Outcome {
        Outcome {
            standing: Standing::Neutral,
            verdict: String::new(),
            sentence: String::new(),
            facts: Vec::new(),
        }
    }

    fn summary(&self) -> String {
        String::new()
    }

    fn tables(&self) -> Vec<Table> {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_specs_are_those_of_the_models() {
        for (maker, spec) in MODELS.iter().zip(SPECS) {
            assert_eq!(format!("{:?}", maker().spec()), format!("{spec:?}"));
        }
    }
}
