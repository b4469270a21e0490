//! One step of point-to-point beside one wall: where its bias comes from.
//!
//! The prediction is exactly right, and there is no noise. Beams hit the wall more sparsely the further away they look, so
//! the nearest old point of a far new one belongs to the same beam, and that is where the robot was.

use core::f64::consts::TAU;

use ch16_slam2d::cloud::{DenseMap, PointCloud};
use ch16_slam2d::icp::{IcpConfig, Pair, correspondences};
use ch16_slam2d::prelude::Point2;
use pr_geom::{SE2, math};
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::{Shown, SketchSpec, Slider};

/// Distance of the wall, half of the corridor, m.
const WALL_M: f64 = 0.6;
/// Beams all round, as in the lap.
const BEAMS: i32 = 120;
/// How far along the wall a beam is counted, m.
const REACH_M: f64 = 4.0;
/// Correspondence distance, m.
const TAU_M: f64 = 0.7;
/// Longest drive, m.
const FARTHEST_M: f64 = 0.26;

pub(super) const SKETCH: SketchSpec = SketchSpec {
    name: "pull",
    title: "One step of point-to-point beside a wall",
    slider: Slider {
        label: "the robot has driven",
        unit: " m",
        min: 0.02,
        max: FARTHEST_M,
        step: 0.01,
        default: 0.14,
        decimals: 2,
    },
    at,
    handle,
};

/// The robot.
fn handle(drive_m: f64) -> (&'static str, [f64; 2]) {
    ("wall", [drive_m, 0.0])
}

/// The points of the wall that a sweep sees, in its frame.
fn sweep() -> PointCloud {
    let bearings = (1..BEAMS / 2).map(|beam| TAU * f64::from(beam) / f64::from(BEAMS));
    let points = bearings.map(|bearing| {
        let (sin, cos) = math::sin_cos(bearing);
        Point2::new(WALL_M * cos / sin, WALL_M)
    });
    points
        .filter(|point| point.x.abs() <= REACH_M)
        .rev()
        .collect()
}

/// The pairs of the sweep at the right pose with the old points.
fn pairs(drive_m: f64, old: &PointCloud) -> Vec<Pair> {
    let config = IcpConfig {
        tau_m: TAU_M,
        ..IcpConfig::default()
    };
    let map = DenseMap::from_cloud(old, TAU_M, usize::MAX);
    correspondences(&sweep(), &map, SE2::from_xy(drive_m, 0.0), &config)
}

/// The pull of each pair along the wall, m.
fn pulls(pairs: &[Pair]) -> impl Iterator<Item = f64> + '_ {
    pairs.iter().map(|pair| pair.target.x - pair.source.x)
}

/// The step along the wall, m: all points are on one line, so the best motion is the mean pull.
fn step_m(pairs: &[Pair]) -> f64 {
    pulls(pairs).sum::<f64>() / pairs.len() as f64
}

fn at(drive_m: f64) -> Shown {
    let pairs = pairs(drive_m, &sweep());
    let step_cm = 100.0 * step_m(&pairs);
    let back = pulls(&pairs).filter(|pull| *pull < 0.0).count();
    Shown {
        scene: Scene {
            panels: vec![wall(drive_m, &pairs), sum(&pairs)],
        },
        sentence: format!(
            "After {drive_m:.2} m and an exact prediction, the sweep is moved {step_cm:.1} cm along the wall: {back} of {} \
             arrows point backwards. Point-to-plane does not move it.",
            pairs.len()
        ),
    }
}

fn wall(drive_m: f64, pairs: &[Pair]) -> Panel {
    let old: Vec<[f64; 2]> = sweep().iter().map(|point| [point.x, point.y]).collect();
    let new: Vec<[f64; 2]> = pairs
        .iter()
        .map(|pair| [pair.source.x, pair.source.y - 0.12])
        .collect();
    let arrows = new
        .iter()
        .zip(pairs)
        .map(|(from, pair)| [*from, [pair.target.x, pair.target.y]])
        .collect();
    Panel {
        id: "wall",
        title: "Each new point’s nearest old point".to_owned(),
        weight: Weight::Main,
        aspect: Aspect::Free,
        x: Axis::new("along the wall (m)", -REACH_M, REACH_M + FARTHEST_M),
        y: Axis::new("across (m)", -0.2, 0.8),
        layers: vec![
            Layer::segments(arrows, Stroke::Solid, Tone::Ink, 1.5),
            Layer::points(old, Mark::Cross, Tone::Measurement, 4.0),
            Layer::points(new, Mark::Circle, Tone::Prior, 3.0),
            Layer::points(vec![[0.0; 2]], Mark::Cross, Tone::Measurement, 6.0),
            Layer::points(vec![[drive_m, 0.0]], Mark::Circle, Tone::Prior, 6.0),
        ],
        legend: vec![
            LegendEntry::mark("old sweep", Tone::Measurement, Mark::Cross),
            LegendEntry::mark("new one, drawn lower", Tone::Prior, Mark::Circle),
        ],
        color_bar: None,
    }
}

/// The pulls head to tail, and where they would end if they cancelled.
fn sum(pairs: &[Pair]) -> Panel {
    let mut reached = 0.0;
    let mut path = vec![[0.0, 0.0]];
    for (k, pull) in pulls(pairs).enumerate() {
        reached += pull;
        path.push([reached, (k + 1) as f64]);
    }
    let end = [reached, pairs.len() as f64];
    Panel {
        id: "sum",
        title: "Their sum, from left to right".to_owned(),
        weight: Weight::Side,
        aspect: Aspect::Free,
        x: Axis::new("sum of the arrows (m)", -2.0, 1.0),
        y: Axis::new("arrows", 0.0, 60.0),
        layers: vec![
            Layer::segments(
                vec![[[0.0, 0.0], [0.0, 60.0]]],
                Stroke::Dotted,
                Tone::Ink,
                1.5,
            ),
            Layer::line(path, Stroke::Solid, Tone::Ink, 2.0),
            Layer::points(vec![end], Mark::Square, Tone::Posterior, 5.0),
        ],
        legend: vec![LegendEntry::mark("the pull", Tone::Posterior, Mark::Square)],
        color_bar: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The claim of the figure, about the steps of a lap: 14 cm for most ticks.
    #[test]
    fn the_step_goes_backwards_by_less_than_the_drive() {
        for drive_cm in 4..=26 {
            let drive_m = f64::from(drive_cm) / 100.0;
            let step_m = step_m(&pairs(drive_m, &sweep()));
            assert!(step_m < 0.0 && step_m > -drive_m, "{drive_m}: {step_m}");
        }
    }

    /// The cause is the spacing of the old points: on a dense wall the same sweep at the same pose is not moved.
    #[test]
    fn a_dense_wall_does_not_pull() {
        let dense: PointCloud = (-4000..=4000)
            .map(|k| Point2::new(f64::from(k) * 1e-3, WALL_M))
            .collect();
        for drive_m in [0.05, 0.1, 0.16, 0.2] {
            let step_m = step_m(&pairs(drive_m, &dense));
            // Half of the spacing of the dense wall.
            assert!(step_m.abs() < 5e-4, "{drive_m}: {step_m}");
        }
    }
}
