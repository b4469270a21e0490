//! What comes of a log, before there is one: most of a drive around the sample's ring, the map of its sweeps, and where the wheels
//! alone put the robot.

use ch16_lab::lap::{Drive, DriveConfig};
use pr_geom::SE2;
use pr_sim::Course;
use widget_kit::scene::{Bounds, Layer, Mark, Stroke, Tone};

use crate::xy::xy;

/// Waypoints driven to: three of the ring's four corridors.
const WAY_POINTS: usize = 3;
/// Ticks between two sweeps of the map.
const SWEEP_STEP: usize = 8;

/// The view: the ring, as large as possible, m.
pub const BOUNDS: Bounds = Bounds {
    min: [-0.5, -0.8],
    max: [12.5, 10.3],
};

/// The picture.
pub fn layers() -> Vec<Layer> {
    let course = Course::ring();
    let mut config = DriveConfig::default().on_course(&course);
    config.driver.waypoints.truncate(WAY_POINTS);
    let drive = Drive::simulate(&config);
    let last = drive.ticks().len();
    let (robot, wheels) = (drive.truth(last), drive.dead_reckoning(last));
    let seen = |tick: usize| {
        let cloud = drive.sweep(tick).cloud.transformed(&drive.truth(tick));
        cloud.iter().map(|p| [p.x, p.y]).collect::<Vec<_>>()
    };
    let path = |pose: &dyn Fn(usize) -> SE2, stroke, tone, width_px| {
        let at = (0..=last).map(|tick| xy(&pose(tick)));
        Layer::line(at.collect(), stroke, tone, width_px)
    };
    let walls = course.world().walls().iter();
    let walls = walls.map(|wall| [[wall.start.x, wall.start.y], [wall.end.x, wall.end.y]]);
    let map = (0..last).step_by(SWEEP_STEP).flat_map(seen).collect();
    vec![
        Layer::Walls(walls.collect()),
        Layer::Seen {
            from: xy(&robot),
            points: seen(last),
            tone: Tone::Measurement,
        },
        Layer::points(map, Mark::Dot, Tone::Ink, 1.2),
        Layer::points(seen(last), Mark::Dot, Tone::Measurement, 2.4),
        path(
            &|tick| drive.dead_reckoning(tick),
            Stroke::Dashed,
            Tone::Prediction,
            2.0,
        ),
        path(
            &|tick| drive.truth(tick),
            Stroke::Solid,
            Tone::Posterior,
            3.0,
        ),
        Layer::pose(wheels.to_array(), Mark::Triangle, Tone::Prediction, 6.0),
        Layer::pose(robot.to_array(), Mark::Square, Tone::Posterior, 6.0),
        Layer::label(xy(&wheels), "wheels alone".to_owned(), 14.0),
        Layer::label(xy(&robot), "where it is".to_owned(), 14.0),
    ]
}
