//! The reader's own flat: what is drawn, what of it is chosen, and the way back.
//!
//! A flat is a [`Sketch`]: it need not be drivable while it is drawn. Whatever changes it goes through
//! [`Flat::remember`], so that all of it can be taken back.

use ch16_lab::lap::BuiltInWorld;
use kit::scene::Bounds;
use kit::values::Values;
use pr_sim::sketch::{PlaceCm, limits, to_m};
use pr_sim::{Course, CourseError, Sketch};

use super::grid::{moved, snapped};
use super::piece::Piece;
use crate::w16_2_full_lap::spec::{EDIT, WORLD};

/// So many changes can be taken back.
const MOST_UNDO: usize = 200;

/// Length of a wall that a button adds, cm.
const NEW_WALL_CM: i32 = 100;

/// A way point that a button adds stands so far from the one before, cm.
const NEW_WAY_POINT_CM: i32 = 50;

/// What a press on the map does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tool {
    /// Moves a wall, an end, a way point or the start.
    Move,
    /// Draws a wall.
    Wall,
    /// Places a way point.
    Way,
    /// Removes what it meets.
    Remove,
}

impl Tool {
    /// The tool in the reader's hand; none where nothing is edited.
    pub fn chosen(values: &Values) -> Option<Self> {
        values.get(&EDIT)
    }
}

/// The world of a moment, to come back to.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept {
    /// The value of `world`.
    pub world: Option<BuiltInWorld>,
    /// What was drawn.
    pub sketch: Sketch,
}

/// A stroke under way.
pub struct Stroke {
    /// What the pointer took hold of.
    pub handle: kit::model::Handle,
    /// Where it did, m.
    pub from: [f64; 2],
    /// The flat before it.
    pub before: Kept,
    /// What is moved; none before a wall is as long as the grid is wide.
    pub piece: Option<Piece>,
}

/// What is drawn, and how it became so.
pub struct Flat {
    /// The world that is chosen, to the centimetre.
    pub sketch: Sketch,
    /// The same as a course, or why it is none.
    pub course: Result<Course, CourseError>,
    /// The stroke under way.
    pub stroke: Option<Stroke>,
    /// What the map shows during the stroke: the picture keeps still under the pointer.
    pub frame: Option<Bounds>,
    /// Why the last change was none.
    pub note: Option<String>,
    /// The lap that comes is shown at its end.
    pub follows: bool,
    /// What is asked of the host.
    pub orders: Vec<String>,
    past: Vec<Kept>,
    future: Vec<Kept>,
}

impl Flat {
    /// A world with nothing to take back.
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

    /// Another world is chosen or drawn.
    pub fn become_of(&mut self, sketch: Sketch) {
        self.course = sketch.course();
        self.sketch = sketch;
        self.note = None;
    }

    /// Remembers a world before it changes.
    pub fn remember(&mut self, kept: Kept) {
        self.future.clear();
        if self.past.last() == Some(&kept) {
            return;
        }
        if self.past.len() == MOST_UNDO {
            self.past.remove(0);
        }
        self.past.push(kept);
    }

    /// The world before the last change; `now` can be had again.
    pub fn back(&mut self, now: Kept) -> Option<Kept> {
        let before = Self::pop(&mut self.past, &now)?;
        self.future.push(now);
        Some(before)
    }

    /// The world after the change that was taken back last.
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

/// Puts a wall behind the others; its number, or why it cannot be.
pub fn add_wall(sketch: &mut Sketch, wall: [PlaceCm; 2]) -> Result<usize, String> {
    if sketch.walls_cm.len() >= limits::WALLS {
        let most = limits::WALLS;
        return Err(format!(
            "a flat has at most {most} walls: remove one before you draw another"
        ));
    }
    sketch.walls_cm.push(wall);
    Ok(sketch.walls_cm.len() - 1)
}

/// Puts a way point behind another, or at the end; its number, or why it cannot be.
pub fn add_way_point(
    sketch: &mut Sketch,
    behind: Option<usize>,
    at: PlaceCm,
) -> Result<usize, String> {
    let count = sketch.way_points_cm.len();
    if count >= limits::WAY_POINTS {
        let most = limits::WAY_POINTS;
        return Err(format!(
            "a way has at most {most} way points: remove one before you place another"
        ));
    }
    let index = behind.map_or(count, |behind| (behind + 1).min(count));
    sketch.way_points_cm.insert(index, at);
    sketch.turn = sketch.turn.map(|turn| turn + usize::from(turn >= index));
    Ok(index)
}

/// A wall of a metre in the middle of what is drawn.
pub fn new_wall(sketch: &Sketch) -> [PlaceCm; 2] {
    let middle = snapped(extent(sketch).middle());
    let half = NEW_WALL_CM / 2;
    [moved(middle, [-half, 0]), moved(middle, [half, 0])]
}

/// Where a way point stands that a button adds: half-way to the next, or a little beyond the last.
pub fn new_way_point(sketch: &Sketch, behind: Option<usize>) -> PlaceCm {
    let points = &sketch.way_points_cm;
    let before = behind.or(points.len().checked_sub(1));
    let at = before.map_or(sketch.start_cm, |index| points[index]);
    match before.and_then(|index| points.get(index + 1)) {
        Some(next) => snapped([0, 1].map(|axis| to_m((at[axis] + next[axis]) / 2))),
        None => moved(at, [NEW_WAY_POINT_CM, 0]),
    }
}

/// What walls, way and start span, m.
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
