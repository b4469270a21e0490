//! A loop at the gate: drift grows with the path length.

use std::sync::OnceLock;

use ch16_lab::drift::{drawn_innovation, straight};
use ch16_lab::lap::{LapConfig, LapRunner};
use ch16_slam2d::chapter::path_information;
use ch16_slam2d::loops::{LoopConfig, chi_squared_gate};
use ch16_slam2d::prelude::Vector3;
use pr_geom::{Rng, SE2, math};
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::{Shown, SketchSpec, Slider};

/// Number of drawn drifts.
const DRIFTS: usize = 200;
/// The drawn part: distance from the prediction, m, and turn away from it, degrees.
const REACH_M: f64 = 1.2;
const REACH_DEG: f64 = 20.0;

pub(super) const SKETCH: SketchSpec = SketchSpec {
    name: "gate",
    title: "A gate that grows with the path",
    slider: Slider {
        label: "edges since the last visit",
        unit: "",
        min: 1.0,
        max: 60.0,
        step: 1.0,
        default: 8.0,
        decimals: 0,
    },
    at,
    handle,
};

/// The innovation of the canonical lap's first loop, m, m, rad.
fn innovation() -> &'static Vector3<f64> {
    static FOUND: OnceLock<Vector3<f64>> = OnceLock::new();
    FOUND.get_or_init(|| {
        let record = LapRunner::new().run(&LapConfig::default());
        let first = record.lap.loop_attempts().next();
        first
            .expect("the canonical lap has loops")
            .verification
            .innovation
    })
}

fn at(edges: f64) -> Shown {
    let config = LapConfig::default().slam.chapter.loops;
    let gap = edges as usize;
    let information = path_information(gap, &config);
    let gate =
        |innovation: &Vector3<f64>| chi_squared_gate(innovation, &information, config.gate_chi2);
    let tested = gate(innovation());
    let word = if tested.passes() {
        "accepted"
    } else {
        "rejected"
    };
    let [reach_m, reach_deg] = reach(gap, &config);
    Shown {
        scene: Scene {
            panels: vec![picture(gap, &config), ends(gap, &config)],
        },
        sentence: format!(
            "After {gap} edges the gate reaches {reach_m:.2} m, or {reach_deg:.0}°. The loop’s χ² is {:.2}, the threshold {:.3}: {word}.",
            tested.chi2, tested.gate_chi2
        ),
    }
}

/// The largest shift without a turn that passes, m, and the largest turn without a shift, degrees.
fn reach(gap: usize, config: &LoopConfig) -> [f64; 2] {
    let information = path_information(gap, config);
    let [shift_m, turn_rad] = [0, 2].map(|k| math::sqrt(config.gate_chi2 / information[(k, k)]));
    [shift_m, turn_rad.to_degrees()]
}

/// The gate at its widest along the distance: where it is dragged.
fn handle(edges: f64) -> (&'static str, [f64; 2]) {
    let config = LapConfig::default().slam.chapter.loops;
    ("gate", [reach(edges as usize, &config)[0], 0.0])
}

/// An innovation in the picture. The gate knows no direction: it tests how far, and by which turn.
fn drawn(innovation: &Vector3<f64>) -> [f64; 2] {
    let far_m = math::norm2(innovation.x, innovation.y);
    [far_m, innovation.z.to_degrees()]
}

fn picture(gap: usize, config: &LoopConfig) -> Panel {
    let [reach_m, reach_deg] = reach(gap, config);
    let information = path_information(gap, config);
    let found = innovation();
    let passes = |innovation: &Vector3<f64>| {
        chi_squared_gate(innovation, &information, config.gate_chi2).passes()
    };
    let (within, beyond): (Vec<_>, Vec<_>) = drifts(gap, config).into_iter().partition(passes);
    let places = |drifts: &[Vector3<f64>]| drifts.iter().map(drawn).collect();
    let (label, mark, tone) = if passes(found) {
        ("the loop, accepted", Mark::Square, Tone::Posterior)
    } else {
        ("the loop, rejected", Mark::Circle, Tone::Truth)
    };
    Panel {
        id: "gate",
        title: format!(
            "Drift over {gap} edges: {} of {DRIFTS} rejected",
            beyond.len()
        ),
        weight: Weight::Main,
        aspect: Aspect::Free,
        x: Axis::new("distance from the prediction (m)", 0.0, REACH_M),
        y: Axis::new("heading error (°)", -REACH_DEG, REACH_DEG),
        layers: vec![
            Layer::points(places(&within), Mark::Dot, Tone::Prior, 2.0),
            Layer::points(places(&beyond), Mark::Triangle, Tone::Prediction, 3.0),
            Layer::Ellipse {
                center: [0.0; 2],
                half_axes: [[reach_m, 0.0], [0.0, reach_deg]],
                stroke: Stroke::Dotted,
                tone: Tone::Ink,
            },
            Layer::points(vec![[0.0; 2]], Mark::Plus, Tone::Prior, 6.0),
            Layer::points(vec![drawn(found)], mark, tone, 7.0),
        ],
        legend: vec![
            LegendEntry::mark("predicted", Tone::Prior, Mark::Plus),
            LegendEntry::mark("true drifts that pass", Tone::Prior, Mark::Dot),
            LegendEntry::mark("rejected drifts", Tone::Prediction, Mark::Triangle),
            LegendEntry::line("gate", Tone::Ink, Stroke::Dotted),
            LegendEntry::mark(label, tone, mark),
        ],
        color_bar: None,
    }
}

