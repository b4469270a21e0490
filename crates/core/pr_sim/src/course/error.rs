//! Errors of a course, one sentence each.

use core::fmt;

use thiserror::Error;

use super::CLEARANCE_M;
use crate::world::WorldRect;

/// A part of a course, counted from 1 as in its file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoursePoint {
    /// The start pose.
    Start,
    /// A waypoint.
    WayPoint(usize),
    /// A wall.
    Wall(usize),
}

impl fmt::Display for CoursePoint {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Start => formatter.write_str("the start"),
            Self::WayPoint(number) => write!(formatter, "waypoint {number}"),
            Self::Wall(number) => write!(formatter, "wall {number}"),
        }
    }
}

/// Why a course cannot be driven: what is wrong, where, and what to do. Walls count from 1.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CourseError {
    /// The text is not JSON.
    #[error(
        "line {line}, column {column}: {problem}; the file has to be JSON, which allows no comments, no NaN and no comma after the last item"
    )]
    NotJson {
        /// Line, from 1.
        line: usize,
        /// Column in bytes, from 1.
        column: usize,
        /// The message of the JSON parser.
        problem: String,
    },
    /// The text is JSON, but not a course.
    #[error(
        "line {line}, column {column}: {problem}; a world has walls_m as [[x, y, x, y], …], start as {{\"x_m\", \"y_m\", \"heading_deg\"}} and way_points_m as [[x, y], …]"
    )]
    NotACourse {
        /// Line, from 1.
        line: usize,
        /// Column in bytes, from 1.
        column: usize,
        /// The message of the JSON parser.
        problem: String,
    },
    /// There are no walls.
    #[error("walls_m is empty: give it at least one wall as [x, y, x, y]")]
    NoWalls,
    /// There are too many walls.
    #[error("walls_m has {count} walls, but at most {limit} are allowed: leave small ones out")]
    TooManyWalls {
        /// Their number.
        count: usize,
        /// Their largest number.
        limit: usize,
    },
    /// The ends of a wall coincide.
    #[error("wall {wall} starts where it ends: give it two different ends, or leave it out")]
    NoLength {
        /// The number of the wall.
        wall: usize,
    },
    /// There are no waypoints.
    #[error("way_points_m is empty: give it at least one waypoint as [x, y]")]
    NoWayPoints,
    /// There are too many waypoints.
    #[error("way_points_m has {count} waypoints, but at most {limit} are allowed: leave some out")]
    TooManyWayPoints {
        /// Their number.
        count: usize,
        /// Their largest number.
        limit: usize,
    },
    /// The turn is not a waypoint.
    #[error("turn_at is {turn}, but there are {count} waypoints: name one of them, from 1")]
    NoSuchTurn {
        /// The given value.
        turn: usize,
        /// The number of waypoints.
        count: usize,
    },
    /// A coordinate is not finite or too large.
    #[error("{place} is more than {limit_m} m from the origin: give coordinates in metres near it")]
    TooFar {
        /// The start, waypoint or wall.
        place: CoursePoint,
        /// The largest distance along an axis, m.
        limit_m: f64,
    },
    /// The heading is not an angle in degrees.
    #[error("heading_deg of the start is not between -360 and 360: give it in degrees")]
    NoHeading,
    /// The start or a waypoint is outside of all walls.
    #[error(
        "{place} is outside the walls, which reach from ({}, {}) to ({}, {}) m: move it inside",
        bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y
    )]
    Outside {
        /// The start, waypoint or wall.
        place: CoursePoint,
        /// The bounds of the walls.
        bounds: WorldRect,
    },
    /// The start or a waypoint is too close to a wall.
    #[error(
        "{place} is {distance_m:.2} m from wall {wall}: keep it {CLEARANCE_M} m from every wall"
    )]
    AtWall {
        /// The start, waypoint or wall.
        place: CoursePoint,
        /// The number of the wall.
        wall: usize,
        /// Its distance from the wall, m.
        distance_m: f64,
    },
    /// The straight segment between two waypoints is too close to a wall.
    #[error(
        "the straight line from {from} to {to} comes within {distance_m:.2} m of wall {wall}: lead it around with waypoints, {CLEARANCE_M} m from every wall"
    )]
    Blocked {
        /// Its start.
        from: CoursePoint,
        /// Its end.
        to: CoursePoint,
        /// The number of the wall.
        wall: usize,
        /// Its distance from the wall, m; 0 if it crosses the wall.
        distance_m: f64,
    },
    /// The path is too long.
    #[error(
        "the path is {length_m:.0} m long, but at most {limit_m} m are allowed: leave waypoints out"
    )]
    TooLong {
        /// The path length, m.
        length_m: f64,
        /// The largest path length, m.
        limit_m: f64,
    },
}
