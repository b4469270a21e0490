//! The event log, tick by tick, in words.

use ch16_lab::lap::{LapRecord, LapTrace, LoopJudgement, RecordedLoopAttempt};
use widget_kit::model::{Assessment, TimelineMark};

/// One line of the log.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// The tick.
    pub tick: usize,
    /// The part of the system: `driver`, `front end`, `back end`, `map`.
    pub part: &'static str,
    /// The event.
    pub text: String,
    /// Good or bad, for a loop.
    pub standing: Assessment,
    /// Whether it has a mark on the timeline, as loops do.
    pub marked: bool,
    /// The part that does it, see [`super::picture::parts`].
    pub part_at_work: usize,
}

/// The parts of the log's events.
mod at_work {
    pub const PREDICT: usize = 0;
    pub const REGISTER: usize = 1;
    pub const KEYFRAME: usize = 2;
    pub const GATE: usize = 5;
    pub const REPAINT: usize = 7;
}

/// The events of a lap in order.
pub fn events(record: &LapRecord) -> Vec<Event> {
    let mut events = Vec::new();
    for report in &record.lap.reports {
        let tick = report.tick;
        let mut say = |part, part_at_work, text| {
            events.push(Event {
                tick,
                part,
                text,
                standing: Assessment::Neutral,
                marked: false,
                part_at_work,
            });
        };
        if let Some(way_point) = record.drive.ticks()[tick - 1].reached {
            say(
                "driver",
                at_work::PREDICT,
                format!("waypoint {} reached", way_point + 1),
            );
        }
        if !report.registration.accepted {
            say(
                "front end",
                at_work::REGISTER,
                format!(
                    "only {} pairs, so the prediction is kept",
                    report.registration.matched.inliers
                ),
            );
        }
        if let Some(node) = report.new_keyframe {
            say("front end", at_work::KEYFRAME, format!("keyframe {node}"));
        }
        if let Some(attempt) = &report.loop_attempt {
            events.extend(loop_events(&record.lap, attempt));
        }
    }
    events
}

/// The loops of a lap as marks on the timeline.
pub fn marks(events: &[Event]) -> Vec<TimelineMark> {
    let marked = events.iter().filter(|event| event.marked);
    marked
        .map(|event| TimelineMark {
            at: event.tick as f64,
            label: event.text.clone(),
            standing: event.standing,
        })
        .collect()
}

/// The test of a loop, and the grid after an accepted one.
fn loop_events(lap: &LapTrace, attempt: &RecordedLoopAttempt) -> Vec<Event> {
    let event = |part, text, standing, marked| Event {
        tick: attempt.tick,
        part,
        text,
        standing,
        marked,
        part_at_work: if marked {
            at_work::GATE
        } else {
            at_work::REPAINT
        },
    };
    let standing = standing(lap.judge(attempt));
    let tested = event("back end", lap.loop_sentence(attempt), standing, true);
    if !attempt.accepted() {
        return vec![tested];
    }
    let keyframes = attempt.verification.from_node + 1;
    let drawn = format!("grid redrawn from {keyframes} keyframes");
    vec![tested, event("map", drawn, Assessment::Neutral, false)]
}

/// Good is an accepted loop that is right, bad an accepted one that is wrong.
fn standing(judgement: LoopJudgement) -> Assessment {
    match judgement {
        LoopJudgement::Right => Assessment::Good,
        LoopJudgement::FalseAcceptance => Assessment::Bad,
        LoopJudgement::Rejected => Assessment::Neutral,
    }
}
