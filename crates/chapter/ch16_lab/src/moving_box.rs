//! Two sweeps of room A with a box that moved in between, and its effect on a registration.
//!
//! The box takes a chosen share of the points of both sweeps; its beams are as dense as that requires. Its
//! points are paired with its old outline or with the wall behind, so all of these pairs are outliers. Their
//! influence depends on how long pairs are treated: full weight, rejection, or reduced weight.

use ch16_slam2d::cloud::{DenseMap, PointCloud};
use ch16_slam2d::icp::{
    Icp, IcpConfig, IcpSummary, IcpVariant, IcpWorkspace, Pair, correspondences,
};
use nalgebra::{Point2, Vector2};
use pr_geom::{SE2, math, sort_numbers};
use pr_sim::{Rng, Wall, World};

use crate::scenes::{self, NORMAL_RADIUS_M};

/// Side of the box, m.
pub const BOX_SIDE_M: f64 = 0.4;

/// Points of each sweep.
pub const SWEEP_POINTS: usize = 180;

const RANGE_SIGMA_M: f64 = 0.012;
/// Five standard deviations of the range noise.
const NOISE_MARGIN_M: f64 = 5.0 * RANGE_SIGMA_M;
const MAX_RANGE_M: f64 = 6.0;
/// Rays per point of a sweep that classify box and walls.
const RAYS_PER_POINT: usize = 4;
const MAP_CELL_M: f64 = 0.25;
/// All points: those of the box are in few cells.
const MAP_POINTS_PER_CELL: usize = SWEEP_POINTS;
/// The truth, `target_from_source`.
const TRUTH: (f64, f64, f64) = (0.12, -0.08, 0.06);

/// Parameters of the two sweeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxConfig {
    /// Seed of the range noise.
    pub seed: u32,
    /// Share of the points that lie on the box, 0 to 1.
    pub share: f64,
    /// Displacement of the box in the world, m.
    pub moved_m: [f64; 2],
}

impl Default for BoxConfig {
    fn default() -> Self {
        Self {
            seed: 1,
            share: 0.2,
            moved_m: [0.3, 0.0],
        }
    }
}

/// How outliers are treated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxMethods {
    /// Which error the increments reduce.
    pub variant: IcpVariant,
    /// Largest distance of a pair, m.
    pub tau_m: f64,
    /// Share of the pairs that trimming drops.
    pub dropped: f64,
    /// Width of Huber's kernel, m.
    pub huber_width_m: f64,
}

impl Default for BoxMethods {
    fn default() -> Self {
        Self {
            variant: IcpVariant::PointToPoint,
            tau_m: 0.7,
            dropped: 0.25,
            huber_width_m: 0.05,
        }
    }
}

impl BoxMethods {
    /// Plain, trimmed, and with Huber's kernel.
    pub const NAMES: [&str; 3] = ["plain", "trimmed", "Huber"];

    /// Settings of the three registrations, in the order of [`BoxMethods::NAMES`].
    #[must_use]
    pub fn configs(&self) -> [IcpConfig; 3] {
        let plain = IcpConfig {
            variant: self.variant,
            tau_m: self.tau_m,
            max_iterations: 30,
            ..IcpConfig::default()
        };
        [
            plain,
            IcpConfig {
                trim: self.dropped,
                ..plain
            },
            IcpConfig {
                huber_width_m: self.huber_width_m,
                ..plain
            },
        ]
    }
}

/// The two sweeps.
#[derive(Clone, Debug)]
pub struct BoxScene {
    target: PointCloud,
    map: DenseMap,
    source: PointCloud,
    boxes: [[Point2<f64>; 4]; 2],
    walls: Vec<[Point2<f64>; 2]>,
}

impl BoxScene {
    /// Takes the sweeps: the target with the box before its move, the source after it.
    #[must_use]
    pub fn new(config: &BoxConfig) -> Self {
        let world_from_target = scenes::room_a();
        let world_from_source = world_from_target * Self::truth();
        let mut rng = Rng::new(config.seed);
        let before = Point2::new(world_from_target.x() + 0.8, world_from_target.y() + 0.7);
        let after = before + Vector2::from(config.moved_m);
        let mut sweep = |middle: Point2<f64>, from: &SE2| {
            let mut cloud = sweep(&with_box(middle), from, config.share, &mut rng);
            cloud.estimate_normals(NORMAL_RADIUS_M);
            cloud
        };
        let target = sweep(before, &world_from_target);
        let source = sweep(after, &world_from_source);
        let target_from_world = world_from_target.inverse();
        let outline = |middle| corners(middle).map(|corner| target_from_world.transform(corner));
        Self {
            map: DenseMap::from_cloud(&target, MAP_CELL_M, MAP_POINTS_PER_CELL),
            target,
            source,
            boxes: [outline(before), outline(after)],
            walls: scenes::walls_seen_from(&World::apartment(), &world_from_target),
        }
    }

