//! All attempts to close a loop of a thousand laps: their true error against χ², and both rates of the gate.

use std::sync::OnceLock;

use ch16_lab::lap::{AcceptedShares, FALSE_LOOP_DISTANCE_M, LapConfig, LoopError, TestedLoop};
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::{Shown, SketchSpec, Slider};

/// Ends of the axes; attempts beyond are drawn there.
const MOST_CHI2: f64 = 20.0;
const MOST_M: f64 = 0.6;

pub(super) const SKETCH: SketchSpec = SketchSpec {
    name: "attempts",
    title: "Every attempt to close a loop, over a thousand laps",
    slider: Slider {
        label: "accept χ² up to",
        unit: "",
        min: 0.2,
        max: 16.0,
        step: 0.2,
        default: 7.8,
        decimals: 1,
    },
    at,
    handle,
};

/// On the line of the gate.
fn handle(gate: f64) -> (&'static str, [f64; 2]) {
    ("attempts", [gate, 0.9 * MOST_M])
}

/// Point-to-point at the usual noise, seeds 1 to 1000; `tests/pinned/page/attempts.rs` compares them with the core.
fn attempts() -> &'static [TestedLoop] {
    static ATTEMPTS: OnceLock<Vec<TestedLoop>> = OnceLock::new();
    ATTEMPTS.get_or_init(|| parse(include_str!("attempts.txt")))
}

/// Lines `chi2 position_m heading_deg fits`.
fn parse(table: &str) -> Vec<TestedLoop> {
    let mut attempts = Vec::new();
    for line in table.lines() {
        let mut numbers = line.split(' ').filter_map(|word| word.parse::<f64>().ok());
        if let (Some(chi2), Some(position_m), Some(heading_deg), Some(fits)) = (
            numbers.next(),
            numbers.next(),
            numbers.next(),
            numbers.next(),
        ) {
            attempts.push(TestedLoop {
                fits: fits > 0.0,
                chi2,
                accepted: fits > 0.0 && chi2 <= LapConfig::default().slam.chapter.loops.gate_chi2,
                error: LoopError {
                    position_m,
                    heading_deg,
                },
            });
        }
    }
    attempts
}

/// Both tests, with the gate at another threshold.
fn shares(gate: f64) -> AcceptedShares {
    AcceptedShares::of(attempts(), |tested| tested.fits && tested.chi2 <= gate)
}

fn at(gate: f64) -> Shown {
    let found = shares(gate);
    let [of_true, of_false] = found.rates().map(|rate| 100.0 * rate);
    Shown {
        scene: Scene {
            panels: vec![picture(gate), rates(gate)],
        },
        sentence: format!(
            "Up to {gate:.1}, {} of {} true attempts are accepted, {of_true:.0}%, and {} of {} false ones, {of_false:.0}%. The \
             difference is {:.0}%; chance has 0, a perfect test 100.",
            found.of_true[0],
            found.of_true[1],
            found.of_false[0],
            found.of_false[1],
            of_true - of_false,
        ),
    }
}

fn picture(gate: f64) -> Panel {
    let places = |wanted: bool| -> Vec<[f64; 2]> {
        let wanted = attempts()
            .iter()
            .filter(|tested| tested.error.is_false() == wanted);
        wanted
            .map(|tested| {
                [
                    tested.chi2.min(MOST_CHI2),
                    tested.error.position_m.min(MOST_M),
                ]
            })
            .collect()
    };
    let across = |y: f64| [[0.0, y], [MOST_CHI2, y]];
    Panel {
        id: "attempts",
        title: "The true error, against what the robot sees".to_owned(),
        weight: Weight::Main,
        aspect: Aspect::Free,
        x: Axis::new("χ²", 0.0, MOST_CHI2),
        y: Axis::new("true error (m)", 0.0, MOST_M),
        layers: vec![
            Layer::points(places(false), Mark::Dot, Tone::Prior, 1.5),
            Layer::points(places(true), Mark::Triangle, Tone::Prediction, 3.0),
            Layer::segments(
                vec![across(FALSE_LOOP_DISTANCE_M)],
                Stroke::Dashed,
                Tone::Truth,
                1.5,
            ),
            Layer::segments(
                vec![[[gate, 0.0], [gate, MOST_M]]],
                Stroke::Dotted,
                Tone::Ink,
                2.0,
            ),
        ],
        legend: vec![
            LegendEntry::mark("true", Tone::Prior, Mark::Dot),
            LegendEntry::mark("false", Tone::Prediction, Mark::Triangle),
            LegendEntry::line("gate", Tone::Ink, Stroke::Dotted),
        ],
        color_bar: None,
    }
}

/// Both rates for every gate, beside chance and perfect.
fn rates(gate: f64) -> Panel {
    let place = |gate: f64| {
        let [of_true, of_false] = shares(gate).rates();
        [100.0 * of_false, 100.0 * of_true]
    };
    let curve = (0..=80).map(|k| place(f64::from(k) * 0.25)).collect();
    Panel {
        id: "rates",
        title: "Both rates".to_owned(),
        weight: Weight::Side,
        aspect: Aspect::Free,
        x: Axis::new("false ones accepted (%)", 0.0, 100.0),
        y: Axis::new("true ones accepted (%)", 0.0, 100.0),
        layers: vec![
            Layer::segments(
                vec![[[0.0, 0.0], [100.0, 100.0]]],
                Stroke::Dotted,
                Tone::Ink,
                1.5,
            ),
            Layer::line(curve, Stroke::Solid, Tone::Posterior, 2.0),
            Layer::points(vec![[0.0, 100.0]], Mark::Plus, Tone::Truth, 6.0),
            Layer::points(vec![place(gate)], Mark::Square, Tone::Posterior, 5.0),
        ],
        legend: vec![
            LegendEntry::line("chance", Tone::Ink, Stroke::Dotted),
            LegendEntry::mark("perfect", Tone::Truth, Mark::Plus),
        ],
        color_bar: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chapters_gate_accepts_true_and_false_alike_and_no_other_parts_them() {
        let [of_true, of_false] = shares(7.815).rates();
        // The rate of some 127 false ones has a standard deviation of 3 %.
        assert!((of_true - of_false).abs() < 0.06, "{of_true} {of_false}");
        for k in 1..=80 {
            let [of_true, of_false] = shares(0.2 * f64::from(k)).rates();
            assert!(of_true - of_false < 0.5, "{k}: {of_true} {of_false}");
        }
    }
}
