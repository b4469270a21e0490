//! What happened, tick by tick, in words.

use ch16_slam2d::loops::LoopRejection;
use ch16_slam2d::slam::{LapRecord, LoopAttempt};
use kit::model::{Standing, TimelineMark};

/// One line of the log.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// When.
    pub tick: usize,
    /// In which part of the system: `front end`, `back end`, `map`.
    pub part: &'static str,
    /// What.
    pub text: String,
    /// Good or bad, for a loop.
    pub standing: Standing,
    /// Loops get a mark on the timeline, the rest does not.
    pub marked: bool,
}

/// The events of a lap in order.
pub fn events(record: &LapRecord) -> Vec<Event> {
    let mut events = Vec::new();
    for report in &record.lap.reports {
        let tick = report.tick;
        let mut say = |part, text| {
            events.push(Event {
                tick,
                part,
                text,
                standing: Standing::Neutral,
                marked: false,
            });
        };
        if let Some(way_point) = record.drive.ticks()[tick - 1].reached {
            say("driver", format!("way point {} reached", way_point + 1));
        }
        if report.registration.icp.inliers < record.config.min_inliers {
            say(
                "front end",
                format!(
                    "only {} pairs: the prediction stands",
                    report.registration.icp.inliers
                ),
            );
        }
        if let Some(node) = report.new_keyframe {
            say("back end", format!("keyframe {node}"));
        }
        if let Some(attempt) = &report.loop_attempt {
            events.extend(loop_events(attempt));
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

fn loop_events(attempt: &LoopAttempt) -> Vec<Event> {
    let tested = &attempt.verification;
    let name = format!("loop {} to {}", tested.from_node, tested.candidate.node);
    let gate = &tested.gate;
    let event = |part, text, standing, marked| Event {
        tick: attempt.tick,
        part,
        text,
        standing,
        marked,
    };
    let Some(effect) = &attempt.effect else {
        let why = match tested.rejection {
            Some(LoopRejection::PoorFit { rmse_m, max_rmse_m }) => {
                format!("rmse {rmse_m:.3} m above {max_rmse_m:.3} m")
            }
            Some(LoopRejection::FewInliers {
                inliers,
                min_inliers,
            }) => format!("{inliers} pairs, fewer than {min_inliers}"),
            Some(LoopRejection::OutsideGate(_)) | None => {
                format!("chi-squared {:.2} above {:.3}", gate.chi2, gate.gate_chi2)
            }
        };
        let text = format!("{name} rejected: {why}");
        return vec![event("back end", text, Standing::Neutral, true)];
    };
    vec![
        event(
            "back end",
            format!(
                "{name} accepted, chi-squared {:.2} below {:.3}, history moved {:.2} m",
                gate.chi2, gate.gate_chi2, effect.max_shift_m
            ),
            Standing::Good,
            true,
        ),
        event(
            "map",
            format!("grid drawn again from {} keyframes", tested.from_node + 1),
            Standing::Neutral,
            false,
        ),
    ]
}
