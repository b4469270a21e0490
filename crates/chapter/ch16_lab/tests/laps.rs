//! Lap after lap: the size of the map is bounded by the mapped area, its error does not grow, and it forgets
//! what is gone.

use ch16_lab::laps::{LapNumbers, Laps, LapsConfig};
use pr_sim::Course;

fn driven(config: LapsConfig, laps: usize) -> Vec<LapNumbers> {
    let mut run = Laps::new(config);
    (0..laps)
        .map(|_| {
            let drive = run.simulate();
            run.estimate(&drive)
        })
        .collect()
}

#[test]
fn a_dozen_laps_of_the_flat_leave_a_map_no_larger_and_no_worse_than_three() {
    let laps = driven(LapsConfig::new(&Course::apartment(), 7, 1.0), 12);
    let (third, last) = (&laps[2], &laps[11]);
    assert!(last.nodes as f64 <= 1.5 * third.nodes as f64, "{laps:#?}");
    // The edges of a removed keyframe are merged into existing ones, so the number of edges grows little.
    assert!(last.edges < 3 * last.nodes, "{laps:#?}");
    assert!(last.removed > 10 && last.divergence.is_finite(), "{last:?}");
    // 0.065 m: a cell of the thinned scans.
    assert!(last.map_rms_m < third.map_rms_m + 0.065, "{laps:#?}");
    let mut growing = LapsConfig::new(&Course::apartment(), 7, 1.0);
    growing.map_pruning = None;
    let growing = driven(growing, 4);
    assert!(growing[3].nodes > 3 * growing[0].nodes, "{growing:#?}");
}

#[test]
fn a_wardrobe_that_was_moved_is_gone_after_two_laps() {
    let mut config = LapsConfig::new(&Course::apartment(), 3, 1.0);
    config.wardrobe = Some(4);
    let laps = driven(config, 6);
    assert!(laps[2].wardrobe_points > 20, "{laps:#?}");
    assert_eq!(laps[5].wardrobe_points, 0, "{laps:#?}");
}
