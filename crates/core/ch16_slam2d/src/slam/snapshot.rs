//! State of an estimator between two frames, as plain data for session files.
//!
//! [`Slam::snapshot`] takes it, [`Slam::restore`] continues from it. The results are the same to the
//! bit as without an interruption: only buffers that every frame refills are left out.
//! Serialized it has neither the parameters nor the scans, which a session file stores in its own form.

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::Vector3;
use pr_geom::SE2;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::{Keyframe, SlamConfig, WindowScan};
use crate::cloud::PointCloud;
use crate::graph::{EdgeView, PoseNode};
use crate::loops::PendingLoop;

/// Larger numbers are not measurements, and their products would overflow.
const LARGEST: f64 = 1e50;
/// Upper limit of the number of frames.
const MAX_FRAMES: usize = 1 << 30;

/// An estimator between two frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SlamSnapshot {
    /// The parameters.
    #[serde(skip)]
    pub config: SlamConfig,
    /// Number of frames.
    pub frames: usize,
    /// Time of the newest frame, s; minus infinity before the first.
    pub last_stamp_s: f64,
    /// The graph's nodes; node k is keyframe k.
    pub nodes: Vec<PoseNode>,
    /// The graph's edges, in the order in which they were added.
    pub edges: Vec<EdgeView>,
    /// Number of edges when a node was last moved; later loops are not optimized yet.
    pub optimized_edges: usize,
    /// The keyframes in order.
    pub keyframes: Vec<Keyframe>,
    /// The newest node at which loops were searched.
    pub last_attempt_node: Option<usize>,
    /// The newest node at which a loop was closed.
    pub last_loop_node: usize,
    /// The pending loops, in order.
    pub pending: Vec<PendingLoop>,
    /// Estimate, window and threshold.
    pub front_end: FrontEndSnapshot,
}

/// A front end between two frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrontEndSnapshot {
    /// The estimated pose, `world_from_body`.
    pub estimate: SE2,
    /// Twist of the last motion, in m/s, m/s, rad/s.
    pub velocity: Vector3<f64>,
    /// Duration of the last motion, s; infinite before the first.
    pub last_dt_s: f64,
    /// The sweeps of the next local map, oldest first.
    pub window: Vec<WindowScan>,
    /// Their scans, body frame.
    #[serde(skip)]
    pub scans: Vec<Arc<PointCloud>>,
    /// State of the registrar.
    pub registrar: NamedNumbers,
}

/// State of a strategy between two frames: its numbers by their names.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NamedNumbers(BTreeMap<String, Vec<f64>>);

impl NamedNumbers {
    /// The same state with these numbers.
    #[must_use]
    pub fn with(mut self, name: &str, numbers: &[f64]) -> Self {
        self.0.insert(name.to_owned(), numbers.to_vec());
        self
    }

    /// Whether there are numbers of this name.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.0.contains_key(name)
    }

    /// The numbers of this name.
    ///
    /// # Errors
    /// If there are none, or another count of them.
    pub fn get<const N: usize>(&self, name: &'static str) -> Result<[f64; N], SnapshotError> {
        let numbers = self.0.get(name).and_then(|found| found[..].try_into().ok());
        numbers.ok_or(SnapshotError::Numbers(name))
    }
}

