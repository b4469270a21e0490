//! Reads courses from JSON; `docs/worlds.md` describes the fields.

use pr_geom::{Point2, SE2};
use serde::Deserialize;
use serde_json::error::Category;

use super::{Course, CourseError};
use crate::world::{Wall, World, WorldRect};

/// The byte order mark, which some editors write.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Largest number of characters of the JSON parser's message.
const MAX_QUOTED: usize = 200;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CourseFile {
    walls_m: Vec<[f64; 4]>,
    start: StartPose,
    way_points_m: Vec<[f64; 2]>,
    turn_at: Option<usize>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StartPose {
    x_m: f64,
    y_m: f64,
    heading_deg: f64,
}

impl Course {
    /// Reads a course from JSON; the extent of its world is that of its walls.
    ///
    /// # Errors
    /// If the text is not JSON or does not describe a course that can be driven.
    pub fn from_json(text: &[u8]) -> Result<Self, CourseError> {
        let text = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
        let file: CourseFile = serde_json::from_slice(text).map_err(|error| rejection(&error))?;
        let turn = match file.turn_at {
            Some(0) => {
                return Err(CourseError::NoSuchTurn {
                    turn: 0,
                    count: file.way_points_m.len(),
                });
            }
            number => number.map(|number| number - 1),
        };
        if !(-360.0..=360.0).contains(&file.start.heading_deg) {
            return Err(CourseError::NoHeading);
        }
        let walls: Vec<Wall> = file
            .walls_m
            .iter()
            .map(|&[x_from, y_from, x_to, y_to]| Wall {
                start: Point2::new(x_from, y_from),
                end: Point2::new(x_to, y_to),
            })
            .collect();
        let start = SE2::new(
            file.start.x_m,
            file.start.y_m,
            file.start.heading_deg.to_radians(),
        );
        let way_points = file.way_points_m.iter().map(|&[x, y]| Point2::new(x, y));
        Self::new(
            World::new(extent(&walls), walls),
            start,
            way_points.collect(),
            turn,
        )
    }
}

pub(crate) fn extent(walls: &[Wall]) -> WorldRect {
    let ends = || walls.iter().flat_map(|wall| [wall.start, wall.end]);
    let lowest = |axis: usize| ends().map(|end| end[axis]).fold(f64::INFINITY, f64::min);
    let highest = |axis: usize| {
        ends()
            .map(|end| end[axis])
            .fold(f64::NEG_INFINITY, f64::max)
    };
    WorldRect {
        min: Point2::new(lowest(0), lowest(1)),
        max: Point2::new(highest(0), highest(1)),
    }
}

fn rejection(error: &serde_json::Error) -> CourseError {
    let (line, column) = (error.line(), error.column());
    let words = error.to_string();
    let place = format!(" at line {line} column {column}");
    let words = words.strip_suffix(&place).unwrap_or(&words);
    // The message may quote any text of the file.
    let printable = words.chars().filter(|c| !c.is_control());
    let problem: String = printable.take(MAX_QUOTED).collect();
    match error.classify() {
        Category::Data => CourseError::NotACourse {
            line,
            column,
            problem,
        },
        Category::Io | Category::Syntax | Category::Eof => CourseError::NotJson {
            line,
            column,
            problem,
        },
    }
}
