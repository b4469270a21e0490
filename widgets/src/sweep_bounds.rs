//! What a picture of two sweeps has to show.

use ch16_lab::basin::BasinScene;
use ch16_slam2d::cloud::PointCloud;
use pr_geom::{SE2, math};

/// The share of a sweep that a picture shows: what a beam sees far behind a door would make the room small.
const SHOWN: f64 = 0.9;

/// The distance within which that share of a sweep lies, m.
fn reach_m(cloud: &PointCloud) -> f64 {
    let mut distances: Vec<f64> = cloud.iter().map(|p| math::norm2(p.x, p.y)).collect();
    distances.sort_by(f64::total_cmp);
    let at = (SHOWN * distances.len() as f64) as usize;
    distances
        .get(at)
        .or(distances.last())
        .copied()
        .unwrap_or_default()
}

/// The part of a sweep within a distance of its sensor.
fn near(cloud: &PointCloud, reach_m: f64) -> PointCloud {
    let near = cloud.iter().filter(|p| math::norm2(p.x, p.y) <= reach_m);
    near.collect()
}

/// Bounds of most of the target, of the source at any heading about its sensor at these poses, and of the source at the
/// end of a run, target frame, m: `[lowest, highest]` of x and of y.
pub fn sweep_bounds(scene: &BasinScene, sensors: &[SE2], end: Option<&SE2>) -> [[f64; 2]; 2] {
    let (source, target) = (scene.source(), scene.target());
    let source_m = reach_m(source);
    let end = end.map(|pose| near(source, source_m).transformed(pose));
    let target = near(target, reach_m(target));
    [0, 1].map(|axis| {
        let points = target.iter().chain(end.iter().flat_map(PointCloud::iter));
        let points = points.map(|p| [p.x, p.y][axis]);
        let sensors = sensors.iter().map(|pose| [pose.x(), pose.y()][axis]);
        let source = sensors.flat_map(|at| [at - source_m, at + source_m]);
        points
            .chain(source)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| {
                [math::min(low, at), math::max(high, at)]
            })
    })
}
