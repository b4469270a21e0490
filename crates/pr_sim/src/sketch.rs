//! A flat that is being drawn: walls, a start and way points, to the centimetre.
//!
//! A [`Course`] can be driven; a sketch need not be, or nobody could draw it wall by wall. Both forms in
//! which a sketch travels hold whole centimetres and degrees: the JSON of a course ([`Sketch::to_json`]),
//! and a short text for links ([`Sketch::to_text`]). So a course is the same to the bit whichever way it
//! came.

mod error;
mod text;

use core::fmt::Write as _;

use pr_geom::{Point2, SE2};

use crate::course::{Course, CourseError};
use crate::world::{Wall, World};

pub use crate::course::limits;
pub use error::SketchError;

/// Centimetres in a metre.
const CM_PER_M: f64 = 100.0;

/// A place, `[x, y]` in centimetres, world frame.
pub type PlaceCm = [i32; 2];

/// Walls, start and way points, which may not yet make a course.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sketch {
    /// Walls, each from its first end to its second, cm.
    pub walls_cm: Vec<[PlaceCm; 2]>,
    /// Where the robot starts, cm.
    pub start_cm: PlaceCm,
    /// Where it looks there, degrees from 0 to 359; 0 is along x.
    pub heading_deg: i32,
    /// Where it drives to, in order, cm.
    pub way_points_cm: Vec<PlaceCm>,
    /// The way point from which on places are seen again, counted from 0.
    pub turn: Option<usize>,
}

impl Sketch {
    /// A course to the nearest centimetre; walls that are shorter than one are left out.
    #[must_use]
    pub fn from_course(course: &Course) -> Self {
        let walls = course.world().walls().iter();
        let walls = walls.map(|wall| [to_cm(wall.start), to_cm(wall.end)]);
        let degrees = course.start().theta().to_degrees().round() as i32;
        Self {
            walls_cm: walls.filter(|[from, to]| from != to).collect(),
            start_cm: to_cm(course.start().position()),
            heading_deg: degrees.rem_euclid(360),
            way_points_cm: course.way_points().iter().copied().map(to_cm).collect(),
            turn: course.turn(),
        }
    }

    /// Reads the JSON of a course to the nearest centimetre.
    ///
    /// # Errors
    /// Those of [`Course::from_json`].
    pub fn from_json(text: &[u8]) -> Result<Self, CourseError> {
        Course::from_json(text).map(|course| Self::from_course(&course))
    }

    /// The course, where it can be driven.
    ///
    /// # Errors
    /// What stands in the way.
    pub fn course(&self) -> Result<Course, CourseError> {
        let walls: Vec<_> = self.walls().collect();
        let [x, y] = self.start_cm.map(to_m);
        let way_points = self.way_points_cm.iter().copied().map(point);
        Course::new(
            World::new(crate::course::extent(&walls), walls),
            SE2::new(x, y, f64::from(self.heading_deg).to_radians()),
            way_points.collect(),
            self.turn,
        )
    }

    /// The walls in metres.
    pub fn walls(&self) -> impl Iterator<Item = Wall> + '_ {
        self.walls_cm.iter().map(|&[from, to]| Wall {
            start: point(from),
            end: point(to),
        })
    }

    /// The JSON of the course, as `docs/worlds.md` says.
    #[must_use]
    pub fn to_json(&self) -> String {
        let place = |cm: &PlaceCm| {
            let [x, y] = cm.map(to_m);
            format!("{x}, {y}")
        };
        let walls = self.walls_cm.iter();
        let walls: Vec<_> = walls
            .map(|[from, to]| format!("    [{}, {}]", place(from), place(to)))
            .collect();
        let way_points = self.way_points_cm.iter();
        let way_points: Vec<_> = way_points.map(|at| format!("[{}]", place(at))).collect();
        let [x, y] = self.start_cm.map(to_m);
        let mut json = format!(
            "{{\n  \"walls_m\": [\n{}\n  ],\n  \"start\": {{ \"x_m\": {x}, \"y_m\": {y}, \"heading_deg\": {} }},\n  \"way_points_m\": [{}]",
            walls.join(",\n"),
            self.heading_deg,
            way_points.join(", "),
        );
        if let Some(turn) = self.turn {
            // A text takes whatever is written to it.
            let _ = write!(json, ",\n  \"turn_at\": {}", turn + 1);
        }
        json + "\n}\n"
    }
}

/// Centimetres in metres: the nearest number to the decimal fraction, as a file reads it.
#[must_use]
pub fn to_m(cm: i32) -> f64 {
    f64::from(cm) / CM_PER_M
}

fn point(cm: PlaceCm) -> Point2<f64> {
    let [x, y] = cm.map(to_m);
    Point2::new(x, y)
}

fn to_cm(at: Point2<f64>) -> PlaceCm {
    [at.x, at.y].map(|m| (m * CM_PER_M).round() as i32)
}

#[cfg(test)]
mod tests;
