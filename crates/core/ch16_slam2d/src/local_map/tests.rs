use super::*;

/// The walls of a room of 6 m × 4 m around the origin, a point every 5 cm.
fn room() -> PointCloud {
    let across = (0..120).flat_map(|k| {
        let x = -3.0 + 0.05 * f64::from(k);
        [Point2::new(x, -2.0), Point2::new(x, 2.0)]
    });
    let along = (0..80).flat_map(|k| {
        let y = -2.0 + 0.05 * f64::from(k);
        [Point2::new(-3.0, y), Point2::new(3.0, y)]
    });
    across.chain(along).collect()
}

/// Two walls 2 m apart, 20 m long.
fn corridor() -> PointCloud {
    let walls = (0..400).flat_map(|k| {
        let x = -10.0 + 0.05 * f64::from(k);
        [Point2::new(x, -1.0), Point2::new(x, 1.0)]
    });
    walls.collect()
}

fn map_of(scan: &PointCloud) -> LocalMap {
    let mut map = LocalMap::default();
    let profile = Arc::new(RangeProfile::new(scan));
    map.rebuild([(SE2::identity(), scan, &profile)]);
    map
}

const CONFIG: MapRegistrationConfig = MapRegistrationConfig {
    normal_radius_m: 0.3,
    max_correspondence_m: 0.3,
    inlier_distance_m: 0.15,
    point_sigma_m: 0.025,
    independent_points: 28.0,
    unseen_cost: 0.4,
    good_score: 0.8,
    search_m: 1.1,
    search_rad: 1.6,
};

fn odometry(pose: SE2) -> MotionPrior {
    MotionPrior {
        pose,
        sigma_m: 0.05,
        sigma_rad: 0.02,
        tail: PriorTail::Student,
    }
}

#[test]
fn registration_in_a_room_converges_despite_the_odometry_prior() {
    let scan = room();
    let mut map = map_of(&scan);
    let start = SE2::new(0.12, -0.08, 0.05);
    let found = map.register(&scan, start, &[0.3, 0.15], Some(&odometry(start)), &CONFIG);
    let pose = found.registered.pose;
    // 0.01 m, 0.002 rad: the odometry's 5 cm against 28 points of 2.5 cm.
    assert!(math::norm2(pose.x(), pose.y()) < 0.01, "{pose:?}");
    assert!(pose.theta().abs() < 0.002, "{pose:?}");
    assert!(found.fit.score > 0.98, "{:?}", found.fit);
}

#[test]
fn odometry_determines_the_pose_along_a_corridor_and_the_scan_across() {
    let scan = corridor();
    let mut map = map_of(&scan);
    let start = SE2::new(0.2, 0.1, 0.0);
    let found = map.register(&scan, start, &[0.3, 0.15], Some(&odometry(start)), &CONFIG);
    let pose = found.registered.pose;
    assert!(
        (pose.x() - 0.2).abs() < 0.005 && pose.y().abs() < 0.005,
        "{pose:?}"
    );
    // Along the corridor only the two ends of the walls constrain the pose.
    let information = found.information();
    assert!(
        information[(0, 0)] < 1e-3 * information[(1, 1)],
        "{information}"
    );
}

#[test]
fn a_miss_in_free_space_costs_more_than_in_unseen_space() {
    let scan = room();
    let map = map_of(&scan);
    let at = |x: f64| {
        let point: PointCloud = [Point2::new(x, 0.0)].into_iter().collect();
        map.fit(&point, &SE2::identity(), &CONFIG).score
    };
    assert!((at(3.0) - 1.0).abs() < 1e-9);
    assert!((at(1.0) - 0.0).abs() < 1e-9);
    assert!((at(5.0) - 0.6).abs() < 1e-9);
}

#[test]
fn a_room_shows_that_a_robot_was_carried() {
    let scan = room();
    let mut map = map_of(&scan);
    // The odometry says that it moved by a metre; it did not.
    let prior = odometry(SE2::new(1.0, 0.0, 0.0));
    let found = map.locate(&scan, &prior, &[SE2::identity()], &CONFIG);
    // 0.02 m: a metre of the odometry against 28 points of 2.5 cm.
    assert!(found.registered.pose.x().abs() < 0.02, "{found:?}");
}
