//! Drives the shell like a reader, through its pointer.

use crate::fake::Fake;
use egui::accesskit::Role;
use egui::{Event, Modifiers, PointerButton, Pos2, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use widget_kit::controls::shown;
use widget_kit::palette::Theme;
use widget_kit::scene::{Layer, RasterCell, Scene};
use widget_kit::shell::Shell;
use widget_kit::view::{Arrangement, Row, Slot};
use widget_kit::zoom::Look;

fn shell() -> Shell {
    Shell::new(Box::new(Fake::new()), Arrangement::by_weight)
}

fn harness(width: f32) -> Harness<'static, Shell> {
    let mut harness = Harness::builder()
        .with_size(vec2(width, 1400.0))
        .with_max_steps(600)
        .build_ui_state(|ui, shell: &mut Shell| shell.ui(ui), shell());
    harness.run_steps(3);
    harness
}

fn value(harness: &Harness<'_, Shell>, id: &str) -> f64 {
    harness.state().model().values().number(id)
}

/// A press or release of the primary button.
fn button(pos: Pos2, pressed: bool) -> Event {
    Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    }
}

/// Presses at one position, moves to another, releases.
fn drag(harness: &mut Harness<'_, Shell>, from: Pos2, to: Pos2) {
    for (pos, pressed) in [(from, Some(true)), (to, None), (to, Some(false))] {
        harness.event(Event::PointerMoved(pos));
        if let Some(pressed) = pressed {
            harness.event(button(pos, pressed));
        }
        harness.run_steps(2);
    }
}

#[test]
fn a_widget_opens_with_its_scene_one_control_and_play_and_more_adds_the_rest_below() {
    for width in [390.0, 1100.0] {
        let mut harness = harness(width);
        let all = harness.state().content_height();
        let place =
            |harness: &Harness<'_, Shell>| harness.state().panel_to_screen("map", [1.0, 1.0]);
        let at = place(&harness);
        harness.state_mut().model_mut().set("more", 0.0).unwrap();
        harness.run_steps(3);
        assert_eq!(
            shown(harness.state().model()),
            ["x", "time", "more", "play"]
        );
        assert!(harness.state().content_height() < 0.8 * all);
        assert_eq!(place(&harness), at, "the picture stays");
        harness.state_mut().model_mut().set("more", 1.0).unwrap();
        harness.run_steps(3);
        let spec = harness.state().model().spec();
        let controls = spec.presets.len() + spec.params.len() + spec.buttons.len();
        assert_eq!(shown(harness.state().model()).len(), controls);
        assert_eq!(harness.state().content_height(), all);
    }
}

/// Controls are the host's: native ones in a browser, egui's in a window.
#[test]
fn the_picture_holds_no_control() {
    for width in [390.0, 1100.0] {
        let harness = harness(width);
        for role in [
            Role::Button,
            Role::CheckBox,
            Role::ComboBox,
            Role::RadioButton,
            Role::Slider,
            Role::SpinButton,
            Role::TextInput,
        ] {
            assert_eq!(
                harness.query_all_by_role(role).count(),
                0,
                "{role:?} at {width}"
            );
        }
    }
}

/// A look with the pointer is no act, and neither is a value of the page.
#[test]
fn a_press_on_the_picture_is_an_act_and_a_look_is_none() {
    for width in [390.0, 560.0, 1100.0] {
        let mut harness = harness(width);
        harness.state_mut().model_mut().set("x", 1.5).unwrap();
        harness.run_steps(3);
        let [x, y] = harness
            .state()
            .panel_to_screen("map", [1.5, 1.0])
            .expect("the map is shown");
        let at = pos2(x, y);
        harness.event(Event::PointerMoved(at));
        harness.run_steps(2);
        assert!(!harness.state().has_acted());
        let height = harness.state().content_height();
        drag(&mut harness, at, at);
        assert!(harness.state().has_acted());
        assert_eq!(harness.state().content_height(), height, "at {width}");
    }
}

