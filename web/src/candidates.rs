//! Ten loop candidates for the reader to judge, and the curve of the gate's decisions on them.

use std::sync::OnceLock;

use ch16_lab::lap::{LapConfig, LapRecord, LapRunner, RecordedLoopAttempt};
use ch16_slam2d::loops::LoopRejection;
use pr_geom::sort_numbers;
use serde_json::{Value, json};
use widget_kit::palette::Theme;
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};
use widget_kit::svg::scene_svg;

/// Number of right candidates, and of wrong ones.
const OF_EACH: usize = 5;
/// Odometry noise of the laps after the canonical one, high enough that registration errs.
const NOISE: f64 = 2.0;
/// Half of a picture's side, m.
const REACH_M: f64 = 4.0;

/// A loop candidate of a lap, and its evidence.
struct Candidate {
    submap: Vec<[f64; 2]>,
    sweep: Vec<[f64; 2]>,
    says: String,
    chi2: f64,
    /// Whether the sweep fits: the first test.
    fits: bool,
    is_right: bool,
    error: String,
}

/// The canonical lap's first candidate, then the first of each kind over the seeds, at most one per lap.
fn candidates() -> &'static [Candidate] {
    static FOUND: OnceLock<Vec<Candidate>> = OnceLock::new();
    FOUND.get_or_init(|| {
        let mut runner = LapRunner::new();
        let mut found: Vec<Candidate> = Vec::new();
        let mut missing = [OF_EACH; 2];
        let noisy = (1..).map(|seed| LapConfig::with_seed_and_noise(seed, NOISE));
        let mut laps = core::iter::once(LapConfig::default()).chain(noisy);
        while missing != [0, 0] {
            let record = runner.run(&laps.next().expect("there is another seed"));
            let wanted = record.lap.loop_attempts().find(|attempt| {
                let kind = usize::from(record.lap.loop_error(attempt).is_false());
                missing[kind] > 0 && missing[kind] >= missing[1 - kind]
            });
            if let Some(attempt) = wanted {
                let candidate = Candidate::new(&record, attempt);
                missing[usize::from(!candidate.is_right)] -= 1;
                found.push(candidate);
            }
        }
        found
    })
}

impl Candidate {
    fn new(record: &LapRecord, attempt: &RecordedLoopAttempt) -> Self {
        let loop_ = &attempt.verification;
        let lap = &record.lap;
        let poses = lap.poses(attempt.tick - 1);
        let half_width = record.config.slam.chapter.loops.submap_half_width;
        let old = loop_.candidate.node;
        let cloud = |node: usize| record.drive.prepared(lap.keyframes[node].tick).cloud;
        let around = old.saturating_sub(half_width)..=old + half_width;
        let submap = around.flat_map(|node| {
            let pose = poses[old].between(&poses[node]);
            let points: Vec<_> = cloud(node).iter().map(|p| pose.transform(p)).collect();
            points
        });
        let sweep = cloud(loop_.from_node);
        let moved = sweep.iter().map(|point| loop_.registered.transform(point));
        let error = lap.loop_error(attempt);
        let off = loop_.predicted.between(&loop_.registered);
        Self {
            submap: submap.map(|point| [point.x, point.y]).collect(),
            sweep: moved.map(|point| [point.x, point.y]).collect(),
            says: format!(
                "It fits to {:.3} m over {} pairs. After {} nodes it is {:.2} m and {:.1}° from where the graph \
                 puts it.",
                loop_.rmse_m,
                loop_.inliers,
                loop_.gap(),
                off.translation().norm(),
                off.theta().to_degrees().abs(),
            ),
            chi2: loop_.gate.chi2,
            fits: matches!(loop_.rejection, None | Some(LoopRejection::OutsideGate(_))),
            is_right: !error.is_false(),
            error: format!(
                "{:.2} m and {:.1}° from the truth",
                error.position_m,
                error.heading_deg.abs()
            ),
        }
    }

    fn picture(&self) -> Panel {
        let near = |points: &[[f64; 2]]| -> Vec<[f64; 2]> {
            let near = points
                .iter()
                .filter(|p| p.iter().all(|c| c.abs() < REACH_M));
            near.copied().collect()
        };
        Panel {
            id: "candidate",
            title: "The sweep over the submap".to_owned(),
            weight: Weight::Main,
            aspect: Aspect::Equal,
            x: Axis::new("x of the old keyframe (m)", -REACH_M, REACH_M),
            y: Axis::new("y (m)", -REACH_M / 2.0, REACH_M / 2.0),
            layers: vec![
                Layer::points(near(&self.submap), Mark::Cross, Tone::Measurement, 3.0),
                Layer::points(near(&self.sweep), Mark::Circle, Tone::Prior, 3.0),
            ],
            legend: vec![
                LegendEntry::mark("submap", Tone::Measurement, Mark::Cross),
                LegendEntry::mark("newest sweep", Tone::Prior, Mark::Circle),
            ],
            color_bar: None,
        }
    }
}

/// Numbers of accepted right and wrong candidates.
fn accepted(is_accepted: impl Fn(usize, &Candidate) -> bool) -> [usize; 2] {
    let all = candidates().iter().enumerate();
    let accepted: Vec<_> = all
        .filter(|(k, candidate)| is_accepted(*k, candidate))
        .collect();
    let right = accepted
        .iter()
        .filter(|(_, candidate)| candidate.is_right)
        .count();
    [right, accepted.len() - right]
}

/// Numbers accepted by both tests at a threshold of the gate.
fn accepted_by_gate(chi2: f64) -> [usize; 2] {
    accepted(|_, candidate| candidate.fits && candidate.chi2 <= chi2)
}

