//! Requirements for every widget: each test iterates over the registry.

use std::time::Duration;

use bench_support::timed;
use egui::{pos2, vec2};
use widget_kit::invariants::{assert_reports, assert_values};
use widget_kit::model::{Activity, Model, Motion, shown_scene};
use widget_kit::param::{MORE, ParamKind, ParamSpec};
use widget_kit::playback::SPEED;
use widget_kit::scene::{Layer, Scene};
use widget_kit::shell::Shell;
use widget_kit::spec::{Awaits, Preset, WidgetSpec};
use widgets::registry::{MODELS, SHELLS, SPECS, find, names};

use crate::support::{click_at, drawn};

/// States other than the defaults in which the limits of every parameter are tried.
///
/// Each layout of a picture has its own state, and a slow search a coarser one.
fn states(name: &str) -> Vec<Vec<(&'static str, f64)>> {
    let each = |id, count: u32| (0..count).map(|k| vec![(id, f64::from(k))]).collect();
    match name {
        "w16.1" => vec![vec![("tau", 0.1)]],
        "w16.5" => (0..3)
            .map(|k| vec![("steps", 20.0), ("graph", f64::from(k))])
            .collect(),
        "w16.6" => vec![vec![("cell", 0.15), ("progress", 90.0)]],
        "w16.7" => each("detector", 3),
        "w16.8" => (0..3)
            .map(|k| vec![("share", 40.0), ("method", f64::from(k))])
            .collect(),
        "w16.11" => each("shape", 4),
        _ => vec![Vec::new()],
    }
}

/// Runs an action; if it panics, prints which one it was.
fn doing<T>(what: impl Fn() -> String, act: impl FnOnce() -> T) -> T {
    struct Doing<F: Fn() -> String>(F);
    impl<F: Fn() -> String> Drop for Doing<F> {
        fn drop(&mut self) {
            if std::thread::panicking() {
                eprintln!("{}", (self.0)());
            }
        }
    }
    let _doing = Doing(what);
    act()
}

#[test]
fn a_widget_is_registered_under_its_own_name() {
    for ((model, shell), spec) in MODELS.into_iter().zip(SHELLS).zip(SPECS) {
        for found in [model().spec(), shell().model().spec()] {
            assert_eq!(format!("{found:?}"), format!("{spec:?}"));
        }
        assert_eq!(find(spec.id).unwrap()().model().spec().id, spec.id);
    }
    assert!(names().contains("w16.4"));
    let rejected = find("w17.1").err().unwrap();
    assert!(rejected.starts_with("there is no widget `w17.1`; there are w16.1, w16.2"));
}

#[test]
fn the_first_press_on_the_picture_reveals_what_it_held_back() {
    for name in ["w16.7", "w16.11"] {
        let mut harness = drawn(name, 560.0, |shell| {
            shell.finish_work();
        });
        let before = harness.state().model().scene();
        let picture = harness.state().scene_rect().expect("a picture");
        // A corner, where nothing is to be grabbed or selected.
        let pos = pos2(picture.left + 3.0, picture.top + 3.0);
        click_at(&mut harness, pos);
        assert_ne!(harness.state().model().scene(), before, "{name}");
    }
}

/// A page stays responsive if no task takes longer, ms.
const LONGEST_TASK_MS: f64 = 100.0;

/// In CPU time of the thread, which the load of the machine does not change.
#[test]
fn a_widget_starts_in_tasks_of_at_most_a_tenth_of_a_second() {
    for (make, spec) in SHELLS.into_iter().zip(SPECS) {
        let (mut shell, start_ms) = timed(make);
        let (_, scene_ms) = timed(|| shell.model().scene());
        let pieces = (0..400).map(|_| timed(|| shell.model_mut().work()).1);
        let piece_ms = pieces.fold(0.0, f64::max);
        for (what, ms) in [
            ("start", start_ms),
            ("picture", scene_ms),
            ("piece", piece_ms),
        ] {
            assert!(ms < LONGEST_TASK_MS, "{}: {what} takes {ms} ms", spec.id);
        }
    }
}

