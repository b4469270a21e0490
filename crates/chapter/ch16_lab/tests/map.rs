//! The grid that a lap paints covers what its sensor saw, in any world.

use ch16_lab::lap::{BuiltInWorld, GridExtent, LapConfig, LapMatcher, LapRecord, LapRunner};
use ch16_slam2d::slam::SlamConfig;
use pr_sim::Course;

/// A hall of 40 m × 8 m around the origin, with posts that constrain the matcher.
fn hall() -> Course {
    let mut walls = vec![
        [-20.0, -4.0, 20.0, -4.0],
        [20.0, -4.0, 20.0, 4.0],
        [20.0, 4.0, -20.0, 4.0],
        [-20.0, 4.0, -20.0, -4.0],
    ];
    let post = |x: f64, from: f64, to: f64| [x, from, x, to];
    walls.extend((-9..=9).map(|k| post(2.0 * f64::from(k), 3.0, 3.6)));
    walls.extend((-6..=6).map(|k| post(3.1 * f64::from(k), -3.6, -2.9)));
    let text = format!(
        r#"{{ "walls_m": {walls:?}, "start": {{ "x_m": -18, "y_m": 0.5, "heading_deg": 0 }},
        "way_points_m": [[18, 0.5]] }}"#
    );
    Course::from_json(text.as_bytes()).expect("the way keeps clear of the walls")
}

#[test]
fn the_grid_holds_every_wall_that_a_lap_through_forty_metres_has_seen() {
    let config = LapConfig::with_seed_and_noise(1, 1.0).elsewhere(&hall());
    let config = config.with_matcher(LapMatcher::Ndt);
    let record = LapRunner::new().run(&config);
    let grid = record.occupancy_grid(record.ticks());
    let poses = record.lap.poses(record.ticks());
    let mut returns = 0;
    for (pose, keyframe) in poses.iter().zip(&record.lap.keyframes) {
        for point in record.drive.sweep(keyframe.tick).cloud.iter() {
            let cell = grid.cell_at(pose.transform(point));
            assert!(grid.index(cell).is_some(), "{point} is beyond the grid");
            returns += 1;
        }
    }
    assert!(returns > 1000);
    assert!(grid.columns() as f64 * grid.config().cell_m > 40.0);
}

#[test]
fn an_estimate_that_leaves_the_plan_takes_the_map_with_it() {
    // Point-to-point ends metres off the ring, outside of its outer wall.
    let mut config = LapConfig::in_world(BuiltInWorld::Ring, 1, 1.0);
    let runner = &mut LapRunner::new();
    let grown = runner.run(&config);
    config.grid = GridExtent::Plan;
    let cut = runner.run(&config);
    let cells = |record: &LapRecord| {
        let grid = record.occupancy_grid(record.ticks());
        grid.occupied_cells() + grid.free_cells()
    };
    assert!(cells(&grown) > cells(&cut));
    assert_eq!(grown.lap, cut.lap, "the grid is only a picture");
}

#[test]
fn the_chapters_lap_is_painted_on_the_plan_and_others_are_not() {
    assert_eq!(LapConfig::default().grid, GridExtent::Plan);
    let elsewhere = LapConfig::in_world(BuiltInWorld::Ring, 1, 1.0);
    assert_eq!(elsewhere.grid, GridExtent::Poses);
    assert_eq!(elsewhere.slam.scan, SlamConfig::default().scan);
}
