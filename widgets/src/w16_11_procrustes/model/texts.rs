//! The result in words and numbers.

use ch16_lab::procrustes::{Handedness, Procrustes, Winner};
use pr_geom::math;
use widget_kit::model::{Assessment, Fact, Outcome};

use super::ProcrustesTrace;
use crate::w16_11_procrustes::spec::{TURN, WHOLE_TURN_DEG};

/// Plural name of a kind of matrices.
pub fn plural(kind: Handedness) -> &'static str {
    match kind {
        Handedness::Turn => "rotations",
        Handedness::Mirror => "mirror images",
    }
}

/// An angle on the timeline, whole degrees from 0 to below 360.
pub fn whole_degrees(theta_rad: f64) -> f64 {
    let degrees = theta_rad.to_degrees().round();
    if degrees < 0.0 {
        degrees + WHOLE_TURN_DEG
    } else {
        degrees
    }
}

/// Good is a rotation with the largest trace; a reflection never is.
pub fn standing_of(problem: &Procrustes, kind: Handedness) -> Assessment {
    match (kind, problem.winner()) {
        (Handedness::Turn, Winner::Turn) => Assessment::Good,
        (Handedness::Turn, _) => Assessment::Neutral,
        (Handedness::Mirror, _) => Assessment::Bad,
    }
}

fn verdict(winner: Winner) -> &'static str {
    match winner {
        Winner::Turn => "a turn fits best",
        Winner::Mirror => "a mirror image fits best",
        Winner::Tie => "turn and mirror image tie",
    }
}

pub fn outcome(trace: &ProcrustesTrace) -> Outcome {
    let problem = &trace.problem;
    let [turn, mirror] = Handedness::ALL.map(|kind| problem.best(kind));
    let [first, second] = problem.singular_values_m2();
    let cost = |kind: Handedness| problem.cost_m2(kind, problem.best(kind).theta_rad);
    let pairs = trace.pairs.len() as f64;
    let rms_m = |kind: Handedness| math::sqrt(cost(kind) / pairs);
    let aligned_deg = problem.aligned.theta().to_degrees();
    let here = problem.trace_m2(trace.tried(), trace.theta_rad());
    let winner = problem.winner();
    let consequence = match winner {
        Winner::Tie if !problem.measures_rotation => "No pair measures the heading",
        Winner::Turn => "An unchecked decomposition finds the rotation, too",
        Winner::Mirror => "An unchecked decomposition mirrors the map",
        Winner::Tie => "An unchecked decomposition may return either",
    };
    let standing = match winner {
        Winner::Tie if !problem.measures_rotation => Assessment::Bad,
        Winner::Turn => Assessment::Good,
        Winner::Mirror => Assessment::Doubtful,
        Winner::Tie => Assessment::Neutral,
    };
    Outcome {
        standing,
        verdict: verdict(winner).to_owned(),
        sentence: format!(
            "with the best rotation, the points miss their targets by {:.2} m (rms); mirrored, by {:.2} m. {consequence}",
            rms_m(Handedness::Turn),
            rms_m(Handedness::Mirror),
        ),
        facts: vec![
            Fact::new("trace_m2", "trace of the matrix tried", here, "m²", 3),
            Fact::new("bound_m2", "bound: s₁ + s₂", first + second, "m²", 3),
            Fact::new("difference_m2", "s₁ − s₂", first - second, "m²", 3),
            Fact::new(
                "turn_trace_m2",
                "best rotation: trace",
                turn.trace_m2,
                "m²",
                3,
            ),
            Fact::new(
                "mirror_trace_m2",
                "best mirror image: trace",
                mirror.trace_m2,
                "m²",
                3,
            ),
            Fact::new(
                "turn_cost_m2",
                "best rotation: cost",
                cost(Handedness::Turn),
                "m²",
                4,
            ),
            Fact::new(
                "mirror_cost_m2",
                "best mirror image: cost",
                cost(Handedness::Mirror),
                "m²",
                4,
            ),
            Fact::new("aligned_deg", "svd_align: heading", aligned_deg, "°", 1),
            Fact::metres("aligned_x_m", "svd_align: x", problem.aligned.x()),
            Fact::metres("aligned_y_m", "svd_align: y", problem.aligned.y()),
        ],
    }
}

pub fn summary(trace: &ProcrustesTrace) -> String {
    let theta_rad = trace.theta_rad();
    let targets = trace.pairs.target.iter().enumerate();
    let targets = targets.map(|(k, p)| format!("{} at x {:.2} m, y {:.2} m", k + 1, p.x, p.y));
    let targets: Vec<_> = targets.collect();
    format!(
        "{} pairs of points. Targets: {}. Trying {}, now at {:.0}°, with a trace of {:.3} m².",
        trace.pairs.len(),
        targets.join("; "),
        plural(trace.tried()),
        trace.values.get(&TURN),
        trace.problem.trace_m2(trace.tried(), theta_rad),
    )
}
