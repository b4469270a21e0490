//! Draggable things: a point of the target, or the angle on the trace.

use widget_kit::chart::{dragged_to, grab_now};
use widget_kit::model::{Handle, Model as _};

use super::settings::seen;
use super::{ProcrustesTrace, panel};
use crate::w16_11_procrustes::spec::{MOVED, REACH_M, TURN, WHOLE_TURN_DEG};

/// The nearest point of the target within reach, or the line at the angle.
pub fn grab(trace: &ProcrustesTrace, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
    if panel == panel::TRACE {
        return grab_now(panel::TRACE, trace.values.get(&TURN), at, reach);
    }
    if panel != panel::POINTS {
        return None;
    }
    let points = trace.pairs.target.iter().enumerate();
    let things = points.map(|(k, point)| ("target", k, [point.x, point.y]));
    Handle::nearest(panel::POINTS, things, at, reach)
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
    let k = handle.index;
    let home = seen(&trace.values).target;
    let Some(home) = home.get(k) else { return };
    let away = |axis: usize, home: f64| {
        let moved = at[axis] - handle.offset[axis] - home;
        ((100.0 * moved).round() / 100.0).clamp(-REACH_M, REACH_M)
    };
    trace.values.put(&MOVED[k][0], away(0, home.x));
    trace.values.put(&MOVED[k][1], away(1, home.y));
    trace.follow(None);
}
