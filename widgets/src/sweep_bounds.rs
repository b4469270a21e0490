//! What a picture of two sweeps has to show.

use ch16_lab::basin::BasinScene;
use ch16_slam2d::cloud::PointCloud;
use pr_geom::{SE2, math};

/// Bounds of the target, of the source at any heading about its sensor at these poses, and of the source at the end of
/// a run, target frame, m: `[lowest, highest]` of x and of y.
pub fn sweep_bounds(scene: &BasinScene, sensors: &[SE2], end: Option<&SE2>) -> [[f64; 2]; 2] {
    let distances = scene.source().iter().map(|p| math::norm2(p.x, p.y));
    let reach_m = distances.fold(0.0, math::max);
    let end = end.map(|pose| scene.source().transformed(pose));
    [0, 1].map(|axis| {
        let points = scene
            .target()
            .iter()
            .chain(end.iter().flat_map(PointCloud::iter));
        let points = points.map(|p| [p.x, p.y][axis]);
        let sensors = sensors.iter().map(|pose| [pose.x(), pose.y()][axis]);
        let source = sensors.flat_map(|at| [at - reach_m, at + reach_m]);
        points
            .chain(source)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| {
                [math::min(low, at), math::max(high, at)]
            })
    })
}
