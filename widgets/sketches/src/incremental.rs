//! Incremental mapping: a local search for the nearest maximum, and the treatment of a detected error.

use core::f64::consts::FRAC_PI_2;

use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::graph::{EdgeKind, PoseGraph};
use ch16_slam2d::metrics::position_error_m;
use ch16_slam2d::prelude::{Matrix3, Point2, Vector3};
use incremental_mapping::field::{ClimbConfig, PosePrior, ScanClimb};
use incremental_mapping::{LikelihoodMap, LikelihoodMapConfig, push_backwards};
use pr_geom::SE2;
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::{Shown, SketchSpec, Slider};

/// Distance of two posts, m: every position looks like the next one.
const SPACING_M: f64 = 1.0;
/// Assumed standard deviation of the odometry at the end of the path, m.
const ODOMETRY_SIGMA_M: f64 = 0.6;
/// Largest error of the slider, m.
const LARGEST_M: f64 = 1.2;
/// Steps of one metre, four on a side.
const STEPS: usize = 16;
/// A search that ends this close to the truth has succeeded, m.
const RIGHT_M: f64 = 0.1;

/// Height of the handle at the start of the climb, below all curves.
const START_HEIGHT: f64 = -9.8;

const CLIMB: ClimbConfig = ClimbConfig {
    weight: 1.0,
    max_steps: 60,
    tolerance: 1e-7,
};

pub(super) const SKETCH: SketchSpec = SketchSpec {
    name: "incremental",
    title: "A climb, and the error it finds",
    slider: Slider {
        label: "wheel error, once around",
        unit: " m",
        min: 0.0,
        max: LARGEST_M,
        step: 0.02,
        default: 0.36,
        decimals: 2,
    },
    at,
    handle,
};

/// The robot's final view: a row of posts that the map contains from the start.
struct SearchScene {
    map: LikelihoodMap,
    sweep: PointCloud,
}

impl SearchScene {
    fn new() -> Self {
        let posts = |first: i32, last: i32| -> PointCloud {
            let along = (first..=last).map(|k| Point2::new(SPACING_M * f64::from(k), 1.0));
            along.collect()
        };
        let mut map = LikelihoodMap::new(LikelihoodMapConfig {
            cell_m: 0.1,
            sigma_m: 0.25,
            wall_m: 0.0,
            floor: 0.05,
            unseen: 0.3,
        });
        map.insert(&posts(-5, 6), &SE2::identity());
        Self {
            map,
            sweep: posts(-1, 1),
        }
    }

    /// `ln p(z | s)` of the sweep, plus the odometry's `ln p(s | u)` if it is given, at s along the row.
    fn score(&self, along_m: f64, wheels: Option<PosePrior>) -> f64 {
        let pose = SE2::from_xy(along_m, 0.0);
        let field = self.map.field(self.map.config().sigma_m);
        ScanClimb::new(&field, &self.sweep, pose, wheels, CLIMB)
            .objective(&pose)
            .0
    }

    /// The result of a search from the odometry's pose along the row, m.
    fn search_result_m(&self, wheels: PosePrior) -> f64 {
        let field = self.map.field(self.map.config().sigma_m);
        let climb = ScanClimb::new(&field, &self.sweep, wheels.pose, Some(wheels), CLIMB);
        climb.run().pose.x()
    }
}

/// The odometry prior at the end of the path.
fn odometry_prior(error_m: f64) -> PosePrior {
    let known = 1.0 / (ODOMETRY_SIGMA_M * ODOMETRY_SIGMA_M);
    PosePrior {
        pose: SE2::from_xy(error_m, 0.0),
        information: Matrix3::from_diagonal(&Vector3::new(known, 1e4, 1e4)),
    }
}

/// The same path by four methods; each one starts and should end at the origin.
struct Paths {
    truth: Vec<SE2>,
    climbed: Vec<SE2>,
    pushed: Vec<SE2>,
    solved: Vec<SE2>,
}

