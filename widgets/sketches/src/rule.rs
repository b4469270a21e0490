//! What a loop is worth: predicted by the graph, and driven a thousand times.

use ch16_lab::rule::{EDGES, biased_m, driven_m, sigmas_m};
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::{Shown, SketchSpec, Slider};

/// Number of simulated drives.
const DRIVES: usize = 1000;
/// The tip of the arm.
const TIP: usize = EDGES / 2;
/// A dot is drawn for every so many nodes.
const EVERY: usize = 2;

pub(super) const SKETCH: SketchSpec = SketchSpec {
    name: "rule",
    title: "What a loop is worth",
    slider: Slider {
        label: "the loop ties both passes at",
        unit: " m",
        min: 0.0,
        max: 18.0,
        step: 1.0,
        default: 8.0,
        decimals: 0,
    },
    at,
    handle,
};

/// The tie on the way out.
fn handle(tie: f64) -> (&'static str, [f64; 2]) {
    ("walk", [tie, sigmas_m(None)[tie as usize]])
}

/// How much smaller than `before`, %.
fn fall_percent(before: f64, after: f64) -> f64 {
    100.0 * (1.0 - after / before)
}

fn at(tie: f64) -> Shown {
    let tie = tie as usize;
    let [predicted, driven, biased] = [
        [sigmas_m(None), sigmas_m(Some(tie))],
        [driven_m(None, DRIVES, 16), driven_m(Some(tie), DRIVES, 16)],
        [biased_m(None), biased_m(Some(tie))],
    ];
    let fall = |[before, after]: &[Vec<f64>; 2]| fall_percent(before[TIP], after[TIP]);
    let sentence = format!(
        "With a tie at {tie} m, the tip’s standard deviation should fall by {:.0}%. Over {DRIVES} drives the error there falls by \
         {:.0}%. A bias shared by all edges falls by {:.0}%.",
        fall(&predicted),
        fall(&driven),
        fall(&biased).abs()
    );
    Shown {
        scene: Scene {
            panels: vec![walk(tie, &predicted, &driven), bias(&biased)],
        },
        sentence,
    }
}

fn line(values: &[f64], stroke: Stroke, tone: Tone) -> Layer {
    let points = values.iter().enumerate();
    let points = points.map(|(node, value)| [node as f64, *value]).collect();
    Layer::line(points, stroke, tone, 2.0)
}

fn dots(values: &[f64], mark: Mark, tone: Tone) -> Layer {
    let points = values.iter().enumerate().step_by(EVERY);
    let points = points.map(|(node, value)| [node as f64, *value]).collect();
    Layer::points(points, mark, tone, 3.0)
}

fn walk(tie: usize, [before, after]: &[Vec<f64>; 2], driven: &[Vec<f64>; 2]) -> Panel {
    let tied = [tie, EDGES - tie].map(|node| [node as f64, after[node]]);
    Panel {
        id: "walk",
        title: "Independent errors".to_owned(),
        weight: Weight::Main,
        aspect: Aspect::Free,
        x: Axis::new("along the path, out and back (m)", 0.0, EDGES as f64),
        y: Axis::new("std. deviation (m)", 0.0, 0.8),
        layers: vec![
            line(before, Stroke::Dashed, Tone::Prior),
            line(after, Stroke::Solid, Tone::Posterior),
            dots(&driven[0], Mark::Circle, Tone::Prior),
            dots(&driven[1], Mark::Square, Tone::Posterior),
            Layer::segments(vec![tied], Stroke::Solid, Tone::Measurement, 2.0),
            Layer::points(tied.to_vec(), Mark::Cross, Tone::Measurement, 6.0),
        ],
        legend: vec![
            LegendEntry::marked_line(
                "without the loop",
                Tone::Prior,
                Mark::Circle,
                Stroke::Dashed,
            ),
            LegendEntry::marked_line("with it", Tone::Posterior, Mark::Square, Stroke::Solid),
            LegendEntry::marked_line("the loop", Tone::Measurement, Mark::Cross, Stroke::Solid),
        ],
        color_bar: None,
    }
}

fn bias([before, after]: &[Vec<f64>; 2]) -> Panel {
    Panel {
        id: "bias",
        title: "A bias all edges share".to_owned(),
        weight: Weight::Side,
        aspect: Aspect::Free,
        x: Axis::new("along the path (m)", 0.0, EDGES as f64),
        y: Axis::new("error (m)", -2.4, 0.2),
        layers: vec![
            line(before, Stroke::Dashed, Tone::Prior),
            dots(after, Mark::Square, Tone::Posterior),
        ],
        legend: vec![
            LegendEntry::line("without the loop", Tone::Prior, Stroke::Dashed),
            LegendEntry::mark("with it", Tone::Posterior, Mark::Square),
        ],
        color_bar: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tip_gains_most_from_a_loop_at_the_start_and_never_more_than_two_measurements_of_an_arm()
    {
        let falls: Vec<f64> = (0..=18)
            .map(|tie| fall_percent(sigmas_m(None)[TIP], sigmas_m(Some(tie))[TIP]))
            .collect();
        assert!(falls.is_sorted_by(|a, b| a > b), "{falls:?}");
        let most = 100.0 * (1.0 - 0.5_f64.sqrt());
        // 0.01 %: the loop's information is finite.
        assert!((falls[0] - most).abs() < 0.01, "{falls:?}");
    }

    #[test]
    fn the_sentence_compares_what_is_predicted_with_what_was_driven() {
        let says = at(0.0).sentence;
        assert!(
            says.contains("fall by 29%") && says.ends_with("falls by 0%."),
            "{says}"
        );
        let driven = fall_percent(
            driven_m(None, DRIVES, 16)[TIP],
            driven_m(Some(0), DRIVES, 16)[TIP],
        );
        // Three standard deviations of a quotient of root mean squares over 1000 drives, which share their edges.
        assert!((driven - 29.3).abs() < 5.0, "{driven}");
    }
}
