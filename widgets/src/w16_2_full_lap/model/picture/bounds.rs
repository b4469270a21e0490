//! The visible part of the map.

use ch16_lab::lap::BuiltInWorld;
use pr_geom::math;
use widget_kit::scene::Bounds;

use crate::w16_2_full_lap::model::floor_plan::extent;
use crate::w16_2_full_lap::model::moment::LapState;
use crate::xy::xy;

/// Margin around the world, m.
const MARGIN_M: f64 = 0.4;

/// Margin during editing: how far outside a stroke may go, m.
const EDIT_MARGIN_M: f64 = 0.6;

/// The world with a margin, and the extent of the estimates except in the Apartment, whose axes are fixed.
pub fn shown_bounds(moment: &LapState) -> Bounds {
    if let Some(frame) = moment.drawn.and_then(|drawn| drawn.frame) {
        return frame;
    }
    let Bounds { mut min, mut max } = match &moment.drawn {
        Some(drawn) => extent(drawn.sketch),
        None => {
            let walls = moment.runs.world().bounds();
            Bounds {
                min: [walls.min.x, walls.min.y],
                max: [walls.max.x, walls.max.y],
            }
        }
    };
    let is_shown = moment.drawn.is_none_or(|drawn| drawn.problem.is_none());
    if moment.runs.place() != Some(BuiltInWorld::Apartment) && is_shown {
        let ends = moment.runs.graph.poses_at(moment.runs.ticks());
        for pose in ends.iter().chain(&moment.nodes).map(xy) {
            for i in 0..2 {
                min[i] = math::min(min[i], pose[i]);
                max[i] = math::max(max[i], pose[i]);
            }
        }
    }
    let margin = match moment.drawn.and_then(|drawn| drawn.tool) {
        Some(_) => EDIT_MARGIN_M,
        None => MARGIN_M,
    };
    Bounds {
        min: min.map(|least| least - margin),
        max: max.map(|most| most + margin),
    }
}
