//! A course: a world, the robot's start pose, and the waypoints that it visits.
//!
//! Built in are the chapter's Apartment, a ring of corridors, and three worlds in which SLAM fails;
//! [`Course::from_json`] reads others. A course guarantees that the driver, which turns toward the next
//! waypoint and drives straight to it, touches no wall and arrives.

mod breaking;
mod clearance;
mod error;
mod file;
mod ring;

use pr_geom::{Point2, SE2, math};

use crate::driver::DriverConfig;
use crate::world::World;

use clearance::{nearest_wall, nearest_wall_to_leg};
pub use error::{CourseError, CoursePoint};
pub(crate) use file::extent;

/// Limits of a course, because a lap must fit into memory and finish in reasonable time.
pub mod limits {
    /// Number of walls; a scan casts every ray against every wall within range.
    pub const WALLS: usize = 2000;
    /// Number of waypoints; the robot may have to turn around at each.
    pub const WAY_POINTS: usize = 50;
    /// Largest |coordinate|, m.
    pub const COORDINATE_M: f64 = 100.0;
    /// The same in centimetres.
    pub const COORDINATE_CM: u32 = 10_000;
    /// Largest path length, m.
    pub const PATH_LENGTH_M: f64 = 200.0;
}

/// Least distance between the path and a wall, m.
///
/// The driver turns to the next waypoint within 0.3 m of the present one, so it cuts a corner by less.
pub const CLEARANCE_M: f64 = 0.3;

/// A world with a path through it.
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    world: World,
    start: SE2,
    way_points: Vec<Point2<f64>>,
    turn: Option<usize>,
}

impl Course {
    /// Creates a course and checks it.
    ///
    /// `turn` is the index of the waypoint, from 0, after which the robot revisits known space.
    ///
    /// # Errors
    /// If the driver would touch a wall or could not finish, or if a number is out of range.
    pub fn new(
        world: World,
        start: SE2,
        way_points: Vec<Point2<f64>>,
        turn: Option<usize>,
    ) -> Result<Self, CourseError> {
        let course = Self {
            world,
            start,
            way_points,
            turn,
        };
        course.check()?;
        Ok(course)
    }

    /// The chapter's lap: down the corridor of [`World::apartment`] and back.
    #[must_use]
    pub fn apartment() -> Self {
        Self {
            world: World::apartment(),
            start: SE2::new(1.35, 4.42, 0.0),
            way_points: DriverConfig::default().waypoints,
            turn: Some(0),
        }
    }

    /// One lap around [`World::ring`], counterclockwise, and on to the middle of its first corridor.
    ///
    /// The path closes a cycle: the last corridor meets the first one from the other side, while the
    /// Apartment's lap returns through the corridor by which it left.
    #[must_use]
    pub fn ring() -> Self {
        let (west, east, south, north) = (0.7, 11.3, 0.7, 8.3);
        Self {
            world: World::ring(),
            start: SE2::new(2.0, south, 0.0),
            way_points: vec![
                Point2::new(east, south),
                Point2::new(east, north),
                Point2::new(west, north),
                Point2::new(west, south),
                Point2::new(2.0, south),
                Point2::new(8.0, south),
            ],
            turn: Some(4),
        }
    }

    /// The walls.
    #[must_use]
    pub fn world(&self) -> &World {
        &self.world
    }

    /// True start pose, world frame.
    #[must_use]
    pub fn start(&self) -> SE2 {
        self.start
    }

    /// Waypoints in metres, world frame, in the order in which they are visited.
    #[must_use]
    pub fn way_points(&self) -> &[Point2<f64>] {
        &self.way_points
    }

    /// Index of the waypoint, from 0, after which the robot revisits known space.
    #[must_use]
    pub fn turn(&self) -> Option<usize> {
        self.turn
    }

    fn check(&self) -> Result<(), CourseError> {
        self.check_counts()?;
        self.check_numbers()?;
        self.check_places()?;
        self.check_way()
    }

    fn check_counts(&self) -> Result<(), CourseError> {
        let (walls, way_points) = (self.world.walls().len(), self.way_points.len());
        if walls == 0 {
            return Err(CourseError::NoWalls);
        }
        if walls > limits::WALLS {
            return Err(CourseError::TooManyWalls {
                count: walls,
                limit: limits::WALLS,
            });
        }
        if way_points == 0 {
            return Err(CourseError::NoWayPoints);
        }
        if way_points > limits::WAY_POINTS {
            return Err(CourseError::TooManyWayPoints {
                count: way_points,
                limit: limits::WAY_POINTS,
            });
        }
        match self.turn {
            Some(turn) if turn >= way_points => Err(CourseError::NoSuchTurn {
                turn: turn + 1,
                count: way_points,
            }),
            _ => Ok(()),
        }
    }

    fn check_numbers(&self) -> Result<(), CourseError> {
        let within = |point: &Point2<f64>| {
            let limit = limits::COORDINATE_M;
            (-limit..=limit).contains(&point.x) && (-limit..=limit).contains(&point.y)
        };
        let out = |place| CourseError::TooFar {
            place,
            limit_m: limits::COORDINATE_M,
        };
        for (index, wall) in self.world.walls().iter().enumerate() {
            if !within(&wall.start) || !within(&wall.end) {
                return Err(out(CoursePoint::Wall(index + 1)));
            }
            if wall.start == wall.end {
                return Err(CourseError::NoLength { wall: index + 1 });
            }
        }
        match self.stops().find(|(_, point)| !within(point)) {
            Some((place, _)) => Err(out(place)),
            None if !self.start.theta().is_finite() => Err(CourseError::NoHeading),
            None => Ok(()),
        }
    }

    fn check_places(&self) -> Result<(), CourseError> {
        let bounds = self.world.bounds();
        for (place, point) in self.stops() {
            let is_inside = (bounds.min.x..=bounds.max.x).contains(&point.x)
                && (bounds.min.y..=bounds.max.y).contains(&point.y);
            if !is_inside {
                return Err(CourseError::Outside { place, bounds });
            }
            let (wall, distance_m) = nearest_wall(&self.world, point);
            if distance_m < CLEARANCE_M {
                return Err(CourseError::AtWall {
                    place,
                    wall: wall + 1,
                    distance_m,
                });
            }
        }
        Ok(())
    }

    fn check_way(&self) -> Result<(), CourseError> {
        let mut length_m = 0.0;
        for ((from, from_point), (to, to_point)) in self.stops().zip(self.stops().skip(1)) {
            let (wall, distance_m) = nearest_wall_to_leg(&self.world, from_point, to_point);
            if distance_m < CLEARANCE_M {
                return Err(CourseError::Blocked {
                    from,
                    to,
                    wall: wall + 1,
                    distance_m,
                });
            }
            length_m += math::norm2(to_point.x - from_point.x, to_point.y - from_point.y);
        }
        if length_m > limits::PATH_LENGTH_M {
            return Err(CourseError::TooLong {
                length_m,
                limit_m: limits::PATH_LENGTH_M,
            });
        }
        Ok(())
    }

    /// The start and every waypoint.
    fn stops(&self) -> impl Iterator<Item = (CoursePoint, Point2<f64>)> {
        let way_points = self.way_points.iter().enumerate();
        core::iter::once((CoursePoint::Start, self.start.position()))
            .chain(way_points.map(|(index, &point)| (CoursePoint::WayPoint(index + 1), point)))
    }
}

#[cfg(test)]
mod tests;
