//! Edits of the flat: by the pointer, by buttons, by a link and by a file.

use ch16_lab::lap::BuiltInWorld;
use pr_sim::{Course, Sketch};
use widget_kit::model::Handle;
use widget_kit::param::{ParamError, printable};

use super::FullLap;
use super::floor_plan::{
    Kept, PencilDrag, add_wall, add_way_point, is_own, new_wall, new_way_point,
};
use super::grid::snapped;
use super::panel;
use super::pick::PickDirection;
use super::picture;
use super::plan_element::PlanElement;
use crate::w16_2_full_lap::spec::{EDIT, FLAT, SPEC, Tool, WORLD};

/// The file name of a saved flat.
const FILE_NAME: &str = "flat.json";

/// Handles of parts that do not exist yet.
const DRAW: &str = "draw";
const PLACE: &str = "place";

impl FullLap {
    /// The course of the reader's own flat, if it is selected and can be driven.
    pub(super) fn own_course(&self) -> Option<&Course> {
        let course = self.floor_plan.course.as_ref().ok();
        course.filter(|_| is_own(&self.values))
    }

    /// Handles a change of the value of `world`.
    pub(super) fn world_chosen(&mut self, before: Option<BuiltInWorld>) {
        let sketch = self.floor_plan.sketch.clone();
        self.floor_plan.remember(Kept {
            world: before,
            sketch,
        });
        match self.values.get(&WORLD) {
            None => self.take(self.floor_plan.sketch.clone()),
            Some(world) => self.leave_own(world),
        }
    }

    /// Selects a built-in world.
    fn leave_own(&mut self, world: BuiltInWorld) {
        self.values.store(FLAT.id, 0.0);
        self.floor_plan
            .become_of(Sketch::from_course(&world.course()));
        self.recompute();
    }

    /// Sets a flat from a link; without one, drawing starts from the Apartment.
    pub(super) fn set_flat(&mut self, text: &str) -> Result<(), ParamError> {
        let (param, _) = self.values.find_for(SPEC.id, "flat")?;
        param.parse(text)?;
        let text = text.trim();
        if text == self.values.to_text("flat") || (text.is_empty() && !is_own(&self.values)) {
            return Ok(());
        }
        let sketch = if text.is_empty() {
            Sketch::from_course(&Course::apartment())
        } else {
            Sketch::from_text(text).map_err(|error| ParamError::Rejected {
                id: param.id,
                problem: error.to_string(),
            })?
        };
        self.take(sketch);
        Ok(())
    }

    /// Replaces the world by another flat.
    fn take(&mut self, sketch: Sketch) {
        let text = sketch.to_text();
        if let Err(error) = self.values.set_text(SPEC.id, "flat", &text) {
            panic!("the edited floor plan is invalid: {error}");
        }
        self.values.put(&WORLD, None);
        self.floor_plan.become_of(sketch);
        self.recompute();
    }

    /// Replaces it by an edit of the reader, which can be undone; the lap is shown to its end.
    fn draw(&mut self, sketch: Sketch) {
        if sketch == self.floor_plan.sketch {
            return;
        }
        self.floor_plan.remember(self.kept());
        self.playback.pause();
        self.floor_plan.follows = true;
        self.take(sketch);
    }

    fn kept(&self) -> Kept {
        Kept {
            world: self.values.get(&WORLD),
            sketch: self.floor_plan.sketch.clone(),
        }
    }

    fn choose(&mut self, piece: Option<PlanElement>) {
        PlanElement::put(piece, &mut self.values);
    }

    /// The selected piece, if it exists in the flat.
    pub(super) fn piece(&self) -> Option<PlanElement> {
        PlanElement::chosen(&self.values, &self.floor_plan.sketch)
    }

    /// Reports why an edit was rejected.
    fn reject(&mut self, why: impl Into<String>) {
        self.floor_plan.note = Some(why.into());
    }

    /// Handles the buttons of the flat. Returns whether the button is one of them.
    pub(super) fn press_flat(&mut self, id: &str) -> bool {
        self.floor_plan.note = None;
        match id {
            "edit-flat" => {
                let is_off = self.values.get(&EDIT).is_none();
                self.playback.pause();
                // The wall tool is selected, so a drag draws at once.
                self.values.put(&EDIT, is_off.then_some(Tool::Wall));
            }
            "piece-back" => self.step_piece(PickDirection::Back),
            "piece-on" => self.step_piece(PickDirection::On),
            "west" => self.nudge([-1, 0]),
            "east" => self.nudge([1, 0]),
            "north" => self.nudge([0, 1]),
            "south" => self.nudge([0, -1]),
            "remove" => self.remove_piece(),
            "add-wall" => {
                let wall = new_wall(&self.floor_plan.sketch);
                let mut sketch = self.floor_plan.sketch.clone();
                let added = add_wall(&mut sketch, wall).map(PlanElement::Wall);
                self.added(sketch, added);
            }
            "add-way-point" => {
                let behind = self.chosen_way_point();
                let at = new_way_point(&self.floor_plan.sketch, behind);
                let mut sketch = self.floor_plan.sketch.clone();
                let added = add_way_point(&mut sketch, behind, at).map(PlanElement::WayPoint);
                self.added(sketch, added);
            }
            "turn-here" => self.mark_revisit_start(),
            "take-back" => {
                let before = self.floor_plan.back(self.kept());
                self.restore(before, "nothing to undo");
            }
            "do-again" => {
                let after = self.floor_plan.again(self.kept());
                self.restore(after, "nothing to redo");
            }
            "open-flat" => self.floor_plan.orders.push("open-text .json".to_owned()),
            "save-flat" => {
                let json = self.floor_plan.sketch.to_json();
                let order = format!("save-text {FILE_NAME}\n{json}");
                self.floor_plan.orders.push(order);
            }
            _ => return false,
        }
        true
    }

