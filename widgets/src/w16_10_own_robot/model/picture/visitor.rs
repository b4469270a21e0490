//! The robot of another log on the map.

use pr_geom::math;
use widget_kit::scene::{Layer, Mark, Stroke, Tone};

use crate::w16_10_own_robot::model::OwnRobot;

/// Colour of the other log's robot.
pub const OTHER: Tone = Tone::Class(2);

/// Size of its ellipse in standard deviations.
const SIGMAS: f64 = 3.0;

/// The path of the other log's robot, and the uncertainty of its current pose.
pub fn other_log(own: &OwnRobot) -> Vec<Layer> {
    let Some(((_, shown), other)) = own.place().zip(own.robot.other_log.as_ref()) else {
        return Vec::new();
    };
    let line = |is_localized: bool, stroke, width_px| {
        let places = other.places.iter().map(|place| {
            if place.state.is_localized() == is_localized {
                [place.pose[0], place.pose[1]]
            } else {
                [f64::NAN; 2]
            }
        });
        Layer::Line {
            points: places.collect(),
            stroke,
            tone: OTHER,
            width_px,
        }
    };
    let mut layers = vec![
        line(true, Stroke::Solid, 3.0),
        line(false, Stroke::Dotted, 2.0),
    ];
    if !shown.pose.iter().all(|value| value.is_finite()) {
        return layers;
    }
    let [long, short, heading] = shown.ellipse;
    if (long + short + heading).is_finite() {
        let (sin, cos) = math::sin_cos(heading);
        layers.push(Layer::Ellipse {
            center: [shown.pose[0], shown.pose[1]],
            half_axes: [
                [SIGMAS * long * cos, SIGMAS * long * sin],
                [-SIGMAS * short * sin, SIGMAS * short * cos],
            ],
            stroke: Stroke::Solid,
            tone: OTHER,
        });
    }
    layers.push(Layer::pose(shown.pose, Mark::Triangle, OTHER, 6.0));
    layers
}
