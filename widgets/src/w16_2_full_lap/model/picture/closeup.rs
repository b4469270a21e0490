//! Close-up of one loop in the frame of the old node: the predicted pose of the new sweep, the registered
//! one, and the region in which each gate accepts it.

use ch16_lab::lap::RecordedLoopAttempt;
use pr_geom::SE2;
use widget_kit::scene::{Aspect, Axis, Layer, LegendEntry, Mark, Panel, Stroke, Tone, Weight};

use crate::w16_2_full_lap::model::gates::{Gate, Gates, Region};
use crate::w16_2_full_lap::model::moment::LapState;
use crate::w16_2_full_lap::model::panel;
use crate::w16_2_full_lap::model::runs::Runs;
use crate::w16_2_full_lap::model::texts::{ends, model_name};

/// Half width and half height of the view, m: the corridor is 1.2 m wide.
const HALF_VIEW_M: [f64; 2] = [2.0, 1.3];

/// Margin around both nodes, m; candidates of the lap always have it.
const ROOM_M: f64 = 0.25;

/// The custom loop, else the newest one of the lap, or a text if none was tried so far.
pub fn closeup(moment: &LapState) -> Panel {
    let runs = moment.runs;
    if let Some(own) = moment.own {
        let before = runs.graph.poses_at(moment.tick);
        let shown = LoopShown {
            attempt: &own.attempt,
            gates: &runs.gates_of_own(own),
            before,
            after: &own.poses,
            title: format!("Close-up of your loop {}", ends(&own.attempt)),
        };
        return of_loop(runs, &shown);
    }
    match moment.loop_near() {
        Some(attempt) => of_loop(
            runs,
            &LoopShown {
                attempt,
                gates: runs.gates(attempt),
                before: runs.graph.poses_before_loop(attempt.tick),
                after: runs.graph.poses_at(attempt.tick),
                title: format!("Close-up of loop {}, tick {}", ends(attempt), attempt.tick),
            },
        ),
        None => view(
            "No loop tried so far".to_owned(),
            [0.0, 0.0],
            1.0,
            vec![Layer::Text {
                at: [0.0, 0.0],
                text: "no loop tried so far".to_owned(),
                tone: Tone::Ink,
            }],
            Vec::new(),
        ),
    }
}

/// A loop with the poses of all nodes before and after it.
struct LoopShown<'a> {
    attempt: &'a RecordedLoopAttempt,
    gates: &'a Gates,
    before: &'a [SE2],
    after: &'a [SE2],
    title: String,
}

fn of_loop(runs: &Runs, shown: &LoopShown) -> Panel {
    let attempt = shown.attempt;
    let loop_ = &attempt.verification;
    let (predicted, registered) = (loop_.predicted, loop_.registered);
    let mut layers = vec![
        Layer::points(submap(runs, shown), Mark::Dot, Tone::Prior, 1.6),
        Layer::points(
            runs.sweep_at(loop_.from_node, predicted).collect(),
            Mark::Dot,
            Tone::Prediction,
            1.6,
        ),
        Layer::points(
            runs.sweep_at(loop_.from_node, registered).collect(),
            Mark::Cross,
            Tone::Measurement,
            2.4,
        ),
    ];
    let gates = shown.gates;
    let chosen = runs.loop_config().gate_model;
    let gates = [&gates.path, &gates.exact].map(|gate| GateShown {
        gate,
        region: gate.region(loop_),
        stroke: if gate.model == chosen {
            Stroke::Solid
        } else {
            Stroke::Dotted
        },
    });
    layers.extend(gates.iter().filter_map(GateShown::layer));
    let truth = runs.graph.lap().loop_truth(attempt);
    layers.extend([
        pose(SE2::identity(), Mark::Circle, Tone::Prior, 7.0),
        pose(truth, Mark::Plus, Tone::Truth, 8.0),
        pose(predicted, Mark::Triangle, Tone::Prediction, 7.0),
    ]);
    if attempt.accepted() {
        let nodes = shown.after;
        let graph = nodes[loop_.candidate.node].between(&nodes[loop_.from_node]);
        layers.push(pose(graph, Mark::Square, Tone::Posterior, 5.0));
    }
    // On top and larger, because the final pose is close to the registered one.
    layers.push(pose(registered, Mark::Cross, Tone::Measurement, 9.0));
    let named = [(predicted, "expected"), (truth, "truth")];
    layers.extend(named.map(|(at, name)| Layer::label([at.x(), at.y()], name.to_owned(), 10.0)));
    // Both nodes in view: candidates are within 2 m, the ends of a custom loop may be anywhere.
    let middle = [0.5 * predicted.x(), 0.5 * predicted.y()];
    let wider = (0..2).map(|i| (middle[i].abs() + ROOM_M) / HALF_VIEW_M[i]);
    let scale = wider.fold(1.0, f64::max);
    let legend = legend(&gates);
    view(shown.title.clone(), middle, scale, layers, legend)
}

fn view(
    title: String,
    middle: [f64; 2],
    scale: f64,
    layers: Vec<Layer>,
    legend: Vec<LegendEntry>,
) -> Panel {
    let axis = |label, i: usize| {
        let half = scale * HALF_VIEW_M[i];
        Axis::new(label, middle[i] - half, middle[i] + half)
    };
    Panel {
        id: panel::LOOP,
        title,
        weight: Weight::Side,
        aspect: Aspect::Equal,
        x: axis("ahead of the old node (m)", 0),
        y: axis("left of the old node (m)", 1),
        layers,
        legend,
        color_bar: None,
    }
}

/// The old sweeps of the verification: around the candidate, at the poses before the loop.
fn submap(runs: &Runs, shown: &LoopShown) -> Vec<[f64; 2]> {
    let candidate = shown.attempt.verification.candidate.node;
    let reach = runs.loop_config().submap_half_width;
    let nodes = shown.before;
    let last = (candidate + reach).min(nodes.len() - 1);
    (candidate.saturating_sub(reach)..=last)
        .flat_map(|near| runs.sweep_at(near, nodes[candidate].between(&nodes[near])))
        .collect()
}

/// A gate as the panel draws it: solid if it decides, dotted otherwise.
struct GateShown<'a> {
    gate: &'a Gate,
    region: Option<Region>,
    stroke: Stroke,
}

impl GateShown<'_> {
    fn layer(&self) -> Option<Layer> {
        self.region.map(|region| Layer::Ellipse {
            center: region.center,
            half_axes: region.half_axes,
            stroke: self.stroke,
            tone: Tone::Prediction,
        })
    }

    fn entry(&self) -> LegendEntry {
        let name = model_name(self.gate.model);
        let chi2 = self.gate.test.chi2;
        let label = match self.region {
            Some(_) => format!("{name} gate, χ² {chi2:.2}"),
            None => format!("{name} gate, χ² {chi2:.2}: no position passes"),
        };
        LegendEntry::line(&label, Tone::Prediction, self.stroke)
    }
}

fn pose(pose: SE2, mark: Mark, tone: Tone, radius_px: f32) -> Layer {
    Layer::pose(pose.to_array(), mark, tone, radius_px)
}

fn legend(gates: &[GateShown; 2]) -> Vec<LegendEntry> {
    vec![
        LegendEntry::mark("old node and its sweeps", Tone::Prior, Mark::Circle),
        gates[0].entry(),
        gates[1].entry(),
        LegendEntry::mark("registered", Tone::Measurement, Mark::Cross),
    ]
}
