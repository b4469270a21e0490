//! The picture of a widget on egui: its panels, their handles and the pointer. The controls, the verdict and all other
//! text are the host's, drawn from [`crate::spec::WidgetSpec`] and [`crate::controls::shown`].

mod first_act;
mod room;
mod stage;

use egui::{Pos2, Rect, Ui, vec2};
use web_time::{Duration, Instant};

use crate::audit::{label_faults, text_faults};
use crate::egui_surface::{Textures, color};
use crate::model::{Activity, Model, Motion, shown_scene, text_alternative};
use crate::palette::{self, Theme};
use crate::param::ParamError;
use crate::pointer::{Pointer, TOUCH_REACH_PX};
use crate::scene::{Aspect, Scene, Tone};
use crate::spec::{Awaits, PLAY};
use crate::surface::PxRect;
use crate::svg::picture_svg;
use crate::transform::Transform;
use crate::view::{MARGIN, View};
use crate::zoom::Look;
use first_act::FirstAct;

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
    view: View,
    theme: Theme,
    /// The model's picture at its last change.
    scene: Scene,
    /// Number of changes of `scene`.
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
    content_height: f32,
    /// Height of the part above the plots that More opens, in points.
    stage_height: f32,
    /// Height that stays free between the two for the host's controls, in points.
    gap: f32,
    /// Available height for the picture, in points.
    room: f32,
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

