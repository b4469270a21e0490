//! Draggable things: the source by its points, its turning handle, a basin map.

use ch16_slam2d::icp::IcpVariant;
use pr_geom::{Point2, SE2, math};
use widget_kit::model::Handle;

use super::basins::start_at;
use super::{BasinExplorer, panel};
use crate::w16_1_basin_explorer::spec::{EDGE, EDGES, Phase, VARIANT};

/// Distance of the turning handle from the sensor, m.
const TURN_ARM_M: f64 = 1.0;

/// Names of the draggable things.
mod thing {
    pub const SOURCE: &str = "source";
    pub const TURN: &str = "turn";
    pub const START: &str = "start";
    pub const EDGE: &str = "edge";
}

/// Position of the handle that turns the source, at the current iteration.
pub fn turn_handle(explorer: &BasinExplorer) -> Point2<f64> {
    let arm = Point2::new(TURN_ARM_M, 0.0);
    explorer.shown().pose.transform(arm)
}

/// What is within reach of a spot.
pub fn grab(
    explorer: &BasinExplorer,
    panel: &str,
    at: [f64; 2],
    reach: [f64; 2],
) -> Option<Handle> {
    if panel == panel::SWEEPS {
        return grab_source(explorer, at, reach);
    }
    // Every spot of a basin map is a start or, during the question, a mark.
    let maps = [panel::POINT, panel::PLANE];
    let panel = maps.into_iter().find(|id| *id == panel)?;
    Some(Handle {
        panel,
        id: if explorer.values.get(&EDGE) == Phase::Marking {
            thing::EDGE
        } else {
            thing::START
        },
        offset: [0.0, 0.0],
        ..Handle::default()
    })
}

/// The turning handle, or the source by any of its points or its sensor.
fn grab_source(explorer: &BasinExplorer, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
    let near = |spot: Point2<f64>| {
        (spot.x - at[0]).abs() <= reach[0] && (spot.y - at[1]).abs() <= reach[1]
    };
    let take = |id, spot: Point2<f64>| Handle {
        panel: panel::SWEEPS,
        id,
        offset: [at[0] - spot.x, at[1] - spot.y],
        ..Handle::default()
    };
    let turn = turn_handle(explorer);
    if near(turn) {
        return Some(take(thing::TURN, turn));
    }
    let pose = explorer.shown().pose;
    let sensor = pose.position();
    let mut points = explorer.scene.source().iter();
    let touched = near(sensor) || points.any(|p| near(pose.transform(p)));
    touched.then(|| take(thing::SOURCE, sensor))
}

/// Moves the grabbed thing; the result is the new start.
pub fn drag(explorer: &mut BasinExplorer, handle: Handle, at: [f64; 2]) {
    if handle.id == thing::EDGE {
        if at[0].is_finite() {
            let edge = &EDGES[usize::from(handle.panel == panel::PLANE)];
            explorer.values.put(edge, at[0].abs().round().min(180.0));
        }
        return;
    }
    let pose = explorer.shown().pose;
    let spot = [at[0] - handle.offset[0], at[1] - handle.offset[1]];
    let start = match handle.id {
        thing::START => {
            let variant = match handle.panel {
                panel::PLANE => IcpVariant::PointToPlane,
                _ => IcpVariant::PointToPoint,
            };
            explorer.values.put(&VARIANT, variant);
            start_at(&explorer.values, at)
        }
        thing::TURN => {
            let theta = math::atan2(spot[1] - pose.y(), spot[0] - pose.x());
            let pose = SE2::new(pose.x(), pose.y(), theta);
            explorer.scene.start_of(&pose)
        }
        _ => {
            let pose = SE2::new(spot[0], spot[1], pose.theta());
            explorer.scene.start_of(&pose)
        }
    };
    explorer.start_at(start);
}
