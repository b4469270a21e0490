//! The descriptors of the two views: two histograms over the range, or the views unrolled by bearing, the newer
//! one slid over the older one.

use ch16_lab::lap::LapDetector;
use ch16_lab::places::{GRADED, Place};
use ch16_slam2d::places::RangeHistogram;
use pr_geom::SE2;
use widget_kit::chart::axis_from_zero;
use widget_kit::scene::{Aspect, Axis, Layer, LegendEntry, Mark, Panel, Stroke, Tone};

use super::super::lap::Places;
use super::super::{PlaceRecognition, panel};
use super::{NOW, THEN, empty};

/// The rows of the plot: the curve of the distance in the first one, the views in the rest.
const CURVE: [f64; 2] = [0.5, 1.8];
const VIEWS: [f64; 2] = [2.2, 4.3];

/// The lowest bearing of the plot, degrees: places of the way back are seen half a turn away.
const LOWEST_DEG: f64 = -90.0;

pub fn panel(been: &PlaceRecognition) -> Panel {
    let empty = Panel {
        aspect: Aspect::Free,
        x: bearings(),
        y: rows(),
        // Present from the start, so that the page below does not move.
        legend: vec![
            LegendEntry::mark("then", THEN, Mark::Cross),
            LegendEntry::mark("now", NOW, Mark::Square),
        ],
        ..empty(panel::LOOKS, "What both views show")
    };
    let Some((places, [old, new])) = been.places.as_ref().zip(been.pair()) else {
        return empty;
    };
    match GRADED[been.detector()] {
        LapDetector::Context => contexts(been, places, [old, new], empty),
        _ => {
            let of = |node: usize| &places.study.places()[node].histogram;
            histograms(of(old), of(new), places.study.max_range_m(), empty)
        }
    }
}

/// The turn of the newer view on screen, degrees; `None` without Scan Context.
pub fn turn_deg(been: &PlaceRecognition) -> Option<f64> {
    let (places, [old, new]) = been.places.as_ref().zip(been.pair())?;
    if GRADED[been.detector()] != LapDetector::Context {
        return None;
    }
    let best = places.study.turned(old, new).turn_rad;
    let turn = SE2::new(0.0, 0.0, best + been.turned_away_deg().to_radians());
    Some(on_axis(turn.theta().to_degrees()))
}

fn bearings() -> Axis {
    Axis::new("bearing (°)", LOWEST_DEG, LOWEST_DEG + 360.0)
}

fn rows() -> Axis {
    let names = ["unlike", "", "view"].map(str::to_owned);
    Axis {
        min: 0.4,
        max: 4.4,
        ..Axis::from_names("", names)
    }
}

/// The same bearing on the axis of the plot.
fn on_axis(bearing_deg: f64) -> f64 {
    (bearing_deg - LOWEST_DEG).rem_euclid(360.0) + LOWEST_DEG
}

fn histograms(old: &RangeHistogram, new: &RangeHistogram, max_range_m: f64, empty: Panel) -> Panel {
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
        title: format!("Ranges: a difference of {:.2}", old.distance(new)),
        x: Axis::new("range (m)", 0.0, max_range_m),
        y: axis_from_zero("share of the returns", highest.fold(0.0, f64::max)),
        layers: vec![line(old, THEN, 2.5), line(new, NOW, 1.5)],
        legend: vec![
            LegendEntry::line("then", THEN, Stroke::Solid),
            LegendEntry::line("now", NOW, Stroke::Solid),
        ],
        ..empty
    }
}

fn contexts(
    been: &PlaceRecognition,
    places: &Places,
    [old, new]: [usize; 2],
    empty: Panel,
) -> Panel {
    let all = places.study.places();
    let (old, new) = (&all[old], &all[new]);
    let rings = old.context.ring_key().len();
    let sectors = old.context.bins().len() / rings.max(1);
    let sector_deg = 360.0 / sectors as f64;
    let turn_deg = turn_deg(been).unwrap_or_default();
    let shift_of = |turn_deg: f64| (turn_deg / sector_deg).round().rem_euclid(sectors as f64);
    let differ = |shift: f64| {
        old.context
            .distance_at(&new.context, shift as usize % sectors)
    };
    let height = |distance: f64| CURVE[0] + (CURVE[1] - CURVE[0]) * distance;
    let seen = |place: &Place, by_deg: f64| {
        let bins = place.context.bins().iter().enumerate();
        let returns = bins.filter(|(_, bin)| **bin > 0.0);
        let spot = |(k, _): (usize, &f64)| {
            let bearing = on_axis((k / rings) as f64 * sector_deg + 0.5 * sector_deg + by_deg);
            let ring = ((k % rings) as f64 + 0.5) / rings as f64;
            [bearing, VIEWS[0] + (VIEWS[1] - VIEWS[0]) * ring]
        };
        returns.map(spot).collect::<Vec<_>>()
    };
    let curve = (0..=sectors).map(|k| {
        let at = LOWEST_DEG + k as f64 * sector_deg;
        [at, height(differ(shift_of(at)))]
    });
    let distance = differ(shift_of(turn_deg));
    Panel {
        title: format!("Turned by {turn_deg:.0}° they differ by {distance:.2}"),
        layers: vec![
            Layer::line(curve.collect(), Stroke::Solid, Tone::Ink, 1.75),
            Layer::segments(
                vec![[[turn_deg, CURVE[0]], [turn_deg, VIEWS[1]]]],
                Stroke::Dotted,
                NOW,
                1.5,
            ),
            Layer::points(seen(old, 0.0), Mark::Cross, THEN, 2.6),
            Layer::points(seen(new, turn_deg), Mark::Square, NOW, 2.0),
            Layer::Handle {
                at: [turn_deg, height(distance)],
                tone: NOW,
                label: "slide the newer view over the older one",
            },
        ],
        ..empty
    }
}
