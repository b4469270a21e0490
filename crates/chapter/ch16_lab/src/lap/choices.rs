//! The parts of a lap by name: worlds, matchers, gates, frames of information.
//!
//! The command line and the widgets share these lists, so a name means the same everywhere.

use ch16_slam2d::chapter::{DetectorKind, InformationFrame};
use ch16_slam2d::loops::GateModel;
use ch16_slam2d::matching::{MatcherKind, NdtMatcherConfig, SearchMatcherConfig};
use ch16_slam2d::places::PlaceDetectorConfig;
use ch16_slam2d::scan::{LaserScan, ScanConfig};
use ch16_slam2d::slam::SlamConfig;
use pr_sim::Course;
use serde::Serialize;

use super::config::LapConfig;

/// A named choice from a short list.
pub trait NamedChoice: Copy + PartialEq + Sized + 'static {
    /// Each choice with its short name, for commands and links, and its label, for readers; the chapter's first.
    const NAMED: &'static [(Self, &'static str, &'static str)];

    /// All choices.
    fn all() -> impl Iterator<Item = Self> {
        Self::NAMED.iter().map(|(choice, ..)| *choice)
    }

    /// The short name.
    #[must_use]
    fn name(self) -> &'static str {
        self.texts().0
    }

    /// The label.
    #[must_use]
    fn label(self) -> &'static str {
        self.texts().1
    }

    /// Name and label.
    ///
    /// # Panics
    /// If the list lacks the choice: a bug.
    #[must_use]
    fn texts(self) -> (&'static str, &'static str) {
        let row = Self::NAMED.iter().find(|(choice, ..)| *choice == self);
        let (_, name, label) = row.expect("every choice is in the list");
        (name, label)
    }

    /// Looks up a choice by its short name.
    #[must_use]
    fn named(name: &str) -> Option<Self> {
        Self::all().find(|choice| choice.name() == name)
    }
}

/// The worlds that are built in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BuiltInWorld {
    /// The chapter's: down a corridor and back.
    #[default]
    Apartment,
    /// Corridors around a block: its free space has a hole.
    Ring,
    /// Two rooms that look alike: a loop may join the wrong pair.
    TwinRooms,
    /// A corridor without a door: degenerate along its axis.
    Corridor,
    /// A round hall: its wall does not fix the heading.
    Hall,
}

impl BuiltInWorld {
    /// Worlds in which place recognition is graded; in the others many locations look alike.
    pub const GRADED: [Self; 2] = [Self::Apartment, Self::Ring];

    /// The world and the path through it.
    #[must_use]
    pub fn course(self) -> Course {
        match self {
            Self::Apartment => Course::apartment(),
            Self::Ring => Course::ring(),
            Self::TwinRooms => Course::twin_rooms(),
            Self::Corridor => Course::bare_corridor(),
            Self::Hall => Course::round_hall(),
        }
    }
}

impl NamedChoice for BuiltInWorld {
    const NAMED: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Apartment, "apartment", "the Apartment"),
        (Self::Ring, "ring", "a ring of corridors"),
        (Self::TwinRooms, "twins", "two rooms alike"),
        (Self::Corridor, "corridor", "a bare corridor"),
        (Self::Hall, "hall", "a round hall"),
    ];
}

/// Matchers for a lap's front end and loops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LapMatcher {
    /// Point-to-point ICP, the chapter's.
    #[default]
    PointToPoint,
    /// Point-to-plane ICP.
    PointToPlane,
    /// The normal distributions transform.
    Ndt,
}

impl LapMatcher {
    /// The matcher with its settings.
    #[must_use]
    pub fn kind(self) -> MatcherKind {
        match self {
            Self::PointToPoint => MatcherKind::PointToPoint,
            Self::PointToPlane => MatcherKind::PointToPlane,
            Self::Ndt => MatcherKind::Ndt(NdtMatcherConfig::default()),
        }
    }
}

impl NamedChoice for LapMatcher {
    const NAMED: &'static [(Self, &'static str, &'static str)] = &[
        (Self::PointToPoint, "p2p", "point-to-point"),
        (Self::PointToPlane, "p2l", "point-to-plane"),
        (Self::Ndt, "ndt", "NDT"),
    ];
}

/// Matchers that verify loops.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LoopMatcher {
    /// A matcher that a front end may use, too.
    Local(LapMatcher),
    /// Searches every pose of ±3 m × 360° around the proposal, then refines by ICP.
    Search,
}

