//! The path by odometry alone, up to the keyframe shown.

use pr_geom::SE2;
use widget_kit::scene::{Bounds, Layer, Mark, Stroke, Tone};

use crate::w16_10_own_robot::model::OwnRobot;
use crate::w16_10_own_robot::model::wheels::off_m;
use crate::xy::xy;

/// The path as far as it stays in view, and how far off it ends.
pub fn wheels(own: &OwnRobot, poses: &[Option<SE2>], view: &Bounds) -> Vec<Layer> {
    let shown = poses.iter().take(own.keyframe() + 1);
    let seen = |at: &[f64; 2]| (0..2).all(|i| (view.min[i]..=view.max[i]).contains(&at[i]));
    let at: Vec<_> = shown
        .map(|pose| pose.as_ref().map(xy).filter(seen))
        .collect();
    let Some(end) = at.iter().rposition(Option::is_some) else {
        return Vec::new();
    };
    let off_m = off_m(&own.robot, poses, end).unwrap_or_default();
    let points: Vec<_> = at.iter().map(|at| at.unwrap_or([f64::NAN; 2])).collect();
    let gap = super::at(&own.robot, end).map(|keyframe| [keyframe, points[end]]);
    let label = Layer::label(points[end], format!("wheels alone: {off_m:.1} m off"), 14.0);
    let pose =
        poses[end].map(|pose| Layer::pose(pose.to_array(), Mark::Triangle, Tone::Prediction, 6.0));
    let path = Layer::line(points, Stroke::Dashed, Tone::Prediction, 2.0);
    let off = Layer::segments(
        gap.into_iter().collect(),
        Stroke::Dotted,
        Tone::Strained,
        2.0,
    );
    [path, off].into_iter().chain(pose).chain([label]).collect()
}
