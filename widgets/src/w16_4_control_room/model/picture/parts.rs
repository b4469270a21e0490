//! Front end and back end up to the current tick: a mark for each of their parts, filled while it works.

use ch16_lab::lap::{RecordedLoopAttempt, TickReport};
use ch16_slam2d::loops::LoopRejection;
use widget_kit::scene::{Aspect, Axis, Layer, LegendEntry, Mark, Panel, Stroke, Tone, Weight};
use widget_kit::ticks::signed;

/// Works at every tick.
const FRONT_END: Tone = Tone::Series(0);
/// Works when a loop is tried.
const BACK_END: Tone = Tone::Series(1);

/// A part that turned its candidate or its registration down.
const REJECTED: Tone = Tone::Series(3);

/// Name of the panel.
pub const ID: &str = "parts";

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

/// A part, and its data in a tick.
struct Part {
    name: &'static str,
    done: fn(&TickReport) -> Done,
    /// The numbers of the operation.
    data: fn(&TickReport) -> String,
}

/// The operations of a tick in order: two of the front end at every tick, its keyframe, the back end's at loops,
/// and the map last.
static PARTS: [Part; 8] = [
    Part {
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
    Part {
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
    Part {
        name: "keyframe",
        done: |report| executed(report.new_keyframe.is_some()),
        data: |report| match report.new_keyframe {
            Some(node) => format!("node {node} and an edge to node {}", node.saturating_sub(1)),
            None => NOTHING.to_owned(),
        },
    },
    Part {
        name: "candidate",
        done: |report| executed(report.loop_attempt.is_some()),
        data: |report| {
            said_of_loop(report, |attempt| {
                let candidate = &attempt.verification.candidate;
                let new = attempt.verification.from_node;
                format!(
                    "node {new} to node {}, {:.2} m away in the graph",
                    candidate.node, candidate.distance_m
                )
            })
        },
    },
    Part {
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
            said_of_loop(report, |attempt| {
                let found = &attempt.verification;
                format!("{} pairs, rmse {:.3} m", found.inliers, found.rmse_m)
            })
        },
    },
    Part {
        name: "gate",
        done: |report| match &report.loop_attempt {
            None => Done::Idle,
            Some(attempt) => tested(attempt.verification.gate.passes()),
        },
        data: |report| {
            said_of_loop(report, |attempt| {
                let gate = &attempt.verification.gate;
                let side = if gate.passes() { "below" } else { "above" };
                format!("chi-squared {:.2} {side} {:.3}", gate.chi2, gate.gate_chi2)
            })
        },
    },
    Part {
        name: "optimize",
        done: |report| executed(closes_loop(report)),
        data: |report| {
            said_of_loop(report, |attempt| match &attempt.effect {
                Some(effect) => format!(
                    "{} iterations, chi-squared {:.1} to {:.1}, nodes moved by up to {:.2} m",
                    effect.iterations, effect.chi2.before, effect.chi2.after, effect.max_shift_m
                ),
                None => NOTHING.to_owned(),
            })
        },
    },
    Part {
        name: "repaint",
        done: |report| executed(closes_loop(report)),
        data: |report| {
            said_of_loop(report, |attempt| match attempt.effect {
                Some(_) => format!(
                    "the grid from the sweeps of {} keyframes",
                    attempt.verification.from_node + 1
                ),
                None => NOTHING.to_owned(),
            })
        },
    },
];

/// The data of a part in a tick without its operation.
const NOTHING: &str = "nothing to do";

fn said_of_loop(report: &TickReport, say: impl Fn(&RecordedLoopAttempt) -> String) -> String {
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

/// Name of a part.
pub fn name(part: usize) -> &'static str {
    PARTS[part].name
}

/// The part of that name.
pub fn from_name(name: &str) -> Option<usize> {
    PARTS.iter().position(|part| part.name == name)
}

/// The data of every part in a tick, by its name.
pub fn data(report: &TickReport) -> impl Iterator<Item = (&'static str, String)> + '_ {
    PARTS
        .iter()
        .map(move |part| (part.name, (part.data)(report)))
}

/// The part in which a loop begins; it goes on through those after it.
const CANDIDATE: usize = 3;
/// Share of a closing after which the last part has begun.
const BEGUN: f64 = 0.5;
const MARK_PX: f32 = 8.0;
/// Heights in the panel, as shares of it: of the marks, of the names (two rows, because on a phone one has no room for
/// them all) and of the counts.
const MARKS: f64 = 0.44;
const NAMES: [f64; 2] = [0.91, 0.76];
const COUNTS: f64 = 0.09;
/// From the middle of a name to the line under it.
const UNDER_NAME: f64 = 0.09;
/// Above the marks.
const ABOVE: f64 = 0.64;

/// Where a part stands in the row.
fn spot(part: usize) -> [f64; 2] {
    [part as f64 + 0.5, MARKS]
}

/// Whether a part has begun its work when a loop's closing has reached that share of its time.
fn has_begun(part: usize, closing: Option<f64>) -> bool {
    let begins = BEGUN * part.saturating_sub(CANDIDATE) as f64 / (PARTS.len() - CANDIDATE) as f64;
    part < CANDIDATE || closing.is_none_or(|share| share > begins)
}

/// All parts in a row after these ticks: filled if they work in the last one, hollow if they rest, each with the number
/// of ticks in which it worked. The name of the chosen one is underlined.
pub fn parts(reports: &[TickReport], chosen: usize, closing: Option<f64>) -> Panel {
    let ends = [spot(0), spot(PARTS.len() - 1)];
    let mut legend = vec![
        LegendEntry::mark("front end", FRONT_END, Mark::Dot),
        LegendEntry::mark("back end", BACK_END, Mark::Dot),
    ];
    let upper = (0..PARTS.len()).step_by(2);
    let stem = |part: usize| [NAMES[0], ABOVE].map(|y| [part as f64 + 0.5, y]);
    let mut layers = vec![
        Layer::segments(vec![ends], Stroke::Solid, Tone::Faint, 1.5),
        Layer::segments(upper.map(stem).collect(), Stroke::Solid, Tone::Faint, 1.0),
    ];
    for (number, part) in PARTS.iter().enumerate() {
        let is_on = has_begun(number, closing);
        // A part that has not begun its work in this tick rests.
        let until = reports.len() - usize::from(!is_on);
        let worked = |report: &&TickReport| (part.done)(report) != Done::Idle;
        let times = reports[..until].iter().filter(worked).count();
        let now = reports.last().filter(|_| is_on);
        let done = now.map_or(Done::Idle, part.done);
        let group = if number < CANDIDATE {
            FRONT_END
        } else {
            BACK_END
        };
        let (mark, tone) = match done {
            Done::Idle if times == 0 => (Mark::Circle, Tone::Faint),
            Done::Idle => (Mark::Circle, group),
            Done::Rejected => (Mark::Circle, REJECTED),
            Done::Passed => (Mark::Dot, group),
        };
        if tone == REJECTED && legend.len() == 2 {
            legend.push(LegendEntry::mark("rejected", REJECTED, Mark::Circle));
        }
        let [x, y] = spot(number);
        layers.push(Layer::points(vec![[x, y]], mark, tone, MARK_PX));
        if number == chosen {
            let under = NAMES[number % 2] - UNDER_NAME;
            let line = [[x - 0.35, under], [x + 0.35, under]];
            layers.push(Layer::segments(vec![line], Stroke::Solid, Tone::Ink, 2.0));
        }
        let words = |at_y: f64, text: String| Layer::Text {
            at: [x, at_y],
            text,
            tone: Tone::Ink,
        };
        layers.push(words(NAMES[number % 2], part.name.to_owned()));
        if times > 0 {
            layers.push(words(COUNTS, format!("×{times}")));
        }
    }
    Panel {
        id: ID,
        title: "Runs of each part (filled: in this tick)".to_owned(),
        weight: Weight::Side,
        aspect: Aspect::Free,
        // Room for the names of the first and the last one.
        x: Axis::hidden(-0.35, PARTS.len() as f64 + 0.35),
        y: Axis::hidden(0.0, 1.0),
        layers,
        legend,
        color_bar: None,
    }
}

/// The part at a spot of the row.
pub fn at(spot: [f64; 2]) -> Option<usize> {
    let [x, y] = spot;
    let is_inside = (0.0..PARTS.len() as f64).contains(&x) && (0.0..1.0).contains(&y);
    is_inside.then_some(x as usize)
}
