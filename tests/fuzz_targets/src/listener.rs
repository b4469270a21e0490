//! A widget without computation.

use kit::model::{Activity, Model, Outcome, Standing, Table, unknown_button};
use kit::param::ParamError;
use kit::scene::Scene;
use kit::spec::WidgetSpec;
use kit::values::Values;

/// A widget that validates values and presses like another one, and computes nothing.
pub struct Listener {
    spec: &'static WidgetSpec,
    values: Values,
    /// Number of pressed buttons.
    pub presses: usize,
}

impl Listener {
    /// Creates a listener with the parameters and buttons of that widget.
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
