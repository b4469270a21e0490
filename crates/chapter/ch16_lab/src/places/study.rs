//! Compares the keyframes of one lap pair by pair.

use std::sync::Arc;

use ch16_slam2d::chapter::path_information;
use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::loops::LoopConfig;
use ch16_slam2d::places::{
    ContextConfig, ContextMatch, HistogramConfig, RangeHistogram, ScanContext,
};
use pr_geom::{SE2, math};

use super::{PlacePair, SAME_PLACE_M};
use crate::lap::{Lap, RecordedKeyframe};

/// A keyframe with its appearance.
#[derive(Clone, Debug)]
pub struct Place {
    /// True pose, world frame.
    pub truth: SE2,
    /// Pose by the front end, world frame.
    pub pose: SE2,
    /// Its thinned scan, body frame.
    pub scan: Arc<PointCloud>,
    /// Histogram of ranges.
    pub histogram: RangeHistogram,
    /// Occupancy by bearing and distance.
    pub context: ScanContext,
}

/// The keyframes of a lap that ran with the front end alone, and the similarity of each pair.
#[derive(Clone, Debug)]
pub struct PlaceStudy {
    seed: u32,
    loops: LoopConfig,
    max_range_m: f64,
    places: Vec<Place>,
    /// Ordered by the newer keyframe, each with all older ones.
    pairs: Vec<PlacePair>,
}

impl PlaceStudy {
    /// The keyframes of a finished lap, before any comparison.
    #[must_use]
    pub fn new(lap: &Lap) -> Self {
        let config = lap.config();
        let max_range_m = config.drive.lidar.max_range_m;
        let histogram = HistogramConfig {
            max_range_m,
            ..HistogramConfig::default()
        };
        let context = ContextConfig {
            max_range_m,
            ..ContextConfig::default()
        };
        let poses = lap.graph().poses();
        let scans = lap.slam().keyframes();
        let place = |(keyframe, pose): (RecordedKeyframe, &SE2)| {
            let scan = &scans[keyframe.node].scan;
            Place {
                truth: keyframe.truth,
                pose: *pose,
                scan: Arc::clone(scan),
                histogram: RangeHistogram::new(scan, &histogram),
                context: ScanContext::new(scan, &context),
            }
        };
        Self {
            seed: config.drive.seed,
            loops: config.slam.chapter.loops,
            max_range_m,
            places: lap.keyframes().zip(poses).map(place).collect(),
            pairs: Vec::new(),
        }
    }

    /// Compares the next pair; false once all are compared.
    pub fn step(&mut self) -> bool {
        let (old, new) = nodes_of(self.pairs.len());
        if new >= self.places.len() {
            return false;
        }
        let pair = self.compared(old, new);
        self.pairs.push(pair);
        true
    }

    /// Compares all pairs.
    #[must_use]
    pub fn run(mut self) -> Self {
        while self.step() {}
        self
    }

    /// The keyframes in order.
    #[must_use]
    pub fn places(&self) -> &[Place] {
        &self.places
    }

    /// Range of the sensor, m.
    #[must_use]
    pub fn max_range_m(&self) -> f64 {
        self.max_range_m
    }

    /// The pair of two keyframes; `None` before it is compared.
    #[must_use]
    pub fn pair(&self, old: usize, new: usize) -> Option<&PlacePair> {
        (old < new).then(|| self.pairs.get(new * (new - 1) / 2 + old))?
    }

    /// All compared pairs, including neighbours in time.
    #[must_use]
    pub fn pairs(&self) -> &[PlacePair] {
        &self.pairs
    }

    /// Share of the pairs that are compared.
    #[must_use]
    pub fn progress(&self) -> f64 {
        let count = self.places.len();
        let all = count * count.saturating_sub(1) / 2;
        self.pairs.len() as f64 / all.max(1) as f64
    }

    /// Whether two keyframes are far enough apart in time to count as a loop.
    #[must_use]
    pub fn is_loop(&self, [old, new]: [usize; 2]) -> bool {
        new >= old + self.loops.min_gap_nodes
    }

    /// The pairs for grading: those far enough apart in time.
    pub fn graded(&self) -> impl Iterator<Item = &PlacePair> {
        self.pairs.iter().filter(|pair| self.is_loop(pair.nodes))
    }

    /// The relative heading at which two keyframes look most alike, `old_from_new`, and their distance.
    #[must_use]
    pub fn turned(&self, old: usize, new: usize) -> ContextMatch {
        self.places[old].context.compare(&self.places[new].context)
    }

    fn compared(&self, old: usize, new: usize) -> PlacePair {
        let (a, b) = (&self.places[old], &self.places[new]);
        let between = a.truth.between(&b.truth);
        let drift = path_information(new - old, &self.loops);
        let apart = a.pose.between(&b.pose);
        let distance_m = math::norm2(apart.x(), apart.y());
        PlacePair {
            seed: self.seed,
            nodes: [old, new],
            is_same: math::norm2(between.x(), between.y()) <= SAME_PLACE_M,
            distances: [
                distance_m * math::sqrt(drift[(0, 0)]),
                a.histogram.distance(&b.histogram),
                a.context.compare(&b.context).distance,
            ],
        }
    }
}

/// The keyframes of a pair by its number.
fn nodes_of(number: usize) -> (usize, usize) {
    let mut new = (math::sqrt(2.0 * number as f64) + 0.5) as usize;
    while new * new.saturating_sub(1) / 2 > number {
        new -= 1;
    }
    while (new + 1) * new / 2 <= number {
        new += 1;
    }
    (number - new * (new - 1) / 2, new)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lap::LapConfig;

    #[test]
    fn the_pairs_are_numbered_newer_keyframe_by_newer_keyframe() {
        let by_hand = (1..60).flat_map(|new| (0..new).map(move |old| (old, new)));
        for (number, nodes) in by_hand.enumerate() {
            assert_eq!(nodes_of(number), nodes);
        }
    }

    #[test]
    fn a_pair_is_found_by_its_keyframes_and_only_loops_are_graded() {
        let mut lap = Lap::new(LapConfig::with_seed_and_noise(1, 1.0).without_loops());
        lap.run();
        let mut study = PlaceStudy::new(&lap);
        assert_eq!((study.progress(), study.pair(0, 1)), (0.0, None));
        while study.step() {}
        assert_eq!(study.progress(), 1.0);
        let last = study.places().len() - 1;
        for nodes in [[0, 1], [3, 17], [last - 1, last], [0, last]] {
            assert_eq!(study.pair(nodes[0], nodes[1]).unwrap().nodes, nodes);
        }
        assert_eq!(study.pair(4, 4), None);
        let gap = lap.config().slam.chapter.loops.min_gap_nodes;
        assert!(
            study
                .graded()
                .all(|pair| pair.nodes[1] - pair.nodes[0] >= gap)
        );
        assert!(study.graded().count() > 100);
        let turned = study.turned(0, last);
        assert_eq!(turned.distance, study.pair(0, last).unwrap().distances[2]);
    }
}
