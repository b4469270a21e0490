//! A correction that the front end does not get: its effect on the next sweeps and the next loop.

use std::sync::OnceLock;

use ch16_lab::lap::{LapConfig, LapRecord, LapRunner, RecordedLoopAttempt};
use ch16_slam2d::loops::{GateTest, chi_squared_gate};
use ch16_slam2d::metrics::{DisagreementConfig, MapDisagreement};
use pr_geom::{Point2, SE2};
use widget_kit::scene::{Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Tone, Weight};

use super::{Shown, SketchSpec, Slider};

/// The drawn part of the corridor, around the next keyframe, m.
const REACH_M: [f64; 2] = [2.4, 1.3];

pub(super) const SKETCH: SketchSpec = SketchSpec {
    name: "push",
    title: "The sweeps after a loop",
    slider: Slider {
        label: "correction given to the front end",
        unit: " %",
        min: 0.0,
        max: 100.0,
        step: 5.0,
        default: 0.0,
        decimals: 0,
    },
    at,
    handle,
};

/// The canonical lap between its first loop and its second.
struct Between {
    record: LapRecord,
    first: RecordedLoopAttempt,
    second: RecordedLoopAttempt,
    /// The correction by the first loop: newest node's pose after it ∘ pose before it, inverted.
    correction: SE2,
}

impl Between {
    fn get() -> &'static Self {
        static LAP: OnceLock<Between> = OnceLock::new();
        LAP.get_or_init(|| {
            let record = LapRunner::new().run(&LapConfig::default());
            let mut closed = record.lap.loop_attempts().filter(|loop_| loop_.accepted());
            let mut next = || *closed.next().expect("the canonical lap closes three loops");
            let (first, second) = (next(), next());
            drop(closed);
            let node = first.verification.from_node;
            let (before, after) = (record.lap.loop_motion(first.tick)).expect("it moved the graph");
            let correction = after[node] * before[node].inverse();
            Self {
                record,
                first,
                second,
                correction,
            }
        })
    }

    /// The remaining error in the front end's frame, if it gets this share of the correction.
    fn left(&self, share: f64) -> SE2 {
        SE2::exp(&(-(1.0 - share) * self.correction.log()))
    }

    /// Poses in the graph just before the second loop, if the front end got the complete correction.
    fn poses(&self) -> &[SE2] {
        self.record.lap.poses(self.second.tick - 1)
    }

    /// The keyframes that the front end adds before the next loop.
    fn next_keyframes(&self) -> core::ops::RangeInclusive<usize> {
        self.first.verification.from_node + 1..=self.second.verification.from_node - 1
    }

    fn sweep(&self, node: usize, pose: &SE2) -> Vec<Point2<f64>> {
        let tick = self.record.lap.keyframes[node].tick;
        let cloud = self.record.drive.prepared(tick).cloud;
        cloud.iter().map(|point| pose.transform(point)).collect()
    }

    /// The second loop at the gate: the registration is the same, the graph's prediction is not.
    fn gate(&self, left: &SE2) -> GateTest {
        let loop_ = &self.second.verification;
        let old = self.poses()[loop_.candidate.node];
        let new = old * loop_.predicted;
        let innovation = old.between(&(*left * new)).between(&loop_.registered).log();
        chi_squared_gate(&innovation, &loop_.gate_information, loop_.gate.gate_chi2)
    }

    /// Disagreement of the sweeps after the loop with those of the outward path.
    fn disagreement_m(&self, left: &SE2) -> f64 {
        let turn = self.record.lap.turn_node.expect("the lap turns round");
        let clouds: Vec<_> = (0..=*self.next_keyframes().end())
            .map(|node| {
                self.record
                    .drive
                    .prepared(self.record.lap.keyframes[node].tick)
                    .cloud
            })
            .collect();
        let mut compared = MapDisagreement::new(DisagreementConfig::default());
        compared.start((0..=turn).map(|node| (&self.poses()[node], &*clouds[node])));
        for node in self.next_keyframes() {
            compared.compare(&(*left * self.poses()[node]), &clouds[node]);
        }
        compared.value_m().unwrap_or(f64::NAN)
    }
}