/// Why a snapshot cannot be restored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SnapshotError {
    /// The numbers of nodes and keyframes differ.
    #[error("the snapshot has {nodes} nodes but {keyframes} keyframes; each node needs one")]
    Keyframes {
        /// Nodes of the graph.
        nodes: usize,
        /// Keyframes.
        keyframes: usize,
    },
    /// No node is fixed.
    #[error("no node is fixed; fix one to define the map's frame")]
    NothingFixed,
    /// An edge has an end that does not exist, or equal ends.
    #[error("edge {edge} connects node {from} to {to}, but nodes are numbered from 0 to {last}")]
    Ends {
        /// Index of the edge.
        edge: usize,
        /// Its ends.
        from: usize,
        /// Its ends.
        to: usize,
        /// The last node.
        last: usize,
    },
    /// A number is not finite, or too large.
    #[error("{what} {number} has a value that is not within ±1e50")]
    OutOfRange {
        /// Kind of the part.
        what: &'static str,
        /// Its index.
        number: usize,
    },
    /// Numbers of a strategy are missing or impossible.
    #[error("the snapshot has no valid {0}; it is of another estimator")]
    Numbers(&'static str),
    /// A counter is inconsistent with the rest.
    #[error("the {0} is inconsistent with the rest of the snapshot")]
    Counter(&'static str),
}

impl SlamSnapshot {
    /// Checks that all numbers are within ±1e50 and all indices exist.
    ///
    /// # Errors
    /// The first inconsistency.
    pub fn check(&self) -> Result<(), SnapshotError> {
        let nodes = self.nodes.len();
        if nodes != self.keyframes.len() {
            return Err(SnapshotError::Keyframes {
                nodes,
                keyframes: self.keyframes.len(),
            });
        }
        if nodes > 0 && !self.nodes.iter().any(|node| node.fixed) {
            return Err(SnapshotError::NothingFixed);
        }
        let out_of_range = |what, number| SnapshotError::OutOfRange { what, number };
        for (number, node) in self.nodes.iter().enumerate() {
            let keyframe = &self.keyframes[number];
            if !is_within_limits(&node.pose) || !keyframe.stamp_s.is_finite() {
                return Err(out_of_range("node", number));
            }
            if keyframe.node != number {
                return Err(SnapshotError::Counter("number of a keyframe's node"));
            }
            if !is_cloud(&keyframe.scan) {
                return Err(out_of_range("the scan of keyframe", number));
            }
        }
        for (number, view) in self.edges.iter().enumerate() {
            let (from, to) = (view.from.index(), view.to.index());
            if from >= nodes || to >= nodes || from == to {
                return Err(SnapshotError::Ends {
                    edge: number,
                    from,
                    to,
                    last: nodes.saturating_sub(1),
                });
            }
            if !is_within_limits(&view.edge.measurement) || !is_each_number(&view.edge.information)
            {
                return Err(out_of_range("edge", number));
            }
        }
        let is_node = |node: usize| node < nodes || (node == 0 && nodes == 0);
        let newest = [self.last_attempt_node, Some(self.last_loop_node)];
        if !newest.into_iter().flatten().all(is_node) {
            return Err(SnapshotError::Counter("newest node with a loop"));
        }
        if self.optimized_edges > self.edges.len() {
            return Err(SnapshotError::Counter("number of optimized edges"));
        }
        for (number, waiting) in self.pending.iter().enumerate() {
            let found = &waiting.verification;
            if found.from_node >= nodes || found.candidate.node >= found.from_node {
                return Err(SnapshotError::Counter("node of a pending loop"));
            }
            let poses = [&found.predicted, &found.initial, &found.registered];
            let matrices = [&found.information, &found.gate_information];
            let known = poses.into_iter().all(is_within_limits)
                && found
                    .candidate
                    .proposal
                    .as_ref()
                    .is_none_or(is_within_limits)
                && matrices.into_iter().all(is_each_number)
                && is_each_number(&found.innovation)
                && is_number(waiting.path_m);
            if !known {
                return Err(out_of_range("pending loop", number));
            }
        }
        let is_counted = (self.frames == 0) == (nodes == 0) && self.frames < MAX_FRAMES;
        if !is_counted || self.last_stamp_s.is_nan() {
            return Err(SnapshotError::Counter("number of frames"));
        }
        if !is_within_limits(&self.config.start) {
            return Err(out_of_range("start pose", 0));
        }
        self.front_end.check(nodes > 0)
    }
}

impl FrontEndSnapshot {
    fn check(&self, has_window: bool) -> Result<(), SnapshotError> {
        if self.window.len() != self.scans.len() || self.window.is_empty() == has_window {
            return Err(SnapshotError::Counter("window of sweeps"));
        }
        let sweeps = self.window.iter().zip(&self.scans).enumerate();
        for (number, (sweep, scan)) in sweeps {
            if !is_within_limits(&sweep.pose) || !is_cloud(scan) {
                return Err(SnapshotError::OutOfRange {
                    what: "sweep",
                    number,
                });
            }
        }
        let known = self.registrar.0.values().all(is_each_number)
            && is_each_number(&self.velocity)
            && is_within_limits(&self.estimate)
            && self.last_dt_s > 0.0;
        if known {
            Ok(())
        } else {
            Err(SnapshotError::OutOfRange {
                what: "front end",
                number: 0,
            })
        }
    }
}

fn is_cloud(cloud: &PointCloud) -> bool {
    is_each_number(cloud.xs().iter().chain(cloud.ys()))
}

fn is_each_number<'a>(values: impl IntoIterator<Item = &'a f64>) -> bool {
    values.into_iter().copied().all(is_number)
}

fn is_number(value: f64) -> bool {
    value.abs() <= LARGEST
}

/// Whether all components of a pose are within ±1e50, as in a snapshot.
#[must_use]
pub fn is_within_limits(pose: &SE2) -> bool {
    is_each_number(&pose.to_array())
}