/// Where the drifts end, in the plane: a bent cloud, and the circle of the positions that pass without a turn.
fn ends(gap: usize, config: &LoopConfig) -> Panel {
    let [reach_m, _] = reach(gap, config);
    let information = path_information(gap, config);
    let passes = |innovation: &Vector3<f64>| {
        chi_squared_gate(innovation, &information, config.gate_chi2).passes()
    };
    let place = |innovation: &Vector3<f64>| {
        let end = SE2::exp(innovation);
        [end.x(), end.y()]
    };
    let (within, beyond): (Vec<_>, Vec<_>) = drifts(gap, config).into_iter().partition(passes);
    let places = |drifts: &[Vector3<f64>]| drifts.iter().map(place).collect();
    Panel {
        id: "ends",
        title: "Where drifts end, and the gate".to_owned(),
        weight: Weight::Side,
        aspect: Aspect::Equal,
        x: Axis::new("along the path (m)", -REACH_M, REACH_M),
        y: Axis::new("across (m)", -2.0 * REACH_M, 2.0 * REACH_M),
        layers: vec![
            Layer::points(places(&within), Mark::Dot, Tone::Prior, 2.0),
            Layer::points(places(&beyond), Mark::Triangle, Tone::Prediction, 3.0),
            Layer::Ellipse {
                center: [0.0; 2],
                half_axes: [[reach_m, 0.0], [0.0, reach_m]],
                stroke: Stroke::Dotted,
                tone: Tone::Ink,
            },
        ],
        legend: Vec::new(),
        color_bar: None,
    }
}

/// Drifts over a straight path, drawn edge by edge, m, m, rad.
fn drifts(gap: usize, config: &LoopConfig) -> Vec<Vector3<f64>> {
    let path = straight(gap, LapConfig::default().slam.keyframe_distance_m);
    let mut rng = Rng::new(16);
    (0..DRIFTS)
        .map(|_| drawn_innovation(&path, config, &mut rng))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn accepted(edges: f64) -> bool {
        at(edges).sentence.ends_with("accepted.")
    }

    /// The canonical lap tests this loop over 22 edges, and accepts it (chapter, canonical run).
    #[test]
    fn the_loop_is_rejected_after_a_short_path_and_accepted_after_its_own() {
        assert!(!accepted(1.0));
        assert!(accepted(22.0));
        assert!(
            at(22.0)
                .sentence
                .contains("χ² is 4.24, the threshold 7.815"),
            "{}",
            at(22.0).sentence
        );
    }

    /// A picture in which a rejected loop lies within the gate would deny its own verdict.
    #[test]
    fn a_loop_lies_within_the_drawn_gate_exactly_if_it_passes() {
        let config = LapConfig::default().slam.chapter.loops;
        for gap in 1..=60 {
            let [reach_m, reach_deg] = reach(gap, &config);
            for drift in drifts(gap, &config).iter().chain([innovation()]) {
                let [far_m, turn_deg] = drawn(drift);
                let within = math::norm2(far_m / reach_m, turn_deg / reach_deg) <= 1.0;
                let information = path_information(gap, &config);
                let passes = chi_squared_gate(drift, &information, config.gate_chi2).passes();
                assert_eq!(within, passes, "{gap}: {drift:?}");
            }
        }
    }

    #[test]
    fn a_wider_gate_accepts_all_that_a_narrower_one_accepts() {
        let verdicts: Vec<bool> = (1..=60).map(|edges| accepted(f64::from(edges))).collect();
        assert!(verdicts.windows(2).all(|pair| pair[0] <= pair[1]));
    }

    /// 18 % of 40,000 draws (`drift.straight.22` of the page); 3 standard deviations of a count of 200 are 16.
    #[test]
    fn about_one_true_drift_in_six_stays_outside_after_a_straight_path() {
        let config = LapConfig::default().slam.chapter.loops;
        let information = path_information(22, &config);
        let outside = drifts(22, &config)
            .iter()
            .filter(|drift| !chi_squared_gate(drift, &information, config.gate_chi2).passes())
            .count();
        assert!((19..=51).contains(&outside), "{outside}");
    }
}
