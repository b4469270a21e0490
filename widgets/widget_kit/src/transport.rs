//! The transport bar: play, step, reset, speed, and the timeline with its events.

use egui::{
    Button, CursorIcon, Key, Label, Rect, Response, Sense, Stroke, Ui, WidgetInfo, pos2, vec2,
};

use crate::controls;
use crate::egui_surface::color;
use crate::hit_areas::HitAreas;
use crate::model::{Assessment, Model, Timeline};
use crate::palette::{self, Theme, mix};
use crate::param::{ParamKind, ParamSpec};
use crate::playback::SPEED;
use crate::pointer::{PrimaryButton, Touched};
use crate::scene::Tone;
use crate::spec::{ButtonSpec, DEFAULTS, PLAY};
use crate::style::TARGET;

/// Half the width of the thumb, for a target of 24 pixels.
const THUMB: f32 = 12.0;
/// Width of the speed control with its name.
const SPEED_ROOM: f32 = 260.0;
/// Width from which the position on the timeline is beside the buttons of the opening view.
const PLACE_BESIDE: f32 = 480.0;
/// Distance within which a mark reacts to the pointer.
const MARK_REACH: f32 = 7.0;

/// Shows the buttons, the speed and the timeline of the widget. Returns whether any of them was used.
pub fn bar(ui: &mut Ui, model: &mut dyn Model, theme: Theme, hot: &mut HitAreas) -> Touched {
    let mut touched = Touched::No;
    let disclosure = model.disclosure();
    let timeline = model.timeline();
    let tab = model.tabs().map(|tabs| tabs.button.id);
    let playing = timeline.as_ref().is_some_and(|timeline| timeline.playing);
    // Beside few buttons the position on the timeline needs no separate row.
    let is_beside = !disclosure.is_all() && ui.available_width() >= PLACE_BESIDE;
    ui.horizontal_wrapped(|ui| {
        for spec in model.spec().buttons {
            if spec.id != DEFAULTS.id
                && tab != Some(spec.id)
                && disclosure.has_button(spec.id)
                && button(ui, spec, model.is_enabled(spec.id), playing, hot).clicked()
            {
                // The buttons come from the widget's own list.
                let _ = model.press(spec.id);
                touched = Touched::Yes;
            }
        }
        if disclosure.is_all()
            && let Some((spec, value)) = model.values().find(SPEED.id)
            && let ParamKind::Choice { options } = spec.kind
        {
            // The rest of a row may be too narrow for the choices, which do not wrap.
            if ui.available_size_before_wrap().x < SPEED_ROOM {
                ui.end_row();
            }
            ui.label(spec.label).on_hover_text(spec.help);
            if let Some(new) = controls::choice(ui, spec, options, value, hot) {
                let _ = model.set(spec.id, new);
                touched = Touched::Yes;
            }
        }
        if is_beside {
            place_on(ui, model, timeline.as_ref());
        }
    });
    if !is_beside {
        place_on(ui, model, timeline.as_ref());
    }
    if let Some(timeline) = timeline
        && let Some((spec, value)) = model.values().find(timeline.param)
        && let Some(new) = scrubber(ui, spec, &timeline, value, theme, hot)
    {
        let _ = model.set(spec.id, new);
        touched = Touched::Yes;
    }
    touched
}

/// One button; "Play" becomes "Pause" while the run plays.
pub fn button(
    ui: &mut Ui,
    spec: &'static ButtonSpec,
    is_enabled: bool,
    playing: bool,
    hot: &mut HitAreas,
) -> Response {
    let pressed = spec.id == PLAY.id && playing;
    let label = if pressed { "Pause" } else { spec.label };
    let response = ui.add_enabled(is_enabled, Button::new(label).min_size(vec2(44.0, TARGET)));
    hot.control(spec.id, &response);
    response
        .on_hover_text(spec.help)
        .on_disabled_hover_text(spec.help)
}

/// The position on the timeline in words.
fn place_on(ui: &mut Ui, model: &dyn Model, timeline: Option<&Timeline>) {
    if let Some(timeline) = timeline
        && let Some((spec, value)) = model.values().find(timeline.param)
    {
        let last = timeline.last.max(0.0);
        if last == 0.0 {
            return;
        }
        // A position beyond the end means the current end.
        let value = value.min(last);
        // Not split: if it does not fit beside the buttons, it moves below them.
        let words = format!("{} {value:.0} of {last:.0}", spec.label);
        ui.add(Label::new(words).extend()).on_hover_text(spec.help);
    }
}

