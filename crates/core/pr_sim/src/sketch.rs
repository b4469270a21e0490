//! A floor plan that a user draws: walls, a start and waypoints, to the centimetre.
//!
//! A [`Course`] can be driven; a sketch may be incomplete, because it is drawn wall by wall. Both of its
//! formats keep whole centimetres and degrees: the JSON of a course ([`Sketch::to_json`]), and a short
//! text for links ([`Sketch::to_text`]). Therefore both give the same course to the bit.

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

/// A point, `[x, y]` in centimetres, world frame.
pub type PlaceCm = [i32; 2];

/// Walls, start and waypoints, which need not be a valid course yet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sketch {
    /// Walls, each from its first end to its second, cm.
    pub walls_cm: Vec<[PlaceCm; 2]>,
    /// Start position, cm.
    pub start_cm: PlaceCm,
    /// Start heading, degrees from 0 to 359; 0 is along x.
    pub heading_deg: i32,
    /// Waypoints, in order, cm.
    pub way_points_cm: Vec<PlaceCm>,
    /// Index of the waypoint, from 0, after which the robot revisits known space.
    pub turn: Option<usize>,
}

impl Sketch {
    /// Rounds a course to centimetres, without walls shorter than one.
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

    /// Reads the JSON of a course and rounds it to centimetres.
    ///
    /// # Errors
    /// Those of [`Course::from_json`].
    pub fn from_json(text: &[u8]) -> Result<Self, CourseError> {
        Course::from_json(text).map(|course| Self::from_course(&course))
    }

    /// Converts the sketch to a course, if it can be driven.
    ///
    /// # Errors
    /// The reason why it cannot be driven.
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

    /// Writes the JSON of the course, see `docs/worlds.md`.
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
            // Writing to a string cannot fail.
            let _ = write!(json, ",\n  \"turn_at\": {}", turn + 1);
        }
        json + "\n}\n"
    }
}

/// Converts centimetres to metres: the number nearest to the decimal fraction, as parsed from a file.
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
