//! Converts the values of the parameters to the types of the core.

use ch16_slam2d::graph::{EdgeKind, PoseGraph};
use nalgebra::Matrix3;
use pr_geom::{SE2, math};
use widget_kit::values::Values;

use crate::w16_5_pose_graph_toy::spec::{
    GAP, GRAPH, GraphShape, MOVED, ODOMETRY, PINNED, STIFFNESS,
};

/// Sides of the square and of the ring, m.
const SIDE_M: f64 = 1.0;

impl GraphShape {
    /// Number of poses.
    pub fn poses(self) -> usize {
        match self {
            Self::Line => 3,
            Self::Square => 4,
            Self::Ring => 6,
        }
    }

    /// The measurements of odometry from each pose to the next. The last pose of the ring is the first one
    /// again, and odometry misses it by `gap_m`: every side is off by what it has of that direction.
    fn odometry(self, gap_m: f64) -> Vec<SE2> {
        let edges = self.poses() - 1;
        let turn = match self {
            Self::Line => 0.0,
            Self::Square => core::f64::consts::FRAC_PI_2,
            Self::Ring => core::f64::consts::TAU / edges as f64,
        };
        let side_m = |k: usize| match self {
            Self::Line | Self::Square => SIDE_M,
            // The squares of the cosines of evenly spread directions add up to half their number.
            Self::Ring => SIDE_M - gap_m * 2.0 / edges as f64 * math::sin_cos(turn * k as f64).1,
        };
        (0..edges).map(|k| SE2::new(side_m(k), 0.0, turn)).collect()
    }

    /// The poses by odometry, the first one at the origin.
    pub fn driven(self, gap_m: f64) -> Vec<SE2> {
        let mut poses = vec![SE2::identity()];
        for step in self.odometry(gap_m) {
            poses.push(poses[poses.len() - 1] * step);
        }
        poses
    }
}

/// The poses set by the reader.
pub fn start(values: &Values) -> Vec<SE2> {
    let driven = values.get(&GRAPH).driven(values.get(&GAP));
    let put = driven.iter().zip(&MOVED).map(|(pose, [x, y, turn])| {
        SE2::new(
            pose.x() + values.get(x),
            pose.y() + values.get(y),
            pose.theta() + values.get(turn).to_radians(),
        )
    });
    put.collect()
}

/// The graph with the poses set by the reader: odometry from each pose to the next, and a loop from the first
/// to the last.
pub fn graph(values: &Values) -> PoseGraph {
    let shape = values.get(&GRAPH);
    let mut graph = PoseGraph::new();
    let pinned = values.get(&PINNED);
    for (k, pose) in start(values).into_iter().enumerate() {
        if k == 0 && pinned {
            graph.add_fixed_node(pose);
        } else {
            graph.add_node(pose);
        }
    }
    let odometry = Matrix3::from_diagonal_element(values.get(&ODOMETRY));
    let gap_m = values.get(&GAP);
    let last = shape.poses() - 1;
    for (k, step) in shape.odometry(gap_m).into_iter().enumerate() {
        graph.add_edge(k, k + 1, step, odometry, EdgeKind::Odometry);
    }
    // Ahead of the first pose, in its frame.
    let gap = SE2::from_xy(gap_m, 0.0);
    let seen = gap * shape.driven(gap_m)[last];
    let stiffness = Matrix3::from_diagonal_element(values.get(&STIFFNESS));
    graph.add_edge(0, last, seen, stiffness, EdgeKind::Loop);
    graph
}
