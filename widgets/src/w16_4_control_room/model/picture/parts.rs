//! Front end and back end up to the current tick: a mark for each of their parts, filled while it works.

use ch16_lab::lap::{RecordedLoopAttempt, TickReport};
use ch16_slam2d::loops::LoopRejection;
use pr_geom::math;
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
    /// Keyframes that it goes through, if it works in the tick.
    keyframes: fn(&TickReport) -> usize,
    /// The numbers of the operation.
    data: fn(&TickReport) -> String,
}

/// The operations of a tick in order: two of the front end at every tick, its keyframe, the back end's at loops,
/// and the map last.
static PARTS: [Part; 8] = [
    Part {
        name: "predict",
        done: |_| Done::Passed,
        keyframes: |_| 1,
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
        keyframes: |_| 1,
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
        keyframes: |_| 1,
        data: |report| match report.new_keyframe {
            Some(node) => format!("node {node} and an edge to node {}", node.saturating_sub(1)),
            None => NOTHING.to_owned(),
        },
    },
    Part {
        name: "candidate",
        done: |report| executed(report.loop_attempt.is_some()),
        keyframes: |report| of_loop(report, |attempt| attempt.verification.from_node),
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
        keyframes: |_| 1,
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
        keyframes: |report| {
            of_loop(report, |attempt| {
                let found = &attempt.verification;
                found.from_node - found.candidate.node
            })
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
        keyframes: all_keyframes,
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
        keyframes: all_keyframes,
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

fn of_loop(report: &TickReport, count: impl Fn(&RecordedLoopAttempt) -> usize) -> usize {
    report.loop_attempt.as_ref().map_or(0, count)
}

fn all_keyframes(report: &TickReport) -> usize {
    of_loop(report, |attempt| attempt.verification.from_node + 1)
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
/// Radius of a mark that stands for one keyframe.
const ONE_KEYFRAME_PX: f32 = 2.7;
/// Heights in the panel, as shares of it: of the marks, of the names (two rows, because on a phone one has no room for
/// them all) and of the counts.
const MARKS: f64 = 0.44;
const NAMES: [f64; 2] = [0.91, 0.76];
const COUNTS: f64 = 0.09;
/// Above the largest mark.
const ABOVE: f64 = 0.64;

/// Where a part stands in the row.
fn spot(part: usize) -> [f64; 2] {
    [part as f64 + 0.5, MARKS]
}

/// The share of its work that a part has done when a loop's closing has reached that share of its time.
fn share_done(part: usize, closing: Option<f64>) -> f64 {
    let (Some(share), true) = (closing, part >= CANDIDATE) else {
        return 1.0;
    };
    let begins = BEGUN * (part - CANDIDATE) as f64 / (PARTS.len() - CANDIDATE) as f64;
    ((share - begins) / (1.0 - begins)).max(0.0)
}

/// All parts in a row after these ticks: filled if they work in the last one, hollow and as large as at their last work
/// if they rest, each with the number of ticks in which it worked. A ring is around the chosen one if it works.
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
        let share = share_done(number, closing);
        // A part that has not begun its work in this tick rests.
        let until = reports.len() - usize::from(share == 0.0);
        let worked = |report: &&TickReport| (part.done)(report) != Done::Idle;
        let times = reports[..until].iter().filter(worked).count();
        let newest = reports[..until].iter().rfind(worked);
        let now = reports.last().filter(|_| share > 0.0);
        let done = now.map_or(Done::Idle, part.done);
        let group = if number < CANDIDATE {
            FRONT_END
        } else {
            BACK_END
        };
        let (mark, tone, share) = match done {
            Done::Idle if newest.is_none() => (Mark::Circle, Tone::Faint, 1.0),
            Done::Idle => (Mark::Circle, group, 1.0),
            Done::Rejected => (Mark::Circle, REJECTED, share),
            Done::Passed => (Mark::Dot, group, share),
        };
        if tone == REJECTED && legend.len() == 2 {
            legend.push(LegendEntry::mark("rejected", REJECTED, Mark::Circle));
        }
        let keyframes = newest.map_or(0, part.keyframes) as f64 * share;
        let radius_px = ONE_KEYFRAME_PX * math::sqrt(keyframes.max(1.0)) as f32;
        let [x, y] = spot(number);
        layers.push(Layer::points(vec![[x, y]], mark, tone, radius_px));
        if number == chosen && done != Done::Idle {
            let ring_px = radius_px + 4.0;
            layers.push(Layer::points(
                vec![[x, y]],
                Mark::Circle,
                Tone::Ink,
                ring_px,
            ));
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
        title: "Runs of each part (size: keyframes handled)".to_owned(),
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
