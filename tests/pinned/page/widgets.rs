//! The widgets of the page in the states of its links and questions.

use widget_kit::model::Model;
use widget_kit::shell::Shell;
use widgets::registry::SHELLS;

/// One of each widget.
pub struct Widgets(pub Vec<Shell>);

impl Widgets {
    /// All of them, at their defaults.
    pub fn new() -> Self {
        Self(SHELLS.iter().map(|make| make()).collect())
    }

    /// Sets a widget to a state such as `heading=40&dx=0`, from its defaults.
    pub fn set(&mut self, id: &str, state: &str) -> &dyn Model {
        let widget = self
            .0
            .iter_mut()
            .find(|widget| widget.model().spec().id == id);
        let model = widget
            .unwrap_or_else(|| panic!("no widget {id}"))
            .model_mut();
        model.press("defaults").expect("every widget has defaults");
        for pair in state.split('&') {
            let (name, text) = pair.split_once('=').expect("a name and a value");
            model
                .set_text(name, text)
                .unwrap_or_else(|error| panic!("{id}: {error}"));
        }
        // A lap is computed in pieces between frames; here are none.
        model.finish_work();
        model
    }
}
