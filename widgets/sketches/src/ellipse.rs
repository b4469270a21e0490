//! A robot that leaves a room for the corridor: the information of each of its sweeps about its position.

use ch16_lab::lap::DriveConfig;
use ch16_lab::samples;
use ch16_slam2d::cloud::DenseMap;
use ch16_slam2d::icp::{
    INFORMATION_CAP, INFORMATION_RIDGE, IcpConfig, correspondences, regularize,
};
use ch16_slam2d::matching::match_information;
use ch16_slam2d::prelude::Point2;
use ch16_slam2d::slam::SlamConfig;
use pr_geom::{Rng, SE2, math};
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::{Shown, SketchSpec, Slider};

/// The path from the middle of room A through its door, and down the corridor, m.
const PATH_M: [[f64; 2]; 3] = [[2.05, 1.9], [2.05, 4.4], [10.8, 4.4]];
/// Beams of a sweep.
const BEAMS: usize = 180;
/// Radius of the normals, m.
const NORMAL_RADIUS_M: f64 = 0.3;
/// Magnification of the ellipse.
const ENLARGED: f64 = 20.0;

pub(super) const SKETCH: SketchSpec = SketchSpec {
    name: "ellipse",
    title: "What a sweep knows about its pose",
    slider: Slider {
        label: "metres driven",
        unit: " m",
        min: 0.0,
        max: 11.2,
        step: 0.1,
        default: 7.0,
        decimals: 1,
    },
    at,
    handle,
};

/// The position after that many metres of the path.
fn place(mut driven_m: f64) -> [f64; 2] {
    for leg in PATH_M.windows(2) {
        let ([x0, y0], [x1, y1]) = (leg[0], leg[1]);
        let length_m = math::norm2(x1 - x0, y1 - y0);
        if driven_m <= length_m {
            let share = driven_m / length_m;
            return [x0 + share * (x1 - x0), y0 + share * (y1 - y0)];
        }
        driven_m -= length_m;
    }
    PATH_M[PATH_M.len() - 1]
}

/// The robot.
fn handle(driven_m: f64) -> (&'static str, [f64; 2]) {
    ("plan", place(driven_m))
}

/// The information at a position: observed points, and a root of the position's covariance, m.
struct Known {
    points: Vec<Point2<f64>>,
    root: [[f64; 2]; 2],
}

/// Registers a sweep with one from the same pose, point-to-plane, at the truth.
fn known(world_from_body: &SE2) -> Known {
    let mut rng = Rng::new(16);
    let mut before = samples::sweep(world_from_body, BEAMS, &mut rng);
    before.estimate_normals(NORMAL_RADIUS_M);
    let now = samples::sweep(world_from_body, BEAMS, &mut rng);
    let config = IcpConfig::default();
    let map = DenseMap::from_cloud(&before, config.tau_m, usize::MAX);
    let mut pairs = correspondences(&now, &map, SE2::identity(), &config);
    // Point-to-plane ignores points without a normal.
    pairs.retain(|pair| pair.normal.is_some());
    let trust = SlamConfig::chapter().chapter.odometry_trust;
    let information = match_information(&pairs, &SE2::identity(), &trust);
    let information = regularize(information, INFORMATION_RIDGE, INFORMATION_CAP);
    let covariance = information
        .try_inverse()
        .expect("the ridge keeps it positive definite");
    let position = covariance.fixed_view::<2, 2>(0, 0).into_owned();
    let root = position
        .cholesky()
        .expect("a block of a covariance is one")
        .l();
    Known {
        points: now.iter().collect(),
        root: [[root[(0, 0)], root[(1, 0)]], [root[(0, 1)], root[(1, 1)]]],
    }
}

/// Standard deviations along x and y, m: the norms of a root's rows.
fn sigmas_m(root: &[[f64; 2]; 2]) -> [f64; 2] {
    core::array::from_fn(|axis| math::norm2(root[0][axis], root[1][axis]))
}

fn at(driven_m: f64) -> Shown {
    let [x, y] = place(driven_m);
    let body = SE2::from_xy(x, y);
    let known = known(&body);
    let [along, across] = sigmas_m(&known.root).map(|sigma_m| 100.0 * sigma_m);
    let seen = known.points.iter().map(|&point| {
        let point = body.transform(point);
        [point.x, point.y]
    });
    let walls = DriveConfig::default().world;
    let walls = walls
        .walls()
        .iter()
        .map(|wall| [[wall.start.x, wall.start.y], [wall.end.x, wall.end.y]]);
    let panel = Panel {
        id: "plan",
        title: format!("One standard deviation, enlarged {ENLARGED:.0} times"),
        weight: Weight::Main,
        aspect: Aspect::Equal,
        x: Axis::new("x (m)", -0.2, 12.2),
        y: Axis::new("y (m)", -0.2, 6.2),
        layers: vec![
            Layer::segments(walls.collect(), Stroke::Solid, Tone::Truth, 1.0),
            Layer::line(PATH_M.to_vec(), Stroke::Dashed, Tone::Truth, 1.0),
            Layer::points(seen.collect(), Mark::Cross, Tone::Measurement, 2.5),
            Layer::Ellipse {
                center: [x, y],
                half_axes: known.root.map(|axis| axis.map(|length| ENLARGED * length)),
                stroke: Stroke::Solid,
                tone: Tone::Posterior,
            },
            Layer::pose([x, y, 0.0], Mark::Square, Tone::Posterior, 5.0),
        ],
        legend: vec![
            LegendEntry::mark("what the sweep sees", Tone::Measurement, Mark::Cross),
            LegendEntry::mark("robot", Tone::Posterior, Mark::Square),
            LegendEntry::line(
                "what it knows about its pose",
                Tone::Posterior,
                Stroke::Solid,
            ),
        ],
        color_bar: None,
    };
    Shown {
        scene: Scene {
            panels: vec![panel],
        },
        sentence: format!(
            "After {driven_m:.1} m, the sweep fixes the position to {along:.1} cm along the corridor, and to {across:.1} cm across."
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sigmas_at(driven_m: f64) -> [f64; 2] {
        let [x, y] = place(driven_m);
        sigmas_m(&known(&SE2::from_xy(x, y)).root)
    }

    /// The claim of the section: nearly a circle in the room, a needle in the corridor.
    #[test]
    fn the_ellipse_is_round_in_the_room_and_a_needle_in_the_corridor() {
        let [x_m, y_m] = sigmas_at(0.0);
        assert!(x_m / y_m < 1.5 && y_m / x_m < 1.5, "{x_m} and {y_m}");
        let [along_m, across_m] = sigmas_at(SKETCH.slider.default);
        assert!(along_m > 2.0 * across_m, "{along_m} and {across_m}");
    }

    #[test]
    fn the_path_ends_where_the_slider_does() {
        let length_m: f64 = PATH_M
            .windows(2)
            .map(|leg| math::norm2(leg[1][0] - leg[0][0], leg[1][1] - leg[0][1]))
            .sum();
        assert!((SKETCH.slider.max..SKETCH.slider.max + 0.1).contains(&length_m));
        assert_eq!(place(0.0), PATH_M[0]);
    }
}
