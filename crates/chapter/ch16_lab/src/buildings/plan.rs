//! Walls and a path through them, generated from a seed.

use pr_geom::{Point2, math, order_by};
use pr_sim::{Rng, Wall, World, WorldRect};

/// Width of a door, m.
const DOOR_M: f64 = 0.95;
/// Recess of a closed door behind its wall, m.
const RECESS_M: f64 = 0.1;
/// Depth of the rooms on the outer side of a corridor, m.
const DEPTH_M: f64 = 5.0;

/// Layout of the corridors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Layout {
    /// A loop around a block of rooms, driven twice and then halfway back.
    #[default]
    Ring,
    /// One corridor, driven there and back.
    Hallway,
}

/// Variation among rooms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rooms {
    /// Widths, doors and furniture differ.
    #[default]
    Different,
    /// All rooms are equal, without furniture.
    Alike,
}

/// Parameters of a generated building.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuildingConfig {
    /// Seed of walls, path and furniture.
    pub seed: u32,
    /// Layout of the corridors.
    pub layout: Layout,
    /// Variation among rooms.
    pub rooms: Rooms,
    /// Length and width of the loop of corridor center lines, m; a hallway has no width.
    pub extent_m: [f64; 2],
    /// Width of a corridor, m.
    pub corridor_m: f64,
    /// Share of the rooms whose door is open and that the robot visits.
    pub visited: f64,
    /// Share of the facade that is glass.
    pub glass: f64,
}

impl Default for BuildingConfig {
    fn default() -> Self {
        Self {
            seed: 1,
            layout: Layout::Ring,
            rooms: Rooms::Different,
            extent_m: [32.0, 16.0],
            corridor_m: 2.0,
            visited: 0.2,
            glass: 0.3,
        }
    }
}

/// A building and a path through it.
#[derive(Clone, Debug, PartialEq)]
pub struct BuildingPlan {
    /// Walls that every beam sees.
    pub opaque: World,
    /// Glass, which beams pass unless they meet it almost head-on.
    pub glass: World,
    /// Waypoints, joined by straight lines, m.
    pub path: Vec<Point2<f64>>,
}

impl BuildingPlan {
    /// Generates the building of a seed.
    #[must_use]
    pub fn new(config: &BuildingConfig) -> Self {
        let mut draft = Draft {
            config: *config,
            rng: Rng::new(config.seed),
            opaque: Vec::new(),
            glass: Vec::new(),
            visits: Vec::new(),
        };
        let path = match config.layout {
            Layout::Ring => draft.ring(),
            Layout::Hallway => draft.hallway(),
        };
        let [length, width] = config.extent_m;
        let reach = 2.0 * DEPTH_M + config.corridor_m;
        let bounds = WorldRect {
            min: Point2::new(-reach, -reach),
            max: Point2::new(length + reach, width + reach),
        };
        Self {
            opaque: World::new(bounds, draft.opaque),
            glass: World::new(bounds, draft.glass),
            path,
        }
    }
}

/// A straight side of a corridor: a frame with x along the wall and y into the rooms.
#[derive(Clone, Copy)]
struct Side {
    origin: [f64; 2],
    along: [f64; 2],
    into: [f64; 2],
    length: f64,
    /// Depth of the rooms, m.
    depth: f64,
    /// Whether the rooms end at a facade, which may be glass.
    is_outer: bool,
}

impl Side {
    fn at(&self, x: f64, y: f64) -> Point2<f64> {
        let [ox, oy] = self.origin;
        Point2::new(
            ox + x * self.along[0] + y * self.into[0],
            oy + x * self.along[1] + y * self.into[1],
        )
    }
}

/// A room to visit: where to leave the corridor, and how far to go in.
#[derive(Clone, Copy)]
struct Visit {
    corridor: Point2<f64>,
    inside: Point2<f64>,
}