#[test]
fn a_start_in_short_tasks_ends_like_one_in_a_single_task() {
    for (make, spec) in SHELLS.into_iter().zip(SPECS) {
        let (mut pieces, mut whole) = (make(), make());
        let tasks = core::iter::repeat_with(|| pieces.settle(Duration::from_millis(5)));
        let tasks = tasks.take_while(|did| *did).count();
        whole.finish_work();
        let sentence = |shell: &Shell| shell.model().outcome().in_full();
        assert_eq!(sentence(&pieces), sentence(&whole), "{}", spec.id);
        // Two laps and a run take far longer than a task.
        assert!(tasks > 1 || spec.id != "w16.9", "{tasks} tasks");
    }
}

#[test]
fn a_legend_has_at_most_four_entries() {
    for make in MODELS {
        let name = make().spec().id;
        for state in states(name) {
            let mut model = make();
            for (id, value) in state {
                model.set(id, value).expect("a value in range");
            }
            model.finish_work();
            let check = |model: &dyn Model| {
                for panel in model.scene().panels {
                    let count = panel.legend.len();
                    assert!(count <= 4, "{name}: {} has {count}", panel.id);
                }
            };
            check(model.as_ref());
            model.set_motion(Motion::Reduced);
            model.press("play").expect("every widget plays");
            model.reveal();
            model.finish_work();
            check(model.as_ref());
        }
    }
}

#[test]
fn the_ends_of_every_parameter_have_a_finite_picture() {
    for make in MODELS {
        let mut model = make();
        let spec = model.spec();
        for state in states(spec.id) {
            for param in spec.params {
                let (min, max) = param.range();
                for value in [min, max] {
                    model.press("defaults").expect("every widget has defaults");
                    for (id, value) in &state {
                        model.set(id, *value).expect("a value in range");
                    }
                    doing(
                        || format!("{} {state:?}, {} at {value}", spec.id, param.id),
                        || {
                            model.set(param.id, value).unwrap();
                            model.finish_work();
                            model.work();
                            assert_values(model.as_ref());
                            assert_reports(model.as_ref());
                        },
                    );
                }
            }
        }
    }
}

/// Only lines may have gaps at values that are not finite; those of these widgets have none.
#[test]
fn no_line_has_a_gap_without_missing_data() {
    for name in ["w16.5", "w16.7"] {
        let mut shell = find(name).unwrap()();
        shell.finish_work();
        shell.model_mut().work();
        for panel in shell.model().scene().panels {
            for layer in &panel.layers {
                if let Layer::Line { points, .. } = layer {
                    let finite = points.iter().flatten().all(|value| value.is_finite());
                    assert!(finite, "{name}: {}", panel.id);
                }
            }
        }
    }
}

/// Pieces of visual refinement before the picture is compared.
const WORKED: usize = 50;

/// Whether two pictures are equal. Unknown values are NaN and equal none: only then their texts decide, which take long.
fn is_same(one: &Scene, other: &Scene) -> bool {
    let has_unknown = !one.eq(one);
    one == other || has_unknown && format!("{one:?}") == format!("{other:?}")
}

/// Whether a value of the parameter changes picture, result or tables, in the present state of the model.
fn changes_what_is_shown(model: &mut dyn Model, param: &ParamSpec) -> bool {
    let shown = |model: &mut dyn Model| {
        model.finish_work();
        // Enough for the first paths of w16.1; its maps refine for minutes.
        (0..WORKED).for_each(|_| {
            model.work();
        });
        (
            format!("{:?}", model.outcome()),
            model.tables(),
            model.scene(),
        )
    };
    let before = shown(model);
    let now = model.values().number(param.id);
    let (min, max) = param.range();
    let found = [min, max, (min + max) / 2.0].into_iter().any(|value| {
        model.set(param.id, value).expect("a value in range");
        let after = shown(model);
        after.0 != before.0 || after.1 != before.1 || !is_same(&after.2, &before.2)
    });
    model.set(param.id, now).expect("the value it had");
    found
}

