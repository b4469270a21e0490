//! A complete widget on egui: texts, presets, panels, transport, controls, readouts, tables.

mod first_act;
mod parts;
mod room;
mod stage;

use egui::{Pos2, Rect, Ui, UiBuilder, pos2, vec2};
use web_time::{Duration, Instant};

use crate::audit::{label_faults, text_faults};
use crate::egui_surface::{Textures, color};
use crate::hit_areas::HitAreas;
use crate::model::{Activity, Model, Motion, Outcome, Table};
use crate::palette::{self, Theme};
use crate::param::ParamError;
use crate::pointer::{Pointer, TOUCH_REACH_PX};
use crate::scene::{Aspect, Scene, Tone};
use crate::style;
use crate::surface::PxRect;
use crate::svg::picture_svg;
use crate::transform::Transform;
use crate::view::View;
use crate::zoom::Look;
use first_act::FirstAct;
use room::Room;

/// Width from which controls and readouts are beside the panels.
const WIDE: f32 = 820.0;
/// Width of the controls beside the panels.
const SIDE_WIDTH: f32 = 300.0;
/// Space around everything.
const MARGIN: f32 = 12.0;
/// Space between blocks.
const GAP: f32 = 14.0;
/// Time budget of [`Model::work`] per frame during a drag or a series of external changes, which keeps the
/// picture responsive.
const WORK_WHILE_CHANGING: Duration = Duration::from_millis(4);
/// Duration for which more changes are expected after one, s: if drawing is slow, not every frame brings a
/// change.
const CHANGES_FOR_S: f64 = 0.2;
/// Time budget otherwise: a frame at 60 Hz has 16 ms. It does not grow if drawing is slow, because then the page
/// needs its thread most.
const WORK_AT_REST: Duration = Duration::from_millis(10);

/// A widget on egui: model, view, and the state between frames.
pub struct Shell {
    model: Box<dyn Model>,
    view: Box<dyn View>,
    theme: Theme,
    focus: Option<String>,
    shown: Shown,
    /// Number of changes of `shown`.
    revision: u64,
    stale: bool,
    moving: Moving,
    working: bool,
    /// Whether the model was changed since the last frame.
    changed: bool,
    /// Time until which more changes are expected, s of egui's clock.
    changes_until_s: f64,
    pointer: Pointer,
    panels: Vec<(&'static str, Transform)>,
    textures: Textures,
    hot: HitAreas,
    content_height: f32,
    room: Room,
    first: FirstAct,
}

/// Whether the model is animated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Moving {
    /// It reported that it is not.
    No,
    /// It was changed since; query it.
    Perhaps,
    /// It was at the last frame.
    Yes,
}

/// The model's output at its last change.
struct Shown {
    scene: Scene,
    outcome: Outcome,
    tables: Vec<Table>,
}

impl Shown {
    fn new(model: &dyn Model) -> Self {
        Self {
            scene: model.scene(),
            outcome: model.outcome(),
            tables: model.shown_tables(),
        }
    }
}

impl Shell {
    /// Creates a widget from its two halves.
    #[must_use]
    pub fn new(model: Box<dyn Model>, view: Box<dyn View>) -> Self {
        Self {
            shown: Shown::new(model.as_ref()),
            model,
            view,
            theme: Theme::default(),
            focus: None,
            revision: 0,
            stale: false,
            moving: Moving::Perhaps,
            working: true,
            changed: false,
            changes_until_s: 0.0,
            pointer: Pointer::default(),
            panels: Vec::new(),
            textures: Textures::default(),
            hot: HitAreas::default(),
            content_height: 0.0,
            room: Room::default(),
            first: FirstAct::default(),
        }
    }

    /// Shared access to the model.
    #[must_use]
    pub fn model(&self) -> &dyn Model {
        self.model.as_ref()
    }

    /// Mutable access to the model; the next frame updates the picture.
    pub fn model_mut(&mut self) -> &mut dyn Model {
        self.touch();
        self.model.as_mut()
    }

    /// Presses a button or a preset for the reader: nothing happens if it has nothing to do.
    ///
    /// # Errors
    /// [`ParamError::UnknownButton`]; the state does not change.
    pub fn press(&mut self, id: &str) -> Result<(), ParamError> {
        if self.model.is_enabled(id) {
            self.act();
            self.model.press(id)?;
        }
        Ok(())
    }

