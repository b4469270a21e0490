//! Converts the values of the parameters to the types of the core.

use ch16_slam2d::graph::{EdgeKind, PoseGraph};
use kit::values::Values;
use nalgebra::Matrix3;
use pr_geom::SE2;

use crate::w16_5_pose_graph_toy::spec::{GAP, GRAPH, MOVED, ODOMETRY, PINNED, STIFFNESS, Shape};

/// Sides of the square and of the ring, m.
const SIDE_M: f64 = 1.0;

impl Shape {
    /// Number of poses.
    pub fn poses(self) -> usize {
        match self {
            Self::Line => 3,
            Self::Square => 4,
            Self::Ring => 6,
        }
    }

    /// The measurement of each edge of odometry.
    fn odometry(self) -> SE2 {
        match self {
            Self::Line => SE2::translation(SIDE_M, 0.0),
            Self::Square | Self::Ring => {
                let turn = core::f64::consts::TAU / self.poses() as f64;
                SE2::new(SIDE_M, 0.0, turn)
            }
        }
    }

    /// The poses by odometry, the first one at the origin.
    pub fn driven(self) -> Vec<SE2> {
        let step = self.odometry();
        let next = |pose: &SE2| Some(*pose * step);
        core::iter::successors(Some(SE2::identity()), next)
            .take(self.poses())
            .collect()
    }
}

/// The poses set by the reader.
pub fn start(values: &Values) -> Vec<SE2> {
    let driven = values.get(&GRAPH).driven();
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
    let step = shape.odometry();
    let last = shape.poses() - 1;
    for k in 0..last {
        graph.add_edge(k, k + 1, step, odometry, EdgeKind::Odometry);
    }
    // Ahead of the first pose, in its frame.
    let gap = SE2::translation(values.get(&GAP), 0.0);
    let seen = gap * shape.driven()[last];
    let stiffness = Matrix3::from_diagonal_element(values.get(&STIFFNESS));
    graph.add_edge(0, last, seen, stiffness, EdgeKind::Loop);
    graph
}
