//! Marks at the edge of a plot: a ring at the last place of an axis is drawn whole.

use super::layers::{HANDLE_RADIUS, is_finite};
use crate::scene::Layer;
use crate::transform::Transform;

/// Points of a layer that is a handful of marks; more are a cloud, which the plot cuts.
const FEW: usize = 16;

/// How far beyond its plot a layer has to be drawn, in pixels; nothing where the plot cuts it.
///
/// That is the radius of its marks, where all their places lie in the plot and one lies so near its
/// edge that the plot would cut it.
pub fn reach_over(layer: &Layer, to: &Transform) -> Option<f32> {
    let pose;
    let (places, radius) = match layer {
        Layer::Points {
            points, radius_px, ..
        } if points.len() <= FEW => (&points[..], *radius_px),
        Layer::Pose {
            pose: [x, y, _],
            radius_px,
            ..
        } => {
            pose = [[*x, *y]];
            (&pose[..], *radius_px)
        }
        Layer::Handle { at, .. } => (core::slice::from_ref(at), HANDLE_RADIUS),
        _ => return None,
    };
    // The stroke is drawn half outside the radius.
    let reach = radius + 2.0;
    let (whole, inner) = (to.plot().grown(0.5), to.plot().grown(-reach));
    let mut is_cut = false;
    for place in places.iter().filter(|at| is_finite(at)) {
        let at = to.to_px(*place);
        if !whole.contains(at) {
            return None;
        }
        is_cut |= !inner.contains(at);
    }
    is_cut.then_some(reach)
}
