//! Three worlds in which SLAM fails, because the scans do not determine the pose.

use core::f64::consts::TAU;

use pr_geom::{Point2, SE2, math};

use super::Course;
use super::file::extent;
use crate::world::{Wall, World};

/// Width of each of the two rooms, m.
const ROOM_M: f64 = 1.3;

/// The west wall of the first room, m.
const ROOMS_AT_M: f64 = 4.2;

/// Middle line of the corridor before the rooms, and of the bare corridor, m.
const MIDDLE_M: f64 = 0.8;

/// Radius of the hall and of the path around it, m.
const HALL_M: f64 = 3.5;
const HALL_WAY_M: f64 = 2.2;

/// Number of walls of the hall, and of waypoints of one round.
const HALL_WALLS: u16 = 36;
const HALL_ROUND: u16 = 8;

impl Course {
    /// Two identical rooms side by side on a corridor: into one, up and down the corridor twice, into
    /// the other.
    ///
    /// The scans of both rooms are the same. They are 1.3 m apart, and the drift may be as large after
    /// such a path length, so data association fails.
    #[must_use]
    pub fn twin_rooms() -> Self {
        let east = ROOMS_AT_M + 2.0 * ROOM_M;
        let mut walls = vec![
            Wall::horizontal(0.0, 0.0, 12.0),
            Wall::vertical(12.0, 0.0, 1.6),
            Wall::vertical(0.0, 0.0, 1.6),
            Wall::horizontal(1.6, 0.0, ROOMS_AT_M),
            Wall::horizontal(1.6, east, 12.0),
            Wall::vertical(east, 1.6, 4.6),
            // Pillars, because the corridor itself must not be degenerate.
            Wall::vertical(2.0, 1.25, 1.6),
            Wall::vertical(9.0, 0.0, 0.3),
        ];
        for x in [ROOMS_AT_M, ROOMS_AT_M + ROOM_M] {
            let far = x + ROOM_M;
            walls.extend([
                Wall::horizontal(1.6, x, x + 0.25),
                Wall::horizontal(1.6, far - 0.25, far),
                Wall::vertical(x, 1.6, 4.6),
                Wall::horizontal(4.6, x, far),
                Wall::horizontal(3.2, x, x + 0.25),
                Wall::horizontal(4.1, far - 0.25, far),
            ]);
        }
        let [first, second] = [0.5, 1.5].map(|rooms| ROOMS_AT_M + rooms * ROOM_M);
        let visit = |x| [(x, MIDDLE_M), (x, 3.7), (x, MIDDLE_M)];
        let mut way = visit(first).to_vec();
        for _ in 0..2 {
            way.extend([(11.0, MIDDLE_M), (1.0, MIDDLE_M)]);
        }
        way.extend(visit(second));
        way.push((1.0, MIDDLE_M));
        Self::built(walls, SE2::new(1.0, MIDDLE_M, 0.0), &way, 3)
    }

    /// A corridor of 24 m without a door or a pillar, there and back.
    ///
    /// Degenerate along its axis: every scan equals the previous one.
    #[must_use]
    pub fn bare_corridor() -> Self {
        let walls = vec![
            Wall::horizontal(0.0, 0.0, 24.0),
            Wall::vertical(24.0, 0.0, 1.6),
            Wall::horizontal(1.6, 0.0, 24.0),
            Wall::vertical(0.0, 0.0, 1.6),
        ];
        let way = [(22.5, MIDDLE_M), (1.0, MIDDLE_M)];
        Self::built(walls, SE2::new(1.0, MIDDLE_M, 0.0), &way, 0)
    }

    /// A round hall of 7 m, one and a half times around.
    ///
    /// Its wall of 36 segments determines the distance, but hardly the heading.
    #[must_use]
    pub fn round_hall() -> Self {
        let at = |radius_m: f64, share: f64| {
            let angle = TAU * share;
            let along = |of: f64| HALL_M + radius_m * of;
            (along(math::cos(angle)), along(math::sin(angle)))
        };
        let corner = |k: u16| {
            let (x, y) = at(HALL_M, f64::from(k % HALL_WALLS) / f64::from(HALL_WALLS));
            Point2::new(x, y)
        };
        let walls = (0..HALL_WALLS).map(|k| Wall {
            start: corner(k),
            end: corner(k + 1),
        });
        let stop = |k: u16| at(HALL_WAY_M, f64::from(k) / f64::from(HALL_ROUND));
        let way: Vec<_> = (1..=HALL_ROUND + HALL_ROUND / 2).map(stop).collect();
        let (x, y) = stop(0);
        let start = SE2::new(x, y, 0.25 * TAU);
        Self::built(walls.collect(), start, &way, usize::from(HALL_ROUND) - 1)
    }

    fn built(walls: Vec<Wall>, start: SE2, way: &[(f64, f64)], turn: usize) -> Self {
        Self {
            world: World::new(extent(&walls), walls),
            start,
            way_points: way.iter().map(|&(x, y)| Point2::new(x, y)).collect(),
            turn: Some(turn),
        }
    }
}
