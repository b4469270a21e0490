//! Front end and back end over time: a lane for each of their operations, and a mark for each execution.

use ch16_lab::lap::{LapRecord, RecordedLoopAttempt, TickReport};
use ch16_slam2d::loops::LoopRejection;
use widget_kit::scene::{Aspect, Axis, Layer, Mark, Panel, Stroke, Tone, Weight};
use widget_kit::ticks::signed;

/// Name of the panel.
pub const ID: &str = "lanes";

/// The result of an operation in a tick.
#[derive(Clone, Copy, PartialEq)]
enum Done {
    /// Not executed in this tick.
    Idle,
    /// Passed.
    Passed,
    /// Rejected.
    Rejected,
}

/// A lane, and its data in a tick.
struct Lane {
    name: &'static str,
    done: fn(&TickReport) -> Done,
    /// The numbers of the operation.
    data: fn(&TickReport) -> String,
}

/// The operations of a tick in order: the front end's two at every tick, the back end's at keyframes, and the
/// map last.
static LANES: [Lane; 8] = [
    Lane {
        name: "predict",
        done: |_| Done::Passed,
        data: |report| {
            let at = report.registration.prediction;
            let off_m = (at.position() - report.registration.estimate.position()).norm();
            format!(
                "robot at ({}, {}) m, {off_m:.3} m from where the sweep puts it",
                signed(at.x(), 2),
                signed(at.y(), 2)
            )
        },
    },
    Lane {
        name: "register",
        done: |report| tested(report.registration.accepted),
        data: |report| {
            let found = &report.registration.matched;
            format!(
                "{} pairs within τ = {:.2} m, rmse {:.3} m, {} iterations",
                found.inliers, report.registration.tau_m, found.rmse_m, found.iterations
            )
        },
    },
    Lane {
        name: "keyframe",
        done: |report| executed(report.new_keyframe.is_some()),
        data: |report| match report.new_keyframe {
            Some(node) => format!("node {node} and an edge to node {}", node.saturating_sub(1)),
            None => NOTHING.to_owned(),
        },
    },
    Lane {
        name: "candidate",
        done: |report| executed(report.loop_attempt.is_some()),
        data: |report| {
            of_loop(report, |attempt| {
                let candidate = &attempt.verification.candidate;
                let new = attempt.verification.from_node;
                format!(
                    "node {new} to node {}, {:.2} m away in the graph",
                    candidate.node, candidate.distance_m
                )
            })
        },
    },
    Lane {
        name: "fit",
        done: |report| match &report.loop_attempt {
            None => Done::Idle,
            Some(attempt) => tested(!matches!(
                attempt.verification.rejection,
                Some(
                    LoopRejection::PoorFit { .. }
                        | LoopRejection::FewInliers { .. }
                        | LoopRejection::NotRegistered(_)
                        | LoopRejection::NoPlace { .. }
                )
            )),
        },
        data: |report| {
            of_loop(report, |attempt| {
                let found = &attempt.verification;
                format!("{} pairs, rmse {:.3} m", found.inliers, found.rmse_m)
            })
        },
    },
    Lane {
        name: "gate",
        done: |report| match &report.loop_attempt {
            None => Done::Idle,
            Some(attempt) => tested(attempt.verification.gate.passes()),
        },
        data: |report| {
            of_loop(report, |attempt| {
                let gate = &attempt.verification.gate;
                let side = if gate.passes() { "below" } else { "above" };
                format!("chi-squared {:.2} {side} {:.3}", gate.chi2, gate.gate_chi2)
            })
        },
    },
    Lane {
        name: "optimize",
        done: |report| executed(closes_loop(report)),
        data: |report| {
            of_loop(report, |attempt| match &attempt.effect {
                Some(effect) => format!(
                    "{} iterations, chi-squared {:.1} to {:.1}, nodes moved by up to {:.2} m",
                    effect.iterations, effect.chi2.before, effect.chi2.after, effect.max_shift_m
                ),
                None => NOTHING.to_owned(),
            })
        },
    },
    Lane {
        name: "repaint",
        done: |report| executed(closes_loop(report)),
        data: |report| {
            of_loop(report, |attempt| match attempt.effect {
                Some(_) => format!(
                    "the grid from the sweeps of {} keyframes",
                    attempt.verification.from_node + 1
                ),
                None => NOTHING.to_owned(),
            })
        },
    },
];

/// The data of a lane in a tick without its operation.
const NOTHING: &str = "nothing to do";

fn of_loop(report: &TickReport, say: impl Fn(&RecordedLoopAttempt) -> String) -> String {
    let attempt = report.loop_attempt.as_ref();
    attempt.map_or_else(|| NOTHING.to_owned(), say)
}

fn tested(passed: bool) -> Done {
    if passed { Done::Passed } else { Done::Rejected }
}

fn executed(is_done: bool) -> Done {
    if is_done { Done::Passed } else { Done::Idle }
}

/// Whether a loop is closed in the tick.
pub fn closes_loop(report: &TickReport) -> bool {
    report
        .loop_attempt
        .as_ref()
        .is_some_and(|attempt| attempt.accepted())
}

