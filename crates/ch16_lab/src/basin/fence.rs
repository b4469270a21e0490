//! A row of equal posts, a picket fence: what fits once fits again after every spacing.

use pr_geom::{Point2, SE2};
use pr_sim::{Bounds, Lidar, LidarConfig, Wall, World};

/// From the middle of a post to that of the next, m.
pub const FENCE_SPACING_M: f64 = 0.5;

/// Side of a post, which is square, m.
const POST_M: f64 = 0.12;
/// How far in front of the target's sensor the fence stands, m.
const AHEAD_M: f64 = 1.2;
/// Posts to either side of the middle one: more than a sweep sees, so that no end tells them apart.
const POSTS_ASIDE: i32 = 16;
/// Farthest points that are kept of the target and of the source, m: a source that starts 1.5 m beside
/// its place still stands over posts of the target, and no end of the row pulls it back.
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
    let bounds = Bounds {
        min: Point2::new(-end_m, 0.0),
        max: Point2::new(end_m, AHEAD_M + POST_M),
    };
    World::new(bounds, walls)
}

/// Where the target's sensor stands, and the source's, `world_from_sensor`.
pub fn sensors() -> [SE2; 2] {
    // A third of a spacing apart: what the source sees is no shift of what the target saw.
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