#[test]
fn a_press_of_a_host_is_an_act() {
    let mut pressed = shell();
    pressed.press("play").unwrap();
    assert!(pressed.has_acted());
}

#[test]
fn the_ring_of_a_handle_pulses_once_and_then_needs_no_frame() {
    let mut harness = harness(1100.0);
    let mut frames = 0;
    while harness.state().is_busy() {
        harness.run_steps(1);
        frames += 1;
        assert!(frames < 200, "it pulses on");
    }
    assert!(!harness.state().has_acted());
    let mut reduced = shell();
    reduced.set_motion(widget_kit::model::Motion::Reduced);
    let mut harness = Harness::builder()
        .with_size(vec2(1100.0, 1400.0))
        .build_ui_state(|ui, shell: &mut Shell| shell.ui(ui), reduced);
    harness.run_steps(20);
    assert!(!harness.state().is_busy(), "reduced motion pulses");
}

#[test]
fn the_cursor_stays_grabbing_while_a_handle_is_held_without_a_movement() {
    let mut harness = harness(1100.0);
    let [x, y] = harness
        .state()
        .panel_to_screen("map", [1.0, 1.0])
        .expect("the map is shown");
    let at = pos2(x, y);
    let cursor = |harness: &Harness<'_, Shell>| harness.output().platform_output.cursor_icon;
    harness.event(Event::PointerMoved(at));
    harness.run_steps(2);
    assert_eq!(cursor(&harness), egui::CursorIcon::Grab);
    harness.event(button(at, true));
    for _ in 0..5 {
        harness.run_steps(1);
        assert_eq!(cursor(&harness), egui::CursorIcon::Grabbing);
    }
    harness.event(button(at, false));
    harness.run_steps(2);
    assert_ne!(cursor(&harness), egui::CursorIcon::Grabbing);
}

#[test]
fn only_a_picture_with_equal_axes_zooms() {
    let harness = harness(1100.0);
    let shell = harness.state();
    let at = |panel, point| Pos2::from(shell.panel_to_screen(panel, point).unwrap());
    assert!(shell.zooms_at(at("map", [1.0, 1.0])));
    assert!(!shell.zooms_at(at("plot", [10.0, 0.1])));
    assert!(!shell.zooms_at(pos2(2.0, 2.0)));
}

#[test]
fn an_opened_layer_stays_open_after_presets_and_defaults() {
    let mut harness = harness(1100.0);
    for id in ["far", "defaults"] {
        harness.state_mut().press(id).unwrap();
        assert_eq!(value(&harness, "more"), 1.0, "{id}");
    }
    harness.state_mut().model_mut().set("more", 0.0).unwrap();
    harness.state_mut().press("far").unwrap();
    assert_eq!(
        value(&harness, "more"),
        0.0,
        "nor does a preset open anything"
    );
}

#[test]
fn a_preset_sets_the_state_that_it_names() {
    let mut pressed = shell();
    pressed.press("far").unwrap();
    assert_eq!(pressed.model().values().number("x"), 3.5);
}

#[test]
fn a_handle_follows_the_pointer_at_the_grabbed_spot() {
    let mut harness = harness(1100.0);
    let at = |harness: &Harness<'_, Shell>, world: [f64; 2]| {
        let [x, y] = harness
            .state()
            .panel_to_screen("map", world)
            .expect("the map is shown");
        pos2(x, y)
    };
    // Five pixels off the handle: it must not jump by them.
    let from = at(&harness, [1.0, 1.0]) + vec2(5.0, 0.0);
    let to = at(&harness, [2.0, 1.0]) + vec2(5.0, 0.0);
    drag(&mut harness, from, to);
    assert!(
        (value(&harness, "x") - 2.0).abs() < 0.02,
        "{}",
        value(&harness, "x")
    );
}

#[test]
fn only_draggable_parts_keep_a_touch_from_scrolling_the_page() {
    let harness = harness(390.0);
    let screen = |world| {
        let [x, y] = harness
            .state()
            .panel_to_screen("map", world)
            .expect("the map is shown");
        pos2(x, y)
    };
    assert!(harness.state().drags_at(screen([1.0, 1.0])));
    assert!(!harness.state().drags_at(screen([3.5, 2.5])));
    assert!(!harness.state().drags_at(pos2(5.0, 5.0)));
}

