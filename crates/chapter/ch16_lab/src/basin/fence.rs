//! A row of equal posts, a picket fence: a shift by one spacing fits as well as the truth.

use pr_geom::{Point2, SE2};
use pr_sim::{Lidar, LidarConfig, Wall, World, WorldRect};

/// Distance between the centers of neighbouring posts, m.
pub const FENCE_SPACING_M: f64 = 0.5;

/// Side of a post, which is square, m.
const POST_M: f64 = 0.12;
/// Distance from the target's sensor to the fence, m.
const AHEAD_M: f64 = 1.2;
/// Posts on each side of the middle one: more than a sweep sees, so no end of the row is in view.
const POSTS_ASIDE: i32 = 16;
/// Largest range that is kept of the target and of the source, m. A source 1.5 m off its true pose still
/// overlaps only posts of the target, so no end of the row attracts it.
pub const KEPT_M: [f64; 2] = [4.4, 2.6];
/// More beams than in the room: a post is narrow.
const BEAMS: usize = 540;

/// The posts along x, in front of a sensor at the origin.
pub fn world() -> World {
    let half = 0.5 * POST_M;
    let walls: Vec<Wall> = (-POSTS_ASIDE..=POSTS_ASIDE)
        .flat_map(|post| {
            let x = f64::from(post) * FENCE_SPACING_M;
            let corners = [(-half, -half), (half, -half), (half, half), (-half, half)]
                .map(|(dx, dy)| Point2::new(x + dx, AHEAD_M + dy));
            (0..4).map(move |k| Wall {
                start: corners[k],
                end: corners[(k + 1) % 4],
            })
        })
        .collect();
    let end_m = f64::from(POSTS_ASIDE + 1) * FENCE_SPACING_M;
    let bounds = WorldRect {
        min: Point2::new(-end_m, 0.0),
        max: Point2::new(end_m, AHEAD_M + POST_M),
    };
    World::new(bounds, walls)
}

/// Poses of the target's and of the source's sensor, `world_from_sensor`.
pub fn sensors() -> [SE2; 2] {
    // A third of a spacing apart: the source's points are not a shifted copy of the target's.
    [
        SE2::identity(),
        SE2::new(FENCE_SPACING_M / 3.0, -0.15, 0.12),
    ]
}

/// The sensor in front of the fence.
pub fn lidar(range_sigma_m: f64) -> Lidar {
    Lidar::new(LidarConfig {
        beams: BEAMS,
        range_sigma_m,
        ..LidarConfig::default()
    })
}
