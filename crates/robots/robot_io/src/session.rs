//! Saved sessions: the complete state of a run in one file, for continuing, mapping and localization.
//!
//! `docs/sessions.md` describes the file. Content is checked when it is read: a file that is truncated,
//! damaged, of another format or version gives one sentence, and no length is trusted beyond the bytes that are
//! present. A written session restores the same estimator, and writing that again gives the same bytes.

mod body;
mod error;
mod rays;
mod scans;
#[cfg(test)]
mod tests;

use std::io::Read;

use ch16_slam2d::digest::Digest;
use ch16_slam2d::graph::{EdgeKind, EdgeView, PoseGraph, PoseNode};
use ch16_slam2d::pipeline::ScanPose;
use ch16_slam2d::scan::LaserScan;
use ch16_slam2d::slam::{Slam, SlamSnapshot, is_within_limits};
use pr_geom::SE2;
use serde::{Deserialize, Serialize};

pub use error::SessionError;
pub use rays::rays;

/// The first bytes of a session.
pub const MAGIC: [u8; 8] = *b"SLAM2D\r\n";
/// The version that is written and read.
pub const VERSION: u32 = 5;
/// Default name of a session in the folder of a run.
pub const FILE_NAME: &str = "session.slam2d";
/// Larger files are rejected before they are read, bytes: 150,000 keyframes.
pub const MAX_BYTES: u64 = 1 << 29;

/// Bytes of magic, version and length.
const HEAD_BYTES: usize = 20;
/// Bytes of the checksum.
const TAIL_BYTES: usize = 8;

/// A saved session.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Session {
    /// The estimator after its last frame.
    pub snapshot: SlamSnapshot,
    /// The map after the final pass over all keyframes, if there was one.
    pub mapped: Option<MappedGraph>,
    /// Poses of the scans, at most eight for each keyframe but the last; empty if they were not kept.
    pub scan_poses: Vec<ScanPose>,
    /// Beam geometry of the laser, without ranges.
    pub sensor: Option<LaserScan>,
    /// Odometry pose at the last frame.
    pub last_odometry: Option<SE2>,
}

/// Most scans kept of a keyframe that is not the last.
const SCANS_PER_KEYFRAME: usize = 8;

/// Selects at most eight scans of each keyframe but the last, evenly: a robot that waits for an hour
/// does not fill the file.
pub(crate) fn selected_scan_poses(poses: &[ScanPose]) -> Vec<ScanPose> {
    let mut kept = Vec::new();
    let last = poses.last().map(|scan| scan.keyframe);
    for of_one in poses.chunk_by(|a, b| a.keyframe == b.keyframe) {
        let count = of_one.len();
        if Some(of_one[0].keyframe) == last || count <= SCANS_PER_KEYFRAME {
            kept.extend_from_slice(of_one);
        } else {
            kept.extend((0..SCANS_PER_KEYFRAME).map(|k| of_one[k * count / SCANS_PER_KEYFRAME]));
        }
    }
    kept
}

/// Poses and loops after the final pass; odometry edges are those of the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MappedGraph {
    /// Poses of all keyframes, `world_from_body`.
    pub poses: Vec<SE2>,
    /// The loops.
    pub loops: Vec<EdgeView>,
}

impl MappedGraph {
    /// Extracts what the final pass changes in a graph; loops are numbered from 0.
    #[must_use]
    pub fn from_graph(graph: &PoseGraph) -> Self {
        let loops = graph
            .edges()
            .filter(|view| view.edge.kind == EdgeKind::Loop);
        Self {
            poses: graph.poses().to_vec(),
            loops: loops
                .enumerate()
                .map(|(number, view)| EdgeView {
                    id: number.into(),
                    ..view
                })
                .collect(),
        }
    }
}

impl Session {
    /// Whether a file with these first bytes is a session.
    #[must_use]
    pub fn begins(first_bytes: &[u8]) -> bool {
        first_bytes.starts_with(&MAGIC)
    }

    /// Poses of the keyframes on the map, `world_from_body`.
    #[must_use]
    pub fn poses(&self) -> Vec<SE2> {
        match &self.mapped {
            Some(mapped) => mapped.poses.clone(),
            None => self.snapshot.nodes.iter().map(|node| node.pose).collect(),
        }
    }

    /// The graph of the map.
    #[must_use]
    pub fn graph(&self) -> PoseGraph {
        let jacobians = self.snapshot.config.jacobians;
        let Some(mapped) = &self.mapped else {
            let mut graph = PoseGraph::from_parts(&self.snapshot.nodes, &self.snapshot.edges);
            graph.mark_optimized(self.snapshot.optimized_edges);
            return graph.solved_with(jacobians);
        };
        let poses = self.snapshot.nodes.iter().zip(&mapped.poses);
        let nodes: Vec<PoseNode> = poses
            .map(|(node, &pose)| PoseNode { pose, ..*node })
            .collect();
        let edges = self.snapshot.edges.iter();
        let odometry = edges.filter(|view| view.edge.kind == EdgeKind::Odometry);
        let mut graph = PoseGraph::from_parts(&nodes, odometry.chain(&mapped.loops));
        // The final pass optimizes after its last loop.
        graph.mark_optimized(graph.edge_count());
        graph.solved_with(jacobians)
    }

