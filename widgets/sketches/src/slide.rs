//! A sweep that slides along its wall: the effect on the two distances of ICP.

use ch16_slam2d::cloud::{DenseMap, PointCloud};
use ch16_slam2d::icp::{IcpConfig, Pair, correspondences};
use ch16_slam2d::prelude::Point2;
use pr_geom::SE2;
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::{Shown, SketchSpec, Slider};

/// Spacing of the points of a wall, m.
const SPACING_M: f64 = 0.3;
/// Distance of the sweep from the wall, m: a little, so that its pairs are visible.
const BESIDE_M: f64 = 0.1;
/// Largest shift along the wall, m.
const FARTHEST_M: f64 = 0.6;
/// Correspondence distance, m: no point loses its partner here.
const TAU_M: f64 = 1.0;

pub(super) const SKETCH: SketchSpec = SketchSpec {
    name: "slide",
    title: "A sweep slides along a wall",
    slider: Slider {
        label: "shift along the wall",
        unit: " m",
        min: -FARTHEST_M,
        max: FARTHEST_M,
        step: 0.01,
        default: 0.12,
        decimals: 2,
    },
    at,
    handle,
};

/// `count` points in a row, the middle one at x = 0.
fn row(count: i32, y_m: f64) -> PointCloud {
    let half = f64::from(count - 1) / 2.0;
    (0..count)
        .map(|k| Point2::new(SPACING_M * (f64::from(k) - half), y_m))
        .collect()
}

/// The middle point of the sweep.
fn handle(shift_m: f64) -> (&'static str, [f64; 2]) {
    ("wall", [shift_m, -BESIDE_M])
}

struct Wall {
    points: PointCloud,
    map: DenseMap,
    sweep: PointCloud,
}

impl Wall {
    fn new() -> Self {
        let mut points = row(11, 0.0);
        points.estimate_normals(2.5 * SPACING_M);
        Self {
            map: DenseMap::from_cloud(&points, SPACING_M, usize::MAX),
            sweep: row(5, -BESIDE_M),
            points,
        }
    }

    fn pairs(&self, shift_m: f64) -> Vec<Pair> {
        let config = IcpConfig {
            tau_m: TAU_M,
            ..IcpConfig::default()
        };
        correspondences(&self.sweep, &self.map, SE2::from_xy(shift_m, 0.0), &config)
    }

    /// The mean squared distance, point-to-point and point-to-plane, cm².
    fn costs(&self, shift_m: f64) -> [f64; 2] {
        let pairs = self.pairs(shift_m);
        let mean = |square: fn(&Pair) -> f64| {
            1e4 * pairs.iter().map(square).sum::<f64>() / pairs.len() as f64
        };
        [
            mean(|pair| pair.distance_m() * pair.distance_m()),
            mean(|pair| pair.plane_distance_m() * pair.plane_distance_m()),
        ]
    }
}

fn at(shift_m: f64) -> Shown {
    let wall = Wall::new();
    let [to_point, to_plane] = wall.costs(shift_m);
    Shown {
        scene: Scene {
            panels: vec![picture(&wall, shift_m), costs(&wall, shift_m)],
        },
        sentence: format!(
            "{shift_m:.2} m along the wall, a pair costs {to_point:.0} cm² point-to-point and {to_plane:.0} cm² \
             point-to-plane."
        ),
    }
}

fn picture(wall: &Wall, shift_m: f64) -> Panel {
    let pairs = wall.pairs(shift_m);
    let to_point = pairs.iter().map(|pair| {
        [
            [pair.source.x, pair.source.y],
            [pair.target.x, pair.target.y],
        ]
    });
    let to_plane = pairs.iter().filter_map(|pair| {
        let foot = pair.source - pair.normal? * pair.plane_distance_m();
        Some([[pair.source.x, pair.source.y], [foot.x, foot.y]])
    });
    let moved = pairs.iter().map(|pair| [pair.source.x, pair.source.y]);
    let segments = |segments: Vec<_>, stroke, tone| Layer::segments(segments, stroke, tone, 1.5);
    Panel {
        id: "wall",
        title: "The sweep beside its wall".to_owned(),
        weight: Weight::Main,
        aspect: Aspect::Equal,
        x: Axis::new("along the wall (m)", -1.6, 1.6),
        y: Axis::new("across (m)", -0.3, 0.2),
        layers: vec![
            segments(to_plane.collect(), Stroke::Solid, Tone::Posterior),
            segments(to_point.collect(), Stroke::Dotted, Tone::Ink),
            Layer::points(
                wall.points.iter().map(|point| [point.x, point.y]).collect(),
                Mark::Cross,
                Tone::Measurement,
                4.0,
            ),
            Layer::points(moved.collect(), Mark::Circle, Tone::Prior, 4.0),
        ],
        legend: vec![
            LegendEntry::mark("wall", Tone::Measurement, Mark::Cross),
            LegendEntry::mark("sweep", Tone::Prior, Mark::Circle),
            LegendEntry::line("point-to-point", Tone::Ink, Stroke::Dotted),
            LegendEntry::line("point-to-plane", Tone::Posterior, Stroke::Solid),
        ],
        color_bar: None,
    }
}

fn costs(wall: &Wall, shift_m: f64) -> Panel {
    let places: Vec<f64> = (-60..=60)
        .map(|k| FARTHEST_M * f64::from(k) / 60.0)
        .collect();
    let curve = |which: usize, stroke, tone| {
        Layer::line(
            places
                .iter()
                .map(|&place| [place, wall.costs(place)[which]])
                .collect(),
            stroke,
            tone,
            2.0,
        )
    };
    let now = wall.costs(shift_m);
    Panel {
        id: "costs",
        title: "What a pair costs".to_owned(),
        weight: Weight::Side,
        aspect: Aspect::Free,
        x: Axis::new("shift along the wall (m)", -FARTHEST_M, FARTHEST_M),
        y: Axis::new("cost (cm²)", 0.0, 400.0),
        layers: vec![
            curve(0, Stroke::Dotted, Tone::Ink),
            curve(1, Stroke::Solid, Tone::Posterior),
            Layer::points(vec![[shift_m, now[0]]], Mark::Dot, Tone::Ink, 5.0),
            Layer::points(vec![[shift_m, now[1]]], Mark::Square, Tone::Posterior, 5.0),
        ],
        legend: vec![
            LegendEntry::marked_line("point-to-point", Tone::Ink, Mark::Dot, Stroke::Dotted),
            LegendEntry::marked_line(
                "point-to-plane",
                Tone::Posterior,
                Mark::Square,
                Stroke::Solid,
            ),
        ],
        color_bar: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The claim of the section: the position along a wall is unconstrained, but point-to-point constrains
    /// it.
    #[test]
    fn sliding_has_no_cost_point_to_plane_and_a_periodic_one_point_to_point() {
        let wall = Wall::new();
        let beside = 1e4 * BESIDE_M * BESIDE_M;
        for step in -20..=20 {
            let shift_m = f64::from(step) * 0.03;
            let [to_point, to_plane] = wall.costs(shift_m);
            // 1e-9: a few roundings of numbers near 100.
            assert!((to_plane - beside).abs() < 1e-9, "{shift_m}: {to_plane}");
            // The nearest point is at most half a spacing away.
            let nearest = shift_m - SPACING_M * (shift_m / SPACING_M).round();
            assert!(
                (to_point - beside - 1e4 * nearest * nearest).abs() < 1e-6,
                "{shift_m}: {to_point}"
            );
        }
    }
}