#[test]
fn play_runs_to_the_end_and_is_shown_as_pressed_meanwhile() {
    let mut harness = harness(1100.0);
    harness.state_mut().press("play").unwrap();
    harness.run_steps(2);
    assert!(harness.state().is_busy() && harness.state().model().is_pressed("play"));
    harness.run_steps(400);
    assert_eq!(value(&harness, "time"), 20.0);
    assert!(!harness.state().model().is_pressed("play"));
    assert!(
        !harness.state().is_busy(),
        "an idle widget asks for no frame"
    );
    // The last piece of the picture is worked on after the run only.
    let scene = harness.state().model().scene();
    assert!(scene.panels[0].layers.iter().any(|layer| matches!(layer,
        Layer::Raster(raster) if raster.cells.iter().all(|cell| *cell != RasterCell::Unknown))));
}

#[test]
fn the_stage_fits_the_available_height_and_keeps_it_as_more_opens() {
    for width in [560.0, 1100.0] {
        let mut harness = harness(width);
        harness.state_mut().model_mut().set("more", 0.0).unwrap();
        harness.run_steps(3);
        let natural = harness.state().content_height();
        let room = natural - 60.0;
        harness.state_mut().set_room(room);
        harness.run_steps(3);
        let height = harness.state().content_height();
        assert!(height <= room && height > room - 20.0, "{height} of {room}");
        let map = harness.state().scene_rect();
        harness.state_mut().model_mut().set("more", 1.0).unwrap();
        harness.run_steps(3);
        assert!(harness.state().content_height() > room);
        assert_eq!(harness.state().scene_rect(), map);
        harness.state_mut().model_mut().set("more", 0.0).unwrap();
        // Plots cannot shrink to zero; then the host has to scroll.
        harness.state_mut().set_room(10.0);
        harness.run_steps(3);
        assert!(harness.state().content_height() > 100.0);
        harness.state_mut().set_room(f32::INFINITY);
        harness.run_steps(3);
        assert_eq!(harness.state().content_height(), natural);
    }
}

#[test]
fn the_wheel_scrolls_the_page_and_with_ctrl_zooms_the_map() {
    let mut harness = harness(1100.0);
    let spot = harness
        .state()
        .panel_to_screen("map", [2.0, 1.5])
        .expect("the map is shown");
    let before = harness.state().panel_to_screen("map", [1.0, 1.0]);
    let wheel = |harness: &mut Harness<'_, Shell>, modifiers| {
        harness.event(Event::PointerMoved(pos2(spot[0], spot[1])));
        harness.event(Event::MouseWheel {
            unit: egui::MouseWheelUnit::Line,
            delta: vec2(0.0, 3.0),
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Wheel,
            modifiers,
        });
        harness.run_steps(8);
    };
    wheel(&mut harness, Modifiers::NONE);
    assert_eq!(harness.state().panel_to_screen("map", [1.0, 1.0]), before);
    wheel(&mut harness, Modifiers::COMMAND);
    assert_ne!(harness.state().panel_to_screen("map", [1.0, 1.0]), before);
    assert!(harness.state().is_zoomed());
    harness.state_mut().look(Look::Whole);
    harness.run_steps(3);
    assert!(!harness.state().is_zoomed());
    assert_eq!(harness.state().panel_to_screen("map", [1.0, 1.0]), before);
}