impl Shell {
    /// Creates a widget from its two halves.
    #[must_use]
    pub fn new(model: Box<dyn Model>, view: View) -> Self {
        Self {
            scene: shown_scene(model.as_ref()),
            model,
            view,
            theme: Theme::default(),
            revision: 0,
            stale: false,
            moving: Moving::Perhaps,
            working: true,
            changed: false,
            changes_until_s: 0.0,
            pointer: Pointer::default(),
            panels: Vec::new(),
            textures: Textures::default(),
            content_height: 0.0,
            stage_height: 0.0,
            gap: 0.0,
            room: f32::INFINITY,
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
        self.settle(Duration::MAX)
    }

    /// Does pending work for about that long, see [`Model::settle`]. Returns whether there was any.
    pub fn settle(&mut self, budget: Duration) -> bool {
        let start = Instant::now();
        let mut settled = false;
        while start.elapsed() < budget && self.model.settle().is_busy() {
            settled = true;
        }
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

    /// Height of the part above the plots that More opens; without such plots, the whole height.
    #[must_use]
    pub fn stage_height(&self) -> f32 {
        self.stage_height
    }

    /// Sets the height in points that stays free above the plots that More opens: the controls do not move.
    pub fn set_gap(&mut self, height: f32) {
        if self.gap != height {
            self.gap = height;
            self.stale = true;
        }
    }

    /// Sets the available height in points; the plots of the stage shrink to fit.
    pub fn set_room(&mut self, height: f32) {
        self.room = height;
    }

    /// Sets light or dark.
    pub fn set_theme(&mut self, theme: Theme) {
        self.theme = theme;
    }

    /// Records that the reader has acted: the verdict takes the place of the gesture, and the picture shows the answer.
    pub fn act(&mut self) {
        self.first.is_over = true;
        self.model.reveal();
        self.touch();
    }

    /// Whether the reader has acted, see [`Shell::act`].
    #[must_use]
    pub fn has_acted(&self) -> bool {
        self.first.is_over
    }

    /// Whether the gesture stands in place of the verdict: until the reader acts, and while the verdict waits for a
    /// run; never with everything open.
    #[must_use]
    pub fn asks(&self) -> bool {
        let waits = match self.model.spec().awaits {
            Awaits::Nothing => false,
            Awaits::Rest => {
                self.model.is_pressed(PLAY.id) || self.pointer.holds_back(self.model.as_ref())
            }
            Awaits::End => !self.model.is_at_end(),
        };
        (waits || !self.has_acted()) && !self.model.disclosure().is_all()
    }

    /// The text alternative of the picture, with the question or the result.
    #[must_use]
    pub fn summary(&self) -> String {
        text_alternative(self.model(), self.asks())
    }

    /// Sets whether animations run.
    pub fn set_motion(&mut self, motion: Motion) {
        self.first.motion = motion;
        self.model.set_motion(motion);
        self.touch();
    }

    /// Zooms or moves every map, like ctrl and the wheel, without a pointer.
    pub fn look(&mut self, look: Look) {
        for panel in &self.scene.panels {
            self.pointer.zoom.look(panel, look);
        }
    }

    /// Whether something draggable is at that position: a touch that starts elsewhere scrolls the page.
    #[must_use]
    pub fn drags_at(&self, pos: Pos2) -> bool {
        self.panels.iter().any(|(panel, to)| {
            let px = [pos.x, pos.y];
            let reach = to.units_per_px().map(|units| TOUCH_REACH_PX * units);
            let is_grabbed = || self.model.grab(panel, to.from_px(px), reach).is_some();
            to.plot().contains(px) && (self.pointer.zoom.is_zoomed(panel) || is_grabbed())
        })
    }

    /// Whether a picture that zooms is at that position: elsewhere ctrl and the wheel zoom the page.
    #[must_use]
    pub fn zooms_at(&self, pos: Pos2) -> bool {
        let mut panels = self.panels.iter();
        let panel = panels.find(|(_, to)| to.plot().contains([pos.x, pos.y]));
        panel.is_some_and(|(id, _)| {
            let scene = &self.scene;
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

    /// The effect of the handle under the pointer, see [`Pointer::handle`].
    #[must_use]
    pub fn handle(&self) -> Option<&'static str> {
        self.pointer.handle()
    }

    /// Whether a map is zoomed.
    #[must_use]
    pub fn is_zoomed(&self) -> bool {
        self.scene
            .panels
            .iter()
            .any(|panel| self.pointer.zoom.is_zoomed(panel.id))
    }

    /// The rectangle of the first panel in the last frame, which a host keeps in view while a control moves.
    #[must_use]
    pub fn scene_rect(&self) -> Option<PxRect> {
        Some(self.panels.first()?.1.plot())
    }

    /// Ends all drags after a cancelled touch.
    pub fn release_drags(&mut self) {
        self.pointer.cancel(self.model.as_mut());
        self.touch();
    }

    /// The static picture of the current state.
    #[must_use]
    pub fn picture_svg(&self, width_px: f32, theme: Theme) -> String {
        picture_svg(self.model.as_ref(), self.view, width_px, theme)
    }

    /// Faults of the texts in that picture, see [`crate::audit`].
    #[must_use]
    pub fn text_faults(&self, width_px: f32) -> Vec<String> {
        text_faults(self.model.as_ref(), self.view, width_px)
    }

    /// Overlapping texts over the data of that picture.
    #[must_use]
    pub fn label_faults(&self, width_px: f32) -> Vec<String> {
        label_faults(self.model.as_ref(), self.view, width_px)
    }

    /// Whether another frame is needed without further input.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.moving != Moving::No || self.working || self.stale || self.first.is_pulsing()
    }

    /// Draws the picture into the available width.
    pub fn ui(&mut self, ui: &mut Ui) {
        let paper = color(palette::tone(self.theme, Tone::Paper));
        ui.painter().rect_filled(ui.clip_rect(), 0.0, paper);
        self.advance(ui);
        self.panels.clear();
        let whole = ui.available_rect_before_wrap();
        let width = (whole.width() - 2.0 * MARGIN).max(200.0);
        let at = [whole.left() + MARGIN, whole.top() + MARGIN];
        let (reserved, height) = self.reserve(ui, at, width);

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
        self.first.paint(ui, &self.scene, &self.panels, self.theme);
        self.content_height = height + 2.0 * MARGIN;
        let size = vec2(whole.width(), self.content_height);
        ui.allocate_rect(Rect::from_min_size(whole.min, size), egui::Sense::hover());
        if self.is_busy() {
            ui.ctx().request_repaint();
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
                // The end of a run may call for work.
                self.working = true;
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
            self.scene = shown_scene(self.model());
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
}
