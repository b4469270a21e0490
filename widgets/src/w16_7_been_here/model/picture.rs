//! The panels: all pairs, the two scans of one, their descriptors, the curves, and the map.

mod looks;

use std::sync::Arc;

use ch16_lab::lap::{Choice, LapDetector};
use ch16_lab::places::PlaceStudy;
use ch16_slam2d::cloud::PointCloud;
use kit::scene::{
    Aspect, Axis, Bounds, Cell, Layer, LegendEntry, Mark, Panel, Raster, Scene, Stroke, Tone,
    Weight,
};
use pr_geom::SE2;

use super::lap::Places;
use super::{BeenHere, panel};

/// Tones of the detectors, in the order of [`LapDetector::ALL`].
pub const TONES: [Tone; 3] = [Tone::Series(0), Tone::Series(1), Tone::Series(2)];
const MARKS: [Mark; 3] = [Mark::Circle, Mark::Triangle, Mark::Square];

pub fn scene(been: &BeenHere) -> Scene {
    Scene {
        panels: vec![
            matrix(been),
            scans(been),
            looks::panel(been),
            curves(been),
            map(been),
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

fn matrix(been: &BeenHere) -> Panel {
    let last = been.last().max(1) as f64;
    let axis = |label| Axis::new(label, -0.5, last + 0.5);
    let mut panel = Panel {
        weight: Weight::Main,
        x: axis("newer keyframe"),
        y: axis("older keyframe"),
        legend: vec![
            LegendEntry::mark("called the same, and it is", Tone::Series(0), Mark::Cross),
            LegendEntry::mark(
                "called the same, and it is not",
                Tone::Series(3),
                Mark::Triangle,
            ),
            LegendEntry::mark("the same, and not called", Tone::Series(2), Mark::Plus),
            LegendEntry::mark("the pair that is looked at", Tone::Posterior, Mark::Circle),
            LegendEntry::mark("the more ink, the more alike", Tone::Ink, Mark::Dot),
        ],
        ..empty(panel::MATRIX, "The lap is driven")
    };
    let Some(places) = &been.places else {
        return panel;
    };
    let (detector, newest) = (been.detector(), been.newest());
    panel.title = format!(
        "Alike by {}, keyframe {newest} of {}",
        LapDetector::ALL[detector].label(),
        places.last()
    );
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
        Layer::points(missed, Mark::Plus, Tone::Series(2), radius_px),
        Layer::points(wrong, Mark::Triangle, Tone::Series(3), radius_px),
        Layer::points(right, Mark::Cross, Tone::Series(0), radius_px),
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
fn raster(been: &BeenHere, places: &Places) -> Raster {
    let count = places.study.places().len();
    let (detector, newest) = (been.detector(), been.newest());
    let graded = places.study.graded();
    let widest = graded
        .map(|pair| pair.distances[detector])
        .fold(f64::MIN_POSITIVE, f64::max);
    let cell = |k: usize| {
        let (old, new) = (k / count, k % count);
        if new > newest {
            return Cell::Unknown;
        }
        match places.study.pair(old, new) {
            Some(pair) => {
                let alike = 1.0 - (pair.distances[detector] / widest).min(1.0);
                Cell::Occupancy((alike * alike) as f32)
            }
            None => Cell::Unknown,
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
        cells: (0..count * count).map(cell).collect::<Arc<[Cell]>>(),
        // Everything on which the picture depends, in one number.
        revision: (been.laps << 16) + ((newest as u64) << 2) + detector as u64,
    }
}

/// The pair at a spot of the matrix; a spot below the diagonal is the mirrored pair.
pub fn pair_at(been: &BeenHere, at: [f64; 2]) -> Option<[usize; 2]> {
    let places = been.places.as_ref()?;
    let last = places.last() as f64;
    if !at.iter().all(|value| value.is_finite()) {
        return None;
    }
    let [new, old] = at.map(|value| value.round().clamp(0.0, last) as usize);
    Some([old.min(new), new.max(old)])
}

/// The rotation of the pair's newer scan in the picture: that of Scan Context, or none.
fn shown_turn(been: &BeenHere, study: &PlaceStudy, [old, new]: [usize; 2]) -> SE2 {
    match LapDetector::ALL[been.detector()] {
        LapDetector::Context => SE2::new(0.0, 0.0, study.turned(old, new).turn_rad),
        LapDetector::Nearby | LapDetector::Histogram => SE2::identity(),
    }
}

fn scans(been: &BeenHere) -> Panel {
    let told = been.places.as_ref().zip(been.pair());
    let Some((places, [old, new])) = told else {
        return Panel {
            legend: two_keyframes(),
            ..empty(
                panel::SCANS,
                "Scans of two keyframes, once the lap is driven",
            )
        };
    };
    let study = &places.study;
    let turn = shown_turn(been, study, [old, new]);
    let reach = study.max_range_m();
    let points = |scan: &PointCloud, mark, tone| {
        Layer::points(scan.iter().map(|p| [p.x, p.y]).collect(), mark, tone, 2.6)
    };
    let of = |node: usize| &study.places()[node].scan;
    let turned = if turn == SE2::identity() {
        "as the robot sees them".to_owned()
    } else {
        format!("the newer turned by {:.0}°", turn.theta().to_degrees())
    };
    Panel {
        title: format!("Scans of keyframes {old} and {new}, {turned}"),
        x: Axis::new("ahead of the robot (m)", -reach, reach),
        y: Axis::new("to its left (m)", -reach, reach),
        layers: vec![
            points(of(old), Mark::Cross, Tone::Measurement),
            points(&of(new).transformed(&turn), Mark::Square, Tone::Posterior),
            Layer::pose([0.0; 3], Mark::Plus, Tone::Ink, 6.0),
        ],
        legend: two_keyframes(),
        ..empty(panel::SCANS, "")
    }
}

fn two_keyframes() -> Vec<LegendEntry> {
    vec![
        LegendEntry::mark("older keyframe", Tone::Measurement, Mark::Cross),
        LegendEntry::mark("newer keyframe", Tone::Posterior, Mark::Square),
    ]
}

fn curves(been: &BeenHere) -> Panel {
    let mut panel = Panel {
        weight: Weight::Half,
        aspect: Aspect::Free,
        x: Axis::new("recall", 0.0, 1.0),
        y: Axis::new("precision", 0.0, 1.05),
        legend: LapDetector::ALL
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

fn map(been: &BeenHere) -> Panel {
    let told = been.places.as_ref().zip(been.pair());
    let Some((places, pair)) = told else {
        return empty(panel::MAP, "Where the keyframes are");
    };
    let walls = been.config.drive.world.walls();
    let bounds = been.config.drive.world.bounds();
    let truth = |node: usize| places.study.places()[node].truth;
    let way = places.study.places()[..=been.newest()].iter();
    let [old, new] = pair.map(truth);
    Panel {
        weight: Weight::Side,
        x: Axis::new("x (m)", bounds.min.x - 0.4, bounds.max.x + 0.4),
        y: Axis::new("y (m)", bounds.min.y - 0.4, bounds.max.y + 0.4),
        layers: vec![
            Layer::segments(
                walls
                    .iter()
                    .map(|wall| [[wall.start.x, wall.start.y], [wall.end.x, wall.end.y]])
                    .collect(),
                Stroke::Solid,
                Tone::Ink,
                1.5,
            ),
            Layer::points(
                way.map(|place| [place.truth.x(), place.truth.y()])
                    .collect(),
                Mark::Dot,
                Tone::Truth,
                2.0,
            ),
            Layer::segments(
                vec![[[old.x(), old.y()], [new.x(), new.y()]]],
                Stroke::Dotted,
                Tone::Posterior,
                1.75,
            ),
            Layer::pose(old.to_array(), Mark::Cross, Tone::Measurement, 6.0),
            Layer::pose(new.to_array(), Mark::Square, Tone::Posterior, 6.0),
        ],
        legend: vec![
            LegendEntry::mark("older keyframe", Tone::Measurement, Mark::Cross),
            LegendEntry::mark("newer keyframe", Tone::Posterior, Mark::Square),
            LegendEntry::mark("keyframes, where they truly are", Tone::Truth, Mark::Dot),
        ],
        ..empty(panel::MAP, "Where the keyframes are")
    }
}
