//! The pointer over the panels: grab, drag, hover, zoom, pan.

use egui::{CursorIcon, Event, MultiTouchInfo, PointerButton, Pos2, Response, Sense, Ui};

use crate::model::{Handle, Model};
use crate::scene::{Layer, Panel};
use crate::spec::PLAY;
use crate::transform::Transform;
use crate::values::Values;
use crate::zoom::Zoom;

/// Distance within which a mouse grabs something, pixels.
pub const MOUSE_REACH_PX: f64 = 14.0;
/// Distance within which a finger grabs something, pixels.
pub const TOUCH_REACH_PX: f64 = 24.0;

/// The state of the pointer, and the zoom of each map.
#[derive(Clone, Debug, Default)]
pub struct Pointer {
    /// The zoom of each map.
    pub zoom: Zoom,
    held: Option<Held>,
    /// The values as the reader took hold.
    before: Option<Values>,
    /// Whether the last press was by touch.
    by_touch: bool,
    hovered: Option<(&'static str, [f64; 2])>,
    /// The handle under the pointer.
    handle: Option<&'static str>,
    /// Whether a press reached the model.
    pressed: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Held {
    Thing(Handle),
    /// A zoomed map, dragged so that this spot stays under the pointer.
    Map {
        panel: &'static str,
        spot: [f64; 2],
    },
}

/// The events of the primary button within a frame.
#[derive(Clone, Copy, Debug, Default)]
struct PrimaryButton {
    /// Where it was pressed.
    pressed_at: Option<Pos2>,
    /// Where it was released after that.
    released_at: Option<Pos2>,
    /// Whether it is a touch.
    is_touch: bool,
}

impl PrimaryButton {
    fn in_this_frame(ui: &Ui) -> Self {
        ui.input(|input| {
            let mut button = Self {
                is_touch: input.any_touches(),
                ..Self::default()
            };
            for event in &input.events {
                match event {
                    Event::PointerButton {
                        pos,
                        button: PointerButton::Primary,
                        pressed,
                        ..
                    } if *pressed => {
                        button.pressed_at = Some(*pos);
                        button.released_at = None;
                    }
                    Event::PointerButton {
                        pos,
                        button: PointerButton::Primary,
                        ..
                    } => button.released_at = Some(*pos),
                    Event::Touch { .. } => button.is_touch = true,
                    _ => {}
                }
            }
            button
        })
    }

    /// Whether a complete drag from `response` happened within the frame, which egui reports neither as a
    /// press nor as a click.
    fn is_flick_on(&self, ui: &Ui, response: &Response) -> bool {
        let (Some(from), Some(_)) = (self.pressed_at, self.released_at) else {
            return false;
        };
        let top = ui.ctx().layer_id_at(from);
        !response.clicked()
            && response.rect.contains(from)
            && top.is_none_or(|layer| layer == response.layer_id)
    }
}

/// Whether the pointer changed the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touched {
    /// The scene must be computed again.
    Yes,
    /// No change.
    No,
}

impl Pointer {
    /// Whether the reader has ever pressed, dragged or tapped something on a panel.
    #[must_use]
    pub fn has_pressed(&self) -> bool {
        self.pressed
    }

    /// The effect of the handle under the pointer, which the host shows.
    #[must_use]
    pub fn handle(&self) -> Option<&'static str> {
        self.handle
    }

    /// Ends every drag that is cancelled; nothing plays.
    pub fn cancel(&mut self, model: &mut dyn Model) {
        self.before = None;
        if let Some(Held::Thing(_)) = self.held.take() {
            model.release();
        }
    }

    /// Ends a drag where the reader lets go.
    fn release(&mut self, model: &mut dyn Model) {
        let before = self.before.take();
        let held = self.held;
        self.cancel(model);
        if let Some(Held::Thing(handle)) = held {
            let is_moved = before.is_some_and(|values| values != *model.values());
            if is_moved && model.plays_when_let_go(&handle) && !model.is_pressed(PLAY.id) {
                // Every widget plays.
                let _ = model.press(PLAY.id);
            }
        }
    }