impl Paths {
    /// Odometry that loses `error_m` evenly, and a search that ends `found_m` off.
    fn new(error_m: f64, found_m: f64) -> Self {
        let mut truth = vec![SE2::identity()];
        for k in 0..STEPS {
            let turn = if k % 4 == 3 { FRAC_PI_2 } else { 0.0 };
            truth.push(truth[k] * SE2::new(1.0, 0.0, turn));
        }
        let share = |k: usize| error_m * k as f64 / STEPS as f64;
        let drifted = |(k, pose): (usize, &SE2)| SE2::from_xy(share(k), 0.0) * *pose;
        let wheels: Vec<SE2> = truth.iter().enumerate().map(drifted).collect();
        let end = SE2::from_xy(found_m, 0.0) * truth[STEPS];
        let mut climbed = wheels.clone();
        climbed[STEPS] = end;
        let mut pushed = wheels.clone();
        push_backwards(&mut pushed, &end);
        let solved = solve(&wheels, &end);
        Self {
            truth,
            climbed,
            pushed,
            solved,
        }
    }

    /// The largest error of a pose, m.
    fn worst_m(&self, path: &[SE2]) -> f64 {
        let errors = path.iter().zip(&self.truth);
        errors
            .map(|(pose, truth)| position_error_m(pose, truth))
            .fold(0.0, f64::max)
    }
}

/// The pose graph of the odometry steps, with equal covariances, and of one more accurate loop.
fn solve(wheels: &[SE2], end: &SE2) -> Vec<SE2> {
    let step = Matrix3::from_diagonal(&Vector3::new(100.0, 100.0, 1e4));
    let mut graph = PoseGraph::new();
    graph.add_fixed_node(wheels[0]);
    for (k, pose) in wheels.iter().enumerate().skip(1) {
        graph.add_node(*pose);
        let moved = wheels[k - 1].between(pose);
        graph.add_edge(k - 1, k, moved, step, EdgeKind::Odometry);
    }
    let last = wheels.len() - 1;
    let loop_measured = wheels[0].between(end);
    graph.add_edge(0, last, loop_measured, step * 1e4, EdgeKind::Loop);
    graph.optimize(20, 1e-9);
    graph.poses().to_vec()
}

fn at(error_m: f64) -> Shown {
    let place = SearchScene::new();
    let found_m = place.search_result_m(odometry_prior(error_m));
    let paths = Paths::new(error_m, found_m);
    let [climbed, pushed, solved] =
        [&paths.climbed, &paths.pushed, &paths.solved].map(|path| paths.worst_m(path));
    let ending = if found_m.abs() <= RIGHT_M {
        format!("{:.2} m out, on the right hill", found_m.abs())
    } else {
        format!("{found_m:.2} m out, on the next hill, and no mapper reports it")
    };
    Shown {
        sentence: format!(
            "The wheels are {error_m:.2} m off; the climb ends {ending}. The worst pose is {climbed:.2} m out if no earlier pose moves, {pushed:.2} m if the error is sent backwards, and {solved:.2} m in the graph."
        ),
        scene: Scene {
            panels: vec![hills(&place, error_m, found_m), map(&paths)],
        },
    }
}

/// The start of the climb, at the foot of the picture.
fn handle(error_m: f64) -> (&'static str, [f64; 2]) {
    ("hills", [error_m, START_HEIGHT])
}

fn line(points: Vec<[f64; 2]>, stroke: Stroke, tone: Tone) -> Layer {
    Layer::line(points, stroke, tone, 2.0)
}

