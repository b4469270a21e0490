//! Every widget there is, in the order of the chapter.

use kit::shell::Shell;
use kit::spec::WidgetSpec;

/// How a widget is made.
pub type Maker = fn() -> Shell;

/// The widgets with their names.
pub const WIDGETS: [(&str, Maker); 12] = [
    ("w16.1", w16_1_basin_explorer::widget),
    ("w16.2", w16_2_full_lap::widget),
    ("w16.3", w16_3_cost_terraces::widget),
    ("w16.4", w16_4_control_room::widget),
    ("w16.5", w16_5_pose_graph_toy::widget),
    ("w16.6", w16_6_whole_window::widget),
    ("w16.7", w16_7_been_here::widget),
    ("w16.8", w16_8_moving_box::widget),
    ("w16.9", w16_9_come_back::widget),
    ("w16.10", w16_10_own_robot::widget),
    ("w16.11", w16_11_procrustes::widget),
    ("w16.12", w16_12_jacobians::widget),
];

/// What never changes about them, in the same order.
const SPECS: [&WidgetSpec; WIDGETS.len()] = [
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

/// What is said of a name that no widget has.
#[must_use]
pub fn unknown(name: &str) -> String {
    format!("there is no widget `{name}`; there are {}", names())
}

#[cfg(test)]
mod tests {
    use super::*;
    use kit::param::MORE;

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
                for more in [0.0, 1.0] {
                    let model = shell.model_mut();
                    model.set(MORE.id, more).expect("every widget has layers");
                    for width in [320.0, 390.0, 700.0, 1100.0] {
                        let faults = shell.text_faults(width);
                        assert!(faults.is_empty(), "{name} after {state}: {faults:#?}");
                    }
                }
            }
        }
    }

    /// The canvas on a phone of 390 by 844 points, between the margins of the page.
    const PHONE: egui::Vec2 = egui::vec2(356.0, 844.0);
    /// The border of the element, and its buttons below the canvas.
    const BAR: f32 = 47.0;
    const TWO_SCREENS: f32 = 2.0 * PHONE.y - BAR;

    /// What the module measures in the browser, with egui's own fonts in place of ours.
    fn height_on_a_phone(ctx: &egui::Context, shell: &mut Shell) -> f32 {
        let input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, PHONE)),
            ..Default::default()
        };
        for _ in 0..3 {
            let mut output = ctx.run_ui(input.clone(), |ui| shell.ui(ui));
            // Nothing is drawn: the font's texture is not wanted.
            output.textures_delta.clear();
        }
        shell.content_height()
    }

    #[test]
    fn no_widget_is_higher_than_two_screens_of_a_phone_until_more_is_asked_for() {
        let ctx = egui::Context::default();
        for (name, maker) in WIDGETS {
            let mut shell = maker();
            let presets = shell.model().spec().presets;
            let states = core::iter::once("defaults").chain(presets.iter().map(|p| p.id));
            for state in states {
                shell.model_mut().press(state).expect("the widget has it");
                shell.settle();
                let height = height_on_a_phone(&ctx, &mut shell);
                assert!(height <= TWO_SCREENS, "{name} after {state}: {height}");
            }
            let opening = height_on_a_phone(&ctx, &mut shell);
            shell.model_mut().set(MORE.id, 1.0).expect("a switch");
            let all = height_on_a_phone(&ctx, &mut shell);
            assert!(all > opening + 200.0, "{name}: {opening} and {all}");
        }
    }

    /// The page finds a control by its name alone, whatever its kind.
    #[test]
    fn no_two_controls_of_a_widget_share_a_name() {
        for (name, maker) in WIDGETS {
            let shell = maker();
            let spec = shell.model().spec();
            let mut ids: Vec<_> = (spec.presets.iter().map(|preset| preset.id))
                .chain(spec.params.iter().map(|param| param.id))
                .chain(spec.buttons.iter().map(|button| button.id))
                .collect();
            ids.sort_unstable();
            for pair in ids.windows(2) {
                assert_ne!(pair[0], pair[1], "{name} has two controls of this name");
            }
        }
    }

    #[test]
    fn what_a_widget_opens_with_is_there() {
        for (name, maker) in WIDGETS {
            let shell = maker();
            let model = shell.model();
            let spec = model.spec();
            let panels: Vec<_> = model.scene().panels.iter().map(|panel| panel.id).collect();
            let params: Vec<_> = spec.params.iter().map(|param| param.id).collect();
            let buttons: Vec<_> = spec.buttons.iter().map(|button| button.id).collect();
            for (known, named) in [
                (panels, spec.opening.panels),
                (params, spec.opening.params),
                (buttons, spec.opening.buttons),
            ] {
                assert!(!named.is_empty(), "{name}");
                for id in named {
                    assert!(known.contains(id), "{name} has no {id}");
                }
            }
            assert_eq!(
                spec.opening.params.len(),
                1,
                "{name} opens with one control"
            );
            assert!(spec.opening.buttons.contains(&"play"), "{name}");
        }
    }

    #[test]
    fn an_unknown_name_gives_none() {
        assert!(make("w17.1").is_none());
        assert!(spec("w17.1").is_none());
        assert!(names().contains("w16.4"));
    }
}