    /// The buttons that have nothing to do now, by name.
    #[must_use]
    pub fn disabled(&self) -> Vec<&'static str> {
        let buttons = self.model.spec().buttons.iter().map(|button| button.id);
        buttons.filter(|id| !self.model.is_enabled(id)).collect()
    }

    /// The widget's requests to its host, see [`Model::take_requests`]; the picture does not change.
    pub fn take_requests(&mut self) -> Vec<String> {
        self.model.take_requests()
    }

    /// Finishes pending work, see [`Model::finish_work`]. Returns whether there was any.
    pub fn finish_work(&mut self) -> bool {
        let settled = self.model.finish_work().is_busy();
        if settled {
            self.touch();
        }
        settled
    }

    /// Height at the width of the last [`Shell::ui`], in points.
    #[must_use]
    pub fn content_height(&self) -> f32 {
        self.content_height
    }

    /// Sets the available height in points; until the reader opens more, the plots of the scene shrink to
    /// fit.
    pub fn set_room(&mut self, height: f32) {
        self.room = Room::from_height(height);
    }

    /// Sets light or dark.
    pub fn set_theme(&mut self, theme: Theme) {
        self.theme = theme;
    }

    /// Records that the reader has acted: the verdict takes the place of the question.
    pub fn act(&mut self) {
        self.first.is_over = true;
        self.touch();
    }

    /// Whether the reader has acted, see [`Shell::act`].
    #[must_use]
    pub fn has_acted(&self) -> bool {
        self.first.is_over
    }

    /// Whether the question stands in place of the verdict.
    fn asks(&self) -> bool {
        !self.first.is_over && !self.model.disclosure().is_all()
    }

    /// Sets whether animations run.
    pub fn set_motion(&mut self, motion: Motion) {
        self.first.motion = motion;
        self.model.set_motion(motion);
        self.touch();
    }

    /// Draws a focus ring around the control that has the focus outside of egui.
    pub fn set_focus(&mut self, id: Option<&str>) {
        self.focus = id.map(str::to_owned);
    }

    /// Zooms or moves every map, like ctrl and the wheel, without a pointer.
    pub fn look(&mut self, look: Look) {
        for panel in &self.shown.scene.panels {
            self.pointer.zoom.look(panel, look);
        }
    }

    /// Whether something draggable is at that position: a touch that starts elsewhere scrolls the page.
    #[must_use]
    pub fn drags_at(&self, pos: Pos2) -> bool {
        self.hot.drags_at(pos)
            || self.panels.iter().any(|(panel, to)| {
                let px = [pos.x, pos.y];
                let reach = to.units_per_px().map(|units| TOUCH_REACH_PX * units);
                to.plot().contains(px) && self.model.grab(panel, to.from_px(px), reach).is_some()
            })
    }

    /// Whether a picture that zooms is at that position: elsewhere ctrl and the wheel zoom the page.
    #[must_use]
    pub fn zooms_at(&self, pos: Pos2) -> bool {
        let mut panels = self.panels.iter();
        let panel = panels.find(|(_, to)| to.plot().contains([pos.x, pos.y]));
        panel.is_some_and(|(id, _)| {
            let scene = &self.shown.scene;
            let shown = scene.panels.iter().find(|panel| panel.id == *id);
            shown.is_some_and(|panel| panel.aspect == Aspect::Equal)
        })
    }

    /// Screen position of a point in a panel's axes, in points.
    #[must_use]
    pub fn panel_to_screen(&self, panel: &str, at: [f64; 2]) -> Option<[f32; 2]> {
        let (_, to) = self.panels.iter().find(|(id, _)| *id == panel)?;
        Some(to.to_px(at))
    }

    /// The rectangle of a control in the last frame, so that a host can scroll to it.
    #[must_use]
    pub fn control_rect(&self, id: &str) -> Option<Rect> {
        self.hot.rect(id)
    }

    /// The rectangle of the first panel in the last frame, which a host keeps in view while a control moves.
    #[must_use]
    pub fn scene_rect(&self) -> Option<PxRect> {
        Some(self.panels.first()?.1.plot())
    }

    /// Ends all drags after a cancelled touch.
    pub fn release_drags(&mut self) {
        self.pointer.release(self.model.as_mut());
        self.touch();
    }

    /// The static picture of the current state.
    #[must_use]
    pub fn picture_svg(&self, width_px: f32, theme: Theme) -> String {
        let (model, view) = (self.model.as_ref(), self.view.as_ref());
        picture_svg(model, view, self.asks(), width_px, theme)
    }

    /// Faults of the texts in that picture, see [`crate::audit`].
    #[must_use]
    pub fn text_faults(&self, width_px: f32) -> Vec<String> {
        text_faults(self.model.as_ref(), self.view.as_ref(), width_px)
    }

    /// Overlapping texts over the data of that picture.
    #[must_use]
    pub fn label_faults(&self, width_px: f32) -> Vec<String> {
        label_faults(self.model.as_ref(), self.view.as_ref(), width_px)
    }

    /// Whether another frame is needed without further input.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.moving != Moving::No || self.working || self.stale || self.first.is_pulsing()
    }

    /// Draws everything into the available width.
    pub fn ui(&mut self, ui: &mut Ui) {
        ui.set_style(style::style(self.theme));
        let paper = color(palette::tone(self.theme, Tone::Paper));
        ui.painter().rect_filled(ui.clip_rect(), 0.0, paper);
        self.advance(ui);
        self.hot = HitAreas::default();
        self.panels.clear();

        let whole = ui.available_rect_before_wrap();
        let left = whole.left() + MARGIN;
        let width = (whole.width() - 2.0 * MARGIN).max(200.0);
        let mut y = self.block(ui, [left, whole.top() + MARGIN], width, Self::header);
        let mut reserved = Vec::new();
        let column = if width >= WIDE {
            let stage_width = width - SIDE_WIDTH - 2.0 * GAP;
            let side_left = left + width - SIDE_WIDTH;
            // Controls come first, so that their changes show in this frame.
            let side = self.block(ui, [side_left, y], SIDE_WIDTH, Self::side);
            let stage = self.stage(ui, [left, y], stage_width, &mut reserved);
            let notice = self.block(ui, [left, stage], stage_width, Self::notice);
            y = side.max(notice);
            notice
        } else {
            y = self.stage_narrow(ui, [left, y], width, &mut reserved);
            y = self.block(ui, [left, y], width, Self::notice);
            y
        };
        self.room.learn(width, column - whole.top() + MARGIN - GAP);

        let (now_s, pressed) = ui.input(|input| (input.time, input.pointer.any_down()));
        if core::mem::take(&mut self.changed) || pressed {
            self.changes_until_s = now_s + CHANGES_FOR_S;
        }
        self.work(if now_s < self.changes_until_s {
            WORK_WHILE_CHANGING
        } else {
            WORK_AT_REST
        });
        self.paint(ui, &reserved);
        self.first
            .paint(ui, &self.shown.scene, &self.panels, self.theme);
        self.ring(ui);
        self.content_height = y - whole.top() + MARGIN - GAP;
        ui.allocate_rect(
            Rect::from_min_size(whole.min, vec2(whole.width(), self.content_height)),
            egui::Sense::hover(),
        );
        if self.is_busy() {
            ui.ctx().request_repaint();
        }
    }

    /// Draws one block of egui widgets below `at`. Returns the vertical start of the next block.
    fn block(
        &mut self,
        ui: &mut Ui,
        at: [f32; 2],
        width: f32,
        contents: fn(&mut Self, &mut Ui),
    ) -> f32 {
        let room = Rect::from_min_size(pos2(at[0], at[1]), vec2(width, f32::INFINITY));
        let mut child = ui.new_child(UiBuilder::new().max_rect(room));
        child.set_max_width(width);
        contents(self, &mut child);
        let height = child.min_rect().height();
        if height > 0.0 {
            at[1] + height + GAP
        } else {
            at[1]
        }
    }

    fn advance(&mut self, ui: &Ui) {
        if self.moving != Moving::No {
            let elapsed_s = f64::from(ui.input(|input| input.stable_dt));
            let activity = self.model.advance(elapsed_s);
            // The last step of a run changes the picture although it already returns idle.
            self.stale |= activity == Activity::Busy || self.moving == Moving::Yes;
            self.moving = if activity.is_busy() {
                Moving::Yes
            } else {
                Moving::No
            };
        }
        self.refresh();
    }

    fn work(&mut self, budget: Duration) {
        let start = Instant::now();
        while self.working && start.elapsed() < budget {
            let activity = self.model.work();
            self.working = activity.is_busy();
            self.stale |= activity == Activity::Busy;
        }
    }

    /// Queries the model again if something changed.
    fn refresh(&mut self) {
        if self.stale {
            self.shown = Shown::new(self.model.as_ref());
            self.stale = false;
            self.revision += 1;
        }
    }

    /// Marks the model as possibly changed.
    fn touch(&mut self) {
        self.stale = true;
        self.working = true;
        self.changed = true;
        if self.moving == Moving::No {
            self.moving = Moving::Perhaps;
        }
    }

    fn ring(&self, ui: &Ui) {
        let rect = self.focus.as_deref().and_then(|id| self.hot.rect(id));
        if let Some(rect) = rect {
            ui.painter().rect_stroke(
                rect.expand(3.0),
                6.0,
                egui::Stroke::new(3.0, style::focus_color(self.theme)),
                egui::StrokeKind::Outside,
            );
        }
    }
}