/// The candidates, each with its picture and its registration in words.
#[must_use]
pub fn shown(width_px: f32, theme: Theme) -> Value {
    let shown = candidates().iter().enumerate().map(|(k, candidate)| {
        let scene = Scene {
            panels: vec![candidate.picture()],
        };
        let title = format!("Candidate {}", k + 1);
        let svg = scene_svg(&scene, &title, &format!("candidate-{k}"), width_px, theme);
        json!({ "svg": svg, "says": candidate.says })
    });
    Value::from(shown.collect::<Vec<_>>())
}

/// Evaluates the reader's answers, one for each candidate: whether it was accepted.
#[must_use]
pub fn judged(answers: &[bool], width_px: f32, theme: Theme) -> Value {
    let gate_chi2 = LapConfig::default().slam.chapter.loops.gate_chi2;
    let [right, wrong] = accepted(|k, _| answers.get(k) == Some(&true));
    let [gate_right, gate_wrong] = accepted_by_gate(gate_chi2);
    let scene = Scene {
        panels: vec![curve([right, wrong], [gate_right, gate_wrong])],
    };
    let each = candidates().iter().enumerate().map(|(k, candidate)| {
        let truth = if candidate.is_right { "right" } else { "false" };
        let did = if answers.get(k) == Some(&true) {
            "accepted"
        } else {
            "rejected"
        };
        format!(
            "You {did} it. It is {truth}, {}; χ² {:.2}.",
            candidate.error, candidate.chi2
        )
    });
    let judged_right = right + OF_EACH - wrong;
    json!({
        "right": judged_right,
        "svg": scene_svg(&scene, "True and false ones accepted", "candidates", width_px, theme),
        "says": format!(
            "You took {right} of {OF_EACH} right ones and {wrong} of {OF_EACH} false ones. Both tests, at their threshold \
             of {gate_chi2:.3}, take {gate_right} and {gate_wrong}."
        ),
        "each": each.collect::<Vec<_>>(),
    })
}

fn curve([right, wrong]: [usize; 2], [gate_right, gate_wrong]: [usize; 2]) -> Panel {
    let mut thresholds: Vec<f64> = candidates()
        .iter()
        .map(|candidate| candidate.chi2)
        .collect();
    thresholds.push(0.0);
    sort_numbers(&mut thresholds);
    let spot = |[right, wrong]: [usize; 2]| [wrong as f64, right as f64];
    let points = thresholds
        .into_iter()
        .map(|chi2| spot(accepted_by_gate(chi2)));
    let most = OF_EACH as f64 + 0.5;
    Panel {
        id: "curve",
        title: "True and false ones accepted".to_owned(),
        weight: Weight::Main,
        aspect: Aspect::Free,
        x: Axis::new("false ones accepted", -0.5, most),
        y: Axis::new("true ones accepted", -0.5, most),
        layers: vec![
            Layer::line(points.collect(), Stroke::Dotted, Tone::Ink, 2.0),
            Layer::points(
                vec![spot([gate_right, gate_wrong])],
                Mark::Plus,
                Tone::Ink,
                8.0,
            ),
            Layer::points(
                vec![spot([right, wrong])],
                Mark::Square,
                Tone::Posterior,
                7.0,
            ),
        ],
        legend: vec![
            LegendEntry::line("a gate that opens", Tone::Ink, Stroke::Dotted),
            LegendEntry::mark("the gate as it is", Tone::Ink, Mark::Plus),
            LegendEntry::mark("you", Tone::Posterior, Mark::Square),
        ],
        color_bar: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use widget_kit::audit::scene_text_faults;

    #[test]
    fn half_of_the_candidates_are_right_and_neither_test_separates_them_all() {
        assert_eq!(candidates().len(), 2 * OF_EACH);
        let right = candidates()
            .iter()
            .filter(|candidate| candidate.is_right)
            .count();
        assert_eq!(right, OF_EACH);
        // What the page says of the first one: keyframe 29 of the canonical lap, 22 nodes after keyframe 7.
        let first = &candidates()[0];
        assert!(
            first.is_right && first.says.contains("After 22 nodes"),
            "{}",
            first.says
        );
        assert!((first.chi2 - 4.236).abs() < 5e-4, "{}", first.chi2);
        // A reader who knows the truth is better than every threshold.
        for threshold in [0.5, 2.0, 7.815, 20.0, 1e6] {
            assert_ne!(accepted_by_gate(threshold), [OF_EACH, 0], "{threshold}");
        }
    }

    #[test]
    fn an_answer_is_judged_by_the_truth() {
        let truth: Vec<bool> = candidates()
            .iter()
            .map(|candidate| candidate.is_right)
            .collect();
        let says = |answers: &[bool]| judged(answers, 360.0, Theme::Light)["says"].to_string();
        let right = |answers: &[bool]| judged(answers, 360.0, Theme::Light)["right"].as_u64();
        assert_eq!(right(&truth), Some(2 * OF_EACH as u64));
        assert!(says(&truth).contains("You took 5 of 5 right ones and 0 of 5 false ones"));
        let inverse: Vec<bool> = truth.iter().map(|right| !right).collect();
        assert!(says(&inverse).contains("You took 0 of 5 right ones and 5 of 5 false ones"));
        assert_eq!(
            shown(360.0, Theme::Dark).as_array().map(Vec::len),
            Some(2 * OF_EACH)
        );
    }

    #[test]
    fn no_text_of_a_picture_overlaps_or_is_cut_off() {
        for width in [320.0, 360.0, 600.0] {
            let first = candidates()[0].picture();
            for panel in [first, curve([3, 1], [4, 2])] {
                let scene = Scene {
                    panels: vec![panel],
                };
                let faults = scene_text_faults(&scene, width);
                assert!(faults.is_empty(), "{width}: {faults:#?}");
            }
        }
    }
}
