//! The path by odometry alone, up to the keyframe shown.

use pr_geom::math;
use widget_kit::scene::{Bounds, Layer, Mark, Stroke, Tone};

use crate::w16_10_own_robot::model::{OwnRobot, wheels};
use crate::xy::xy;

/// The path as far as it stays in view, and how far off it ends.
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
    let [x, y, _] = own.robot.keyframes[end].pose;
    let gap = [[x, y], points[end]];
    let off_m = math::norm2(gap[1][0] - x, gap[1][1] - y);
    let label = Layer::label(gap[1], format!("wheels alone: {off_m:.1} m off"), 14.0);
    let pose =
        poses[end].map(|pose| Layer::pose(pose.to_array(), Mark::Triangle, Tone::Prediction, 6.0));
    let path = Layer::line(points, Stroke::Dashed, Tone::Prediction, 2.0);
    let off = Layer::segments(vec![gap], Stroke::Dotted, Tone::Strained, 2.0);
    [path, off].into_iter().chain(pose).chain([label]).collect()
}