fn hills(place: &SearchScene, error_m: f64, found_m: f64) -> Panel {
    let prior = odometry_prior(error_m);
    let sweep = |along_m: f64| place.score(along_m, None);
    let both = |along_m: f64| place.score(along_m, Some(prior));
    let motion = |along_m: f64| both(along_m) - sweep(along_m);
    let curve = |score: &dyn Fn(f64) -> f64| -> Vec<[f64; 2]> {
        let places = (-60..=170).map(|k| 0.01 * f64::from(k));
        places.map(|along_m| [along_m, score(along_m)]).collect()
    };
    Panel {
        id: "hills",
        title: "The climb".to_owned(),
        weight: Weight::Half,
        aspect: Aspect::Free,
        x: Axis::new("offset along the row (m)", -0.6, 1.7),
        y: Axis::new("log-likelihood", -10.5, 1.0),
        layers: vec![
            line(curve(&motion), Stroke::Dashed, Tone::Prediction),
            line(curve(&sweep), Stroke::Dotted, Tone::Measurement),
            line(curve(&both), Stroke::Solid, Tone::Posterior),
            Layer::points(
                vec![[error_m, both(error_m)]],
                Mark::Triangle,
                Tone::Prediction,
                6.0,
            ),
            Layer::points(
                vec![[found_m, both(found_m)]],
                Mark::Square,
                Tone::Posterior,
                6.0,
            ),
        ],
        legend: vec![
            LegendEntry::marked_line("wheels", Tone::Prediction, Mark::Triangle, Stroke::Dashed),
            LegendEntry::line("sweep", Tone::Measurement, Stroke::Dotted),
            LegendEntry::marked_line("both", Tone::Posterior, Mark::Square, Stroke::Solid),
        ],
        color_bar: None,
    }
}

fn map(paths: &Paths) -> Panel {
    let places =
        |path: &[SE2]| -> Vec<[f64; 2]> { path.iter().map(|pose| [pose.x(), pose.y()]).collect() };
    let with_marks = |path: &[SE2], stroke, tone, mark| {
        [
            line(places(path), stroke, tone),
            Layer::points(places(path), mark, tone, 3.0),
        ]
    };
    let mut layers = vec![line(places(&paths.truth), Stroke::Dashed, Tone::Truth)];
    layers.extend(with_marks(
        &paths.climbed,
        Stroke::Dotted,
        Tone::Prediction,
        Mark::Triangle,
    ));
    layers.extend(with_marks(
        &paths.pushed,
        Stroke::Solid,
        Tone::Prior,
        Mark::Circle,
    ));
    layers.push(Layer::points(
        places(&paths.solved),
        Mark::Square,
        Tone::Posterior,
        3.0,
    ));
    Panel {
        id: "paths",
        title: "Once around".to_owned(),
        weight: Weight::Half,
        aspect: Aspect::Equal,
        x: Axis::new("x (m)", -0.6, 5.6),
        y: Axis::new("y (m)", -0.6, 4.6),
        layers,
        legend: vec![
            LegendEntry::line("truth", Tone::Truth, Stroke::Dashed),
            LegendEntry::marked_line("climbed", Tone::Prediction, Mark::Triangle, Stroke::Dotted),
            LegendEntry::marked_line("sent back", Tone::Prior, Mark::Circle, Stroke::Solid),
            LegendEntry::mark("graph", Tone::Posterior, Mark::Square),
        ],
        color_bar: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found_m(error_m: f64) -> f64 {
        SearchScene::new().search_result_m(odometry_prior(error_m))
    }

    /// The claim of the section: it handles small odometry errors, and no large ones.
    #[test]
    fn a_search_from_less_than_half_a_spacing_ends_at_the_right_maximum_and_otherwise_at_the_next()
    {
        for error_m in [0.0, 0.1, 0.2, 0.3, 0.4] {
            assert!(
                found_m(error_m).abs() < RIGHT_M,
                "{error_m}: {}",
                found_m(error_m)
            );
        }
        for error_m in [0.7, 0.8, 1.0, 1.2] {
            let off_m = (found_m(error_m) - SPACING_M).abs();
            assert!(off_m < RIGHT_M, "{error_m}: {}", found_m(error_m));
        }
    }

    /// The claim of the section: the first method cannot correct the past; its variant propagates errors
    /// backwards, to about the result of the sparse solver.
    #[test]
    fn only_methods_with_a_history_distribute_the_error() {
        let error_m = 0.4;
        let paths = Paths::new(error_m, found_m(error_m));
        let last_but_one_m = error_m * 15.0 / 16.0;
        assert!((paths.worst_m(&paths.climbed) - last_but_one_m).abs() < 1e-9);
        assert!(paths.worst_m(&paths.pushed) < 0.2 * error_m);
        assert!(paths.worst_m(&paths.solved) < 0.2 * error_m);
    }
}