impl LoopMatcher {
    /// The matcher with its settings.
    #[must_use]
    pub fn kind(self) -> MatcherKind {
        match self {
            Self::Local(matcher) => matcher.kind(),
            Self::Search => MatcherKind::Search(SearchMatcherConfig::default()),
        }
    }
}

impl NamedChoice for LoopMatcher {
    const NAMED: &'static [(Self, &'static str, &'static str)] = &[
        (
            Self::Local(LapMatcher::PointToPoint),
            LapMatcher::NAMED[0].1,
            LapMatcher::NAMED[0].2,
        ),
        (
            Self::Local(LapMatcher::PointToPlane),
            LapMatcher::NAMED[1].1,
            LapMatcher::NAMED[1].2,
        ),
        (
            Self::Local(LapMatcher::Ndt),
            LapMatcher::NAMED[2].1,
            LapMatcher::NAMED[2].2,
        ),
        (Self::Search, "search", "window search"),
    ];
}

/// Detectors of loop candidates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum LapDetector {
    /// Keyframes nearby in the graph, the chapter's.
    #[default]
    Nearby,
    /// Keyframes with a similar histogram of ranges.
    Histogram,
    /// Keyframes with a similar scan context.
    Context,
}

impl NamedChoice for LapDetector {
    const NAMED: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Nearby, "nearby", "near in the graph"),
        (Self::Histogram, "histogram", "range histogram"),
        (Self::Context, "context", "Scan Context"),
    ];
}

/// Estimators of the lap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LapEstimator {
    /// Scan matching with a pose graph and its loops, the chapter's.
    #[default]
    Graph,
    /// Scan matching alone.
    FrontEnd,
    /// Incremental maximum likelihood mapping or its variant for cycles.
    IncrementalKind(IncrementalKind),
}

/// The two incremental methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum IncrementalKind {
    /// Incremental maximum likelihood mapping.
    MaximumLikelihood,
    /// The same with the variant for cycles.
    WithCycles,
}

impl IncrementalKind {
    /// Both.
    pub const ALL: [Self; 2] = [Self::MaximumLikelihood, Self::WithCycles];
}

impl NamedChoice for LapEstimator {
    const NAMED: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Graph, "graph", "pose graph with loops"),
        (Self::FrontEnd, "front-end", "scan matching alone"),
        (
            Self::IncrementalKind(IncrementalKind::MaximumLikelihood),
            "ml",
            "incremental maximum likelihood",
        ),
        (
            Self::IncrementalKind(IncrementalKind::WithCycles),
            "ml-cycles",
            "incremental maximum likelihood with particles for cycles",
        ),
    ];
}

/// Front ends of a lap: how it registers scans and finds loops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LapFrontEnd {
    /// A matcher on the last sweeps, and loops that are close in the graph, the chapter's.
    #[default]
    Window,
    /// The estimator for recorded logs: scan and odometry in one cost, and loops on submaps.
    LocalMap,
}

impl NamedChoice for LapFrontEnd {
    const NAMED: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Window, "window", "the points of the last sweeps"),
        (
            Self::LocalMap,
            "local-map",
            "a local map and the odometry, the estimator for recorded logs",
        ),
    ];
}

impl NamedChoice for InformationFrame {
    const NAMED: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Chapter, "chapter", "as in the chapter's figures"),
        (Self::Exact, "exact", "at the edge's target"),
    ];
}

impl NamedChoice for GateModel {
    const NAMED: &'static [(Self, &'static str, &'static str)] = &[
        (
            Self::PathApproximation,
            "path",
            "a drift that grows with the path",
        ),
        (Self::ExactMarginal, "exact", "the graph's own covariance"),
    ];
}

impl LapConfig {
    /// The lap with this seed and noise factor in a built-in world: the chapter's estimator in its own
    /// Apartment, the default one elsewhere.
    #[must_use]
    pub fn in_world(world: BuiltInWorld, seed: u32, noise_factor: f64) -> Self {
        let chapter = Self::with_seed_and_noise(seed, noise_factor);
        match world {
            BuiltInWorld::Apartment => chapter,
            _ => chapter.elsewhere(&world.course()),
        }
    }

