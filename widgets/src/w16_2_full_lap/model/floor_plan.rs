//! The reader's own flat: the drawing, the selection, and the undo history.
//!
//! A flat is a [`Sketch`], which need not be drivable during editing. Every change is recorded by
//! [`FloorPlan::remember`], so all of them can be undone.

use ch16_lab::lap::BuiltInWorld;
use pr_sim::sketch::{PlaceCm, limits, to_m};
use pr_sim::{Course, CourseError, Sketch};
use widget_kit::scene::Bounds;
use widget_kit::values::Values;

use super::grid::{moved, snapped};
use super::plan_element::PlanElement;
use crate::w16_2_full_lap::spec::WORLD;

/// Largest number of changes that can be undone.
const MAX_UNDO: usize = 200;

/// Length of a wall added by a button, cm.
const NEW_WALL_CM: i32 = 100;

/// Distance of a waypoint added by a button from the one before, cm.
const NEW_WAY_POINT_CM: i32 = 50;

/// A world in the undo history.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept {
    /// The value of `world`.
    pub world: Option<BuiltInWorld>,
    /// The drawing.
    pub sketch: Sketch,
}

/// A stroke under way.
pub struct PencilDrag {
    /// The grabbed handle.
    pub handle: widget_kit::model::Handle,
    /// The position of the press, m.
    pub from: [f64; 2],
    /// The flat before it.
    pub before: Kept,
    /// The moved piece; `None` before a new wall has the length of a grid cell.
    pub piece: Option<PlanElement>,
}

/// The drawing and its history.
pub struct FloorPlan {
    /// The selected world, to the centimetre.
    pub sketch: Sketch,
    /// The drawing as a course, or why it cannot be driven.
    pub course: Result<Course, CourseError>,
    /// The stroke under way.
    pub stroke: Option<PencilDrag>,
    /// The visible part of the map during the stroke, which keeps the picture still under the pointer.
    pub frame: Option<Bounds>,
    /// Why the last edit was rejected.
    pub note: Option<String>,
    /// Whether the next lap is shown at its end.
    pub follows: bool,
    /// Requests to the host.
    pub orders: Vec<String>,
    past: Vec<Kept>,
    future: Vec<Kept>,
}

impl FloorPlan {
    /// A world with an empty history.
    pub fn new(sketch: Sketch) -> Self {
        Self {
            course: sketch.course(),
            sketch,
            stroke: None,
            frame: None,
            note: None,
            follows: false,
            orders: Vec::new(),
            past: Vec::new(),
            future: Vec::new(),
        }
    }

    /// Replaces the drawing by another world.
    pub fn become_of(&mut self, sketch: Sketch) {
        self.course = sketch.course();
        self.sketch = sketch;
        self.note = None;
    }

    /// Records a world before it changes.
    pub fn remember(&mut self, kept: Kept) {
        self.future.clear();
        if self.past.last() == Some(&kept) {
            return;
        }
        if self.past.len() == MAX_UNDO {
            self.past.remove(0);
        }
        self.past.push(kept);
    }

    /// Undo: the world before the last change; `now` goes to the redo history.
    pub fn back(&mut self, now: Kept) -> Option<Kept> {
        let before = Self::pop(&mut self.past, &now)?;
        self.future.push(now);
        Some(before)
    }

    /// Redo: the world after the change that was undone last.
    pub fn again(&mut self, now: Kept) -> Option<Kept> {
        let after = Self::pop(&mut self.future, &now)?;
        self.past.push(now);
        Some(after)
    }

    fn pop(from: &mut Vec<Kept>, now: &Kept) -> Option<Kept> {
        loop {
            let kept = from.pop()?;
            if kept != *now {
                return Some(kept);
            }
        }
    }
}

/// Whether the world is the reader's own.
pub fn is_own(values: &Values) -> bool {
    values.get(&WORLD).is_none()
}

/// Appends a wall. Returns its index, or why it is impossible.
pub fn add_wall(sketch: &mut Sketch, wall: [PlaceCm; 2]) -> Result<usize, String> {
    if sketch.walls_cm.len() >= limits::WALLS {
        let most = limits::WALLS;
        return Err(format!(
            "a floor plan has at most {most} walls: remove one before you draw another"
        ));
    }
    sketch.walls_cm.push(wall);
    Ok(sketch.walls_cm.len() - 1)
}

/// Inserts a waypoint after another, or at the end. Returns its index, or why it is impossible.
pub fn add_way_point(
    sketch: &mut Sketch,
    behind: Option<usize>,
    at: PlaceCm,
) -> Result<usize, String> {
    let count = sketch.way_points_cm.len();
    if count >= limits::WAY_POINTS {
        let most = limits::WAY_POINTS;
        return Err(format!(
            "a path has at most {most} waypoints: remove one before you place another"
        ));
    }
    let index = behind.map_or(count, |behind| (behind + 1).min(count));
    sketch.way_points_cm.insert(index, at);
    sketch.turn = sketch.turn.map(|turn| turn + usize::from(turn >= index));
    Ok(index)
}

/// A wall of one metre in the middle of the drawing.
pub fn new_wall(sketch: &Sketch) -> [PlaceCm; 2] {
    let middle = snapped(extent(sketch).middle());
    let half = NEW_WALL_CM / 2;
    [moved(middle, [-half, 0]), moved(middle, [half, 0])]
}

/// Position of a waypoint added by a button: halfway to the next, or a little beyond the last.
pub fn new_way_point(sketch: &Sketch, behind: Option<usize>) -> PlaceCm {
    let points = &sketch.way_points_cm;
    let before = behind.or(points.len().checked_sub(1));
    let at = before.map_or(sketch.start_cm, |index| points[index]);
    match before.and_then(|index| points.get(index + 1)) {
        Some(next) => snapped([0, 1].map(|axis| to_m((at[axis] + next[axis]) / 2))),
        None => moved(at, [NEW_WAY_POINT_CM, 0]),
    }
}

/// The extent of walls, path and start, m.
pub fn extent(sketch: &Sketch) -> Bounds {
    let ends = sketch.walls_cm.iter().flatten();
    let places = ends.chain(&sketch.way_points_cm);
    let start = sketch.start_cm;
    let (min, max) = places.fold((start, start), |(min, max), at| {
        (
            [0, 1].map(|axis: usize| min[axis].min(at[axis])),
            [0, 1].map(|axis: usize| max[axis].max(at[axis])),
        )
    });
    Bounds {
        min: min.map(to_m),
        max: max.map(to_m),
    }
}