/// A parameter that is declared and never read would be a control without effect.
#[test]
fn each_parameter_changes_what_is_shown() {
    let mut idle = Vec::new();
    for make in MODELS {
        let spec = make().spec();
        // The picture of w16.10 is that of a reader's log, which it does not have here.
        if spec.id == "w16.10" {
            continue;
        }
        let states = pressed_states(spec);
        let mut others = vec![Vec::new()];
        if spec.id == "w16.2" {
            // The number of a thing needs the kind of thing, and a piece of the flat the editor.
            others.extend([
                vec![("pick", 1.0)],
                vec![("edit", 1.0)],
                vec![("edit", 1.0), ("piece", 1.0)],
            ]);
        }
        let mut starts: Vec<_> = states
            .iter()
            .flat_map(|state| others.iter().map(move |other| (state, other)))
            .collect();
        let mut has_effect = |param: &ParamSpec| {
            let found = starts.iter().position(|(state, other)| {
                let mut model = make();
                model.set_motion(Motion::Reduced);
                model.press(state).expect("the widget has it");
                for (id, value) in other.iter().chain([&(MORE.id, 1.0)]) {
                    model.set(id, *value).expect("a value in range");
                }
                changes_what_is_shown(model.as_mut(), param) || {
                    model.press("play").expect("every widget plays");
                    changes_what_is_shown(model.as_mut(), param)
                }
            });
            // The next parameter is often one of the same mode.
            starts[..=found.unwrap_or(0)].rotate_right(1);
            found.is_some()
        };
        for param in spec.params {
            let is_text = matches!(param.kind, ParamKind::Text { .. });
            if ![SPEED.id, MORE.id].contains(&param.id) && !is_text && !has_effect(param) {
                idle.push((spec.id, param.id));
            }
        }
    }
    assert!(idle.is_empty(), "without effect: {idle:?}");
}

/// All results and texts; unknown facts are NaN, so the comparison uses text.
fn state_text(model: &dyn Model) -> String {
    format!(
        "{:?} {:?} {}",
        model.values(),
        model.outcome(),
        model.summary()
    )
}

#[test]
fn a_wrong_value_or_button_is_an_error_and_changes_no_state() {
    for make in MODELS {
        let mut model = make();
        model.finish_work();
        let before = state_text(model.as_ref());
        let spec = model.spec();
        for param in spec.params {
            let (min, max) = param.range();
            for bad in [min - 1.0, max + 1.0, -1e300, f64::INFINITY, f64::NAN] {
                let rejected = model.set(param.id, bad);
                assert!(rejected.is_err(), "{}: {} took {bad}", spec.id, param.id);
            }
        }
        assert!(model.set("nonsense", 0.0).is_err(), "{}", spec.id);
        assert!(model.set_text("nonsense", "0").is_err(), "{}", spec.id);
        let rejected = model.press("stepp").unwrap_err().to_string();
        for known in spec.buttons.iter().map(|button| button.id) {
            assert!(rejected.contains(known), "{rejected}");
        }
        assert_eq!(state_text(model.as_ref()), before);
    }
}

#[test]
fn a_press_of_a_button_with_nothing_to_do_changes_no_state() {
    let (mut disabled, mut enabled) = (0, 0);
    for make in SHELLS {
        let mut shell = make();
        let spec = shell.model().spec();
        for state in pressed_states(shell.model().spec()) {
            shell.model_mut().press(state).expect("the widget has it");
            shell.finish_work();
            shell.take_requests();
            let before = state_text(shell.model());
            for id in shell.disabled() {
                shell.press(id).expect("the widget has it");
                assert_eq!(
                    state_text(shell.model()),
                    before,
                    "{} {state} {id}",
                    spec.id
                );
                assert!(shell.take_requests().is_empty(), "{} {state} {id}", spec.id);
                disabled += 1;
            }
            enabled += spec.buttons.len() - shell.disabled().len();
            for always in ["play", "defaults"] {
                assert!(!shell.disabled().contains(&always), "{} {state}", spec.id);
            }
        }
    }
    assert!(disabled > SPECS.len() && enabled > disabled);
}

