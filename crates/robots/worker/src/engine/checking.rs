//! Quality of the graph: covariances, tests of each loop against the rest, and doubts.

use log_messages::{LoopDecision, MapperOrder};
use pr_geom::SE2;
use robot_io::quality::{LinkQuality, Quality, edge_tests};

use super::{Engine, Work};
use crate::links::Link;
use crate::update::{Evidence, LoopEvidence, Update};

/// Number of contradicting loops that are sent with their evidence.
const SHOWN: usize = 6;
/// Neighbours of a keyframe, before and after it, that belong to its surroundings.
const BESIDE: usize = 4;
/// Largest number of points of the surroundings of a keyframe.
const MAX_POINTS: usize = 1500;

impl Engine<'_> {
    pub(super) fn check(&mut self) {
        if self.has_scans {
            self.test_unregistered();
            let quality = self.quality();
            self.take_quality(&quality);
        } else if let Some(graph) = &mut self.graph {
            let covariances = graph.pose_covariances().unwrap_or_default();
            let trace_m = |c: &pr_geom::Matrix3<f64>| pr_geom::math::sqrt(c[(0, 0)] + c[(1, 1)]);
            self.sigmas_m = covariances.iter().map(trace_m).collect();
            let residuals: Vec<_> = graph
                .edges()
                .map(|view| (view.edge.measurement, graph.edge_chi2(view.id)))
                .collect();
            for link in &mut self.links {
                let of = residuals.iter().find(|(is, _)| *is == link.measurement);
                link.chi2 = of.map(|(_, chi2)| *chi2).or(link.chi2);
            }
            self.look_into = contradicting(&self.links)
                .map(|(_, link)| link.new)
                .collect();
        }
        if !self.is_ranked {
            self.rank();
        }
        self.changes.keyframes = true;
        self.changes.loops = true;
        self.changes.doubts = true;
        let evidence = self.evidence();
        self.waiting.push(Update::Evidence(evidence));
        self.work = Work::Idle;
    }

    /// The first loops that the rest of the graph contradicts, each with the surroundings of both ends in the frame
    /// of the older one, as the loop lays them on each other.
    fn evidence(&self) -> Evidence {
        let loops = contradicting(&self.links).take(SHOWN);
        let loops = loops.map(|(index, link)| LoopEvidence {
            index,
            ends: [link.new, link.old],
            chi2: link.chi2.unwrap_or(f64::NAN),
            gate_chi2: link.gate_chi2,
            scans: [
                self.surroundings(link.old, &SE2::identity()),
                self.surroundings(link.new, &link.measurement),
            ],
            accept: MapperOrder::Accept(index).request(),
            reject: MapperOrder::Reject(index).request(),
        });
        Evidence {
            count: contradicting(&self.links).count(),
            loops: loops.collect(),
        }
    }

    /// The scans of a keyframe at that pose and of its neighbours: a loop is registered with them too. Empty in a
    /// graph file.
    fn surroundings(&self, keyframe: usize, pose: &SE2) -> Vec<[f64; 2]> {
        let Some(slam) = self.run.slam() else {
            return Vec::new();
        };
        let poses = slam.graph().poses();
        let near = slam
            .keyframes()
            .iter()
            .zip(poses)
            .take(keyframe + BESIDE + 1);
        let mut points = Vec::new();
        for (near, at) in near.skip(keyframe.saturating_sub(BESIDE)) {
            let place = pose.compose(&poses[keyframe].between(at));
            let cloud = near.scan.transformed(&place);
            points.extend(cloud.iter().map(|point| [point.x, point.y]));
        }
        let every = points.len().div_ceil(MAX_POINTS).max(1);
        points.into_iter().step_by(every).collect()
    }

    /// Sorts the loops by doubt: those of the graph that contradict it most come first. This is
    /// done once, so a loop keeps its number while the user changes others.
    fn rank(&mut self) {
        let doubt = |link: &Link| link.chi2.unwrap_or(f64::INFINITY) / link.gate_chi2;
        self.links.sort_by(|a, b| {
            let in_graph = |link: &Link| link.decision.is_in_graph();
            let by_graph = in_graph(b).cmp(&in_graph(a));
            by_graph.then(doubt(b).total_cmp(&doubt(a)))
        });
        self.is_ranked = true;
    }

    /// The quality of the run; loops of a session have no registration.
    pub(super) fn quality(&mut self) -> Quality {
        let mut quality = self.run.quality();
        let unregistered = self.links.iter().filter(|link| link.found.is_none());
        let in_graph = unregistered.filter(|link| link.decision.is_in_graph());
        quality.links.extend(in_graph.map(|link| LinkQuality {
            from: link.new,
            to: link.old,
            score: None,
            rmse_m: None,
            inliers: 0,
            margin: None,
            chi2: link.chi2,
            gate_chi2: link.gate_chi2,
            accepted: true,
            reason: None,
        }));
        quality
    }

    /// Tests the loops of a session against the rest of the graph.
    fn test_unregistered(&mut self) {
        let is_open = |link: &Link| link.found.is_none();
        let Some(slam) = self.run.slam_mut() else {
            return;
        };
        if !self.links.iter().any(is_open) {
            return;
        }
        let tests = edge_tests(slam);
        for link in self.links.iter_mut().filter(|link| is_open(link)) {
            let test = tests
                .iter()
                .find(|(view, _)| view.edge.measurement == link.measurement);
            if let Some((_, chi2)) = test {
                link.chi2 = *chi2;
            }
        }
    }

    fn take_quality(&mut self, quality: &Quality) {
        let keyframes = quality.keyframes.iter();
        self.sigmas_m = keyframes.map(|keyframe| keyframe.sigma_m()).collect();
        for link in self
            .links
            .iter_mut()
            .filter(|link| link.decision.is_in_graph())
        {
            let Some(found) = &link.found else { continue };
            // Two registrations of one pair of keyframes differ in their inliers.
            let known = quality.links.iter().find(|known| {
                (known.from, known.to, known.inliers) == (link.new, link.old, found.inliers)
                    && known.score == found.score
            });
            if let Some(known) = known {
                (link.chi2, link.gate_chi2) = (known.chi2, known.gate_chi2);
            }
        }
        self.doubts.clone_from(&quality.doubts);
        let stamps: Vec<f64> = quality.keyframes.iter().map(|k| k.stamp_s).collect();
        let at = |stamp_s: f64| stamps.partition_point(|&s| s <= stamp_s).saturating_sub(1);
        let poor = self.run.poor().iter().map(|poor| at(poor.stamp_s));
        let refuted = quality.refuted_paths.iter().map(|path| path.to);
        let contradicted = contradicting(&self.links).map(|(_, link)| link.new);
        let doubted = contradicted.chain(refuted).chain(poor);
        let mut all: Vec<usize> = doubted.collect();
        all.sort_unstable();
        all.dedup();
        self.look_into = all;
    }
}

/// The loops in the graph that the rest contradicts and that the user has not accepted, each with its index.
fn contradicting(links: &[Link]) -> impl Iterator<Item = (usize, &Link)> {
    let is_doubted = |link: &Link| {
        link.decision.is_in_graph()
            && link.decision != LoopDecision::Confirmed
            && link.chi2.is_some_and(|chi2| chi2 > link.gate_chi2)
    };
    let links = links.iter().enumerate();
    links.filter(move |(_, link)| is_doubted(link))
}
