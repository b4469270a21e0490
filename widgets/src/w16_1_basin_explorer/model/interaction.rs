//! Draggable things: the source by its points, its turning handle, a basin map.

use ch16_slam2d::icp::IcpVariant;
use pr_geom::Point2;
use widget_kit::model::Handle;

use super::basins::start_at;
use super::{BasinExplorer, panel};
use crate::pose_handle;
use crate::w16_1_basin_explorer::spec::{EDGE, EDGES, Phase, VARIANT};

/// Names of the draggable things beside those of the source.
mod thing {
    pub const START: &str = "start";
    pub const EDGE: &str = "edge";
}

/// Position of the handle that turns the source, at the current iteration.
pub fn turn_handle(explorer: &BasinExplorer) -> Point2<f64> {
    pose_handle::turn_handle(&explorer.shown().pose)
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
    let pose = explorer.shown().pose;
    let touches = |point: Point2<f64>| {
        let spot = pose.transform(point);
        (spot.x - at[0]).abs() <= reach[0] && (spot.y - at[1]).abs() <= reach[1]
    };
    pose_handle::grab(panel::SWEEPS, &pose, at, reach).or_else(|| {
        let mut points = explorer.scene.source().iter();
        points.any(touches).then(|| Handle {
            panel: panel::SWEEPS,
            id: pose_handle::PLACE,
            offset: [at[0] - pose.x(), at[1] - pose.y()],
            ..Handle::default()
        })
    })
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
    let start = if handle.id == thing::START {
        let variant = match handle.panel {
            panel::PLANE => IcpVariant::PointToPlane,
            _ => IcpVariant::PointToPoint,
        };
        explorer.values.put(&VARIANT, variant);
        start_at(&explorer.values, at)
    } else {
        let spot = [at[0] - handle.offset[0], at[1] - handle.offset[1]];
        let moved = pose_handle::dragged(&explorer.shown().pose, handle, spot);
        explorer.scene.start_of(&moved)
    };
    explorer.start_at(start);
}
