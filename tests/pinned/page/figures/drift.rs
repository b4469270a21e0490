//! Drifts drawn edge by edge over the gate that assumes their sum.

use ch16_lab::drift::{out_and_back, rejected_share, straight};
use ch16_lab::lap::LapConfig;

/// Draws of a path: the standard deviation of a share is 0.2 %.
const DRAWS: usize = 40_000;
const SEED: u32 = 1;

/// `straight.22`, `back.22`, `still.22`: right closures that the gate rejects, by path and number of edges, %.
pub fn rejected_percent(path: &str, edges: &str) -> Option<f64> {
    let config = LapConfig::default();
    let (edges, step_m) = (edges.parse().ok()?, config.slam.keyframe_distance_m);
    let path = match path {
        "still" => straight(edges, 0.0),
        "straight" => straight(edges, step_m),
        "back" => out_and_back(edges, step_m),
        _ => return None,
    };
    let share = rejected_share(&path, &config.slam.chapter.loops, DRAWS, SEED);
    Some(100.0 * share)
}
