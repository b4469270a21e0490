//! What a model of the usual layout takes from the modules of its widget.

/// The methods of a model that its `SPEC`, its field `values` and its modules `picture`, `texts` and `tables` answer.
macro_rules! from_modules {
    () => {
        fn spec(&self) -> &'static widget_kit::spec::WidgetSpec {
            &SPEC
        }

        fn values(&self) -> &widget_kit::values::Values {
            &self.values
        }

        fn scene(&self) -> widget_kit::scene::Scene {
            picture::scene(self)
        }

        fn outcome(&self) -> widget_kit::model::Outcome {
            texts::outcome(self)
        }

        fn summary(&self) -> String {
            texts::summary(self)
        }

        fn tables(&self) -> Vec<widget_kit::model::Table> {
            tables::all(self)
        }
    };
}

pub(crate) use from_modules;