#[test]
fn playing_goes_on_to_the_end_and_stops_there() {
    for make in MODELS {
        let mut model = make();
        model.finish_work();
        let name = model.spec().id;
        // The run of w16.10 is a reader's log, which it does not have here.
        if name == "w16.10" {
            continue;
        }
        let timeline = model.timeline().expect("every other widget has a run");
        let at = |model: &dyn Model| model.values().number(timeline.param);
        model.press("reset").unwrap();
        assert_eq!(at(model.as_ref()), 0.0, "{name}");
        model.press("play").unwrap();
        assert!(model.timeline().unwrap().playing, "{name}");
        let (mut before, mut frames) = (0.0, 0);
        while model.advance(0.1).is_busy() {
            let now = at(model.as_ref());
            assert!(now >= before, "{name} goes from {before} back to {now}");
            before = now;
            frames += 1;
            assert!(frames < 3000, "{name}: five minutes and no end");
        }
        let end = model.timeline().unwrap();
        assert!(!end.playing && at(model.as_ref()) >= end.last, "{name}");
        // Again from the start, and with reduced motion at the end at once.
        model.press("reset").unwrap();
        model.press("play").unwrap();
        model.set_motion(Motion::Reduced);
        assert!(
            at(model.as_ref()) >= end.last,
            "{name}: requested in between"
        );
        for start in ["reset", "step"] {
            model.press(start).unwrap();
            model.press("play").unwrap();
            assert!(at(model.as_ref()) >= end.last, "{name} after {start}");
            assert!(!model.timeline().unwrap().playing, "{name} after {start}");
            assert_eq!(model.advance(0.1), Activity::Idle, "{name} after {start}");
        }
        let plays = |preset: &&Preset| preset.then.contains(&"play");
        for preset in model.spec().presets.iter().filter(plays) {
            model.press(preset.id).unwrap();
            model.finish_work();
            let end = model.timeline().unwrap();
            let ends = at(model.as_ref()) >= end.last && !end.playing;
            assert!(ends, "{name} after {}", preset.id);
        }
    }
}

/// A step of each run with a button of its own for it: the position after it, and the verdict.
#[test]
fn a_step_goes_to_the_next_position() {
    for (name, start, position, verdict) in [
        ("w16.5", ("graph", 0.0), ("steps", 1.0), Some("at rest")),
        (
            "w16.6",
            ("progress", 0.0),
            ("progress", 1.0),
            Some("the search finds the truth"),
        ),
        ("w16.7", ("new", 30.0), ("new", 31.0), None),
        ("w16.9", ("moment", 5.0), ("moment", 6.0), None),
    ] {
        let mut shell = find(name).unwrap()();
        shell.model_mut().set(start.0, start.1).unwrap();
        shell.finish_work();
        shell.press("step").unwrap();
        let model = shell.model();
        assert_eq!(model.values().number(position.0), position.1, "{name}");
        if let Some(verdict) = verdict {
            assert_eq!(model.outcome().verdict, verdict, "{name}");
        }
    }
}