    /// The keyframes' scans with their poses, as rays from the sensor.
    pub fn posed_scans(&self) -> impl Iterator<Item = (SE2, LaserScan)> + '_ {
        let sensor = self.sensor.clone().unwrap_or_default();
        let cell_m = self.snapshot.config.scan.cell_m;
        let keyframes = self.snapshot.keyframes.iter().zip(self.poses());
        keyframes.map(move |(keyframe, pose)| (pose, rays(&keyframe.scan, &sensor, cell_m)))
    }

    /// Serializes the session.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let body = body::write(self);
        let mut file = Vec::with_capacity(HEAD_BYTES + body.len() + TAIL_BYTES);
        file.extend_from_slice(&MAGIC);
        file.extend_from_slice(&VERSION.to_le_bytes());
        file.extend_from_slice(&(body.len() as u64).to_le_bytes());
        file.extend_from_slice(&body);
        let sum = checksum(&file);
        file.extend_from_slice(&sum.to_le_bytes());
        file
    }

    /// Reads a file; `name` is what errors call it.
    ///
    /// # Errors
    /// If it is not a usable session; the message is one sentence.
    pub fn read(source: impl Read, name: &str) -> Result<Self, SessionError> {
        let mut file = Vec::new();
        let io_error = |source| SessionError::Io {
            name: name.to_owned(),
            source,
        };
        let mut source = source.take(MAX_BYTES + 1);
        source.read_to_end(&mut file).map_err(io_error)?;
        Self::from_bytes(&file, name)
    }

    /// Reads a session from these bytes; see [`read`](Self::read).
    ///
    /// # Errors
    /// If it is not a usable session; the message is one sentence.
    pub fn from_bytes(file: &[u8], name: &str) -> Result<Self, SessionError> {
        let named = || name.to_owned();
        if file.is_empty() {
            return Err(SessionError::Empty { name: named() });
        }
        if file.len() as u64 > MAX_BYTES {
            return Err(SessionError::TooLarge { name: named() });
        }
        let known = file.len().min(MAGIC.len());
        if file[..known] != MAGIC[..known] {
            return Err(SessionError::Foreign { name: named() });
        }
        let cut_off = |needs: usize| SessionError::CutOff {
            name: named(),
            has: file.len(),
            needs: needs as u64,
        };
        let Some((head, _)) = file.split_first_chunk::<HEAD_BYTES>() else {
            return Err(cut_off(HEAD_BYTES));
        };
        let version = u32::from_le_bytes(head[8..12].try_into().expect("four bytes"));
        if version != VERSION {
            return Err(SessionError::Version {
                name: named(),
                version,
            });
        }
        let length = u64::from_le_bytes(head[12..].try_into().expect("eight bytes"));
        let needs = length.saturating_add((HEAD_BYTES + TAIL_BYTES) as u64);
        if (file.len() as u64) < needs {
            return Err(SessionError::CutOff {
                name: named(),
                has: file.len(),
                needs,
            });
        }
        if file.len() as u64 > needs {
            return Err(SessionError::Longer {
                name: named(),
                end: needs,
            });
        }
        let (content, sum) = file.split_at(file.len() - TAIL_BYTES);
        if checksum(content).to_le_bytes() != sum {
            return Err(SessionError::Damaged { name: named() });
        }
        let invalid = |problem| SessionError::Content {
            name: named(),
            problem,
        };
        let session = body::read(&content[HEAD_BYTES..]).map_err(invalid)?;
        session.check().map_err(invalid)?;
        Ok(session)
    }

    fn check(&self) -> Result<(), String> {
        // Only the strategies of its estimator can check their own state.
        Slam::restore(&self.snapshot).map_err(|problem| problem.to_string())?;
        if let Some(sensor) = &self.sensor {
            sensor.validate().map_err(|problem| problem.to_string())?;
        }
        let scan_poses = self.scan_poses.iter().map(|scan| &scan.keyframe_from_body);
        if !self
            .last_odometry
            .iter()
            .chain(scan_poses)
            .all(is_within_limits)
        {
            return Err("a pose is not within ±1e50".to_owned());
        }
        // The next scan must be later than all of them.
        let (keyframes, end_s) = (&self.snapshot.keyframes, self.snapshot.last_stamp_s);
        let is_before_end = |last_s: Option<f64>| last_s.is_none_or(|last_s| last_s <= end_s);
        if !keyframes.is_sorted_by(|a, b| a.stamp_s < b.stamp_s)
            || !is_before_end(keyframes.last().map(|keyframe| keyframe.stamp_s))
        {
            return Err("the stamps of keyframes are not in order".to_owned());
        }
        let last_scan = self.scan_poses.last();
        if !self
            .scan_poses
            .is_sorted_by(|a, b| a.stamp_s < b.stamp_s && a.keyframe <= b.keyframe)
            || !is_before_end(last_scan.map(|scan| scan.stamp_s))
            || last_scan.is_some_and(|scan| scan.keyframe >= keyframes.len())
        {
            return Err("the poses of scans are not in order".to_owned());
        }
        let Some(mapped) = &self.mapped else {
            return Ok(());
        };
        // The map's poses and loops must satisfy the same rules.
        if mapped.poses.len() != self.snapshot.nodes.len() {
            return Err(
                "the map's number of poses differs from the number of keyframes".to_owned(),
            );
        }
        let nodes = self.snapshot.nodes.iter().zip(&mapped.poses);
        let as_driven = SlamSnapshot {
            nodes: nodes
                .map(|(node, &pose)| PoseNode { pose, ..*node })
                .collect(),
            edges: mapped.loops.clone(),
            optimized_edges: mapped.loops.len(),
            ..self.snapshot.clone()
        };
        as_driven
            .check()
            .map_err(|problem| format!("in the map, {problem}"))
    }
}

/// FNV-1a over the bytes as 64-bit words, the last one padded with zeros.
fn checksum(bytes: &[u8]) -> u64 {
    let mut digest = Digest::new();
    for word in bytes.chunks(8) {
        let mut whole = [0; 8];
        whole[..word.len()].copy_from_slice(word);
        digest.add_bits(u64::from_le_bytes(whole));
    }
    digest.value()
}
