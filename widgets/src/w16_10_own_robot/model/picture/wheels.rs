//! The path by odometry alone, up to the keyframe shown.

use widget_kit::scene::{Bounds, Layer, Mark, Stroke, Tone};

use crate::w16_10_own_robot::model::{OwnRobot, wheels};
use crate::xy::xy;

/// The path as far as it stays in view, and its name.
pub fn wheels(own: &OwnRobot, view: &Bounds) -> Vec<Layer> {
    let poses = wheels::poses(&own.robot);
    let shown = poses.iter().take(own.keyframe() + 1);
    let seen = |at: &[f64; 2]| (0..2).all(|i| (view.min[i]..=view.max[i]).contains(&at[i]));
    let at: Vec<_> = shown
        .map(|pose| pose.as_ref().map(xy).filter(seen))
        .collect();
    let Some(end) = at.iter().rposition(Option::is_some) else {
        return Vec::new();
    };
    let points: Vec<_> = at.iter().map(|at| at.unwrap_or([f64::NAN; 2])).collect();
    let label = Layer::label(points[end], "by its wheels alone".to_owned(), 14.0);
    let pose =
        poses[end].map(|pose| Layer::pose(pose.to_array(), Mark::Triangle, Tone::Prediction, 6.0));
    let path = Layer::line(points, Stroke::Dashed, Tone::Prediction, 2.0);
    core::iter::once(path).chain(pose).chain([label]).collect()
}