struct Draft {
    config: BuildingConfig,
    rng: Rng,
    opaque: Vec<Wall>,
    glass: Vec<Wall>,
    visits: Vec<Visit>,
}

impl Draft {
    /// Corridors around a block, driven twice, then halfway back.
    fn ring(&mut self) -> Vec<Point2<f64>> {
        let [length, width] = self.config.extent_m;
        let half = 0.5 * self.config.corridor_m;
        let corners = [[0.0, 0.0], [length, 0.0], [length, width], [0.0, width]];
        let inner_depth = (0.5 * width - half).min(DEPTH_M);
        for k in 0..4 {
            let (from, to) = (corners[k], corners[(k + 1) % 4]);
            let span = math::norm2(to[0] - from[0], to[1] - from[1]);
            let along = [(to[0] - from[0]) / span, (to[1] - from[1]) / span];
            let inward = [-along[1], along[0]];
            let outward = [along[1], -along[0]];
            let shifted = |start: f64, side: [f64; 2]| {
                [
                    from[0] + start * along[0] + half * side[0],
                    from[1] + start * along[1] + half * side[1],
                ]
            };
            self.side(Side {
                origin: shifted(half, inward),
                along,
                into: inward,
                length: span - 2.0 * half,
                depth: inner_depth,
                is_outer: false,
            });
            self.side(Side {
                origin: shifted(-half, outward),
                along,
                into: outward,
                length: span + 2.0 * half,
                depth: DEPTH_M,
                is_outer: true,
            });
        }
        let corner = |k: usize| Point2::new(corners[k % 4][0], corners[k % 4][1]);
        let start = Point2::new(0.3 * length, 0.0);
        let mut path = vec![start];
        for k in 1..=4 {
            self.drive(&mut path, corner(k), true);
        }
        self.drive(&mut path, start, false);
        for k in 1..=4 {
            self.drive(&mut path, corner(k), false);
        }
        self.drive(&mut path, start, false);
        self.drive(&mut path, corner(4), false);
        self.drive(&mut path, corner(3), false);
        self.drive(&mut path, corner(2), false);
        path
    }

    /// One corridor with rooms on both sides, there and back.
    fn hallway(&mut self) -> Vec<Point2<f64>> {
        let [length, _] = self.config.extent_m;
        let half = 0.5 * self.config.corridor_m;
        for sign in [1.0, -1.0] {
            self.side(Side {
                origin: [0.0, sign * half],
                along: [1.0, 0.0],
                into: [0.0, sign],
                length,
                depth: DEPTH_M,
                is_outer: true,
            });
        }
        for x in [0.0, length] {
            self.opaque.push(Wall {
                start: Point2::new(x, -half),
                end: Point2::new(x, half),
            });
        }
        let (start, end) = (Point2::new(1.5, 0.0), Point2::new(length - 1.5, 0.0));
        let mut path = vec![start];
        self.drive(&mut path, end, true);
        self.drive(&mut path, start, false);
        self.drive(&mut path, end, false);
        path
    }

    /// Drives straight to `to`, with detours into the rooms to visit on the way.
    fn drive(&mut self, path: &mut Vec<Point2<f64>>, to: Point2<f64>, visit: bool) {
        let from = path[path.len() - 1];
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        let span = math::norm2(dx, dy);
        if visit && span > 0.0 {
            let place = |visit: &Visit| {
                let (x, y) = (visit.corridor.x - from.x, visit.corridor.y - from.y);
                let along = (x * dx + y * dy) / span;
                let off = (x * dy - y * dx).abs() / span;
                (off < 0.1 && along > 0.5 && along < span - 0.5).then_some(along)
            };
            let stops: Vec<(f64, Visit)> = self
                .visits
                .iter()
                .filter_map(|visit| Some((place(visit)?, *visit)))
                .collect();
            for at in order_by(stops.len(), &|at| stops[at].0) {
                let (_, stop) = stops[at];
                path.extend([stop.corridor, stop.inside, stop.corridor]);
            }
        }
        path.push(to);
    }

