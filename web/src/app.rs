//! A widget as an eframe app, and the events that eframe has to leave to the page.

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::rc::Rc;

use egui::{Event, Pos2, RawInput, Rect, TouchPhase, vec2};
use widget_kit::palette::{self, Theme};
use widget_kit::scene::Tone;
use widget_kit::shell::Shell;

/// State shared by the app and the JavaScript handle.
pub struct Shared {
    /// The widget.
    pub shell: RefCell<Shell>,
    /// egui's context while the widget runs.
    pub ctx: RefCell<Option<egui::Context>>,
    /// Light or dark.
    pub theme: Cell<Theme>,
    /// CSS pixels per point: how much larger than usual the page's text is.
    pub scale: Cell<f32>,
    /// Number of laid out frames since the start.
    pub frames: Cell<u32>,
    /// Whether the pointer was pressed on something draggable.
    pub dragging: Cell<bool>,
    /// The position of the pointer over the canvas.
    pub pointer: Cell<Option<Pos2>>,
    /// Whether a touch was cancelled, which egui does not report.
    pub cancelled: Cell<bool>,
    /// Whether the reader pressed on the map of a full-size map widget and the pointer is still on it.
    pub engaged: Cell<bool>,
}

/// Wheel movement in points that doubles or halves the zoom.
const WHEEL_DOUBLES: f32 = 240.0;
/// Points per line, for wheels that count in lines.
const LINE_POINTS: f32 = 40.0;

impl Shared {
    /// Whether something draggable is at that position; false during exclusive access to the widget.
    pub fn drags_at(&self, pos: Pos2) -> bool {
        self.shell
            .try_borrow()
            .is_ok_and(|shell| shell.drags_at(pos))
    }

    /// Whether the wheel belongs to the map there, after a press on a full-size map widget.
    fn is_on_map(&self, pos: Pos2) -> bool {
        self.shell.try_borrow().is_ok_and(|shell| {
            let map = shell.scene_rect().filter(|_| shell.model().takes_files());
            map.is_some_and(|map| map.contains([pos.x, pos.y]))
        })
    }

    /// Whether a picture that zooms is under the pointer.
    fn zooms(&self) -> bool {
        let shell = self.shell.try_borrow();
        let at = self.pointer.get();
        shell.is_ok_and(|shell| at.is_some_and(|at| shell.zooms_at(at)))
    }

    /// Points in CSS pixels.
    pub fn to_css<const N: usize>(&self, points: [f32; N]) -> [f32; N] {
        points.map(|point| self.scale.get() * point)
    }

    /// Requests a frame if the widget runs.
    pub fn request_repaint(&self) {
        if let Some(ctx) = &*self.ctx.borrow() {
            ctx.request_repaint();
        }
    }
}

/// The adapter.
pub struct WidgetApp {
    shared: Rc<Shared>,
}

impl WidgetApp {
    /// Prepares egui for the widget.
    pub fn new(ctx: &egui::Context, shared: Rc<Shared>) -> Self {
        crate::fonts::install(ctx);
        // egui must not follow the system's theme, because the page sets it.
        apply_theme(ctx, shared.theme.get());
        shared.shell.borrow_mut().set_theme(shared.theme.get());
        ctx.set_zoom_factor(shared.scale.get());
        *shared.ctx.borrow_mut() = Some(ctx.clone());
        Self { shared }
    }
}

/// The theme of that name; any other name is light.
pub fn theme_of(name: &str) -> Theme {
    match name {
        "dark" => Theme::Dark,
        _ => Theme::Light,
    }
}

/// Sets the theme of egui's own widgets.
pub fn apply_theme(ctx: &egui::Context, theme: Theme) {
    ctx.set_theme(match theme {
        Theme::Light => egui::Theme::Light,
        Theme::Dark => egui::Theme::Dark,
    });
}

/// Lays out a widget without a canvas. Returns its height in points.
pub fn height_at(ctx: &egui::Context, shell: &mut Shell, width: f32) -> f32 {
    let input = RawInput {
        screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(width, 1e4))),
        ..Default::default()
    };
    // egui knows the sizes of some widgets only after drawing them.
    for _ in 0..2 {
        let _ = ctx.run_ui(input.clone(), |ui| shell.ui(ui));
    }
    shell.content_height()
}

