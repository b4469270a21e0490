//! Loop detectors by appearance.

use pr_geom::{SE2, math, sort_ranked};

use super::{ContextConfig, HistogramConfig, RangeHistogram, ScanContext};
use crate::cloud::PointCloud;
use crate::loops::{LoopCandidate, LoopDetector, LoopQuery};

/// The descriptor for place recognition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlaceDescriptor {
    /// The histogram of ranges, by χ² distance.
    Histogram(HistogramConfig),
    /// Rings and sectors, by the cosine distance of the sectors.
    Context(ContextConfig),
}

impl PlaceDescriptor {
    /// The same descriptor for a sensor with this range, m.
    #[must_use]
    pub fn with_max_range_m(self, max_range_m: f64) -> Self {
        match self {
            Self::Histogram(config) => Self::Histogram(HistogramConfig {
                max_range_m,
                ..config
            }),
            Self::Context(config) => Self::Context(ContextConfig {
                max_range_m,
                ..config
            }),
        }
    }
}

/// Settings of a [`PlaceDetector`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaceDetectorConfig {
    /// The descriptor.
    pub descriptor: PlaceDescriptor,
    /// Largest dissimilarity of a candidate, 0 to 1.
    pub max_distance: f64,
    /// Largest number of keyframes whose contexts are compared, those with the nearest ring keys.
    pub keys_compared: usize,
    /// Candidates are at least this many nodes older.
    pub min_gap_nodes: usize,
}

impl PlaceDetectorConfig {
    /// Uses the histogram.
    #[must_use]
    pub fn histogram(min_gap_nodes: usize) -> Self {
        Self {
            descriptor: PlaceDescriptor::Histogram(HistogramConfig::default()),
            max_distance: 0.15,
            keys_compared: usize::MAX,
            min_gap_nodes,
        }
    }

    /// Uses Scan Context.
    #[must_use]
    pub fn context(min_gap_nodes: usize) -> Self {
        Self {
            descriptor: PlaceDescriptor::Context(ContextConfig::default()),
            max_distance: 0.4,
            keys_compared: 20,
            min_gap_nodes,
        }
    }
}

/// The descriptor of one scan.
#[derive(Clone, Debug)]
enum Appearance {
    Histogram(RangeHistogram),
    Context(ScanContext),
}

impl Appearance {
    fn new(scan: &PointCloud, descriptor: &PlaceDescriptor) -> Self {
        match descriptor {
            PlaceDescriptor::Histogram(config) => {
                Self::Histogram(RangeHistogram::new(scan, config))
            }
            PlaceDescriptor::Context(config) => Self::Context(ScanContext::new(scan, config)),
        }
    }

    /// Dissimilarity and, if the descriptor has it, the rotation of the other scan relative to this one.
    fn compare(&self, other: &Self) -> (f64, Option<f64>) {
        match (self, other) {
            (Self::Histogram(a), Self::Histogram(b)) => (a.distance(b), None),
            (Self::Context(a), Self::Context(b)) => {
                let found = a.compare(b);
                (found.distance, Some(found.turn_rad))
            }
            _ => (1.0, None),
        }
    }

    /// A cheap distance for presorting the candidates.
    fn key_distance(&self, other: &Self) -> f64 {
        match (self, other) {
            (Self::Context(a), Self::Context(b)) => a.key_distance(b),
            _ => 0.0,
        }
    }
}

/// Proposes old keyframes of similar appearance, wherever they are in the graph.
///
/// The most similar ones come first. If the descriptor gives the heading, the proposal is the old keyframe's
/// position with that heading; otherwise registration starts at the graph's relative pose.
#[derive(Clone, Debug)]
pub struct PlaceDetector {
    config: PlaceDetectorConfig,
    looks: Vec<Appearance>,
}

impl PlaceDetector {
    /// A detector without keyframes.
    #[must_use]
    pub fn new(config: PlaceDetectorConfig) -> Self {
        Self {
            config,
            looks: Vec::new(),
        }
    }

