//! Draws marks at the edge of a plot completely, such as a ring at the end of an axis.

use super::layers::HANDLE_RADIUS;
use super::marks::is_finite;
use crate::scene::Layer;
use crate::transform::Transform;

/// Largest number of points that count as separate marks; a larger layer is a cloud, which the plot clips.
const FEW: usize = 16;

/// Margin by which a layer has to be drawn beyond its plot, in pixels; `None` if the plot clips it.
///
/// That is the radius of its marks, if all their positions are in the plot and one of them is so close to the
/// edge that the plot would clip it.
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