/// The states one press away: the start, and each preset.
fn pressed_states(spec: &'static WidgetSpec) -> Vec<&'static str> {
    let presets = spec.presets.iter();
    core::iter::once("defaults")
        .chain(presets.map(|preset| preset.id))
        .collect()
}

#[test]
fn a_preset_sets_what_it_names_and_can_be_pressed_again() {
    for make in SHELLS {
        let mut shell = make();
        let spec = shell.model().spec();
        for preset in spec.presets {
            let mut first_outcome = None;
            for _ in 0..2 {
                shell.model_mut().press(preset.id).unwrap();
                shell.finish_work();
                let values = shell.model().values();
                // A playback that it starts may advance at once.
                let moved = shell.model().timeline().map(|timeline| timeline.param);
                for (id, expected) in preset.set.iter().filter(|(id, _)| Some(*id) != moved) {
                    assert_eq!(values.number(id), *expected, "{} {}", spec.id, preset.id);
                }
                let outcome = format!("{:?}", shell.model().outcome());
                assert_eq!(
                    *first_outcome.get_or_insert_with(|| outcome.clone()),
                    outcome,
                    "{} {}",
                    spec.id,
                    preset.id
                );
            }
        }
    }
}

#[test]
fn no_text_overlaps_or_is_cut_off() {
    for make in SHELLS {
        let mut shell = make();
        let name = shell.model().spec().id;
        for state in pressed_states(shell.model().spec()) {
            shell.model_mut().press(state).expect("the widget has it");
            shell.finish_work();
            for more in [0.0, 1.0] {
                let model = shell.model_mut();
                model.set(MORE.id, more).expect("every widget has layers");
                for width in [320.0, 340.0, 390.0, 520.0, 560.0, 700.0, 1100.0, 1400.0] {
                    let faults = shell.text_faults(width);
                    assert!(faults.is_empty(), "{name} after {state}: {faults:#?}");
                }
            }
        }
    }
}

/// No verdict before a trial: the title asks, and the gesture that answers stands there until the reader acts.
#[test]
fn every_title_is_a_question_and_every_claim_has_one_line() {
    for spec in SPECS {
        let title = spec.title;
        let asks_once = title.ends_with('?') && title.matches(['.', '?', '!']).count() == 1;
        assert!(asks_once && title.len() <= 70, "{}: {title}", spec.id);
        assert!(!spec.gesture.contains('?'), "{}", spec.id);
        let claim = spec.claim;
        assert!(
            claim.ends_with('.') && claim.len() <= 46,
            "{}: {claim}",
            spec.id
        );
    }
}

#[test]
fn no_number_of_a_picture_at_rest_has_three_decimals() {
    for make in SHELLS {
        let mut shell = make();
        shell.finish_work();
        while shell.model_mut().work().is_busy() {}
        let name = shell.model().spec().id;
        for panel in shown_scene(shell.model()).panels {
            let labels = panel.layers.into_iter().filter_map(|layer| match layer {
                Layer::Label { text, .. } | Layer::Text { text, .. } => Some(text),
                _ => None,
            });
            let legend = panel.legend.into_iter().map(|entry| entry.label);
            for words in labels.chain(legend).chain([panel.title]) {
                let mut parts = words.split('.').skip(1);
                let is_long = |part: &str| part.bytes().take_while(u8::is_ascii_digit).count() > 2;
                assert!(!parts.any(is_long), "{name}, {}: {words}", panel.id);
            }
        }
    }
}

#[test]
fn a_verdict_on_a_run_waits_for_its_end() {
    for make in SHELLS {
        let mut shell = make();
        let spec = shell.model().spec();
        shell.finish_work();
        shell.act();
        assert_eq!(shell.asks(), spec.awaits == Awaits::End, "{}", spec.id);
        shell.press("play").expect("every widget plays");
        assert_eq!(shell.asks(), spec.awaits != Awaits::Nothing, "{}", spec.id);
        while shell.asks() && shell.model().is_pressed("play") {
            shell.model_mut().advance(0.25);
        }
        assert!(!shell.asks(), "{}", spec.id);
    }
}

/// What a gesture promises, letting go does.
#[test]
fn every_gesture_that_lets_go_plays() {
    let mut promised = 0;
    for make in SHELLS {
        let mut shell = make();
        let spec = shell.model().spec();
        if !spec.gesture.contains("let it go") {
            continue;
        }
        promised += 1;
        shell.finish_work();
        let scene = shown_scene(shell.model());
        let model = shell.model_mut();
        let mut handles = scene.panels.iter().flat_map(|panel| {
            let places = panel.layers.iter().filter_map(|layer| match layer {
                Layer::Handle { at, .. } => Some((panel.id, *at)),
                _ => None,
            });
            places.collect::<Vec<_>>()
        });
        let held = handles.find_map(|(panel, at)| Some((model.grab(panel, at, [0.1; 2])?, at)));
        let (handle, [x, y]) = held.unwrap_or_else(|| panic!("{}: no handle", spec.id));
        model.drag(handle, [x + 0.5, y - 0.3]);
        model.release();
        let plays = model.plays_when_let_go(&handle) || model.is_pressed("play");
        assert!(plays, "{}: {handle:?}", spec.id);
    }
    assert_eq!(promised, 7);
}

/// The text alternative asks where the page asks, and holds the answer back.
#[test]
fn the_text_alternative_asks_until_the_reader_acts() {
    // Play and a drag may set the same numbers: 25° off, 0.55 m.
    let is_set = |model: &dyn Model, word: &str| {
        let mut values = model.values().iter();
        values.any(|(param, _)| model.values().to_text(param.id) == word)
    };
    for make in SHELLS {
        let mut shell = make();
        let spec = shell.model().spec();
        // As in the page, where nobody has acted: all work is done.
        shell.finish_work();
        while shell.model_mut().work().is_busy() {}
        let outcome = shell.model().outcome();
        let words = shell.summary();
        assert!(
            words.ends_with(&format!("{} {}", spec.title, spec.gesture)),
            "{}: {words}",
            spec.id
        );
        let told = outcome.in_full();
        let numbers = |text: &str| -> Vec<String> {
            let parts = text.split(|letter: char| !(letter.is_ascii_digit() || letter == '.'));
            let parts = parts.map(|part| part.trim_matches('.').to_owned());
            parts.filter(|part| part.contains('.')).collect()
        };
        for number in numbers(&told) {
            let is_told = numbers(&words).contains(&number) && !is_set(shell.model(), &number);
            assert!(!is_told, "{}: {number} of “{told}” in “{words}”", spec.id);
        }
        assert!(!words.contains(&outcome.verdict), "{}: {words}", spec.id);
        shell.act();
        if let Some(run) = shell.model().timeline() {
            let end = shell.model_mut().set(run.param, run.last);
            end.expect("a timeline takes its end");
        }
        let words = shell.summary();
        let outcome = shell.model().outcome().in_full();
        assert!(words.ends_with(&outcome), "{}: {words}", spec.id);
    }
}

/// The canvas on a phone of 390 by 844 points, between the margins of the page.
const PHONE: egui::Vec2 = vec2(356.0, 844.0);
/// The border of the element, its claim, controls and verdict.
const BAR: f32 = 240.0;
const TWO_SCREENS: f32 = 2.0 * PHONE.y - BAR;

/// Heights measured by the module in the browser, with egui's own fonts instead of ours.
fn height_on_a_phone(ctx: &egui::Context, shell: &mut Shell) -> f32 {
    let input = egui::RawInput {
        screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, PHONE)),
        ..Default::default()
    };
    for _ in 0..3 {
        let mut output = ctx.run_ui(input.clone(), |ui| shell.ui(ui));
        // Drawing is skipped, so the font's texture is not needed.
        output.textures_delta.clear();
    }
    shell.content_height()
}