    /// The true `target_from_source`.
    #[must_use]
    pub fn truth() -> SE2 {
        let (x, y, theta) = TRUTH;
        SE2::new(x, y, theta)
    }

    /// The walls in the frame of the target's sensor, as pictures draw them.
    #[must_use]
    pub fn walls(&self) -> &[[Point2<f64>; 2]] {
        &self.walls
    }

    /// The sweep before the move, in its sensor's frame.
    #[must_use]
    pub fn target(&self) -> &PointCloud {
        &self.target
    }

    /// The sweep after the move, in its sensor's frame.
    #[must_use]
    pub fn source(&self) -> &PointCloud {
        &self.source
    }

    /// Corners of the box before and after, in the target's frame.
    #[must_use]
    pub fn boxes(&self) -> &[[Point2<f64>; 4]; 2] {
        &self.boxes
    }

    /// Registers the source from the target's pose; the trace stays in the workspace.
    pub fn register(&self, config: &IcpConfig, workspace: &mut IcpWorkspace) -> IcpSummary {
        let start = SE2::identity();
        Icp::new(&self.source, &self.map, start, config, workspace).run()
    }

    /// The pairs of a registration with the source at `target_from_source`.
    #[must_use]
    pub fn pairs(&self, target_from_source: SE2, config: &IcpConfig) -> Vec<Pair> {
        correspondences(&self.source, &self.map, target_from_source, config)
    }

    /// Whether a point of the source lies on the box.
    #[must_use]
    pub fn is_on_box(&self, source_index: usize) -> bool {
        let [_, outline] = &self.boxes;
        let point = Self::truth().transform(self.source.point(source_index));
        let within = |of: fn(&Point2<f64>) -> f64| {
            let ends = outline.iter().map(of);
            let low = ends.clone().fold(f64::INFINITY, f64::min) - NOISE_MARGIN_M;
            let high = ends.fold(f64::NEG_INFINITY, f64::max) + NOISE_MARGIN_M;
            (low..high).contains(&of(&point))
        };
        within(|p| p.x) && within(|p| p.y)
    }

    /// Error of the translation of a registered `target_from_source`, m, in the target's frame.
    #[must_use]
    pub fn error_m(found: &SE2) -> [f64; 2] {
        let truth = Self::truth();
        [found.x() - truth.x(), found.y() - truth.y()]
    }
}

/// Room A with a box in it.
fn with_box(middle: Point2<f64>) -> World {
    let room = World::apartment();
    let mut walls = room.walls().to_vec();
    let corners = corners(middle);
    walls.extend((0..4).map(|k| Wall {
        start: corners[k],
        end: corners[(k + 1) % 4],
    }));
    World::new(room.bounds(), walls)
}

fn corners(middle: Point2<f64>) -> [Point2<f64>; 4] {
    let half = 0.5 * BOX_SIDE_M;
    [(-half, -half), (half, -half), (half, half), (-half, half)]
        .map(|(x, y)| Point2::new(middle.x + x, middle.y + y))
}

/// A sweep with a share of its points on the box, evenly spread, and the rest on the walls.
fn sweep(world: &World, from: &SE2, share: f64, rng: &mut Rng) -> PointCloud {
    let empty = World::apartment();
    let rays = RAYS_PER_POINT * SWEEP_POINTS;
    let bearing = |k: f64| k / rays as f64 * core::f64::consts::TAU - core::f64::consts::PI;
    let origin = from.position();
    let cast = |world: &World, k: f64| world.cast(origin, from.theta() + bearing(k), MAX_RANGE_M);
    // A ray hits the box if its range would be larger without it.
    let (on_box, on_walls): (Vec<usize>, Vec<usize>) =
        (0..rays).partition(|&k| cast(world, k as f64) < cast(&empty, k as f64));
    let boxed = (share * SWEEP_POINTS as f64).round() as usize;
    let share_of = |i: usize, count: usize| (i as f64 + 0.5) / count as f64;
    let mut bearings = Vec::with_capacity(SWEEP_POINTS);
    if let [first, .., last] = on_box[..] {
        // The box is seen in one piece, without gaps between its rays.
        let (first, width) = (first as f64, (last - first) as f64);
        bearings.extend((0..boxed).map(|i| first + share_of(i, boxed) * width));
    }
    let walls = SWEEP_POINTS - bearings.len();
    let on_wall = |i: usize| on_walls[(share_of(i, walls) * on_walls.len() as f64) as usize];
    bearings.extend((0..walls).map(|i| on_wall(i) as f64));
    sort_numbers(&mut bearings);
    let points = bearings.into_iter().map(|k| {
        let range_m = cast(world, k) + rng.normal(0.0, RANGE_SIGMA_M);
        let (sin, cos) = math::sin_cos(bearing(k));
        Point2::new(range_m * cos, range_m * sin)
    });
    points.collect()
}