impl eframe::App for WidgetApp {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        self.shared.frames.set(self.shared.frames.get() + 1);
        ui.ctx().set_zoom_factor(self.shared.scale.get());
        self.shared.shell.borrow_mut().ui(ui);
    }

    fn clear_color(&self, _visuals: &egui::Visuals) -> [f32; 4] {
        let [red, green, blue] = palette::tone(self.shared.theme.get(), Tone::Paper);
        egui::Color32::from_rgb(red, green, blue).to_normalized_gamma_f32()
    }

    fn raw_input_hook(&mut self, ctx: &egui::Context, input: &mut RawInput) {
        if self.shared.engaged.get() {
            input.events.iter_mut().for_each(zoom_by_wheel);
        }
        input.events.retain(|event| !scrolls_page(event));
        let touch_cancelled = input.events.iter().any(|event| {
            matches!(
                event,
                Event::Touch {
                    phase: TouchPhase::Cancel,
                    ..
                }
            )
        });
        if touch_cancelled || self.shared.cancelled.take() {
            ctx.stop_dragging();
            release_pointer(input);
            self.shared.dragging.set(false);
            self.shared.shell.borrow_mut().release_drags();
        }
    }

    fn persist_egui_memory(&self) -> bool {
        false
    }

    fn as_any_mut(&mut self) -> Option<&mut dyn Any> {
        Some(self)
    }
}

/// Whether an event scrolls the page: the plain wheel does; with ctrl it zooms the view.
fn scrolls_page(event: &Event) -> bool {
    matches!(event, Event::MouseWheel { modifiers, .. } if !modifiers.ctrl && !modifiers.command)
}

/// Converts a turn of the plain wheel into a zoom.
fn zoom_by_wheel(event: &mut Event) {
    if !scrolls_page(event) {
        return;
    }
    let Event::MouseWheel { unit, delta, .. } = event else {
        return;
    };
    let points = match unit {
        egui::MouseWheelUnit::Point => delta.y,
        _ => LINE_POINTS * delta.y,
    };
    *event = Event::Zoom((points / WHEEL_DOUBLES).exp2());
}

/// Releases far outside, so that it is not a click.
fn release_pointer(input: &mut RawInput) {
    let nowhere = Pos2::new(-1e4, -1e4);
    input.events.push(Event::PointerMoved(nowhere));
    input.events.push(Event::PointerButton {
        pos: nowhere,
        button: egui::PointerButton::Primary,
        pressed: false,
        modifiers: egui::Modifiers::NONE,
    });
    input.events.push(Event::PointerGone);
}

/// eframe's options for a widget on a page of other things.
pub fn web_options(shared: &Rc<Shared>) -> eframe::WebOptions {
    let shared = Rc::clone(shared);
    eframe::WebOptions {
        should_stop_propagation: Box::new(|_| false),
        should_prevent_default: Box::new(move |event| is_ours_alone(&shared, event)),
        dithering: false,
        ..Default::default()
    }
}

/// Whether the browser's default action for an event has to be prevented.
fn is_ours_alone(shared: &Shared, event: &Event) -> bool {
    match event {
        // Over a picture that zooms it is the picture's, elsewhere the page's.
        Event::Zoom(_) | Event::Rotate(_) => shared.zooms(),
        Event::MouseWheel { modifiers, .. } => {
            shared.engaged.get() || ((modifiers.ctrl || modifiers.command) && shared.zooms())
        }
        // A touch scrolls the page unless it starts on something draggable.
        Event::PointerButton { pos, pressed, .. } => {
            shared.pointer.set(Some(*pos));
            shared.engaged.set(shared.is_on_map(*pos));
            let was_dragging = shared.dragging.get();
            shared.dragging.set(*pressed && shared.drags_at(*pos));
            was_dragging || shared.dragging.get()
        }
        Event::PointerMoved(pos) => {
            shared.pointer.set(Some(*pos));
            let is_on_map = shared.engaged.get() && shared.is_on_map(*pos);
            shared.engaged.set(is_on_map);
            shared.dragging.get()
        }
        Event::PointerGone => {
            shared.pointer.set(None);
            shared.engaged.set(false);
            shared.dragging.get()
        }
        Event::Touch { .. } => shared.dragging.get(),
        _ => false,
    }
}