#[test]
fn two_resting_fingers_zoom_and_pan_the_map_without_dragging() {
    let mut harness = harness(1100.0);
    let screen = |harness: &Harness<'_, Shell>, at: [f64; 2]| {
        Pos2::from(
            harness
                .state()
                .panel_to_screen("map", at)
                .expect("the map is shown"),
        )
    };
    let apart = |harness: &Harness<'_, Shell>| {
        screen(harness, [1.2, 1.0]).x - screen(harness, [1.0, 1.0]).x
    };
    let finger = |id: u64, phase, pos| Event::Touch {
        device_id: egui::TouchDeviceId(0),
        id: egui::TouchId(id),
        phase,
        pos,
        force: None,
    };
    // The first press grabs the handle, the second one nothing.
    for pressed in [screen(&harness, [1.0, 1.0]), pos2(-1e4, -1e4)] {
        let (before, x) = (apart(&harness), value(&harness, "x"));
        let first = screen(&harness, [1.0, 1.0]);
        let second = |px| first + vec2(px, 0.0);
        harness.event(button(pressed, true));
        harness.event(finger(0, egui::TouchPhase::Start, first));
        harness.event(finger(1, egui::TouchPhase::Start, second(60.0)));
        // By then egui treats it as a long press.
        harness.run_steps(8);
        for px in [75.0, 90.0] {
            harness.event(Event::PointerMoved(first));
            harness.event(finger(1, egui::TouchPhase::Move, second(px)));
            harness.run_steps(1);
        }
        let spot = screen(&harness, [1.0, 1.0]);
        for (id, pos) in [(0, first), (1, second(90.0))] {
            let moved = pos + vec2(12.0, -8.0);
            harness.event(finger(id, egui::TouchPhase::Move, moved));
        }
        harness.run_steps(1);
        let along = screen(&harness, [1.0, 1.0]) - spot;
        assert!((along - vec2(12.0, -8.0)).length() < 0.01, "{along}");
        harness.event(button(first, false));
        harness.event(Event::PointerGone);
        for (id, pos) in [(0, first), (1, second(90.0))] {
            harness.event(finger(id, egui::TouchPhase::End, pos));
        }
        harness.run_steps(2);
        let zoomed = apart(&harness) / before;
        assert!(
            (zoomed - 1.5).abs() < 0.01,
            "{zoomed} with a press at {pressed}"
        );
        assert_eq!(value(&harness, "x"), x);
    }
}

#[test]
fn the_static_picture_has_the_layer_that_is_shown() {
    let mut shell = shell();
    let all = shell.picture_svg(390.0, Theme::Light);
    shell.model_mut().set("more", 0.0).unwrap();
    let first = shell.picture_svg(390.0, Theme::Light);
    assert!(first.len() < all.len());
    assert_well_formed(&first);
}

#[test]
fn the_static_picture_is_well_formed_in_both_themes() {
    for theme in [Theme::Light, Theme::Dark] {
        for width in [390.0, 1100.0] {
            let svg = shell().picture_svg(width, theme);
            assert_well_formed(&svg);
            assert!(svg.contains("Map &lt;of&gt; &quot;things&quot; &amp; ghosts"));
            assert!(!svg.contains("NaN") && !svg.contains("inf"));
        }
    }
}

/// Every element closes in order; attributes and text hold no bare `<` or `&`.
fn assert_well_formed(svg: &str) {
    let mut open = Vec::new();
    let mut rest = svg;
    while let Some(start) = rest.find('<') {
        assert!(
            !rest[..start].contains('>'),
            "stray > before {}",
            &rest[..start]
        );
        for part in rest[..start].split('&').skip(1) {
            let entity = part.split(';').next().unwrap_or_default();
            assert!(["amp", "lt", "gt", "quot"].contains(&entity), "&{entity}");
        }
        let end = rest[start..].find('>').expect("a tag closes") + start;
        let tag = &rest[start + 1..end];
        assert!(
            tag.matches('"').count().is_multiple_of(2),
            "quotes of <{tag}>"
        );
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop().as_deref(), Some(name));
        } else if !tag.ends_with('/') {
            open.push(tag.split([' ', '\n']).next().unwrap_or_default().to_owned());
        }
        rest = &rest[end + 1..];
    }
    assert!(open.is_empty(), "left open: {open:?}");
}

#[test]
fn no_text_overlaps_or_is_cut_off_at_any_width() {
    for width in [320.0, 340.0, 390.0, 520.0, 560.0, 700.0, 1100.0, 1400.0] {
        let faults = widget_kit::audit::text_faults(&Fake::new(), Arrangement::by_weight, width);
        assert!(faults.is_empty(), "{faults:#?}");
    }
}