    fn step_piece(&mut self, step: PickDirection) {
        let piece = PlanElement::stepped(self.piece(), step, &self.floor_plan.sketch);
        self.choose(piece);
    }

    fn chosen_way_point(&self) -> Option<usize> {
        match self.piece() {
            Some(PlanElement::WayPoint(index)) => Some(index),
            _ => None,
        }
    }

    fn nudge(&mut self, by: [i32; 2]) {
        let Some(piece) = self.piece() else {
            self.reject("nothing is selected: select a wall, an end or a waypoint first");
            return;
        };
        match piece.nudged(&self.floor_plan.sketch, by) {
            Some(sketch) => self.draw(sketch),
            None => self.reject("a wall needs two different ends"),
        }
    }

    fn remove_piece(&mut self) {
        let Some(piece) = self.piece() else {
            self.reject("nothing is selected: select a wall or a waypoint first");
            return;
        };
        match piece.removed(&self.floor_plan.sketch) {
            Ok(sketch) => {
                self.draw(sketch);
                // The next one of its kind takes its index.
                let left = piece.count(&self.floor_plan.sketch);
                if piece.index() >= left {
                    self.choose(PlanElement::stepped(
                        None,
                        PickDirection::Back,
                        &self.floor_plan.sketch,
                    ));
                }
            }
            Err(why) => self.reject(why),
        }
    }

    fn added(&mut self, sketch: Sketch, added: Result<PlanElement, String>) {
        match added {
            Ok(piece) => {
                self.draw(sketch);
                self.choose(Some(piece));
            }
            Err(why) => self.reject(why),
        }
    }

    /// Revisits start from the selected waypoint; if they do already, the mark is removed.
    fn mark_revisit_start(&mut self) {
        let Some(index) = self.chosen_way_point() else {
            self.reject(
                "no waypoint is selected: select where the robot starts to revisit known places",
            );
            return;
        };
        let mut sketch = self.floor_plan.sketch.clone();
        sketch.turn = (sketch.turn != Some(index)).then_some(index);
        self.draw(sketch);
    }

    fn restore(&mut self, kept: Option<Kept>, otherwise: &str) {
        let Some(Kept { world, sketch }) = kept else {
            self.reject(otherwise);
            return;
        };
        self.floor_plan.follows = true;
        match world {
            None => self.take(sketch),
            Some(built_in) => {
                self.values.put(&WORLD, world);
                self.leave_own(built_in);
            }
        }
    }

    /// Opens a file of the reader.
    pub(super) fn open_flat(&mut self, name: &str, text: &[u8]) {
        match Sketch::from_json(text) {
            Ok(sketch) => self.draw(sketch),
            Err(error) => self.reject(format!("{} cannot be driven: {error}", printable(name))),
        }
    }

    /// What a press on the map grabs with a tool.
    pub(super) fn grab_flat(&self, tool: Tool, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
        let under = self.piece_under(tool, at, reach);
        let new = |id| Handle {
            panel: panel::MAP,
            id,
            offset: [0.0; 2],
            ..Handle::default()
        };
        match tool {
            Tool::Move => under.map(PlanElement::handle),
            Tool::Wall => Some(new(DRAW)),
            Tool::Way => Some(match under {
                Some(
                    piece @ (PlanElement::WayPoint(_) | PlanElement::Start | PlanElement::Heading),
                ) => piece.handle(),
                _ => new(PLACE),
            }),
            Tool::Remove => None,
            // A press beside everything sets it down there.
            Tool::Robot => Some(under.unwrap_or(PlanElement::Start).handle()),
        }
    }

    /// The tool that applies to a panel.
    pub(super) fn tool_on(&self, name: &str) -> Option<Tool> {
        self.values.get(&EDIT).filter(|_| name == panel::MAP)
    }