/// Translation errors over many seeds at one share of the box.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BoxErrors {
    /// Errors of each method in the order of the seeds, m.
    pub errors_m: [Vec<[f64; 2]>; 3],
}

impl BoxErrors {
    /// Adds the three registrations of a scene.
    pub fn add(&mut self, scene: &BoxScene, methods: &BoxMethods, workspace: &mut IcpWorkspace) {
        for method in 0..self.errors_m.len() {
            self.add_one(scene, methods, method, workspace);
        }
    }

    /// Adds one registration of a scene, for callers that register one method at a time.
    pub fn add_one(
        &mut self,
        scene: &BoxScene,
        methods: &BoxMethods,
        method: usize,
        workspace: &mut IcpWorkspace,
    ) {
        let found = scene.register(&methods.configs()[method], workspace);
        self.errors_m[method].push(BoxScene::error_m(&found.pose));
    }

    /// Length of the mean error of a method, m; `None` without seeds.
    #[must_use]
    pub fn bias_m(&self, method: usize) -> Option<f64> {
        let errors = &self.errors_m[method];
        let count = errors.len() as f64;
        let mean = |axis: usize| errors.iter().map(|error| error[axis]).sum::<f64>() / count;
        (count > 0.0).then(|| math::norm2(mean(0), mean(1)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn errors(share: f64, seeds: u32) -> BoxErrors {
        let mut workspace = IcpWorkspace::new();
        let mut errors = BoxErrors::default();
        for seed in 1..=seeds {
            let config = BoxConfig {
                seed,
                share,
                ..BoxConfig::default()
            };
            errors.add(
                &BoxScene::new(&config),
                &BoxMethods::default(),
                &mut workspace,
            );
        }
        errors
    }

    #[test]
    fn the_box_has_its_share_of_the_points_of_both_sweeps() {
        for share in [0.0, 0.2, 0.45, 0.6] {
            let scene = BoxScene::new(&BoxConfig {
                share,
                ..BoxConfig::default()
            });
            let to_target = BoxScene::truth();
            let moved = scene.source().transformed(&to_target);
            for (cloud, outline) in [scene.target(), &moved].into_iter().zip(scene.boxes()) {
                assert_eq!(cloud.len(), SWEEP_POINTS);
                // Within five standard deviations of the range noise.
                let on_box = |p: &Point2<f64>| {
                    (outline[0].x - 0.06..outline[2].x + 0.06).contains(&p.x)
                        && (outline[0].y - 0.06..outline[2].y + 0.06).contains(&p.y)
                };
                let count = cloud.iter().filter(on_box).count();
                assert_eq!(count, (share * SWEEP_POINTS as f64).round() as usize);
            }
        }
    }

    #[test]
    fn the_points_on_the_box_are_as_many_as_its_share() {
        let scene = BoxScene::new(&BoxConfig::default());
        let count = (0..scene.source().len()).filter(|k| scene.is_on_box(*k));
        assert_eq!(count.count(), SWEEP_POINTS / 5);
    }

    #[test]
    fn without_a_box_all_three_are_at_home() {
        let errors = errors(0.0, 5);
        for method in 0..3 {
            let bias_m = errors.bias_m(method).unwrap();
            // 2 cm: points on the walls are some centimetres apart, and the box hides some of them.
            assert!(bias_m < 0.02, "{}: {bias_m}", BoxMethods::NAMES[method]);
        }
        assert_eq!(BoxErrors::default().bias_m(0), None);
    }

    #[test]
    fn at_a_fifth_of_the_points_trimming_and_huber_are_less_biased_than_plain() {
        let errors = errors(0.2, 10);
        let [plain, trimmed, huber] = [0, 1, 2].map(|method| errors.bias_m(method).unwrap());
        assert!(trimmed < 0.5 * plain, "{trimmed} and {plain}");
        assert!(huber < 0.5 * plain, "{huber} and {plain}");
    }

    #[test]
    fn the_plain_bias_grows_with_the_share_of_the_box() {
        let bias = |share: f64| errors(share, 5).bias_m(0).unwrap();
        let (little, some, much) = (bias(0.1), bias(0.3), bias(0.5));
        assert!(little < some && some < much, "{little}, {some}, {much}");
    }
}
