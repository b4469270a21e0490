//! Joins two maps: a piece that was mapped on its own becomes part of the map on which it was found.

use nalgebra::{Matrix3, Vector3};
use pr_geom::SE2;

use super::SlamSnapshot;
use crate::graph::{EdgeKind, EdgeView, PoseEdge, PoseNode};
use crate::loops::PendingLoop;
use crate::metrics::position_error_m;

/// Standard deviations of the motion between the last keyframe of the map and the first one of the piece, m and rad:
/// nothing measured it, but every keyframe is connected to the one before it.
const UNMEASURED: (f64, f64) = (5.0, 1.0);
/// Standard deviations added to the found pose, m and rad: the map's own errors around it.
const MAP_SIGMAS: (f64, f64) = (0.05, 0.02);

/// Pose of a piece on a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PiecePose {
    /// `map_from_piece`.
    pub map_from_piece: SE2,
    /// Covariance of the pose at which the piece's newest scan was found, body frame.
    pub covariance: Matrix3<f64>,
}

fn information((sigma_m, sigma_rad): (f64, f64)) -> Matrix3<f64> {
    let square = |sigma: f64| 1.0 / (sigma * sigma);
    Matrix3::from_diagonal(&Vector3::new(
        square(sigma_m),
        square(sigma_m),
        square(sigma_rad),
    ))
}

impl SlamSnapshot {
    /// The map with a later piece that was found on it; the estimator continues from the piece's last frame.
    ///
    /// A loop connects the piece's newest keyframe to the nearest one of the map. A map or a piece without keyframes
    /// gives the other one.
    #[must_use]
    pub fn joined(&self, piece: &Self, found: &PiecePose) -> Self {
        let moved = |pose: &SE2| found.map_from_piece * *pose;
        let first = self.nodes.len();
        let (Some(last), Some(newest)) = (self.nodes.last(), piece.nodes.last()) else {
            return if self.nodes.is_empty() { piece } else { self }.clone();
        };
        let newest_pose = moved(&newest.pose);
        let away_m = |node: &usize| position_error_m(&self.nodes[*node].pose, &newest_pose);
        let nearest = (0..first).min_by(|a, b| away_m(a).total_cmp(&away_m(b)));
        let nearest = nearest.unwrap_or_default();
        let edge = |from: usize, to: usize, measurement, information, kind| EdgeView {
            id: 0.into(),
            from: from.into(),
            to: to.into(),
            edge: PoseEdge {
                measurement,
                information,
                kind,
            },
        };
        let onset = moved(&piece.nodes[0].pose);
        let unmeasured = edge(
            first - 1,
            first,
            last.pose.between(&onset),
            information(UNMEASURED),
            EdgeKind::Odometry,
        );
        let of_map = information(MAP_SIGMAS).try_inverse().unwrap_or_default();
        let known = (found.covariance + of_map).try_inverse();
        let found_again = edge(
            nearest,
            first + piece.nodes.len() - 1,
            self.nodes[nearest].pose.between(&newest_pose),
            known.unwrap_or_else(|| information(UNMEASURED)),
            EdgeKind::Loop,
        );
        let mut joined = self.clone();
        joined.edges.extend([unmeasured, found_again]);
        joined.edges.extend(piece.edges.iter().map(|view| EdgeView {
            from: (first + view.from.index()).into(),
            to: (first + view.to.index()).into(),
            ..*view
        }));
        for (index, view) in joined.edges.iter_mut().enumerate() {
            view.id = index.into();
        }
        // The poses satisfy both new edges.
        joined.optimized_edges = if self.optimized_edges == self.edges.len() {
            self.edges.len() + 2 + piece.optimized_edges
        } else {
            self.optimized_edges
        };
        joined.nodes.extend(piece.nodes.iter().map(|node| PoseNode {
            pose: moved(&node.pose),
            fixed: false,
        }));
        for keyframe in &piece.keyframes {
            let mut keyframe = keyframe.clone();
            keyframe.node += first;
            keyframe.frame += self.frames;
            joined.keyframes.push(keyframe);
        }
        let length_m: f64 = joined.nodes[..=first]
            .windows(2)
            .map(|two| position_error_m(&two[0].pose, &two[1].pose))
            .sum();
        joined.pending = piece
            .pending
            .iter()
            .map(|pending| {
                let mut pending: PendingLoop = *pending;
                pending.verification.from_node += first;
                pending.verification.candidate.node += first;
                pending.path_m += length_m;
                pending
            })
            .collect();
        joined.frames += piece.frames;
        joined.last_stamp_s = piece.last_stamp_s;
        joined.last_attempt_node = piece.last_attempt_node.map(|node| first + node);
        joined.last_loop_node = first + piece.nodes.len() - 1;
        joined.front_end = piece.front_end.clone();
        joined.front_end.estimate = moved(&piece.front_end.estimate);
        for sweep in &mut joined.front_end.window {
            sweep.pose = moved(&sweep.pose);
            sweep.frame += self.frames;
        }
        joined
    }
}