fn at(percent: f64) -> Shown {
    let lap = Between::get();
    let left = lap.left(percent / 100.0);
    let gate = lap.gate(&left);
    let verdict = if gate.passes() {
        "passes"
    } else {
        "is rejected"
    };
    Shown {
        scene: Scene {
            panels: vec![picture(lap, &left)],
        },
        sentence: format!(
            "With {percent:.0}% of the correction, the next sweeps disagree with the outbound leg by {:.3} m. The next loop contradicts the graph with a χ² of {:.2}, and {verdict}.",
            lap.disagreement_m(&left),
            gate.chi2
        ),
    }
}

/// The first of the next poses.
fn handle(percent: f64) -> (&'static str, [f64; 2]) {
    let lap = Between::get();
    let pose = lap.left(percent / 100.0) * lap.poses()[*lap.next_keyframes().start()];
    ("push", [pose.x(), pose.y()])
}

fn picture(lap: &Between, left: &SE2) -> Panel {
    let turn = lap.record.lap.turn_node.unwrap_or_default();
    let middle = *lap.next_keyframes().start();
    let center = lap.poses()[middle].position();
    let is_near = |point: &Point2<f64>| {
        (point.x - center.x).abs() < REACH_M[0] && (point.y - center.y).abs() < REACH_M[1]
    };
    let shown = |points: Vec<Point2<f64>>| -> Vec<[f64; 2]> {
        let near = points.into_iter().filter(is_near);
        near.map(|point| [point.x, point.y]).collect()
    };
    let way_out = (0..=turn).flat_map(|node| lap.sweep(node, &lap.poses()[node]));
    let next =
        (lap.next_keyframes()).flat_map(|node| lap.sweep(node, &(*left * lap.poses()[node])));
    let robots = lap.next_keyframes().map(|node| *left * lap.poses()[node]);
    Panel {
        id: "push",
        title: "The corridor, after the loop".to_owned(),
        weight: Weight::Main,
        aspect: Aspect::Equal,
        x: Axis::new("x (m)", center.x - REACH_M[0], center.x + REACH_M[0]),
        y: Axis::new("y (m)", center.y - REACH_M[1], center.y + REACH_M[1]),
        layers: vec![
            Layer::points(
                shown(way_out.collect()),
                Mark::Cross,
                Tone::Measurement,
                3.0,
            ),
            Layer::points(shown(next.collect()), Mark::Circle, Tone::Prior, 3.0),
            Layer::points(
                shown(robots.map(|pose| pose.position()).collect()),
                Mark::Square,
                Tone::Posterior,
                6.0,
            ),
        ],
        legend: vec![
            LegendEntry::mark("outbound map", Tone::Measurement, Mark::Cross),
            LegendEntry::mark("the next sweeps", Tone::Prior, Mark::Circle),
            LegendEntry::mark("the next poses", Tone::Posterior, Mark::Square),
        ],
        color_bar: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The chapter's system applies the complete correction: its second loop then has χ² 0.42 (canonical
    /// run).
    #[test]
    fn the_complete_correction_equals_that_of_the_lap() {
        let lap = Between::get();
        let chi2 = lap.gate(&lap.left(1.0)).chi2;
        // 1e-9: poses are composed in another order.
        assert!(
            (chi2 - lap.second.verification.gate.chi2).abs() < 1e-9,
            "{chi2}"
        );
    }

    #[test]
    fn a_smaller_share_of_it_leaves_the_walls_farther_apart() {
        let lap = Between::get();
        let off: Vec<f64> = [1.0, 0.5, 0.0]
            .map(|share| lap.disagreement_m(&lap.left(share)))
            .into();
        assert!(off[0] < off[1] && off[1] < off[2], "{off:?}");
        assert!(off[2] > 1.5 * off[0], "{off:?}");
    }
}
