//! Attempts to close a loop: the registration, the gate, and the error against the truth.

use ch16_lab::lap::{LapTrace, RecordedLoopAttempt};

/// `from`, `chi2`, `max_shift`: one attempt, by name.
pub fn attempt(attempt: &RecordedLoopAttempt, lap: &LapTrace, what: &str) -> Option<f64> {
    let verification = &attempt.verification;
    let gate_std = |axis: usize| 1.0 / verification.gate_information[(axis, axis)].sqrt();
    Some(match what {
        "tick" => attempt.tick as f64,
        "from" => verification.from_node as f64,
        "to" => verification.candidate.node as f64,
        "gap" => verification.gap() as f64,
        "chi2" => verification.gate.chi2,
        "rmse" => verification.rmse_m,
        "accepted" => f64::from(u8::from(attempt.accepted())),
        "gate_std_m" => gate_std(0),
        "gate_std_deg" => gate_std(2).to_degrees(),
        "rms_before" => attempt.effect?.keyframe_rms_m.before,
        "rms_after" => attempt.effect?.keyframe_rms_m.after,
        "max_shift" => attempt.effect?.max_shift_m,
        "error_m" => lap.loop_error(attempt).position_m,
        "error_deg" => lap.loop_error(attempt).heading_deg,
        _ => return None,
    })
}
