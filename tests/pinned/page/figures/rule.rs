//! What a loop is worth, on graphs of one kind of error: a random walk of the position, or a bias.

use ch16_lab::rule::{EDGES, biased_m, sigmas_m};

/// Node after a quarter of the path.
const QUARTER: usize = EDGES / 4;
/// The tip of the arm.
const TIP: usize = EDGES / 2;

/// `revisit_percent`, `cycle_left`: by how much, or to what, an error shrinks if the loop ties the whole path.
pub fn value(what: &str) -> Option<f64> {
    let left = |of: fn(Option<usize>) -> Vec<f64>, node: usize| of(Some(0))[node] / of(None)[node];
    Some(match what {
        "revisit_percent" => 100.0 * (1.0 - left(sigmas_m, TIP)),
        "cycle_share" => QUARTER as f64 / EDGES as f64,
        "cycle_left" => left(sigmas_m, QUARTER).powi(2),
        "bias_percent" => 100.0 * (1.0 - left(biased_m, TIP)),
        _ => return None,
    })
}