fn scrubber(
    ui: &mut Ui,
    spec: &'static ParamSpec,
    timeline: &Timeline,
    value: f64,
    theme: Theme,
    hot: &mut HitAreas,
) -> Option<f64> {
    let last = timeline.last.max(0.0);
    let value = value.min(last);
    let size = vec2(ui.available_width(), 30.0);
    let (rect, mut response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    hot.control(spec.id, &response);
    hot.drag(&response);
    let rail = Rect::from_min_max(
        pos2(rect.left() + THUMB, rect.center().y - 2.5),
        pos2(rect.right() - THUMB, rect.center().y + 2.5),
    );
    let x_of = |at: f64| rail.left() + rail.width() * (at / last.max(1.0)).clamp(0.0, 1.0) as f32;

    let new = new_position(ui, &response, rail, value, last);
    response = response.on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
    response.widget_info(|| WidgetInfo::slider(true, value, spec.label));
    paint(
        ui,
        rail,
        timeline,
        x_of(new.unwrap_or(value)),
        &x_of,
        theme,
        &response,
    );

    if let Some(pointer) = response.hover_pos() {
        let near = timeline
            .marks
            .iter()
            .map(|mark| (mark, (x_of(mark.at) - pointer.x).abs()))
            .filter(|(_, distance)| *distance <= MARK_REACH)
            .min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((mark, _)) = near {
            response.on_hover_text_at_pointer(&mark.label);
        }
    }
    new
}

/// The position chosen by pointer or keys.
fn new_position(ui: &Ui, response: &Response, rail: Rect, value: f64, last: f64) -> Option<f64> {
    let mut new = value;
    let button = PrimaryButton::in_this_frame(ui);
    let pressed =
        response.is_pointer_button_down_on() || response.clicked() || response.drag_stopped();
    let pointer = if button.is_flick_on(ui, response) {
        button.released_at
    } else {
        response.interact_pointer_pos().filter(|_| pressed)
    };
    if let Some(pointer) = pointer {
        let share = f64::from((pointer.x - rail.left()) / rail.width());
        new = (share * last).round();
    }
    if response.has_focus() {
        let keys = |key: Key| ui.input(|input| input.num_presses(key)) as f64;
        new += keys(Key::ArrowRight) + keys(Key::ArrowUp);
        new -= keys(Key::ArrowLeft) + keys(Key::ArrowDown);
    }
    new = new.clamp(0.0, last);
    (new != value).then_some(new)
}

fn paint(
    ui: &Ui,
    rail: Rect,
    timeline: &Timeline,
    thumb_x: f32,
    x_of: &dyn Fn(f64) -> f32,
    theme: Theme,
    response: &Response,
) {
    let painter = ui.painter();
    let visuals = ui.visuals();
    let paper = palette::tone(theme, Tone::Paper);
    let ink = palette::tone(theme, Tone::Ink);
    painter.rect_filled(rail, 2.5, color(mix(paper, ink, 0.2)));
    let done = Rect::from_min_max(rail.min, pos2(thumb_x, rail.max.y));
    painter.rect_filled(done, 2.5, visuals.selection.bg_fill);
    for mark in &timeline.marks {
        let x = painter.round_to_pixel_center(x_of(mark.at));
        let stroke = Stroke::new(2.0, color(palette::standing(theme, mark.standing)));
        // Good events are above the rail, bad and doubtful ones below it, in addition to their colour.
        let (top, bottom) = match mark.standing {
            Assessment::Good => (rail.top() - 9.0, rail.bottom()),
            Assessment::Bad | Assessment::Doubtful => (rail.top(), rail.bottom() + 9.0),
            Assessment::Neutral => (rail.top() - 4.0, rail.bottom() + 4.0),
        };
        painter.line_segment([pos2(x, top), pos2(x, bottom)], stroke);
    }
    let border = ui.style().interact(response).fg_stroke;
    painter.circle(
        pos2(thumb_x, rail.center().y),
        8.0,
        color(paper),
        Stroke::new(2.0, border.color),
    );
}
