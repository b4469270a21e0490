//! Helpers for tests of several widgets, and a shell on a screen without a GPU.

use egui::{Event, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::Harness;
use widget_kit::model::Model;
use widget_kit::scene::Panel;
use widget_kit::shell::Shell;

/// Height of the screen: all widgets fit.
const HEIGHT: f32 = 3000.0;

/// A number of the outcome.
pub fn fact(model: &dyn Model, id: &str) -> f64 {
    let facts = model.outcome().facts;
    facts.iter().find(|fact| fact.id == id).expect(id).value
}

/// A panel of the scene.
pub fn panel_of(model: &dyn Model, id: &str) -> Panel {
    let panels = model.scene().panels;
    panels.into_iter().find(|panel| panel.id == id).expect(id)
}

/// The widget of that name on a screen of that width, prepared before its first frame.
pub fn drawn(name: &str, width: f32, prepare: impl FnOnce(&mut Shell)) -> Harness<'static, Shell> {
    let mut shell = widgets::registry::find(name).expect("a widget of the registry")();
    prepare(&mut shell);
    let mut harness = Harness::builder()
        .with_size(vec2(width, HEIGHT))
        .with_max_steps(3000)
        .build_ui_state(|ui, shell: &mut Shell| shell.ui(ui), shell);
    harness.run_steps(3);
    harness
}

/// The complete widget of that name, not only its opening layer.
pub fn drawn_whole(name: &str, width: f32) -> Harness<'static, Shell> {
    drawn(name, width, |shell| {
        let more = shell.model_mut().set("more", 1.0);
        more.expect("every widget has layers");
    })
}

/// Moves the pointer there, with the primary button pressed or released if that is given, and runs two frames.
pub fn point(harness: &mut Harness<'_, Shell>, pos: Pos2, pressed: Option<bool>) {
    harness.event(Event::PointerMoved(pos));
    if let Some(pressed) = pressed {
        harness.event(Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
    }
    harness.run_steps(2);
}

/// Presses and releases the primary button.
pub fn click_at(harness: &mut Harness<'_, Shell>, pos: Pos2) {
    point(harness, pos, Some(true));
    point(harness, pos, Some(false));
}

/// The value of a parameter.
pub fn value(harness: &Harness<'_, Shell>, id: &str) -> f64 {
    harness.state().model().values().number(id)
}