#[test]
fn the_audit_finds_clipped_and_overlapping_texts() {
    // Six pixels are too few for two tick labels above each other.
    let flat = |_: &Scene, _: f32| Arrangement {
        stage: Row::each(&[Slot::fixed("map", 6.0)]),
        below: Vec::new(),
    };
    let faults = widget_kit::audit::text_faults(&Fake::new(), flat, 60.0);
    assert!(
        faults
            .iter()
            .any(|fault| fault.contains("leaves the picture")),
        "{faults:#?}"
    );
    assert!(
        faults.iter().any(|fault| fault.contains("lies on")),
        "{faults:#?}"
    );
}

/// A slow page and a fast finger: the complete gesture arrives within one frame.
#[test]
fn a_press_grabs_at_its_own_position_even_if_the_pointer_moved_in_the_same_frame() {
    let mut harness = harness(1100.0);
    let screen = |world: [f64; 2]| harness.state().panel_to_screen("map", world);
    let [from, to] =
        [[1.0, 1.0], [2.0, 1.0]].map(|world| Pos2::from(screen(world).expect("the map is shown")));
    harness.event(Event::PointerMoved(from));
    harness.event(button(from, true));
    harness.event(Event::PointerMoved(to));
    harness.run_steps(2);
    assert!(
        (value(&harness, "x") - 2.0).abs() < 0.02,
        "{}",
        value(&harness, "x")
    );
}

/// A complete drag or its end within one frame.
#[test]
fn a_drag_within_one_frame_ends_at_the_release() {
    for frames_before_the_end in [0, 1] {
        let mut harness = harness(1100.0);
        let drag = |harness: &mut Harness<'_, Shell>, [from, to]: [Pos2; 2]| {
            harness.event(Event::PointerMoved(from));
            harness.run_steps(1);
            harness.event(button(from, true));
            harness.run_steps(frames_before_the_end);
            harness.event(Event::PointerMoved(to));
            harness.event(button(to, false));
            harness.run_steps(2);
        };
        let screen = |world: [f64; 2]| harness.state().panel_to_screen("map", world);
        let ends = [[1.0, 1.0], [2.0, 1.0]]
            .map(|world| Pos2::from(screen(world).expect("the map is shown")));
        drag(&mut harness, ends);
        let x = value(&harness, "x");
        assert!((x - 2.0).abs() < 0.02, "{frames_before_the_end}: {x}");
        // It was released.
        harness.event(Event::PointerMoved(ends[0]));
        harness.run_steps(2);
        assert_eq!(value(&harness, "x"), x);
    }
}

#[test]
fn a_cancelled_touch_ends_its_drag() {
    let mut harness = harness(1100.0);
    let [x, y] = harness
        .state()
        .panel_to_screen("map", [1.0, 1.0])
        .expect("the map is shown");
    harness.event(Event::PointerMoved(pos2(x, y)));
    harness.event(button(pos2(x, y), true));
    harness.run_steps(2);
    harness.state_mut().release_drags();
    harness.event(Event::PointerMoved(pos2(x + 80.0, y)));
    harness.run_steps(2);
    assert_eq!(value(&harness, "x"), 1.0, "it must not follow any more");
}

#[test]
fn points_of_one_style_share_one_element() {
    use widget_kit::surface::{Pen, Surface as _};
    use widget_kit::svg::SvgSurface;
    let mut svg = SvgSurface::new(Theme::Light);
    for k in 0..1000_u16 {
        svg.circle([f32::from(k), 5.0], 2.0, Some([1, 2, 3]), None);
    }
    svg.line(&[[0.0, 0.0], [9.0, 9.0]], Pen::solid([1, 2, 3], 1.0));
    let svg = svg.finish(100.0, 10.0, "");
    assert_eq!(svg.matches("<path").count(), 2);
    assert_eq!(svg.matches('M').count(), 1001);
    assert_well_formed(&svg);
}
