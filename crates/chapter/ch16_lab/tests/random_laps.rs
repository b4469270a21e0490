//! Laps at configurations drawn from the documented ranges: none panics, every result is finite.
//!
//! `ch16 sweep --random --seeds 1..=10000` drives more of them.

use ch16_lab::lap::{LapRunner, random_config};

#[test]
fn every_figure_of_a_lap_within_the_ranges_is_finite() {
    let mut loops = 0;
    for seed in 1..=100 {
        let record = LapRunner::new().run(&random_config(seed));
        assert_eq!(record.first_fault(), None, "configuration {seed}");
        loops += record.lap.graph_summary.loops;
    }
    // An estimator that closes no loop would pass the checks above.
    assert!(loops > 10, "{loops} loops closed");
}
