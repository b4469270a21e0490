//! A room as Gaussians: the effect of the cell size on NDT's map and on its score.

use ch16_lab::samples;
use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::ndt::{NdtCell, NdtMap};
use pr_geom::{Rng, SE2};
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::{Shown, SketchSpec, Slider};

/// Beams of each of the two sweeps.
pub(super) const BEAMS: usize = 180;
/// Smallest number of points in a cell.
const MIN_POINTS: usize = 3;
/// Largest shift, m.
const FARTHEST_M: f64 = 1.5;
/// Size of the drawn ellipses in standard deviations.
const DRAWN_SIGMAS: f64 = 2.0;

pub(super) const SKETCH: SketchSpec = SketchSpec {
    name: "bells",
    title: "A room as bells",
    slider: Slider {
        label: "cell",
        unit: " m",
        min: 0.2,
        max: 1.6,
        step: 0.1,
        default: 0.6,
        decimals: 1,
    },
    at,
    handle,
};

/// Two sweeps from one pose in room A, with independent noise.
pub(super) fn sweeps() -> [PointCloud; 2] {
    let mut rng = Rng::new(16);
    let room = SE2::new(1.9, 1.8, 0.0);
    core::array::from_fn(|_| samples::sweep(&room, BEAMS, &mut rng))
}

/// The Gaussians of a sweep.
pub(super) fn map(target: &PointCloud, cell_m: f64) -> NdtMap {
    NdtMap::build(target, cell_m, MIN_POINTS)
}

/// The score of the second sweep shifted along x.
fn score(map: &NdtMap, sweep: &PointCloud, shift_m: f64) -> f64 {
    map.score(sweep, &SE2::from_xy(shift_m, 0.0))
}

/// The shifts at which the curve is computed, m.
fn shifts() -> impl Iterator<Item = f64> {
    (-25..=25).map(|k| FARTHEST_M * f64::from(k) / 25.0)
}

/// The shift to the right at which the score has fallen to half of its value without a shift, m.
fn half_width_m(map: &NdtMap, sweep: &PointCloud) -> f64 {
    let half = 0.5 * score(map, sweep, 0.0);
    let mut right = shifts().filter(|&shift| shift > 0.0);
    right
        .find(|&shift| score(map, sweep, shift) < half)
        .unwrap_or(FARTHEST_M)
}

fn at(cell_m: f64) -> Shown {
    let [target, sweep] = sweeps();
    let map = map(&target, cell_m);
    let bells = map.cells().len();
    let width = half_width_m(&map, &sweep);
    Shown {
        scene: Scene {
            panels: vec![picture(cell_m, &target, &map), curve(&map, &sweep)],
        },
        sentence: format!(
            "With cells of {cell_m:.1} m, the room has {bells} bells, and half the score is gone {width:.2} m from the truth."
        ),
    }
}

/// Lower left corner of the drawn cell, m.
const CELL_M: [f64; 2] = [-2.3, -2.0];

/// The upper right corner of the drawn cell.
fn handle(cell_m: f64) -> (&'static str, [f64; 2]) {
    ("bells", CELL_M.map(|low| low + cell_m))
}

fn picture(cell_m: f64, target: &PointCloud, map: &NdtMap) -> Panel {
    let mut layers = vec![Layer::points(
        target.iter().map(|point| [point.x, point.y]).collect(),
        Mark::Dot,
        Tone::Measurement,
        1.5,
    )];
    layers.extend(ellipses(map));
    let [[left, low], [right, top]] = [CELL_M, handle(cell_m).1];
    layers.push(Layer::line(
        vec![
            [left, low],
            [right, low],
            [right, top],
            [left, top],
            [left, low],
        ],
        Stroke::Dashed,
        Tone::Ink,
        1.5,
    ));
    Panel {
        layers,
        legend: vec![
            LegendEntry::mark("points of the sweep", Tone::Measurement, Mark::Dot),
            LegendEntry::line(
                "a bell, two standard deviations",
                Tone::Posterior,
                Stroke::Solid,
            ),
            LegendEntry::line("a cell", Tone::Ink, Stroke::Dashed),
        ],
        ..plan()
    }
}

/// Room A without its bells.
pub(super) fn plan() -> Panel {
    Panel {
        id: "bells",
        title: "The map: one bell per cell".to_owned(),
        weight: Weight::Half,
        aspect: Aspect::Equal,
        x: Axis::new("x (m)", -2.4, 2.6),
        y: Axis::new("y (m)", -2.4, 2.4),
        layers: Vec::new(),
        legend: Vec::new(),
        color_bar: None,
    }
}

/// The bells of a map.
pub(super) fn ellipses(map: &NdtMap) -> Vec<Layer> {
    let ellipse = |cell: &NdtCell| {
        // Any root of the covariance spans the ellipse.
        let root = cell.covariance.cholesky()?.l() * DRAWN_SIGMAS;
        Some(Layer::Ellipse {
            center: [cell.mean.x, cell.mean.y],
            half_axes: [[root[(0, 0)], root[(1, 0)]], [root[(0, 1)], root[(1, 1)]]],
            stroke: Stroke::Solid,
            tone: Tone::Posterior,
        })
    };
    map.cells().iter().filter_map(ellipse).collect()
}

fn curve(map: &NdtMap, sweep: &PointCloud) -> Panel {
    let points = shifts().map(|shift| [shift, score(map, sweep, shift) / BEAMS as f64]);
    Panel {
        id: "score",
        title: "The score of a second sweep".to_owned(),
        weight: Weight::Half,
        aspect: Aspect::Free,
        x: Axis::new("shift along x (m)", -FARTHEST_M, FARTHEST_M),
        y: Axis::new("score per beam", 0.0, 1.4),
        layers: vec![Layer::line(
            points.collect(),
            Stroke::Solid,
            Tone::Posterior,
            2.0,
        )],
        legend: Vec::new(),
        color_bar: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The claim of the section: the cell size is a smoothing length.
    #[test]
    fn large_cells_yield_a_wide_peak_and_small_ones_a_narrow_one() {
        let [target, sweep] = sweeps();
        let width = |cell_m: f64| half_width_m(&NdtMap::build(&target, cell_m, MIN_POINTS), &sweep);
        assert!(
            width(1.6) > 2.0 * width(0.2),
            "{} and {}",
            width(1.6),
            width(0.2)
        );
    }

    #[test]
    fn every_gaussian_has_a_least_width_across_its_wall() {
        let [target, _] = sweeps();
        for cell in NdtMap::build(&target, 0.6, MIN_POINTS).cells() {
            assert!(cell.covariance.cholesky().is_some(), "{cell:?}");
        }
    }

    #[test]
    fn the_curve_stays_in_its_picture() {
        let [target, sweep] = sweeps();
        for tenth in 2..=16 {
            let map = NdtMap::build(&target, f64::from(tenth) / 10.0, MIN_POINTS);
            let highest = shifts()
                .map(|shift| score(&map, &sweep, shift))
                .fold(0.0, f64::max);
            assert!(highest / (BEAMS as f64) < 1.4, "{tenth}: {highest}");
        }
    }
}
