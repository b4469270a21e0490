//! The estimator for recorded logs on the drives of laps.

use ch16_lab::lap::{BuiltInWorld, Lap, LapConfig, LapFrontEnd, LapRunner, LapSummary};

#[test]
fn the_estimator_for_logs_beats_odometry_in_both_worlds_and_closes_no_false_loop() {
    for world in [BuiltInWorld::Apartment, BuiltInWorld::Ring] {
        let laps = (1..=4).map(|seed| {
            let config = LapConfig::in_world(world, seed, 1.0);
            let config = config.with_front_end(LapFrontEnd::LocalMap);
            LapRunner::new().run(&config).lap
        });
        let laps: Vec<_> = laps.collect();
        let sum_m = |error_m: fn(&LapSummary) -> f64| -> f64 {
            laps.iter().map(|lap| error_m(&lap.summary)).sum()
        };
        let (error_m, dead_reckoning_m) = (
            sum_m(|lap| lap.keyframe_rms_m),
            sum_m(|lap| lap.odometry_rms_m),
        );
        assert!(
            error_m < 0.3 * dead_reckoning_m,
            "{world:?}: {error_m} {dead_reckoning_m}"
        );
        let wrong: usize = laps.iter().map(|lap| lap.false_acceptances().count()).sum();
        assert_eq!(wrong, 0, "{world:?}");
    }
}

#[test]
fn the_lap_with_a_window_is_the_same_lap_whether_it_is_said_or_not() {
    let config = LapConfig::default();
    let named = config.clone().with_front_end(LapFrontEnd::Window);
    assert_eq!(named, config);
    let local_map = config.with_front_end(LapFrontEnd::LocalMap);
    let twice = [(); 2].map(|()| Lap::new(local_map.clone()).run());
    assert_eq!(twice[0], twice[1]);
    assert_ne!(Lap::new(named).run(), twice[0]);
}
