//! The panels: two robots on the flat, the distances of all pairs, the descriptors of two views, the matrix of
//! all pairs, and the curves.

mod flat;
pub mod looks;
pub mod scores;

use std::sync::Arc;

use ch16_lab::lap::NamedChoice;
use ch16_lab::places::GRADED;
use widget_kit::scene::{
    Aspect, Axis, Bounds, Layer, LegendEntry, Mark, Panel, Raster, RasterCell, Scene, Stroke, Tone,
    Weight,
};

use super::lap::Places;
use super::{PlaceRecognition, panel};

/// Tones of the detectors, in the order of [`GRADED`].
pub const TONES: [Tone; 3] = [Tone::Series(0), Tone::Series(1), Tone::Series(2)];
/// Tones of a pair that is the same place, and of one that is not.
const SAME: Tone = Tone::Series(0);
const OTHER: Tone = Tone::Series(3);
/// Tones of the older keyframe and of the newer one.
const THEN: Tone = Tone::Measurement;
const NOW: Tone = Tone::Posterior;
const MARKS: [Mark; 3] = [Mark::Circle, Mark::Triangle, Mark::Square];

pub fn scene(been: &PlaceRecognition) -> Scene {
    Scene {
        panels: vec![
            flat::panel(been),
            scores::panel(been),
            looks::panel(been),
            matrix(been),
            curves(been),
        ],
    }
}

fn empty(id: &'static str, title: &str) -> Panel {
    Panel {
        id,
        title: title.to_owned(),
        weight: Weight::Half,
        aspect: Aspect::Equal,
        x: Axis::new("x (m)", -6.0, 6.0),
        y: Axis::new("y (m)", -6.0, 6.0),
        layers: Vec::new(),
        legend: Vec::new(),
        color_bar: None,
    }
}

fn matrix(been: &PlaceRecognition) -> Panel {
    let last = been.last().max(1) as f64;
    let axis = || Axis::hidden(-0.5, last + 0.5);
    let mut panel = Panel {
        x: axis(),
        y: axis(),
        ..empty(panel::MATRIX, "Every pair of places: press one")
    };
    let Some(places) = &been.places else {
        return panel;
    };
    let (detector, newest) = (been.detector(), been.known());
    panel.layers.push(Layer::Raster(raster(been, places)));
    let threshold = been.threshold(detector);
    let known = places.study.graded().filter(|pair| pair.nodes[1] <= newest);
    let mut judged = [Vec::new(), Vec::new(), Vec::new()];
    for pair in known {
        let at = [pair.nodes[1] as f64, pair.nodes[0] as f64];
        match (pair.distances[detector] <= threshold, pair.is_same) {
            (true, true) => judged[0].push(at),
            (true, false) => judged[1].push(at),
            (false, true) => judged[2].push(at),
            (false, false) => {}
        }
    }
    let radius_px = if places.last() > 70 { 1.6 } else { 2.4 };
    let [right, wrong, missed] = judged;
    panel.layers.extend([
        Layer::points(missed, Mark::Plus, SAME, radius_px),
        Layer::points(wrong, Mark::Dot, OTHER, radius_px),
        Layer::points(right, Mark::Dot, SAME, radius_px),
    ]);
    if let Some([old, new]) = been.pair() {
        panel.layers.push(Layer::Handle {
            at: [new as f64, old as f64],
            tone: Tone::Posterior,
            label: "press anywhere to look at that pair",
        });
    }
    panel
}

/// Ink for similar keyframes; future keyframes are unknown.
fn raster(been: &PlaceRecognition, places: &Places) -> Raster {
    let count = places.study.places().len();
    let (detector, newest) = (been.detector(), been.known());
    let widest = places.largest(detector).max(f64::MIN_POSITIVE);
    let cell = |k: usize| {
        let (old, new) = (k / count, k % count);
        if new > newest {
            return RasterCell::Unknown;
        }
        match places.study.pair(old, new) {
            Some(pair) => {
                let alike = 1.0 - (pair.distances[detector] / widest).min(1.0);
                RasterCell::Occupancy((alike * alike) as f32)
            }
            None => RasterCell::Unknown,
        }
    };
    let high = count as f64 - 0.5;
    Raster {
        bounds: Bounds {
            min: [-0.5; 2],
            max: [high; 2],
        },
        columns: count,
        rows: count,
        cells: (0..count * count).map(cell).collect::<Arc<[RasterCell]>>(),
        // Everything on which the picture depends, in one number.
        revision: (been.laps << 16) + ((newest as u64) << 2) + detector as u64,
    }
}

/// The pair at a spot of the matrix; a spot below the diagonal is the mirrored pair.
pub fn pair_at(been: &PlaceRecognition, at: [f64; 2]) -> Option<[usize; 2]> {
    let places = been.places.as_ref()?;
    let last = places.last() as f64;
    if !at.iter().all(|value| value.is_finite()) {
        return None;
    }
    let [new, old] = at.map(|value| value.round().clamp(0.0, last) as usize);
    Some([old.min(new), new.max(old)])
}

fn curves(been: &PlaceRecognition) -> Panel {
    let mut panel = Panel {
        weight: Weight::Half,
        aspect: Aspect::Free,
        x: Axis::new("recall", 0.0, 1.0),
        y: Axis::new("precision", 0.0, 1.05),
        legend: GRADED
            .iter()
            .enumerate()
            .map(|(k, detector)| {
                LegendEntry::marked_line(detector.label(), TONES[k], MARKS[k], Stroke::Solid)
            })
            .collect(),
        ..empty(panel::CURVES, "What each threshold costs")
    };
    let Some(places) = &been.places else {
        return panel;
    };
    for (k, curve) in places.curves.iter().enumerate() {
        let points = curve.points.iter();
        panel.layers.push(Layer::line(
            points.map(|at| [at.recall, at.precision]).collect(),
            Stroke::Solid,
            TONES[k],
            if k == been.detector() { 2.75 } else { 1.5 },
        ));
        let threshold = been.threshold(k);
        let at = places.graded_at(k, threshold).point(threshold);
        let at = at.map(|at| [at.recall, at.precision]).into_iter();
        panel
            .layers
            .push(Layer::points(at.collect(), MARKS[k], TONES[k], 5.0));
    }
    panel
}
