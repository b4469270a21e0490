//! A piece of a flat: a wall, one of its ends, a waypoint, the start.

use pr_geom::math;
use pr_sim::Sketch;
use pr_sim::sketch::{PlaceCm, to_m};
use widget_kit::model::Handle;
use widget_kit::values::Values;

use super::grid::{GRID_CM, HEADING_STEP_DEG, moved, snapped};
use super::panel;
use super::pick::PickDirection;

use crate::w16_2_full_lap::spec::{PIECE, PIECE_NUMBER};

/// Distance of the heading's tip from the start, m.
const HEADING_ARM_M: f64 = 0.6;

/// A piece, with its index from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlanElement {
    /// A whole wall.
    Wall(usize),
    /// Its first end.
    FirstEnd(usize),
    /// Its second end.
    SecondEnd(usize),
    /// A waypoint.
    WayPoint(usize),
    /// The position of the start.
    Start,
    /// The heading of the start.
    Heading,
}

/// The names of the kinds, in the order of the parameter's options from 1 on.
const KINDS: [&str; 6] = [
    "wall",
    "first-end",
    "second-end",
    "way-point",
    "start",
    "heading",
];

impl PlanElement {
    /// The selection in the settings, if it exists in the flat.
    pub fn chosen(values: &Values, sketch: &Sketch) -> Option<Self> {
        let kind = values.get(&PIECE)?;
        let index = values.get(&PIECE_NUMBER).checked_sub(1);
        Self::from_index(kind, index.unwrap_or(0)).filter(|piece| piece.is_in(sketch))
    }

    /// Stores the selection in the settings.
    pub fn put(piece: Option<Self>, values: &mut Values) {
        values.put(&PIECE, piece.map(Self::kind));
        values.put(&PIECE_NUMBER, piece.map_or(0, Self::index) + 1);
    }

    fn from_index(kind: usize, index: usize) -> Option<Self> {
        [
            Self::Wall(index),
            Self::FirstEnd(index),
            Self::SecondEnd(index),
            Self::WayPoint(index),
            Self::Start,
            Self::Heading,
        ]
        .get(kind)
        .copied()
    }

    fn kind(self) -> usize {
        match self {
            Self::Wall(_) => 0,
            Self::FirstEnd(_) => 1,
            Self::SecondEnd(_) => 2,
            Self::WayPoint(_) => 3,
            Self::Start => 4,
            Self::Heading => 5,
        }
    }

    /// Index of the wall or the waypoint, from 0.
    pub fn index(self) -> usize {
        match self {
            Self::Wall(index)
            | Self::FirstEnd(index)
            | Self::SecondEnd(index)
            | Self::WayPoint(index) => index,
            Self::Start | Self::Heading => 0,
        }
    }

    fn is_in(self, sketch: &Sketch) -> bool {
        self.index() < self.count(sketch)
    }

    /// The number of pieces of its kind.
    pub fn count(self, sketch: &Sketch) -> usize {
        match self {
            Self::Wall(_) | Self::FirstEnd(_) | Self::SecondEnd(_) => sketch.walls_cm.len(),
            Self::WayPoint(_) => sketch.way_points_cm.len(),
            Self::Start | Self::Heading => 1,
        }
    }

    /// The previous or next piece of its kind; without a selection, the last or the first wall.
    pub fn stepped(piece: Option<Self>, step: PickDirection, sketch: &Sketch) -> Option<Self> {
        let kind = piece.map_or(0, Self::kind);
        let count = Self::from_index(kind, 0)?.count(sketch);
        let last = count.checked_sub(1)?;
        let index = match (piece.map(Self::index), step) {
            (None, PickDirection::On) => 0,
            (None, PickDirection::Back) => last,
            (Some(index), PickDirection::On) => (index + 1) % count,
            (Some(index), PickDirection::Back) => index.checked_sub(1).unwrap_or(last),
        };
        Self::from_index(kind, index)
    }

    /// The piece of a handle.
    pub fn held(handle: Handle) -> Option<Self> {
        let kind = KINDS.iter().position(|name| *name == handle.id)?;
        Self::from_index(kind, handle.index)
    }

    /// The handle of the piece.
    pub fn handle(self) -> Handle {
        Handle {
            panel: panel::MAP,
            id: KINDS[self.kind()],
            index: self.index(),
            ..Handle::default()
        }
    }

    /// Moves the piece from `from` to `at`, m; `None` if a wall would lose its length.
    pub fn dragged(self, sketch: &Sketch, from: [f64; 2], at: [f64; 2]) -> Option<Sketch> {
        match self {
            Self::Heading => {
                let [x, y] = sketch.start_cm.map(to_m);
                let angle = math::atan2(at[1] - y, at[0] - x).to_degrees();
                let steps = (angle / f64::from(HEADING_STEP_DEG)).round() as i32;
                Some(turned(sketch, steps * HEADING_STEP_DEG))
            }
            Self::Wall(_) => {
                let by = [0, 1].map(|axis| at[axis] - from[axis]);
                self.shifted(sketch, snapped(by))
            }
            _ => self.placed(sketch, snapped(at)),
        }
    }

    /// Moves the piece by a step of the grid; the heading turns.
    pub fn nudged(self, sketch: &Sketch, [x, y]: [i32; 2]) -> Option<Sketch> {
        if self == Self::Heading {
            let by = (x + y) * HEADING_STEP_DEG;
            return Some(turned(sketch, sketch.heading_deg + by));
        }
        self.shifted(sketch, [x * GRID_CM, y * GRID_CM])
    }