    /// Whether a thing is held that plays the run when it is let go.
    #[must_use]
    pub fn holds_back(&self, model: &dyn Model) -> bool {
        let handle = match &self.held {
            Some(Held::Thing(handle)) => handle,
            _ => return false,
        };
        model.plays_when_let_go(handle)
    }

    /// Handles the pointer over one panel.
    pub fn panel(
        &mut self,
        ui: &Ui,
        panel: &Panel,
        to: &Transform,
        model: &mut dyn Model,
    ) -> Touched {
        let plot = to.plot();
        let rect = egui::Rect::from_min_size(
            egui::pos2(plot.left, plot.top),
            egui::vec2(plot.width, plot.height),
        );
        let response = ui.interact(rect, ui.scope_id().with(panel.id), Sense::click_and_drag());
        let pinch = ui.input(egui::InputState::multi_touch);
        let pressed = if let Some(pinch) = pinch {
            self.pinch(&pinch, panel, to);
            self.let_go_of(panel, model)
        } else {
            self.wheel(ui, &response, panel, to);
            self.press(ui, &response, panel, to, model)
        };
        let tapped = self.tap(&response, panel, to, model);
        self.pressed |= [pressed, tapped].contains(&Touched::Yes);
        let hovered = self.hover(ui, &response, panel, to, model);
        if [pressed, tapped, hovered].contains(&Touched::Yes) {
            Touched::Yes
        } else {
            Touched::No
        }
    }

    fn press(
        &mut self,
        ui: &Ui,
        response: &Response,
        panel: &Panel,
        to: &Transform,
        model: &mut dyn Model,
    ) -> Touched {
        let button = PrimaryButton::in_this_frame(ui);
        let is_down = response.is_pointer_button_down_on();
        let is_flick = button.is_flick_on(ui, response);
        if !is_down && !is_flick && self.panel_held() != Some(panel.id) {
            return Touched::No;
        }
        let world = |pos: Pos2| to.from_px([pos.x, pos.y]);
        // If frames are slow, the release may come after further movement within the same frame.
        let pos = if is_down {
            response.interact_pointer_pos()
        } else {
            button.released_at
        };
        let mut touched = Touched::No;
        if let Some(at) = pos.map(world) {
            let from = button.pressed_at.filter(|_| is_down || is_flick);
            if let Some(from) = from.map(world) {
                self.take_hold(panel, to, model, from, button.is_touch);
            }
            let moved = ui.input(|input| input.pointer.delta() != egui::Vec2::ZERO);
            if from.is_some() || moved {
                touched = self.pull(panel, model, at);
            }
        }
        if is_down {
            // In each frame, also in one without a movement: egui forgets the cursor after it.
            if self.panel_held() == Some(panel.id) {
                ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
            }
            return touched;
        }
        self.release(model);
        Touched::Yes
    }

    fn take_hold(
        &mut self,
        panel: &Panel,
        to: &Transform,
        model: &mut dyn Model,
        from: [f64; 2],
        is_touch: bool,
    ) {
        self.by_touch = is_touch;
        self.before = Some(model.values().clone());
        self.held = match model.grab(panel.id, from, reach(to, is_touch)) {
            Some(handle) => Some(Held::Thing(handle)),
            None if self.zoom.is_zoomed(panel.id) => Some(Held::Map {
                panel: panel.id,
                spot: from,
            }),
            None => None,
        };
    }

    fn pull(&mut self, panel: &Panel, model: &mut dyn Model, at: [f64; 2]) -> Touched {
        if self.panel_held() != Some(panel.id) {
            return Touched::No;
        }
        match self.held {
            Some(Held::Thing(handle)) => {
                model.drag(handle, at);
                Touched::Yes
            }
            Some(Held::Map { spot, .. }) => {
                let shift = [spot[0] - at[0], spot[1] - at[1]];
                self.zoom.shift(panel, shift);
                Touched::No
            }
            None => Touched::No,
        }
    }

