//! The two machines over time: a lane for each thing that they do, and a mark where it was done.

use ch16_lab::lap::{LapRecord, TickReport};
use ch16_slam2d::loops::LoopRejection;
use kit::scene::{Aspect, Axis, Layer, LegendEntry, Mark, Panel, Stroke, Tone, Weight};

/// Name of the panel.
pub const ID: &str = "lanes";

/// How something that was done came out.
#[derive(Clone, Copy, PartialEq)]
enum Done {
    /// It was not asked for in this tick.
    Not,
    /// It passed.
    Well,
    /// It was refused.
    Refused,
}

/// A lane, and what it says of a tick.
struct Lane {
    name: &'static str,
    done: fn(&TickReport) -> Done,
}

/// What happens in a tick, in its order: the front end's two at every tick, the back end's at
/// keyframes, and the map at last.
static LANES: [Lane; 8] = [
    Lane {
        name: "predict",
        done: |_| Done::Well,
    },
    Lane {
        name: "register",
        done: |report| judged(report.registration.accepted),
    },
    Lane {
        name: "keyframe",
        done: |report| only(report.new_keyframe.is_some()),
    },
    Lane {
        name: "candidate",
        done: |report| only(report.loop_attempt.is_some()),
    },
    Lane {
        name: "fit",
        done: |report| match &report.loop_attempt {
            None => Done::Not,
            Some(attempt) => judged(!matches!(
                attempt.verification.rejection,
                Some(LoopRejection::PoorFit { .. } | LoopRejection::FewInliers { .. })
            )),
        },
    },
    Lane {
        name: "gate",
        done: |report| match &report.loop_attempt {
            None => Done::Not,
            Some(attempt) => judged(attempt.verification.gate.passes()),
        },
    },
    Lane {
        name: "optimize",
        done: |report| only(closed_loop(report)),
    },
    Lane {
        name: "repaint",
        done: |report| only(closed_loop(report)),
    },
];

fn judged(well: bool) -> Done {
    if well { Done::Well } else { Done::Refused }
}

fn only(done: bool) -> Done {
    if done { Done::Well } else { Done::Not }
}

fn closed_loop(report: &TickReport) -> bool {
    report
        .loop_attempt
        .as_ref()
        .is_some_and(|attempt| attempt.accepted())
}

/// Height of a lane on the axis: the first one on top.
fn height(lane: usize) -> f64 {
    (LANES.len() - lane) as f64
}

/// Everything that was done up to a tick.
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

/// The lanes up to a tick.
pub fn lanes(record: &LapRecord, now: usize) -> Panel {
    let last = record.ticks() as f64;
    let names = LANES.iter().enumerate();
    let mut layers = vec![Layer::Line {
        points: vec![[now as f64, 0.4], [now as f64, height(0) + 0.9]],
        stroke: Stroke::Solid,
        tone: Tone::Faint,
        width_px: 2.0,
    }];
    layers.extend([
        Layer::points(
            done(record, now, Done::Well),
            Mark::Dot,
            Tone::Measurement,
            2.4,
        ),
        Layer::points(
            done(record, now, Done::Refused),
            Mark::Circle,
            Tone::Truth,
            3.5,
        ),
    ]);
    layers.extend(names.map(|(lane, Lane { name, .. })| Layer::Text {
        at: [0.09 * last, height(lane) + 0.5],
        text: format!("{} {name}", height(lane)),
        tone: Tone::Ink,
    }));
    Panel {
        id: ID,
        title: "Who does what when".to_owned(),
        weight: Weight::Side,
        aspect: Aspect::Free,
        x: Axis::new("tick", 0.0, last.max(1.0)),
        y: Axis::new("lane", 0.4, height(0) + 0.9),
        layers,
        legend: vec![
            LegendEntry::mark("done, passed", Tone::Measurement, Mark::Dot),
            LegendEntry::mark("refused", Tone::Truth, Mark::Circle),
        ],
        color_bar: None,
    }
}

/// The tick of the mark nearest to a spot, within `reach` of it.
pub fn event_at(record: &LapRecord, now: usize, at: [f64; 2], reach: [f64; 2]) -> Option<f64> {
    let away = |mark: &[f64; 2]| {
        let [x, y] = [0, 1].map(|i: usize| ((mark[i] - at[i]) / reach[i]).abs());
        x.max(y)
    };
    let marks = [Done::Well, Done::Refused].map(|wanted| done(record, now, wanted));
    let marks = marks.iter().flatten().filter(|mark| away(mark) <= 1.0);
    let nearest = marks.min_by(|a, b| away(a).total_cmp(&away(b)))?;
    Some(nearest[0])
}
