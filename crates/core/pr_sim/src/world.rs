//! Walls as line segments, the Apartment among them, and the ray cast against them.

use pr_geom::{Point2, math};

/// Below this |d × (s2 − s1)| a ray counts as parallel to a wall.
const PARALLEL: f64 = 1e-12;

/// Walls up to this much beyond the range are still tested, because distance and ray round differently, m.
const RANGE_ROUNDING_M: f64 = 1e-6;

/// A wall: the segment from `start` to `end`, in metres, world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// One end.
    pub start: Point2<f64>,
    /// The other end.
    pub end: Point2<f64>,
}

impl Wall {
    pub(crate) fn horizontal(y: f64, x_from: f64, x_to: f64) -> Self {
        Self {
            start: Point2::new(x_from, y),
            end: Point2::new(x_to, y),
        }
    }

    pub(crate) fn vertical(x: f64, y_from: f64, y_to: f64) -> Self {
        Self {
            start: Point2::new(x, y_from),
            end: Point2::new(x, y_to),
        }
    }
}

/// An axis-aligned rectangle in metres, world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldRect {
    /// Lower left corner.
    pub min: Point2<f64>,
    /// Upper right corner.
    pub max: Point2<f64>,
}

/// A room of the Apartment, for labels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// The chapter's name of the room.
    pub name: &'static str,
    /// Its extent.
    pub bounds: WorldRect,
}

/// A planar world of walls.
#[derive(Clone, Debug, PartialEq)]
pub struct World {
    bounds: WorldRect,
    walls: Vec<Wall>,
}

impl World {
    /// Creates a world of walls within `bounds`.
    #[must_use]
    pub fn new(bounds: WorldRect, walls: Vec<Wall>) -> Self {
        Self { bounds, walls }
    }

    /// The Apartment of Chapter 4: 12 m × 9 m, a corridor between y = 3.8 and y = 5, three rooms
    /// south of it and two north.
    #[must_use]
    pub fn apartment() -> Self {
        let walls = vec![
            Wall::horizontal(0.0, 0.0, 12.0),
            Wall::horizontal(9.0, 0.0, 12.0),
            Wall::vertical(0.0, 0.0, 9.0),
            Wall::vertical(12.0, 0.0, 9.0),
            // Corridor, south side.
            Wall::horizontal(3.8, 0.0, 1.6),
            Wall::horizontal(3.8, 2.5, 5.5),
            Wall::horizontal(3.8, 6.5, 9.5),
            Wall::horizontal(3.8, 10.4, 12.0),
            // Corridor, north side.
            Wall::horizontal(5.0, 0.0, 2.8),
            Wall::horizontal(5.0, 3.7, 7.4),
            Wall::horizontal(5.0, 8.3, 12.0),
            // Between the rooms.
            Wall::vertical(4.0, 0.0, 3.8),
            Wall::vertical(8.0, 0.0, 3.8),
            Wall::vertical(6.0, 5.0, 9.0),
            // Counter, nook, closet.
            Wall::horizontal(1.4, 4.0, 6.2),
            Wall::vertical(2.0, 7.6, 9.0),
            Wall::vertical(9.6, 7.4, 9.0),
            Wall::horizontal(7.4, 9.6, 10.9),
        ];
        Self::new(rectangle(0.0, 0.0, 12.0, 9.0), walls)
    }

    /// The rooms of [`World::apartment`]: A, B, C south of the corridor, D and E north of it.
    #[must_use]
    pub fn apartment_rooms() -> [Room; 5] {
        let room = |name, x_from, y_from, x_to, y_to| Room {
            name,
            bounds: rectangle(x_from, y_from, x_to, y_to),
        };
        [
            room("A", 0.0, 0.0, 4.0, 3.8),
            room("B", 4.0, 0.0, 8.0, 3.8),
            room("C", 8.0, 0.0, 12.0, 3.8),
            room("D", 0.0, 5.0, 6.0, 9.0),
            room("E", 6.0, 5.0, 12.0, 9.0),
        ]
    }

    /// The extent of the world.
    #[must_use]
    pub fn bounds(&self) -> WorldRect {
        self.bounds
    }

    /// The walls, in the order in which they are tested.
    #[must_use]
    pub fn walls(&self) -> &[Wall] {
        &self.walls
    }

    /// Casts a ray: distance in metres from `origin` along `angle_rad` to the first wall, at most
    /// `max_range_m`.
    #[must_use]
    pub fn cast(&self, origin: Point2<f64>, angle_rad: f64, max_range_m: f64) -> f64 {
        let mut viewpoint = Viewpoint::default();
        viewpoint.stand_at(self, origin, max_range_m);
        viewpoint.cast(angle_rad)
    }
}

pub(crate) fn rectangle(x_from: f64, y_from: f64, x_to: f64, y_to: f64) -> WorldRect {
    WorldRect {
        min: Point2::new(x_from, y_from),
        max: Point2::new(x_to, y_to),
    }
}