#[test]
fn no_opening_layer_is_higher_than_two_screens_of_a_phone() {
    let ctx = egui::Context::default();
    for make in SHELLS {
        let mut shell = make();
        let name = shell.model().spec().id;
        for state in pressed_states(shell.model().spec()) {
            shell.model_mut().press(state).expect("the widget has it");
            shell.finish_work();
            let height = height_on_a_phone(&ctx, &mut shell);
            assert!(height <= TWO_SCREENS, "{name} after {state}: {height}");
        }
        let opening = height_on_a_phone(&ctx, &mut shell);
        shell.model_mut().set(MORE.id, 1.0).expect("a switch");
        let all = height_on_a_phone(&ctx, &mut shell);
        assert!(all >= opening, "{name}: {opening} and {all}");
    }
}

/// The page finds a control by its name alone, regardless of its kind.
#[test]
fn no_two_controls_of_a_widget_share_a_name() {
    for spec in SPECS {
        let mut ids: Vec<_> = (spec.presets.iter().map(|preset| preset.id))
            .chain(spec.params.iter().map(|param| param.id))
            .chain(spec.buttons.iter().map(|button| button.id))
            .collect();
        ids.sort_unstable();
        for pair in ids.windows(2) {
            assert_ne!(pair[0], pair[1], "{} has two of this name", spec.id);
        }
    }
}

