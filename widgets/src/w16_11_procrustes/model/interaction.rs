//! Draggable things: a point of the target, or the angle on the trace.

use widget_kit::chart::{dragged_to, grab_now};
use widget_kit::model::Handle;

use super::settings::seen;
use super::{ProcrustesTrace, panel};
use crate::w16_11_procrustes::spec::{MAX_PAIRS, MOVED, REACH_M, TURN, WHOLE_TURN_DEG};

/// Names of the draggable things: each point of the target.
const TARGETS: [&str; MAX_PAIRS] = ["target1", "target2", "target3", "target4", "target5"];

/// The nearest point of the target within reach, or the line at the angle.
pub fn grab(trace: &ProcrustesTrace, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
    if panel == panel::TRACE {
        return grab_now(panel::TRACE, trace.values.get(&TURN), at, reach);
    }
    if panel != panel::POINTS {
        return None;
    }
    let points = trace.pairs.target.iter().zip(TARGETS);
    let share = |x: f64, y: f64| {
        let away = [(at[0] - x) / reach[0], (at[1] - y) / reach[1]];
        away[0].abs().max(away[1].abs())
    };
    let (point, id) = points
        .filter(|(p, _)| share(p.x, p.y) <= 1.0)
        .min_by(|(a, _), (b, _)| share(a.x, a.y).total_cmp(&share(b.x, b.y)))?;
    Some(Handle {
        panel: panel::POINTS,
        id,
        offset: [at[0] - point.x, at[1] - point.y],
        ..Handle::default()
    })
}

/// Moves the grabbed thing, rounded, which keeps links short.
pub fn drag(trace: &mut ProcrustesTrace, handle: Handle, at: [f64; 2]) {
    if !at.iter().all(|value| value.is_finite()) {
        return;
    }
    trace.playback.pause();
    if handle.panel == panel::TRACE {
        trace
            .values
            .put(&TURN, dragged_to(handle, at).min(WHOLE_TURN_DEG));
        return;
    }
    let Some(k) = TARGETS.iter().position(|id| *id == handle.id) else {
        return;
    };
    let home = seen(&trace.values).target;
    let Some(home) = home.get(k) else { return };
    let away = |axis: usize, home: f64| {
        let moved = at[axis] - handle.offset[axis] - home;
        ((100.0 * moved).round() / 100.0).clamp(-REACH_M, REACH_M)
    };
    trace.values.put(&MOVED[k][0], away(0, home.x));
    trace.values.put(&MOVED[k][1], away(1, home.y));
    trace.follow();
}