/// Casts rays from one origin: the walls within range, relative to it.
///
/// One array per coordinate, because the inner loop can then use SIMD.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Viewpoint {
    max_range_m: f64,
    to_start_x: Vec<f64>,
    to_start_y: Vec<f64>,
    edge_x: Vec<f64>,
    edge_y: Vec<f64>,
    /// `(s1 − o) × (s2 − s1)`: the distance to the wall's line, times the wall's length.
    start_cross_edge: Vec<f64>,
}

impl Viewpoint {
    /// Moves the viewpoint to `origin` and drops walls beyond `max_range_m`; reuses the buffers.
    pub fn stand_at(&mut self, world: &World, origin: Point2<f64>, max_range_m: f64) {
        self.max_range_m = max_range_m;
        for buffer in [
            &mut self.to_start_x,
            &mut self.to_start_y,
            &mut self.edge_x,
            &mut self.edge_y,
            &mut self.start_cross_edge,
        ] {
            buffer.clear();
        }
        for wall in &world.walls {
            let (x, y) = (wall.start.x - origin.x, wall.start.y - origin.y);
            let (edge_x, edge_y) = (wall.end.x - wall.start.x, wall.end.y - wall.start.y);
            if distance_to_segment(x, y, edge_x, edge_y) > max_range_m + RANGE_ROUNDING_M {
                continue;
            }
            self.to_start_x.push(x);
            self.to_start_y.push(y);
            self.edge_x.push(edge_x);
            self.edge_y.push(edge_y);
            self.start_cross_edge.push(x * edge_y - y * edge_x);
        }
    }

    /// Distance in metres along `angle_rad` to the first wall, at most the range.
    ///
    /// With d = (cos a, sin a): `t = (s1 − o) × (s2 − s1) / d × (s2 − s1)` along the ray and
    /// `u = (s1 − o) × d / d × (s2 − s1)` along the wall; a hit has t ≥ 0 and 0 ≤ u ≤ 1.
    #[must_use]
    pub fn cast(&self, angle_rad: f64) -> f64 {
        let (dir_y, dir_x) = math::sin_cos(angle_rad);
        let n = self.start_cross_edge.len();
        let (to_start_x, to_start_y) = (&self.to_start_x[..n], &self.to_start_y[..n]);
        let (edge_x, edge_y) = (&self.edge_x[..n], &self.edge_y[..n]);
        let mut best = self.max_range_m;
        for i in 0..n {
            let denominator = dir_x * edge_y[i] - dir_y * edge_x[i];
            let t = self.start_cross_edge[i] / denominator;
            let u = (to_start_x[i] * dir_y - to_start_y[i] * dir_x) / denominator;
            // One test without a branch: most walls miss, in a pattern that branch prediction cannot
            // learn.
            let on_ray = (t >= 0.0) & (t < best);
            let on_wall = (0.0..=1.0).contains(&u);
            let hit = (denominator.abs() >= PARALLEL) & on_ray & on_wall;
            best = if hit { t } else { best };
        }
        best
    }
}

/// Distance from the origin to the segment that starts at `(x, y)` and runs along the edge.
pub(crate) fn distance_to_segment(x: f64, y: f64, edge_x: f64, edge_y: f64) -> f64 {
    let length_squared = edge_x * edge_x + edge_y * edge_y;
    let along = if length_squared > 0.0 {
        (-(x * edge_x + y * edge_y) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    math::norm2(x + along * edge_x, y + along * edge_y)
}

#[cfg(test)]
mod tests {
    use core::f64::consts::{FRAC_PI_2, PI};

    use super::*;

    #[test]
    fn rays_along_the_axes_of_room_a_measure_its_walls() {
        // Room A is 4.0 m × 3.8 m; from (1, 1) the ray north passes no door.
        let world = World::apartment();
        let origin = Point2::new(1.0, 1.0);
        for (angle, range) in [(0.0, 3.0), (FRAC_PI_2, 2.8), (PI, 1.0), (-FRAC_PI_2, 1.0)] {
            assert!((world.cast(origin, angle, 6.0) - range).abs() < 1e-12);
        }
    }

    #[test]
    fn a_ray_through_a_door_passes_the_wall() {
        // The door of room A is x 1.6…2.5; the ray north at x = 2 meets the corridor's north wall.
        let range = World::apartment().cast(Point2::new(2.0, 1.9), FRAC_PI_2, 6.0);
        assert!((range - 3.1).abs() < 1e-12);
    }

    #[test]
    fn leaving_out_far_walls_changes_no_range() {
        let world = World::apartment();
        for k in 0..500 {
            let step = f64::from(k);
            let origin = Point2::new(0.5 + 0.021 * step, 0.4 + 0.016 * step);
            let angle = 0.7 * step;
            let far = world.cast(origin, angle, 100.0);
            assert_eq!(world.cast(origin, angle, 3.0), far.min(3.0));
        }
    }

    #[test]
    fn a_wall_beyond_the_range_returns_the_range() {
        assert_eq!(
            World::apartment().cast(Point2::new(1.35, 4.42), 0.0, 6.0),
            6.0
        );
    }
}