#[test]
fn every_part_of_the_opening_layer_exists() {
    for make in MODELS {
        let model = make();
        let spec = model.spec();
        let panels: Vec<_> = model.scene().panels.iter().map(|panel| panel.id).collect();
        let params: Vec<_> = spec.params.iter().map(|param| param.id).collect();
        let buttons: Vec<_> = spec.buttons.iter().map(|button| button.id).collect();
        for (known, named) in [
            (panels, spec.opening.panels),
            (params, spec.opening.params),
            (buttons, spec.opening.buttons),
        ] {
            for id in named {
                assert!(known.contains(id), "{} has no {id}", spec.id);
            }
        }
        let name = spec.id;
        assert!(spec.opening.buttons.contains(&"play"), "{name}");
        assert!(!spec.opening.panels.is_empty(), "{name}");
    }
}

/// The end condition of the round's commission: at rest one picture, and one slider, which is the run's.
#[test]
fn at_rest_a_widget_shows_one_picture_and_one_slider() {
    // The marks that light the part at work, and the line that the reader drags over the pairs.
    let strips = [("w16.4", "parts"), ("w16.7", "scores")];
    for make in MODELS {
        let model = make();
        let spec = model.spec();
        let disclosure = model.disclosure();
        let scene = model.scene();
        let shown = scene.panels.iter().filter(|panel| {
            disclosure.has_panel(panel.id)
                && panel.question().is_none()
                && !strips.contains(&(spec.id, panel.id))
        });
        let shown: Vec<_> = shown.map(|panel| panel.id).collect();
        assert_eq!(shown.len(), 1, "{}: {shown:?}", spec.id);
        let sliders = spec.params.iter().filter(|param| {
            matches!(param.kind, ParamKind::Slider { .. }) && disclosure.has_param(param.id)
        });
        assert_eq!(sliders.count(), 0, "{} has the slider of its run", spec.id);
    }
}

#[test]
fn every_sentence_of_a_result_has_a_capital_and_a_full_stop() {
    for maker in MODELS {
        let presets = maker().spec().presets;
        for preset in presets {
            let mut model = maker();
            model.press(preset.id).unwrap();
            for _ in 0..2 {
                let outcome = model.outcome();
                let words = outcome.in_full();
                let first = words.chars().next().unwrap();
                assert!(
                    !first.is_ascii_lowercase() && words.ends_with('.'),
                    "{words}"
                );
                assert!(words.len() <= outcome.sentence.len() + 1, "{words}");
                model.finish_work();
            }
        }
    }
}

#[test]
fn a_name_of_a_file_keeps_its_letters_at_the_start_of_a_sentence() {
    let outcome = |sentence: &str| widget_kit::model::Outcome {
        standing: widget_kit::model::Assessment::Neutral,
        verdict: String::new(),
        sentence: sentence.to_owned(),
        facts: Vec::new(),
    };
    assert_eq!(
        outcome("hall.log is opened.").in_full(),
        "hall.log is opened."
    );
    assert_eq!(outcome("χ² falls").in_full(), "χ² falls.");
    assert_eq!(outcome("the lap ends").in_full(), "The lap ends.");
}

/// What the colours of the legend say: each of the five means one thing, whatever picture it stands in.
#[test]
fn the_five_colours_mean_the_same_in_every_legend() {
    use widget_kit::scene::Tone;
    let meaning = |tone: Tone, words: &str| -> bool {
        let says = |known: &[&str]| known.iter().any(|known| words.contains(known));
        match tone {
            Tone::Prediction => says(&["odometry", "wheels", "predict", "gate", "expected"]),
            Tone::Truth => says(&["tru", "error"]),
            Tone::Prior => says(&[
                "prior",
                "start",
                "put",
                "drop",
                "before",
                "local map",
                "sweep",
                "crosshair",
                "front end alone",
                "first guess",
                "source",
            ]),
            _ => true,
        }
    };
    let mut wrong = std::collections::BTreeSet::new();
    for maker in MODELS {
        let presets = maker().spec().presets;
        for preset in presets {
            let mut model = maker();
            model.press(preset.id).unwrap();
            let _ = model.set(MORE.id, 1.0);
            model.finish_work();
            for panel in model.scene().panels {
                for entry in panel.legend {
                    if !meaning(entry.tone, &entry.label) {
                        wrong.insert(format!(
                            "{} {}: {:?} {}",
                            model.spec().id,
                            panel.id,
                            entry.tone,
                            entry.label
                        ));
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
