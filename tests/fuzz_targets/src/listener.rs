//! A widget model without computation.

use widget_kit::model::{Activity, Assessment, Model, Outcome, Table, unknown_button};
use widget_kit::param::ParamError;
use widget_kit::scene::Scene;
use widget_kit::spec::WidgetSpec;
use widget_kit::values::Values;

/// Takes values and presses by the rules of another widget, and computes nothing.
pub struct Listener {
    spec: &'static WidgetSpec,
    values: Values,
    /// Number of button presses so far.
    pub presses: usize,
}

impl Listener {
    /// Creates with the parameters and buttons of a widget.
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
            standing: Assessment::Neutral,
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