    /// The piece under the pointer; the selected one first if several overlap.
    fn piece_under(&self, tool: Tool, at: [f64; 2], reach: [f64; 2]) -> Option<PlanElement> {
        let sketch = &self.floor_plan.sketch;
        let accepts = |piece: &PlanElement| tool != Tool::Robot || !piece.is_of_wall();
        let chosen = self.piece().filter(accepts).filter(|piece| {
            let place = piece.place(sketch);
            let is_near = (0..2).all(|axis| (place[axis] - at[axis]).abs() <= reach[axis]);
            is_near && !matches!(piece, PlanElement::Wall(_))
        });
        chosen.or_else(|| PlanElement::at(sketch, at, reach, accepts))
    }

    /// Continues or starts a stroke. Returns whether the handle is one of the flat's.
    pub(super) fn stroke(&mut self, handle: Handle, at: [f64; 2]) -> bool {
        let held = PlanElement::held(handle);
        if handle.panel != panel::MAP || (held.is_none() && ![DRAW, PLACE].contains(&handle.id)) {
            return false;
        }
        if self.floor_plan.stroke.as_ref().map(|stroke| stroke.handle) != Some(handle) {
            self.begin_stroke(handle, at, held);
        }
        let Some(stroke) = &self.floor_plan.stroke else {
            return true;
        };
        let before = &stroke.before.sketch;
        let after = match (handle.id, stroke.piece) {
            (DRAW, _) => {
                let [from, to] = [snapped(stroke.from), snapped(at)];
                let mut sketch = before.clone();
                let added = (from != to).then(|| add_wall(&mut sketch, [from, to]));
                match added {
                    Some(Err(why)) => return self.end_rejected(&why),
                    Some(Ok(index)) => Some((sketch, PlanElement::Wall(index))),
                    None => None,
                }
            }
            (PLACE, _) => {
                let mut sketch = before.clone();
                let behind = self.chosen_before_stroke();
                match add_way_point(&mut sketch, behind, snapped(at)) {
                    Err(why) => return self.end_rejected(&why),
                    Ok(index) => Some((sketch, PlanElement::WayPoint(index))),
                }
            }
            (_, Some(piece)) => piece
                .dragged(before, stroke.from, at)
                .map(|sketch| (sketch, piece)),
            (_, None) => None,
        };
        self.show_stroke(after);
        true
    }

    fn begin_stroke(&mut self, handle: Handle, at: [f64; 2], held: Option<PlanElement>) {
        self.floor_plan.frame = Some(picture::map_bounds(&self.moment()));
        self.floor_plan.note = None;
        // A waypoint is inserted after the selected one.
        let piece = match handle.id {
            PLACE => self.piece(),
            _ => held,
        };
        self.floor_plan.stroke = Some(PencilDrag {
            handle,
            from: at,
            before: self.kept(),
            piece,
        });
        if held.is_some() {
            self.choose(held);
        }
    }

    fn chosen_before_stroke(&self) -> Option<usize> {
        match self.floor_plan.stroke.as_ref()?.piece {
            Some(PlanElement::WayPoint(index)) => Some(index),
            _ => None,
        }
    }

    fn end_rejected(&mut self, why: &str) -> bool {
        self.reject(why);
        true
    }

    /// Shows the result of the stroke so far; one stroke is one change.
    fn show_stroke(&mut self, after: Option<(Sketch, PlanElement)>) {
        let Some((sketch, piece)) = after.filter(|(sketch, _)| *sketch != self.floor_plan.sketch)
        else {
            return;
        };
        if let Some(stroke) = &self.floor_plan.stroke {
            let before = stroke.before.clone();
            self.floor_plan.remember(before);
        }
        self.playback.pause();
        self.floor_plan.follows = true;
        self.take(sketch);
        self.choose(Some(piece));
    }

    /// A click or a tap with a tool.
    pub(super) fn tap_flat(&mut self, tool: Tool, at: [f64; 2], reach: [f64; 2]) {
        self.end_stroke();
        let under = self.piece_under(tool, at, reach);
        match tool {
            Tool::Move => self.choose(under),
            Tool::Remove => {
                self.choose(under);
                self.floor_plan.note = None;
                self.remove_piece();
            }
            Tool::Wall if self.floor_plan.note.is_none() => {
                self.reject("drag from one end of the wall to the other");
            }
            Tool::Wall | Tool::Way | Tool::Robot => {}
        }
    }

    /// The pointer was released.
    pub(super) fn end_stroke(&mut self) {
        self.floor_plan.stroke = None;
        self.floor_plan.frame = None;
    }
}

/// The state of the flat, for the picture and the texts.
pub(super) fn drawn(lap: &FullLap) -> Option<super::moment::Drawn<'_>> {
    let tool = lap.values.get(&EDIT);
    (tool.is_some() || is_own(&lap.values)).then(|| super::moment::Drawn {
        sketch: &lap.floor_plan.sketch,
        tool,
        piece: lap.piece().filter(|_| tool.is_some()),
        problem: lap
            .floor_plan
            .course
            .as_ref()
            .err()
            .filter(|_| is_own(&lap.values)),
        note: lap.floor_plan.note.as_deref(),
        frame: lap.floor_plan.frame,
    })
}