    /// Dissimilarity of two scans, 0 to 1.
    #[must_use]
    pub fn distance(descriptor: &PlaceDescriptor, a: &PointCloud, b: &PointCloud) -> f64 {
        Appearance::new(a, descriptor)
            .compare(&Appearance::new(b, descriptor))
            .0
    }
}

impl LoopDetector for PlaceDetector {
    fn detect(&mut self, query: &mut LoopQuery<'_>) -> Vec<LoopCandidate> {
        let node = query.node();
        for known in self.looks.len()..query.keyframes().len() {
            let look = Appearance::new(query.scan(known), &self.config.descriptor);
            self.looks.push(look);
        }
        let Some(here) = self.looks.get(node) else {
            return Vec::new();
        };
        let old_enough = (node + 1)
            .saturating_sub(self.config.min_gap_nodes)
            .min(node);
        let mut keyed: Vec<(f64, usize)> = self.looks[..old_enough]
            .iter()
            .enumerate()
            .map(|(old, look)| (look.key_distance(here), old))
            .collect();
        sort_ranked(&mut keyed);
        keyed.truncate(self.config.keys_compared);
        let mut alike: Vec<(f64, usize, Option<f64>)> = keyed
            .into_iter()
            .map(|(_, old)| {
                let (distance, turn_rad) = self.looks[old].compare(here);
                (distance, old, turn_rad)
            })
            .filter(|(distance, ..)| *distance <= self.config.max_distance)
            .collect();
        alike.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let poses = query.poses();
        let candidate = |(_, old, turn_rad): (f64, usize, Option<f64>)| LoopCandidate {
            node: old,
            distance_m: math::norm2(
                poses[old].x() - poses[node].x(),
                poses[old].y() - poses[node].y(),
            ),
            proposal: turn_rad.map(|turn_rad| SE2::new(0.0, 0.0, turn_rad)),
        };
        alike.into_iter().map(candidate).collect()
    }

    fn remove_keyframe(&mut self, node: usize) {
        if node < self.looks.len() {
            self.looks.remove(node);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use pr_geom::Point2;

    use super::*;
    use crate::graph::{Keyframe, PoseGraph};

    /// A scan at location `k`, from a robot rotated by `turn_rad`.
    fn seen(k: usize, turn_rad: f64) -> PointCloud {
        let side = 1.0 + 0.35 * k as f64;
        let wall = (0..30).map(|i| 0.1 * f64::from(i));
        let points = wall.flat_map(|along| {
            [
                Point2::new(along - 1.0, side),
                Point2::new(2.0 * side, along - 2.0),
            ]
        });
        let cloud: PointCloud = points.collect();
        cloud.transformed(&SE2::new(0.0, 0.0, turn_rad).inverse())
    }

    #[test]
    fn a_revisited_place_ranks_first_whatever_the_pose_error() {
        for config in [
            PlaceDetectorConfig::histogram(3),
            PlaceDetectorConfig::context(3),
        ] {
            let mut graph = PoseGraph::new();
            let mut keyframes = Vec::new();
            let mut visit = |graph: &mut PoseGraph, scan: PointCloud| {
                let pose = SE2::new(50.0 * keyframes.len() as f64, 0.0, 0.0);
                let node = graph.add_node(pose).index();
                keyframes.push(Keyframe {
                    node,
                    frame: node,
                    stamp_s: node as f64,
                    scan: Arc::new(scan),
                });
            };
            for place in 0..6 {
                visit(&mut graph, seen(place, 0.0));
            }
            visit(&mut graph, seen(2, 1.2));
            let mut detector = PlaceDetector::new(config);
            let found = detector.detect(&mut LoopQuery::new(&mut graph, &keyframes));
            assert_eq!(found[0].node, 2, "{config:?}");
            assert!((found[0].distance_m - 200.0).abs() < 1e-9);
            match found[0].proposal {
                // One of 60 sectors is 0.105 rad.
                Some(pose) => assert!((pose.theta() - 1.2).abs() < 0.105),
                None => assert!(matches!(config.descriptor, PlaceDescriptor::Histogram(_))),
            }
            assert!(found.iter().all(|candidate| candidate.node <= 3));
        }
    }
}