/// Name of a lane.
pub fn name(lane: usize) -> &'static str {
    LANES[lane].name
}

/// The lane of that name.
pub fn from_name(name: &str) -> Option<usize> {
    LANES.iter().position(|lane| lane.name == name)
}

/// Position of a lane on the axis: the first one on top.
fn height(lane: usize) -> f64 {
    (LANES.len() - lane) as f64
}

/// All executions with that result up to a tick.
fn done(record: &LapRecord, now: usize, wanted: Done) -> Vec<[f64; 2]> {
    let reports = record.lap.reports.iter().take(now);
    reports
        .flat_map(|report| {
            let lanes = LANES.iter().enumerate();
            let of = lanes.filter(move |(_, lane)| (lane.done)(report) == wanted);
            of.map(move |(lane, _)| [report.tick as f64, height(lane)])
        })
        .collect()
}

/// The data of every lane in a tick, by its name.
pub fn data(report: &TickReport) -> impl Iterator<Item = (&'static str, String)> + '_ {
    LANES
        .iter()
        .map(move |lane| (lane.name, (lane.data)(report)))
}

/// The lane in which a loop begins; it goes on through those below.
const CANDIDATE: usize = 3;
/// Length of a pulse, as a share of the run.
const PULSE: f64 = 0.06;

/// The pulses of a loop, one after the other to the current tick, in that share of their time.
fn pulses(now: usize, last: f64, share: f64) -> [Layer; 2] {
    let lanes = CANDIDATE..LANES.len();
    // A pulse takes as long as two more need to start.
    let time = share * (lanes.len() + 1) as f64;
    let shares = lanes.map(|lane| {
        (
            lane,
            (0.5 * (time - (lane - CANDIDATE) as f64)).clamp(0.0, 1.0),
        )
    });
    let heads = shares.filter(|(_, share)| *share > 0.0);
    let heads = heads.map(|(lane, share)| [share * now as f64, height(lane)]);
    let heads: Vec<[f64; 2]> = heads.collect();
    let tails = heads
        .iter()
        .map(|head| [[head[0] - PULSE * last, head[1]], *head]);
    [
        Layer::segments(tails.collect(), Stroke::Solid, Tone::Revisit, 3.0),
        Layer::points(heads, Mark::Dot, Tone::Revisit, 5.0),
    ]
}

/// The lanes up to a tick; a ring around the mark in question, a tick and a lane.
pub fn lanes(
    record: &LapRecord,
    now: usize,
    (tick, lane): (usize, usize),
    closing: Option<f64>,
) -> Panel {
    let last = record.ticks() as f64;
    let mut layers = vec![Layer::line(
        vec![[now as f64, 0.4], [now as f64, height(0) + 0.6]],
        Stroke::Solid,
        Tone::Faint,
        2.0,
    )];
    let mut passed = done(record, now, Done::Passed);
    if closing.is_some() {
        // The pulses bring the marks of the loop.
        passed.retain(|[tick, high]| *tick < now as f64 || *high > height(CANDIDATE));
    }
    layers.extend([
        Layer::points(passed, Mark::Dot, Tone::Series(0), 2.4),
        Layer::points(
            done(record, now, Done::Rejected),
            Mark::Circle,
            Tone::Series(3),
            3.5,
        ),
    ]);
    let report = record.lap.report(tick);
    if report.is_some_and(|report| (LANES[lane].done)(report) != Done::Idle) {
        let at = vec![[tick as f64, height(lane)]];
        layers.push(Layer::points(at, Mark::Circle, Tone::Ink, 7.0));
    }
    layers.extend(
        closing
            .into_iter()
            .flat_map(|share| pulses(now, last, share)),
    );
    Panel {
        id: ID,
        title: "Who does what when: dots are done, rings rejected".to_owned(),
        weight: Weight::Side,
        aspect: Aspect::Free,
        // The rings at the first and the last one are whole.
        x: Axis::new("tick", -0.03 * last.max(1.0), 1.03 * last.max(1.0)),
        // The first one stands on top.
        y: Axis::from_names("", LANES.iter().rev().map(|lane| lane.name.to_owned())),
        layers,
        // The title has its words: on low screens the names need the room.
        legend: Vec::new(),
        color_bar: None,
    }
}

/// Tick and lane of the mark nearest to a spot, within `reach` of it.
pub fn event_at(
    record: &LapRecord,
    now: usize,
    at: [f64; 2],
    reach: [f64; 2],
) -> Option<(f64, usize)> {
    let away = |mark: &[f64; 2]| {
        let [x, y] = [0, 1].map(|i: usize| ((mark[i] - at[i]) / reach[i]).abs());
        x.max(y)
    };
    let marks = [Done::Passed, Done::Rejected].map(|wanted| done(record, now, wanted));
    let marks = marks.iter().flatten().filter(|mark| away(mark) <= 1.0);
    let [tick, high] = *marks.min_by(|a, b| away(a).total_cmp(&away(b)))?;
    Some((tick, LANES.len() - high as usize))
}
