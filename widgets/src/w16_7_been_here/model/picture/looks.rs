//! The descriptors of the pair: two histograms over the range, or rings and sectors, before and after the
//! rotation.

use ch16_lab::lap::{Choice, LapDetector};
use ch16_lab::places::{Place, PlaceStudy};
use ch16_slam2d::places::RangeHistogram;
use kit::chart::axis_from_zero;
use kit::scene::{
    Aspect, Axis, Bounds, Cell, Layer, LegendEntry, Mark, Panel, Raster, Stroke, Tone, Weight,
};

use super::super::{BeenHere, panel};
use super::{empty, shown_turn, two_keyframes};

/// Rings of empty space between two contexts.
const GAP_RINGS: usize = 2;

pub fn panel(been: &BeenHere) -> Panel {
    let told = been.places.as_ref().zip(been.pair());
    let Some((places, [old, new])) = told else {
        return Panel {
            aspect: Aspect::Free,
            legend: two_keyframes(),
            ..empty(panel::LOOKS, "How alike they look, once the lap is driven")
        };
    };
    match LapDetector::ALL[been.detector()] {
        LapDetector::Context => contexts(been, &places.study, [old, new]),
        LapDetector::Nearby | LapDetector::Histogram => {
            let of = |node: usize| &places.study.places()[node].histogram;
            histograms(of(old), of(new), places.study.max_range_m())
        }
    }
}

fn histograms(old: &RangeHistogram, new: &RangeHistogram, max_range_m: f64) -> Panel {
    let highest = old.shares().iter().chain(new.shares()).copied();
    let steps = |histogram: &RangeHistogram| {
        let width = max_range_m / histogram.shares().len() as f64;
        let bins = histogram.shares().iter().enumerate();
        bins.flat_map(|(k, share)| [[k as f64 * width, *share], [(k + 1) as f64 * width, *share]])
            .collect()
    };
    let line =
        |histogram, tone, width_px| Layer::line(steps(histogram), Stroke::Solid, tone, width_px);
    Panel {
        id: panel::LOOKS,
        title: format!("Histograms of ranges: χ² distance {:.3}", old.distance(new)),
        weight: Weight::Half,
        aspect: Aspect::Free,
        x: Axis::new("range (m)", 0.0, max_range_m),
        y: axis_from_zero("share", highest.fold(0.0, f64::max)),
        layers: vec![
            line(old, Tone::Measurement, 2.5),
            line(new, Tone::Posterior, 1.5),
        ],
        legend: vec![
            LegendEntry::line("older keyframe", Tone::Measurement, Stroke::Solid),
            LegendEntry::line("newer keyframe", Tone::Posterior, Stroke::Solid),
        ],
        color_bar: None,
    }
}

/// The older one on top, the newer one in the middle, and the newer one shifted by its best rotation below.
fn contexts(been: &BeenHere, study: &PlaceStudy, [old, new]: [usize; 2]) -> Panel {
    let places = study.places();
    let rings = places[old].context.ring_key().len();
    let sectors = places[old].context.bins().len() / rings.max(1);
    let turn = shown_turn(been, study, [old, new]).theta();
    let shift = (turn / core::f64::consts::TAU * sectors as f64).round() as i64;
    let shift = shift.rem_euclid(sectors as i64) as usize;
    let row = rings + GAP_RINGS;
    let rows = 3 * rings + 2 * GAP_RINGS;
    let occupied = |place: &Place, sector: usize, ring: usize| {
        let bin = place.context.bins()[sector * rings + ring];
        Cell::Occupancy((0.06 + 0.9 * bin) as f32)
    };
    let cell = |k: usize| {
        // Straight ahead is in the middle: the sector of −180° comes first.
        let (sector, ring) = ((k % sectors + sectors / 2) % sectors, k / sectors);
        match (ring / row, ring % row) {
            (_, ring) if ring >= rings => Cell::Occupancy(0.0),
            (0, ring) => occupied(&places[new], (sector + sectors - shift) % sectors, ring),
            (1, ring) => occupied(&places[new], sector, ring),
            (_, ring) => occupied(&places[old], sector, ring),
        }
    };
    let distance = study.turned(old, new).distance;
    let revision = (been.laps << 40) + ((old as u64) << 20) + new as u64;
    Panel {
        id: panel::LOOKS,
        title: format!(
            "Rings and sectors, shifted by {:.0}°: distance {distance:.3}",
            turn.to_degrees()
        ),
        weight: Weight::Half,
        aspect: Aspect::Free,
        x: Axis::new("bearing (°)", -180.0, 180.0),
        y: Axis::new("rings: older above, newer, newer shifted", 0.0, rows as f64),
        layers: vec![Layer::Raster(Raster {
            bounds: Bounds {
                min: [-180.0, 0.0],
                max: [180.0, rows as f64],
            },
            columns: sectors,
            rows,
            cells: (0..rows * sectors).map(cell).collect(),
            revision,
        })],
        legend: vec![LegendEntry::mark("a return", Tone::Ink, Mark::Dot)],
        color_bar: None,
    }
}