    /// Replaces the matcher of the front end and of the loops.
    ///
    /// Point-to-plane gets the default's normals. With the chapter's, which only weight edges there, it
    /// slides along the corridor, and half of the laps close no loop.
    #[must_use]
    pub fn with_matcher(mut self, matcher: LapMatcher) -> Self {
        self.slam = self.slam.with_matcher(matcher.kind());
        match matcher {
            LapMatcher::PointToPlane => self.with_scan(SlamConfig::default().scan),
            LapMatcher::PointToPoint | LapMatcher::Ndt => self,
        }
    }

    /// Replaces the radius of the neighbours for a point's normal, in cells.
    #[must_use]
    pub fn with_normals(self, cells: f64) -> Self {
        let scan = self.slam.scan;
        self.with_scan(ScanConfig {
            normal_radius_m: cells * scan.cell_m,
            ..scan
        })
    }

    /// Replaces the matcher of the loops.
    #[must_use]
    pub fn with_loop_matcher(mut self, matcher: LoopMatcher) -> Self {
        self.slam.chapter.loops.matcher = matcher.kind();
        self
    }

    /// Replaces the detector of loops.
    #[must_use]
    pub fn with_detector(mut self, detector: LapDetector) -> Self {
        let max_range_m = self.drive.lidar.max_range_m;
        let gap = self.slam.chapter.loops.min_gap_nodes;
        let for_sensor = |places: PlaceDetectorConfig| {
            DetectorKind::Place(PlaceDetectorConfig {
                descriptor: places.descriptor.with_max_range_m(max_range_m),
                ..places
            })
        };
        self.slam.chapter.detector = match detector {
            LapDetector::Nearby => DetectorKind::Nearby,
            LapDetector::Histogram => for_sensor(PlaceDetectorConfig::histogram(gap)),
            LapDetector::Context => for_sensor(PlaceDetectorConfig::context(gap)),
        };
        self
    }

    /// Replaces the front end; the one on a local map has its own matcher, detector and gate.
    #[must_use]
    pub fn with_front_end(mut self, front_end: LapFrontEnd) -> Self {
        if front_end == LapFrontEnd::LocalMap {
            let sensor = LaserScan {
                angle_step_rad: self.drive.lidar.angle_step_rad(),
                ..LaserScan::default()
            };
            self.slam = SlamConfig {
                start: self.slam.start,
                loop_closure: self.slam.loop_closure,
                ..SlamConfig::for_robot(&sensor)
            };
        }
        self
    }

    /// Replaces the drift in the gate of the loops.
    #[must_use]
    pub fn with_gate(mut self, gate: GateModel) -> Self {
        self.slam.chapter.loops.gate_model = gate;
        self
    }

    /// Bounds the information of every edge; [`f64::INFINITY`] leaves it as the pairs give it.
    #[must_use]
    pub fn with_information_cap(mut self, cap: f64) -> Self {
        self.slam.chapter.odometry_trust.information_cap = cap;
        self.slam.chapter.loops.trust.information_cap = cap;
        self
    }

    /// Replaces the frame in which edges hold their information.
    #[must_use]
    pub fn with_information(mut self, frame: InformationFrame) -> Self {
        self.slam.chapter.information_frame = frame;
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check<C: NamedChoice + core::fmt::Debug>() {
        for (k, choice) in C::all().enumerate() {
            assert_eq!(C::named(choice.name()), Some(choice));
            assert!(!choice.label().is_empty());
            assert!(
                C::all()
                    .take(k)
                    .all(|other| other.label() != choice.label())
            );
        }
        assert_eq!(C::named("none of them"), None);
    }

    #[test]
    fn every_choice_is_found_by_its_name() {
        check::<BuiltInWorld>();
        check::<LapMatcher>();
        check::<LapDetector>();
        check::<LoopMatcher>();
        check::<LapEstimator>();
        check::<LapFrontEnd>();
        check::<InformationFrame>();
        check::<GateModel>();
    }

    #[test]
    fn the_first_of_each_list_is_the_chapters_lap() {
        let first =
            LapConfig::in_world(BuiltInWorld::NAMED[0].0, super::super::CANONICAL_SEED, 1.0)
                .with_matcher(LapMatcher::NAMED[0].0)
                .with_gate(GateModel::NAMED[0].0)
                .with_information(InformationFrame::NAMED[0].0);
        assert_eq!(first, LapConfig::default());
    }
}
