//! NDT's own steps from a guess: how far each moves the sweep.

use std::sync::OnceLock;

use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::ndt::{NdtAlign, NdtConfig, NdtMap, NdtStep};
use pr_geom::{SE2, math};
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::bells::{self, BEAMS};
use super::{Shown, SketchSpec, Slider};

/// Width of the map's cells, m.
const CELL_M: f64 = 0.8;
/// The guess: x, y, heading.
const GUESS: [f64; 3] = [0.25, -0.2, 0.15];
/// Steps on the slider.
const STEPS: usize = 14;
/// Top of the axis of the lengths, cm.
const HIGHEST_CM: f64 = 8.0;

pub(super) const SKETCH: SketchSpec = SketchSpec {
    name: "newton",
    title: "NDT, step by step",
    slider: Slider {
        label: "steps taken",
        unit: "",
        min: 0.0,
        max: STEPS as f64,
        step: 1.0,
        default: 0.0,
        decimals: 0,
    },
    at,
    handle,
};

/// A registration, its map and the sweep that it moves.
struct Climb {
    map: NdtMap,
    sweep: PointCloud,
    /// The guess and the state after each step.
    states: Vec<NdtStep>,
}

fn climb() -> &'static Climb {
    static CLIMB: OnceLock<Climb> = OnceLock::new();
    CLIMB.get_or_init(|| {
        let [target, sweep] = bells::sweeps();
        let map = bells::map(&target, CELL_M);
        let [x, y, theta] = GUESS;
        let config = |max_iterations| NdtConfig {
            max_iterations,
            ..NdtConfig::default()
        };
        let guess = SE2::new(x, y, theta);
        // With no iterations allowed, a step reports the guess.
        let mut states = vec![NdtAlign::new(&sweep, &map, guess, &config(0)).step()];
        let mut registration = NdtAlign::new(&sweep, &map, guess, &config(STEPS));
        states.extend((0..STEPS).map(|_| registration.step()));
        Climb { map, sweep, states }
    })
}

/// The score per beam after a step.
fn score(step: usize) -> f64 {
    climb().states[step].score / BEAMS as f64
}

/// How far a step moves the sweep, cm; the guess is no step.
fn length_cm(step: usize) -> f64 {
    let Some(before) = step.checked_sub(1) else {
        return 0.0;
    };
    let [from, to] = [before, step].map(|step| climb().states[step].pose);
    100.0 * math::norm2(to.x() - from.x(), to.y() - from.y())
}

/// On the length of the last step.
fn handle(steps: f64) -> (&'static str, [f64; 2]) {
    ("lengths", [steps, length_cm(steps as usize)])
}

fn at(steps: f64) -> Shown {
    let step = steps as usize;
    let off = climb().states[step].pose;
    let off_cm = 100.0 * math::norm2(off.x(), off.y());
    let off_deg = off.theta().to_degrees().abs();
    Shown {
        scene: Scene {
            panels: vec![plan(step), lengths(step)],
        },
        sentence: match step.checked_sub(1) {
            None => {
                format!(
                    "The guess is {off_cm:.0} cm and {off_deg:.0}° off. Its score is {:.3} per beam.",
                    score(0)
                )
            }
            Some(_) if step == STEPS => {
                let longest = (1..=STEPS).max_by(|a, b| length_cm(*a).total_cmp(&length_cm(*b)));
                let longest = longest.unwrap_or(step);
                format!(
                    "After {step} steps the sweep is {off_cm:.1} cm off. The longest, step {longest}, was {:.1} cm.",
                    length_cm(longest)
                )
            }
            Some(before) => format!(
                "Step {step} is {:.1} cm long and takes the score from {:.3} to {:.3} per beam. The sweep is {off_cm:.1} cm off.",
                length_cm(step),
                score(before),
                score(step)
            ),
        },
    }
}

fn plan(step: usize) -> Panel {
    let climb = climb();
    let placed = |step: usize| {
        let moved = climb.sweep.transformed(&climb.states[step].pose);
        moved.iter().map(|point| [point.x, point.y]).collect()
    };
    let mut layers = bells::ellipses(&climb.map);
    layers.push(Layer::points(placed(0), Mark::Dot, Tone::Prior, 1.2));
    layers.push(Layer::points(
        placed(step),
        Mark::Cross,
        Tone::Measurement,
        3.0,
    ));
    Panel {
        id: "moved",
        title: "The sweep on the bells".to_owned(),
        layers,
        legend: vec![
            LegendEntry::mark("the guess", Tone::Prior, Mark::Dot),
            LegendEntry::mark("the sweep", Tone::Measurement, Mark::Cross),
            LegendEntry::line("a bell", Tone::Posterior, Stroke::Solid),
        ],
        ..bells::plan()
    }
}

fn lengths(step: usize) -> Panel {
    let bar = |k: usize| [[k as f64, 0.0], [k as f64, length_cm(k)]];
    let bars = (1..=step).map(bar).collect();
    Panel {
        id: "lengths",
        title: "Length of each step".to_owned(),
        weight: Weight::Half,
        aspect: Aspect::Free,
        x: Axis::new("step", 0.0, STEPS as f64 + 0.5),
        y: Axis::new("cm", 0.0, HIGHEST_CM),
        layers: vec![Layer::segments(bars, Stroke::Solid, Tone::Posterior, 7.0)],
        legend: Vec::new(),
        color_bar: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_step_climbs_and_the_last_ones_are_at_the_truth() {
        let scores: Vec<f64> = (0..=STEPS).map(score).collect();
        for pair in scores.windows(2) {
            assert!(pair[1] > pair[0], "{scores:?}");
        }
        let off = climb().states[STEPS].pose;
        assert!(off.step_size() < 0.03, "{off:?}");
    }

    /// The claim of the caption.
    #[test]
    fn a_later_step_is_longer_than_the_first() {
        let longest = (2..=STEPS).map(length_cm).fold(0.0, f64::max);
        assert!(
            longest > 1.5 * length_cm(1) && longest < HIGHEST_CM,
            "{longest}"
        );
    }
}
