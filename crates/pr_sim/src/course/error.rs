//! What can be wrong with a course, in one sentence each.

use core::fmt;

use thiserror::Error;

use super::CLEARANCE_M;
use crate::world::Bounds;

/// A part of a course, counted from 1 as in its file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoursePoint {
    /// Where the robot starts.
    Start,
    /// A way point.
    WayPoint(usize),
    /// A wall.
    Wall(usize),
}

impl fmt::Display for CoursePoint {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Start => formatter.write_str("the start"),
            Self::WayPoint(number) => write!(formatter, "way point {number}"),
            Self::Wall(number) => write!(formatter, "wall {number}"),
        }
    }
}

/// Why a course cannot be driven: what is wrong, where, and what to do. Walls count from 1.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CourseError {
    /// The text is no JSON.
    #[error(
        "line {line}, column {column}: {problem}; the file has to be JSON, which knows no comments, no NaN and no comma after the last item"
    )]
    NotJson {
        /// Line, from 1.
        line: usize,
        /// Column in bytes, from 1.
        column: usize,
        /// What the reader of JSON says.
        problem: String,
    },
    /// The text is JSON and no course.
    #[error(
        "line {line}, column {column}: {problem}; a world has walls_m as [[x, y, x, y], …], start as {{\"x_m\", \"y_m\", \"heading_deg\"}} and way_points_m as [[x, y], …]"
    )]
    NotACourse {
        /// Line, from 1.
        line: usize,
        /// Column in bytes, from 1.
        column: usize,
        /// What does not fit.
        problem: String,
    },
    /// Nothing to see.
    #[error("walls_m is empty: give it at least one wall as [x, y, x, y]")]
    NoWalls,
    /// More walls than a sweep may take time for.
    #[error("walls_m has {count} walls, and {limit} are the most: leave small ones out")]
    TooManyWalls {
        /// How many there are.
        count: usize,
        /// How many may be.
        limit: usize,
    },
    /// A wall is a point.
    #[error("wall {wall} starts where it ends: give it two different ends, or leave it out")]
    NoLength {
        /// Which wall.
        wall: usize,
    },
    /// Nowhere to go.
    #[error("way_points_m is empty: give it at least one way point as [x, y]")]
    NoWayPoints,
    /// More way points than a lap may have.
    #[error("way_points_m has {count} way points, and {limit} are the most: leave some out")]
    TooManyWayPoints {
        /// How many there are.
        count: usize,
        /// How many may be.
        limit: usize,
    },
    /// The turn is no way point.
    #[error("turn_at is {turn}, and there are {count} way points: name one of them, from 1")]
    NoSuchTurn {
        /// What was given.
        turn: usize,
        /// How many way points there are.
        count: usize,
    },
    /// A coordinate is not finite or far away.
    #[error("{place} is more than {limit_m} m from the origin: give coordinates in metres near it")]
    TooFar {
        /// What is there.
        place: CoursePoint,
        /// How far it may be along an axis, m.
        limit_m: f64,
    },
    /// The heading is no angle.
    #[error("heading_deg of the start is not between -360 and 360: give it in degrees")]
    NoHeading,
    /// A place lies beyond all walls.
    #[error(
        "{place} is outside the walls, which reach from ({}, {}) to ({}, {}) m: move it inside",
        bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y
    )]
    Outside {
        /// What is there.
        place: CoursePoint,
        /// What the walls enclose.
        bounds: Bounds,
    },
    /// A place lies in or at a wall.
    #[error(
        "{place} is {distance_m:.2} m from wall {wall}: keep it {CLEARANCE_M} m from every wall"
    )]
    AtWall {
        /// What is there.
        place: CoursePoint,
        /// Which wall.
        wall: usize,
        /// How far from it, m.
        distance_m: f64,
    },
    /// The straight way between two places meets a wall.
    #[error(
        "the straight way from {from} to {to} comes within {distance_m:.2} m of wall {wall}: lead it around by way points, {CLEARANCE_M} m from every wall"
    )]
    Blocked {
        /// Where it begins.
        from: CoursePoint,
        /// Where it ends.
        to: CoursePoint,
        /// Which wall.
        wall: usize,
        /// How near it comes, m; 0 is through it.
        distance_m: f64,
    },
    /// The drive takes too long.
    #[error("the way is {length_m:.0} m long, and {limit_m} m are the most: leave way points out")]
    TooLong {
        /// Its length, m.
        length_m: f64,
        /// What it may be, m.
        limit_m: f64,
    },
}
