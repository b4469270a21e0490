//! All attempts to close a loop of a thousand laps: their true error against χ², and both rates of the gate.

use std::sync::OnceLock;

use ch16_lab::lap::{AcceptedShares, FALSE_LOOP_DISTANCE_M};
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

/// An attempt to close a loop, to the digits that the picture needs.
struct Attempt {
    chi2: f64,
    error_m: f64,
    /// Whether it passed the first test, the fit.
    fits: bool,
    is_false: bool,
}

/// Point-to-point at the usual noise, seeds 1 to 1000; `tests/pinned/page/figures/attempts.rs` compares them with the core.
fn attempts() -> &'static [Attempt] {
    static ATTEMPTS: OnceLock<Vec<Attempt>> = OnceLock::new();
    ATTEMPTS.get_or_init(|| {
        include_str!("attempts.txt")
            .lines()
            .filter_map(parse)
            .collect()
    })
}

/// A line `chi2 error_cm flags`: 1 is added for a fit, 2 for a false loop. In the order of χ², to be small when compressed.
fn parse(line: &str) -> Option<Attempt> {
    let mut words = line.split(' ');
    let chi2 = words.next()?.parse().ok()?;
    let error_cm: f64 = words.next()?.parse().ok()?;
    let flags: u8 = words.next()?.parse().ok()?;
    Some(Attempt {
        chi2,
        error_m: 0.01 * error_cm,
        fits: flags & 1 != 0,
        is_false: flags & 2 != 0,
    })
}

/// Both tests, with the gate at another threshold.
fn shares(gate: f64) -> AcceptedShares {
    let accepts = |tried: &Attempt| tried.fits && tried.chi2 <= gate;
    AcceptedShares::of(attempts(), |tried| tried.is_false, accepts)
}

/// Both shares, true and false, %.
fn rates(gate: f64) -> [f64; 2] {
    shares(gate).rates().map(|rate| 100.0 * rate)
}

fn at(gate: f64) -> Shown {
    let AcceptedShares {
        of_true: [passed, all],
        of_false: [slipped, wrong],
    } = shares(gate);
    let [of_true, of_false] = rates(gate);
    Shown {
        scene: Scene {
            panels: vec![picture(gate), curve(gate)],
        },
        sentence: format!(
            "Up to {gate:.1}, {passed} of {all} true attempts are accepted, {of_true:.0}%, and {slipped} of {wrong} false ones, \
             {of_false:.0}%. The difference is {:.0}%; chance scores 0, a perfect test 100.",
            of_true - of_false,
        ),
    }
}

fn picture(gate: f64) -> Panel {
    let places = |wanted: bool| -> Vec<[f64; 2]> {
        let wanted = attempts().iter().filter(|tried| tried.is_false == wanted);
        wanted
            .map(|tried| [tried.chi2.min(MOST_CHI2), tried.error_m.min(MOST_M)])
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
fn curve(gate: f64) -> Panel {
    let place = |gate: f64| {
        let [of_true, of_false] = rates(gate);
        [of_false, of_true]
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
        let [of_true, of_false] = rates(7.815);
        // The rate of some 127 false ones has a standard deviation of 3 %.
        assert!((of_true - of_false).abs() < 6.0, "{of_true} {of_false}");
        for k in 1..=80 {
            let [of_true, of_false] = rates(0.2 * f64::from(k));
            assert!(of_true - of_false < 50.0, "{k}: {of_true} {of_false}");
        }
    }
}
