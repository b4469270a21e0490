//! The lap and its pairs, driven and compared in pieces between frames.

use std::sync::Arc;

use ch16_lab::lap::{DriveSimulation, Lap, LapConfig};
use ch16_lab::places::{OperatingPoint, PlaceCurve, PlaceStudy, place_curves};
use pr_geom::sort_numbers;

/// Pairs in one piece of work: some tenths of a millisecond.
const PAIRS_PER_PIECE: usize = 5;

/// The stages up to the grades of a lap.
pub enum GradingTask {
    /// The drive is simulated.
    Driving(Box<DriveSimulation>),
    /// The front end runs.
    Running(Box<Lap>),
    /// The pairs are compared.
    Comparing(Box<PlaceStudy>),
}

/// A graded lap with its pairs.
pub struct Places {
    /// The keyframes and their pairs.
    pub study: PlaceStudy,
    /// The curve of each detector.
    pub curves: Vec<PlaceCurve>,
    /// Distances of the graded pairs by each detector, in ascending order.
    ranked: [Vec<f64>; 3],
    /// Graded pairs that are the same place.
    pub same: usize,
}

impl GradingTask {
    /// A lap before its first step.
    pub fn new(config: &LapConfig) -> Self {
        Self::Driving(Box::new(DriveSimulation::new(config.drive.clone())))
    }

    /// Does one piece. Returns the graded lap at the end.
    pub fn step(self, config: &LapConfig) -> Result<Places, Self> {
        Err(match self {
            Self::Driving(mut simulation) => match simulation.step() {
                None => Self::Driving(simulation),
                Some(drive) => {
                    let lap = Lap::on_drive(config.clone(), Arc::new(drive));
                    Self::Running(Box::new(lap))
                }
            },
            Self::Running(mut lap) => match lap.step() {
                Some(_) => Self::Running(lap),
                None => Self::Comparing(Box::new(PlaceStudy::new(&lap))),
            },
            Self::Comparing(mut study) => {
                let is_busy = (0..PAIRS_PER_PIECE).all(|_| study.step());
                if !is_busy {
                    return Ok(Places::new(*study));
                }
                Self::Comparing(study)
            }
        })
    }
}

impl Places {
    fn new(study: PlaceStudy) -> Self {
        let graded: Vec<_> = study.graded().copied().collect();
        let ranked = core::array::from_fn(|detector| {
            let distances = graded.iter().map(|pair| pair.distances[detector]);
            let mut distances: Vec<f64> = distances.collect();
            sort_numbers(&mut distances);
            distances
        });
        Self {
            curves: place_curves(&graded),
            same: graded.iter().filter(|pair| pair.is_same).count(),
            ranked,
            study,
        }
    }

    /// Share of the pairs that are the same place: the precision of a guess, at every recall.
    pub fn chance(&self) -> f64 {
        self.same as f64 / self.study.graded().count().max(1) as f64
    }

    /// The precision of a perfect detector that calls as many pairs.
    pub fn perfect(&self, called: usize) -> f64 {
        (self.same as f64 / called.max(1) as f64).min(1.0)
    }

    /// Last keyframe.
    pub fn last(&self) -> usize {
        self.study.places().len() - 1
    }

    /// The threshold at which a detector reports that percentage of the pairs.
    pub fn threshold(&self, detector: usize, called_percent: f64) -> f64 {
        let ranked = &self.ranked[detector];
        let called = (ranked.len() as f64 * called_percent / 100.0).round() as usize;
        match called.checked_sub(1) {
            Some(last) => ranked.get(last).copied().unwrap_or(f64::INFINITY),
            None => -1.0,
        }
    }

    /// The percentage of the pairs that a detector reports at a threshold.
    pub fn called_percent(&self, detector: usize, threshold: f64) -> f64 {
        let ranked = &self.ranked[detector];
        let called = ranked.partition_point(|distance| *distance <= threshold);
        100.0 * called as f64 / ranked.len().max(1) as f64
    }

    /// The largest distance of a detector.
    pub fn largest(&self, detector: usize) -> f64 {
        self.ranked[detector].last().copied().unwrap_or(1.0)
    }

    /// The grade of a detector at a threshold; equal distances share it.
    pub fn graded_at(&self, detector: usize, threshold: f64) -> DetectorCounts {
        let mut grade = DetectorCounts::default();
        for pair in self.study.graded() {
            if pair.distances[detector] <= threshold {
                grade.called += 1;
                grade.right += usize::from(pair.is_same);
            }
        }
        grade.same = self.same;
        grade
    }

    /// The older keyframe most similar to `new`, among possible loops.
    pub fn most_alike(&self, detector: usize, new: usize) -> Option<usize> {
        let pairs = (0..new).filter_map(|old| self.study.pair(old, new));
        let loops = pairs.filter(|pair| self.study.is_loop(pair.nodes));
        loops
            .min_by(|a, b| a.distances[detector].total_cmp(&b.distances[detector]))
            .map(|pair| pair.nodes[0])
    }
}

/// Counts of a detector at a threshold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DetectorCounts {
    /// Reported pairs.
    pub called: usize,
    /// Right ones among them.
    pub right: usize,
    /// All right pairs.
    pub same: usize,
}

impl DetectorCounts {
    /// Precision and recall, if any pair is reported.
    pub fn point(&self, threshold: f64) -> Option<OperatingPoint> {
        (self.called > 0 && self.same > 0).then(|| OperatingPoint {
            threshold,
            precision: self.right as f64 / self.called as f64,
            recall: self.right as f64 / self.same as f64,
        })
    }
}