    fn shifted(self, sketch: &Sketch, by: PlaceCm) -> Option<Sketch> {
        let Self::Wall(index) = self else {
            let at = self.place_cm(sketch)?;
            return self.placed(sketch, moved(at, by));
        };
        let mut sketch = sketch.clone();
        let wall = sketch.walls_cm.get_mut(index)?;
        *wall = wall.map(|end| moved(end, by));
        (wall[0] != wall[1]).then_some(sketch)
    }

    fn placed(self, sketch: &Sketch, at: PlaceCm) -> Option<Sketch> {
        let mut sketch = sketch.clone();
        match self {
            Self::FirstEnd(index) | Self::SecondEnd(index) => {
                let wall = sketch.walls_cm.get_mut(index)?;
                wall[usize::from(self == Self::SecondEnd(index))] = at;
                if wall[0] == wall[1] {
                    return None;
                }
            }
            Self::WayPoint(index) => *sketch.way_points_cm.get_mut(index)? = at,
            Self::Start => sketch.start_cm = at,
            Self::Wall(_) | Self::Heading => return None,
        }
        Some(sketch)
    }

    /// Removes the piece, or returns why that is impossible.
    pub fn removed(self, sketch: &Sketch) -> Result<Sketch, String> {
        let mut sketch = sketch.clone();
        match self {
            Self::Wall(index) | Self::FirstEnd(index) | Self::SecondEnd(index) => {
                sketch.walls_cm.remove(index);
            }
            Self::WayPoint(index) => {
                sketch.way_points_cm.remove(index);
                sketch.turn = match sketch.turn {
                    Some(turn) if turn > index => Some(turn - 1),
                    Some(turn) if turn == index => None,
                    turn => turn,
                };
            }
            Self::Start | Self::Heading => {
                return Err("a robot has to start somewhere: move its start instead".to_owned());
            }
        }
        Ok(sketch)
    }

    /// Its position; `None` for a wall.
    fn place_cm(self, sketch: &Sketch) -> Option<PlaceCm> {
        match self {
            Self::FirstEnd(index) => sketch.walls_cm.get(index).map(|wall| wall[0]),
            Self::SecondEnd(index) => sketch.walls_cm.get(index).map(|wall| wall[1]),
            Self::WayPoint(index) => sketch.way_points_cm.get(index).copied(),
            Self::Start => Some(sketch.start_cm),
            Self::Wall(_) | Self::Heading => None,
        }
    }

    /// The position at which it can be grabbed, m; of a wall its middle.
    pub fn place(self, sketch: &Sketch) -> [f64; 2] {
        match self {
            Self::Wall(index) => {
                let [from, to] = sketch.walls_cm[index].map(|end| end.map(to_m));
                [0, 1].map(|axis| 0.5 * (from[axis] + to[axis]))
            }
            Self::Heading => {
                let [x, y] = sketch.start_cm.map(to_m);
                let angle = f64::from(sketch.heading_deg).to_radians();
                [
                    x + HEADING_ARM_M * math::cos(angle),
                    y + HEADING_ARM_M * math::sin(angle),
                ]
            }
            _ => self.place_cm(sketch).unwrap_or_default().map(to_m),
        }
    }

    /// Whether it is a wall or the end of one.
    pub fn is_of_wall(self) -> bool {
        matches!(self, Self::Wall(_) | Self::FirstEnd(_) | Self::SecondEnd(_))
    }

    /// The accepted piece under a point, within `reach` along each axis: points before walls.
    pub fn at(
        sketch: &Sketch,
        at: [f64; 2],
        reach: [f64; 2],
        accepts: impl Fn(&Self) -> bool,
    ) -> Option<Self> {
        let away = |[x, y]: [f64; 2]| math::norm2((x - at[0]) / reach[0], (y - at[1]) / reach[1]);
        let walls = 0..sketch.walls_cm.len();
        let way = (0..sketch.way_points_cm.len()).map(Self::WayPoint);
        // A closed path ends at its start: the start is on top.
        let way = [Self::Start, Self::Heading].into_iter().chain(way);
        let ends = walls
            .clone()
            .flat_map(|index| [Self::FirstEnd(index), Self::SecondEnd(index)]);
        let places = way.chain(ends).filter(&accepts);
        let near = |pieces: &mut dyn Iterator<Item = (Self, f64)>| {
            pieces
                .filter(|(_, away)| *away <= 1.0)
                .min_by(|a, b| a.1.total_cmp(&b.1))
                .map(|(piece, _)| piece)
        };
        near(&mut places.map(|piece| (piece, away(piece.place(sketch))))).or_else(|| {
            near(
                &mut walls
                    .filter(|index| accepts(&Self::Wall(*index)))
                    .map(|index| {
                        let wall = sketch.walls_cm[index].map(|end| end.map(to_m));
                        (Self::Wall(index), away(nearest_of(wall, at)))
                    }),
            )
        })
    }
}

/// The point of a wall that is nearest to another, m.
fn nearest_of([from, to]: [[f64; 2]; 2], at: [f64; 2]) -> [f64; 2] {
    let edge = [to[0] - from[0], to[1] - from[1]];
    let off = [at[0] - from[0], at[1] - from[1]];
    let length2 = edge[0] * edge[0] + edge[1] * edge[1];
    let along = (off[0] * edge[0] + off[1] * edge[1]) / length2;
    let share = if length2 > 0.0 {
        along.clamp(0.0, 1.0)
    } else {
        0.0
    };
    [from[0] + share * edge[0], from[1] + share * edge[1]]
}

fn turned(sketch: &Sketch, heading_deg: i32) -> Sketch {
    Sketch {
        heading_deg: heading_deg.rem_euclid(360),
        ..sketch.clone()
    }
}