    /// A press and release without movement.
    fn tap(
        &mut self,
        response: &Response,
        panel: &Panel,
        to: &Transform,
        model: &mut dyn Model,
    ) -> Touched {
        let Some(pos) = response
            .interact_pointer_pos()
            .filter(|_| response.clicked())
        else {
            return Touched::No;
        };
        let at = to.from_px([pos.x, pos.y]);
        model.tap(panel.id, at, reach(to, self.by_touch));
        Touched::Yes
    }

    fn hover(
        &mut self,
        ui: &Ui,
        response: &Response,
        panel: &Panel,
        to: &Transform,
        model: &mut dyn Model,
    ) -> Touched {
        let place = response
            .hover_pos()
            .filter(|_| self.held.is_none())
            .map(|pos| (panel.id, to.from_px([pos.x, pos.y])));
        let was_here = self.hovered.is_some_and(|(id, _)| id == panel.id);
        let can_grab = |(_, at)| model.grab(panel.id, at, reach(to, false)).is_some();
        if place.is_some_and(can_grab) {
            ui.ctx().set_cursor_icon(CursorIcon::Grab);
        }
        if place == self.hovered || (place.is_none() && !was_here) {
            return Touched::No;
        }
        model.hover(panel.id, place.map(|(_, at)| at));
        self.handle = place.and_then(|(_, at)| handle_label(panel, to, at));
        self.hovered = place;
        Touched::Yes
    }

    /// Zooms and pans by two fingers.
    ///
    /// A long press captures the pointer, and egui reports no other hovered widget. So the position of the
    /// fingers is not tested against the panel.
    fn pinch(&mut self, pinch: &MultiTouchInfo, panel: &Panel, to: &Transform) {
        let middle = [pinch.center_pos.x, pinch.center_pos.y];
        if !to.plot().contains(middle) {
            return;
        }
        self.zoom
            .by(panel, f64::from(pinch.zoom_delta), to.from_px(middle));
        let [across, up] = to.units_per_px();
        let moved = pinch.translation_delta;
        let shift = [-f64::from(moved.x) * across, f64::from(moved.y) * up];
        self.zoom.shift(panel, shift);
    }

    /// Ends the drag that the first finger may have started.
    fn let_go_of(&mut self, panel: &Panel, model: &mut dyn Model) -> Touched {
        if self.panel_held() != Some(panel.id) {
            return Touched::No;
        }
        self.cancel(model);
        Touched::Yes
    }

    /// Ctrl and the wheel zoom at the pointer; a double click resets the zoom.
    fn wheel(&mut self, ui: &Ui, response: &Response, panel: &Panel, to: &Transform) {
        if response.double_clicked() {
            self.zoom.reset(panel.id);
        }
        let factor = f64::from(ui.input(egui::InputState::zoom_delta));
        if let Some(pos) = response.hover_pos().filter(|_| factor != 1.0) {
            self.zoom.by(panel, factor, to.from_px([pos.x, pos.y]));
        }
    }

    fn panel_held(&self) -> Option<&'static str> {
        self.held.map(|held| match held {
            Held::Thing(handle) => handle.panel,
            Held::Map { panel, .. } => panel,
        })
    }
}

/// The reach of mouse or finger in units of the axes.
#[must_use]
pub fn reach(to: &Transform, touch: bool) -> [f64; 2] {
    let px = if touch {
        TOUCH_REACH_PX
    } else {
        MOUSE_REACH_PX
    };
    to.units_per_px().map(|units| px * units)
}

fn handle_label(panel: &Panel, to: &Transform, at: [f64; 2]) -> Option<&'static str> {
    let reach = reach(to, false);
    panel.layers.iter().rev().find_map(|layer| match layer {
        Layer::Handle {
            at: place, label, ..
        } if (0..2).all(|i| (place[i] - at[i]).abs() <= reach[i]) => Some(*label),
        _ => None,
    })
}
