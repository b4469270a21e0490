//! Poses in the Apartment and the sensor that the scenes of basin and terrain share.

use ch16_slam2d::cloud::PointCloud;
use pr_geom::{Point2, SE2};
use pr_sim::{Lidar, LidarConfig, Rng, Wall, World, WorldRect};

/// In the middle of room A, which has walls on all four sides, `world_from_sensor`.
pub fn room_a() -> SE2 {
    SE2::new(2.0, 1.9, 0.0)
}

/// In the middle of the corridor: two long walls and no wall across, `world_from_sensor`.
pub fn corridor() -> SE2 {
    SE2::new(6.0, 4.42, 0.0)
}

/// The walls of the corridor without its doors, and so long that no sweep from [`corridor`] reaches an end.
pub fn long_corridor() -> World {
    const HALF_LENGTH_M: f64 = 12.0;
    let (south_m, north_m) = (3.8, 5.0);
    let middle_m = corridor().x();
    let [west, east] = [middle_m - HALF_LENGTH_M, middle_m + HALF_LENGTH_M];
    let wall = |y_m| Wall {
        start: Point2::new(west, y_m),
        end: Point2::new(east, y_m),
    };
    let bounds = WorldRect {
        min: Point2::new(west, south_m),
        max: Point2::new(east, north_m),
    };
    World::new(bounds, vec![wall(south_m), wall(north_m)])
}

/// The walls of a world in the frame of a sensor, as pictures draw them.
pub fn walls_seen_from(world: &World, world_from_sensor: &SE2) -> Vec<[Point2<f64>; 2]> {
    let sensor_from_world = world_from_sensor.inverse();
    let ends = |wall: &Wall| [wall.start, wall.end].map(|end| sensor_from_world.transform(end));
    world.walls().iter().map(ends).collect()
}

/// Radius of the normals of a scene's points, m.
pub const NORMAL_RADIUS_M: f64 = 0.3;

/// Largest number of points per cell of a scene's map.
pub const MAP_POINTS_PER_CELL: usize = 8;

/// The sensor of the scenes: more beams than the robot of the lap has.
pub fn lidar(range_sigma_m: f64, max_range_m: f64) -> Lidar {
    Lidar::new(LidarConfig {
        beams: 180,
        max_range_m,
        range_sigma_m,
        ..LidarConfig::default()
    })
}

/// A sweep of a world, thinned to one point in each cell of `voxel_m`, in the sensor's frame.
pub fn sweep(
    world: &World,
    lidar: &mut Lidar,
    world_from_sensor: &SE2,
    rng: &mut Rng,
    voxel_m: f64,
) -> PointCloud {
    let ranges_m = lidar.sense(world, world_from_sensor, rng);
    let cloud: PointCloud = lidar.project(&ranges_m).collect();
    cloud.downsample(voxel_m)
}
