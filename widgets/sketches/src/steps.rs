//! Registered minus predicted steps of three matchers: the one warning of a bias that a robot gets.

use std::sync::OnceLock;

use ch16_lab::lap::{LapConfig, LapMatcher, LapRunner, LapTrace, StepInnovations};
use widget_kit::scene::{Aspect, Axis, Layer, LegendEntry, Panel, Scene, Stroke, Tone, Weight};

use super::{Shown, SketchSpec, Slider, histogram};

/// Beside the histogram in this order, with their lines.
const MATCHERS: [(LapMatcher, &str, Stroke); 3] = [
    (LapMatcher::PointToPoint, "point-to-point", Stroke::Solid),
    (LapMatcher::PointToPlane, "point-to-plane", Stroke::Dashed),
    (LapMatcher::Ndt, "NDT", Stroke::Dotted),
];
/// Width of a bin, cm, and bins to either side.
const BIN_CM: f64 = 2.0;
const BINS: i32 = 8;
/// A mean beyond so many standard errors is seldom chance.
const ALARM: f64 = 2.0;
/// Ticks of the lap.
const TICKS: f64 = 129.0;
/// The first tick with enough steps for a standard error.
const FIRST: f64 = 9.0;
/// Largest count of a bin that is drawn.
const HIGHEST: f64 = 60.0;

pub(super) const SKETCH: SketchSpec = SketchSpec {
    name: "steps",
    title: "What registration adds to each predicted step",
    slider: Slider {
        label: "ticks driven",
        unit: "",
        min: FIRST,
        max: TICKS,
        step: 1.0,
        default: 120.0,
        decimals: 0,
    },
    at,
    handle,
};

/// The front ends of the canonical lap.
fn laps() -> &'static [LapTrace; 3] {
    static LAPS: OnceLock<[LapTrace; 3]> = OnceLock::new();
    LAPS.get_or_init(|| {
        let mut runner = LapRunner::new();
        MATCHERS.map(|(matcher, ..)| {
            runner
                .run(&LapConfig::default().with_matcher(matcher))
                .front_end
        })
    })
}

fn innovations(lap: &LapTrace, ticks: f64) -> StepInnovations {
    lap.innovations(ticks as usize)
        .expect("the robot has driven")
}

/// On the curve of point-to-point.
fn handle(ticks: f64) -> (&'static str, [f64; 2]) {
    ("alarm", [ticks, innovations(&laps()[0], ticks).t()])
}

fn at(ticks: f64) -> Shown {
    let found = laps().each_ref().map(|lap| innovations(lap, ticks));
    let words: Vec<String> = found
        .iter()
        .zip(MATCHERS)
        .map(|(steps, (_, name, _))| {
            format!(
                "{name} by {:+.1} cm, {:.1} standard errors",
                100.0 * steps.mean_m,
                steps.t().abs()
            )
            .replace('-', "−")
            .replace("point−to−", "point-to-")
        })
        .collect();
    Shown {
        scene: Scene {
            panels: vec![changes(ticks), alarm(ticks)],
        },
        sentence: format!(
            "After {ticks:.0} ticks, each matcher changes steps on average: {}.",
            words.join("; ")
        ),
    }
}

/// The colour of a matcher.
fn tone(which: usize) -> Tone {
    Tone::Series(which as u8)
}

fn changes(ticks: f64) -> Panel {
    let curve = |which: usize| {
        let innovations = laps()[which].step_innovations(ticks as usize);
        let points = histogram(innovations.map(|step| 100.0 * step[0]), BIN_CM, BINS);
        Layer::line(points, MATCHERS[which].2, tone(which), 2.0)
    };
    let reach_cm = BIN_CM * (f64::from(BINS) + 0.5);
    Panel {
        id: "steps",
        title: "Registered minus predicted step".to_owned(),
        weight: Weight::Main,
        aspect: Aspect::Free,
        x: Axis::new("along the direction of travel (cm)", -reach_cm, reach_cm),
        y: Axis::new("steps", 0.0, HIGHEST),
        layers: vec![
            Layer::segments(
                vec![[[0.0, 0.0], [0.0, HIGHEST]]],
                Stroke::Dotted,
                Tone::Ink,
                1.0,
            ),
            curve(0),
            curve(1),
            curve(2),
        ],
        legend: (0..MATCHERS.len())
            .map(|which| LegendEntry::line(MATCHERS[which].1, tone(which), MATCHERS[which].2))
            .collect(),
        color_bar: None,
    }
}

fn alarm(ticks: f64) -> Panel {
    let curve = |which: usize| {
        let points = (FIRST as usize..=ticks as usize).map(|tick| {
            let steps = innovations(&laps()[which], tick as f64);
            [tick as f64, steps.t().clamp(-5.0, 5.0)]
        });
        Layer::line(points.collect(), MATCHERS[which].2, tone(which), 2.0)
    };
    let limit = |t: f64| [[0.0, t], [TICKS, t]];
    Panel {
        id: "alarm",
        title: "Their mean in standard errors".to_owned(),
        weight: Weight::Side,
        aspect: Aspect::Free,
        x: Axis::new("tick", 0.0, TICKS),
        y: Axis::new("mean ÷ standard error", -5.0, 5.0),
        layers: vec![
            Layer::segments(
                vec![limit(ALARM), limit(-ALARM)],
                Stroke::Dotted,
                Tone::Ink,
                1.0,
            ),
            curve(0),
            curve(1),
            curve(2),
        ],
        legend: Vec::new(),
        color_bar: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_mean_of_point_to_point_is_no_chance() {
        let t = laps().each_ref().map(|lap| innovations(lap, TICKS).t());
        assert!(t[0] < -ALARM, "{t:?}");
        assert!(t[1].abs() < ALARM && t[2].abs() < ALARM, "{t:?}");
    }

    /// The cause is the matcher, not the wheels: all three have the same odometry.
    #[test]
    fn the_predicted_steps_are_those_of_the_wheels_and_do_not_depend_on_the_matcher() {
        let lengths = laps().each_ref().map(|lap| {
            let steps: Vec<f64> = lap.step_innovations(129).map(|step| step[1]).collect();
            steps
        });
        for (point, plane) in lengths[0].iter().zip(&lengths[1]) {
            // 1e-9: rounding of a composition and its inverse on metres.
            assert!((point - plane).abs() < 1e-9);
        }
    }
}
