//! Every widget there is, in the order of the chapter.

use kit::shell::Shell;
use kit::spec::WidgetSpec;

/// How a widget is made.
pub type Maker = fn() -> Shell;

/// The widgets with their names.
pub const WIDGETS: [(&str, Maker); 4] = [
    ("w16.1", w16_1_basin_explorer::widget),
    ("w16.2", w16_2_full_lap::widget),
    ("w16.3", w16_3_cost_terraces::widget),
    ("w16.4", w16_4_control_room::widget),
];

/// What never changes about them, in the same order.
const SPECS: [&WidgetSpec; WIDGETS.len()] = [
    &w16_1_basin_explorer::spec::SPEC,
    &w16_2_full_lap::spec::SPEC,
    &w16_3_cost_terraces::spec::SPEC,
    &w16_4_control_room::spec::SPEC,
];

/// What never changes about the widget of that name; nothing is computed for it.
#[must_use]
pub fn spec(name: &str) -> Option<&'static WidgetSpec> {
    SPECS.into_iter().find(|spec| spec.id == name)
}

/// A fresh widget of that name.
#[must_use]
pub fn make(name: &str) -> Option<Shell> {
    let (_, maker) = WIDGETS.iter().find(|(known, _)| *known == name)?;
    Some(maker())
}

/// The names, for messages: `w16.1, w16.2, …`.
#[must_use]
pub fn names() -> String {
    WIDGETS.map(|(name, _)| name).join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_widget_is_registered_under_its_own_name() {
        for (name, maker) in WIDGETS {
            let model_spec = maker().model().spec();
            assert_eq!(model_spec.id, name);
            let known_as = spec(name).map(|known| format!("{known:?}"));
            assert_eq!(known_as, Some(format!("{model_spec:?}")));
        }
    }

    #[test]
    fn no_text_overlaps_or_is_cut_off_in_any_widget() {
        for (name, maker) in WIDGETS {
            let mut shell = maker();
            let presets = shell.model().spec().presets;
            let states = core::iter::once("defaults").chain(presets.iter().map(|p| p.id));
            for state in states {
                shell.model_mut().press(state).expect("the widget has it");
                shell.settle();
                for width in [320.0, 390.0, 700.0, 1100.0] {
                    let faults = shell.text_faults(width);
                    assert!(faults.is_empty(), "{name} after {state}: {faults:#?}");
                }
            }
        }
    }

    #[test]
    fn an_unknown_name_gives_none() {
        assert!(make("w16.9").is_none());
        assert!(spec("w16.9").is_none());
        assert!(names().contains("w16.4"));
    }
}