    /// A wall with rooms behind it.
    fn side(&mut self, side: Side) {
        let alike = self.config.rooms == Rooms::Alike;
        let rooms = match alike {
            true => (side.length / 4.0) as usize,
            false => (side.length / self.rng.uniform(3.0, 5.5)) as usize,
        };
        let rooms = rooms.max(1);
        let pitch = side.length / rooms as f64;
        let mut edges: Vec<f64> = (0..=rooms).map(|k| pitch * k as f64).collect();
        if !alike {
            for edge in &mut edges[1..rooms] {
                *edge += self.rng.uniform(-0.15, 0.15) * pitch;
            }
        }
        for pair in edges.windows(2) {
            self.room(&side, pair[0], pair[1]);
        }
        for &edge in &edges {
            self.wall(side.at(edge, 0.0), side.at(edge, side.depth));
        }
    }

    fn room(&mut self, side: &Side, from: f64, to: f64) {
        let alike = self.config.rooms == Rooms::Alike;
        let draw = self.rng.unit();
        let middle = match alike {
            true => 0.5 * (from + to),
            false => self.rng.uniform(from + 0.8, (to - 0.8).max(from + 0.81)),
        };
        let (left, right) = (middle - 0.5 * DOOR_M, middle + 0.5 * DOOR_M);
        self.wall(side.at(from, 0.0), side.at(left, 0.0));
        self.wall(side.at(right, 0.0), side.at(to, 0.0));
        self.facade(side, from, to);
        let (is_visited, is_open) = (draw < self.config.visited, draw < 0.5);
        if !is_open && !alike {
            self.wall(side.at(left, RECESS_M), side.at(right, RECESS_M));
            for x in [left, right] {
                self.wall(side.at(x, 0.0), side.at(x, RECESS_M));
            }
            return;
        }
        let keep_clear = if is_visited && side.depth > 2.5 {
            let into = 0.6 * side.depth;
            self.visits.push(Visit {
                corridor: side.at(middle, -0.5 * self.config.corridor_m),
                inside: side.at(middle, into),
            });
            into + 0.5
        } else {
            1.0
        };
        if alike {
            return;
        }
        let boxes = (self.rng.unit() * 5.0) as usize;
        for _ in 0..boxes {
            let (w, h) = (self.rng.uniform(0.3, 1.5), self.rng.uniform(0.3, 0.8));
            let x = self
                .rng
                .uniform(from + 0.1, (to - 0.1 - w).max(from + 0.11));
            let y = self.rng.uniform(0.4, (side.depth - 0.1 - h).max(0.41));
            let blocks = x - 0.5 < middle && middle < x + w + 0.5 && y < keep_clear;
            if !blocks {
                self.furniture(side, x, y, w, h);
            }
        }
    }

    fn furniture(&mut self, side: &Side, x: f64, y: f64, w: f64, h: f64) {
        let corners = [(x, y), (x + w, y), (x + w, y + h), (x, y + h), (x, y)];
        for pair in corners.windows(2) {
            self.wall(side.at(pair[0].0, pair[0].1), side.at(pair[1].0, pair[1].1));
        }
    }

    /// The far wall of a room, with or without glass in its middle.
    fn facade(&mut self, side: &Side, from: f64, to: f64) {
        let y = side.depth;
        let is_glass = self.rng.unit() < self.config.glass && side.is_outer;
        if is_glass {
            let (a, b) = (from + 0.3, to - 0.3);
            self.wall(side.at(from, y), side.at(a, y));
            self.wall(side.at(b, y), side.at(to, y));
            let (start, end) = (side.at(a, y), side.at(b, y));
            self.glass.push(Wall { start, end });
        } else {
            self.wall(side.at(from, y), side.at(to, y));
        }
    }

    fn wall(&mut self, start: Point2<f64>, end: Point2<f64>) {
        self.opaque.push(Wall { start, end });
    }
}
