//! `ch16 lap --exercises`: drives the lap with a student's functions from `exercises/`.
//!
//! Their ICP is the matcher of the front end and of loops. Only candidates that their `verify_loop` accepts are proposed;
//! ours verifies those again, with their ICP. Their histogram proposes loops with `--detector histogram`. The optimizer of
//! the estimator cannot be exchanged, so their Gauss–Newton solves the finished graph once more, from odometry alone.

use std::panic::{self, AssertUnwindSafe};
use std::sync::{Arc, Mutex, PoisonError};

use anyhow::{Context as _, anyhow, bail};
use ch16_lab::lap::{LapConfig, LapRecord, LapRunner};
use ch16_listings::{
    Correspondence, IcpConfig, IcpVariant, LoopConfig, PointCloud, PoseGraph, VerifiedLoop,
    VoxelMap, associate,
};
use ch16_slam2d::chapter::{ChapterParts, DetectorKind};
use ch16_slam2d::cloud;
use ch16_slam2d::graph::EdgeKind;
use ch16_slam2d::icp::{self, Pair};
use ch16_slam2d::loops::{self, LoopCandidate, LoopDetector, LoopQuery};
use ch16_slam2d::matching::{
    MapConfig, Match, MatchRequest, MatchStop, MatchSummary, Matcher, MatcherKind,
};
use ch16_slam2d::metrics::position_error_m;
use ch16_slam2d::places::PlaceDescriptor;

use command_line::output::say;

/// A registration by the student.
#[derive(Clone)]
struct TheirIcp {
    settings: IcpConfig,
    make: MapConfig,
    map: VoxelMap,
}

impl TheirIcp {
    fn new(kind: &MatcherKind, make: MapConfig) -> anyhow::Result<Self> {
        let settings = kind
            .icp()
            .context("no exercise implements this --matcher; use p2p or p2l")?;
        Ok(Self {
            settings: IcpConfig {
                variant: match settings.variant {
                    icp::IcpVariant::PointToPoint => IcpVariant::PointToPoint,
                    icp::IcpVariant::PointToPlane => IcpVariant::PointToPlane,
                },
                ..IcpConfig::default()
            },
            map: VoxelMap::new(make.cell_m, make.max_per_cell),
            make,
        })
    }
}

impl Matcher for TheirIcp {
    fn set_target(&mut self, target: &cloud::PointCloud) {
        self.map = VoxelMap::new(self.make.cell_m, self.make.max_per_cell);
        let normals: Vec<_> = (0..target.len()).map(|k| target.normal(k)).collect();
        self.map.insert(&points(target).points, &normals);
    }

    fn register(&mut self, source: &cloud::PointCloud, request: &MatchRequest) -> Match {
        let settings = IcpConfig {
            tau: request.tau_m,
            max_iters: request.max_iterations,
            ..self.settings
        };
        let source = points(source);
        let found = exercises::icp(&source, &self.map, request.guess.into(), &settings);
        let pairs = associate(&source, &self.map, &found.pose, settings.tau);
        // The lap reads no index of a pair.
        let pair = |Correspondence { src, dst, normal }| Pair {
            source_index: 0,
            target_index: 0,
            source: src,
            target: dst,
            normal,
        };
        Match {
            summary: MatchSummary {
                pose: found.pose.into(),
                rmse_m: found.rmse,
                inliers: found.inliers,
                iterations: found.trace.len().saturating_sub(1),
                score: None,
                runner_up: None,
                stop: MatchStop::Other("the student's ICP ended"),
            },
            pairs: pairs.into_iter().map(pair).collect(),
        }
    }
}

/// Result of the student's `verify_loop` for a candidate: new node, old node, verdict.
type Verdicts = Arc<Mutex<Vec<(usize, usize, VerifiedLoop)>>>;

/// Proposes the candidates that the student's `verify_loop` accepts.
#[derive(Clone)]
struct TheirLoops {
    /// The detector: ours, or the student's histogram up to this distance, for a sensor of this range, m.
    near: Box<dyn LoopDetector>,
    histogram: Option<(f64, f64)>,
    config: loops::LoopConfig,
    verdicts: Verdicts,
}

impl LoopDetector for TheirLoops {
    fn detect(&mut self, query: &mut LoopQuery<'_>) -> Vec<LoopCandidate> {
        let config = self.config;
        let node = query.node();
        let sweeps: Vec<PointCloud> = (0..=node).map(|k| points(query.scan(k))).collect();
        let mut candidates = match self.histogram {
            None => self.near.detect(query),
            Some((max_distance, max_range_m)) => {
                let gap = config.min_gap_nodes;
                let alike =
                    exercises::detect_by_histogram(&sweeps, node, gap, max_range_m, max_distance);
                let poses = query.poses();
                let candidate = |old: usize| LoopCandidate {
                    node: old,
                    distance_m: position_error_m(&poses[old], &poses[node]),
                    proposal: None,
                };
                alike.into_iter().map(candidate).collect()
            }
        };
        let mut graph = PoseGraph::new();
        graph.add_fixed_node(query.poses()[0].into());
        for pose in &query.poses()[1..] {
            graph.add_node((*pose).into());
        }
        candidates.truncate(config.candidates_tried);
        candidates.retain(|candidate| {
            let [new, old] = [node, candidate.node].map(|k| (k as u32).into());
            let verdict = exercises::verify_loop(&graph, &sweeps, new, old, &limits(&config));
            let mut verdicts = self.verdicts.lock().unwrap_or_else(PoisonError::into_inner);
            verdicts.push((node, candidate.node, verdict));
            verdict.accepted
        });
        candidates
    }
}

/// A cloud in the type of the listings.
fn points(cloud: &cloud::PointCloud) -> PointCloud {
    PointCloud {
        points: cloud.iter().collect(),
        stamp: cloud.stamp_s(),
    }
}

/// The limits of a loop in the type of the listings.
fn limits(config: &loops::LoopConfig) -> LoopConfig {
    LoopConfig {
        radius: config.radius_m,
        min_gap: config.min_gap_nodes,
        half_width: config.submap_half_width,
        submap: (config.submap.cell_m, config.submap.max_per_cell),
        max_rmse: config.max_rmse_m,
        min_inliers: config.min_inliers,
        drift: (config.drift_sigma_m, config.drift_sigma_rad),
        gate: config.gate_chi2,
        trust: (config.trust.sigma_m, config.trust.covariance_scale),
        ..LoopConfig::default()
    }
}

/// A lap with the student's functions.
pub struct ExerciseLap {
    /// The record of the estimator.
    pub record: LapRecord,
    verdicts: Vec<(usize, usize, VerifiedLoop)>,
    by_histogram: bool,
    /// χ² of the finished graph after the student's Gauss–Newton from odometry alone; `None` without a loop.
    chi2: Option<f64>,
}

/// Drives the lap with the student's functions.
///
/// # Errors
/// If a required exercise is not written or panics, or no exercise implements an argument.
pub fn drive(config: &LapConfig) -> anyhow::Result<ExerciseLap> {
    let chapter = &config.slam.chapter;
    let matcher = TheirIcp::new(&chapter.matcher, chapter.local_map)?;
    let loop_matcher = TheirIcp::new(&chapter.loops.matcher, chapter.loops.submap)?;
    let histogram = match chapter.detector {
        DetectorKind::Nearby => None,
        DetectorKind::Place(places) => match places.descriptor {
            PlaceDescriptor::Histogram(bins) => Some((places.max_distance, bins.max_range_m)),
            PlaceDescriptor::Context(_) => {
                bail!("no exercise implements this --detector; use nearby or histogram");
            }
        },
    };
    let verdicts = Verdicts::default();
    let ours = ChapterParts::from_config(&config.slam.chapter);
    let parts = ChapterParts {
        front_end: Box::new(matcher),
        loops: Box::new(loop_matcher),
        detector: Box::new(TheirLoops {
            near: ours.detector,
            histogram,
            config: chapter.loops,
            verdicts: Arc::clone(&verdicts),
        }),
        gate: None,
    };
    let (record, chi2) = in_one_sentence(|| {
        let record = LapRunner::run_with_parts(config, parts);
        let chi2 = solved_again(&record);
        (record, chi2)
    })?;
    let verdicts = verdicts
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .clone();
    Ok(ExerciseLap {
        record,
        verdicts,
        by_histogram: histogram.is_some(),
        chi2,
    })
}

/// Runs the student's code; a panic becomes an error of one sentence, with its location.
fn in_one_sentence<T>(work: impl FnOnce() -> T) -> anyhow::Result<T> {
    let panic_text = Arc::new(Mutex::new(String::new()));
    let written = Arc::clone(&panic_text);
    panic::set_hook(Box::new(move |panic| {
        let what = panic.payload_as_str().unwrap_or("a panic");
        let what = what.replace('\n', " ");
        let place = panic
            .location()
            .map(|place| format!(" ({}:{})", place.file(), place.line()));
        *written.lock().unwrap_or_else(PoisonError::into_inner) = what + &place.unwrap_or_default();
    }));
    let done = panic::catch_unwind(AssertUnwindSafe(work));
    drop(panic::take_hook());
    let panic_text = panic_text
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .clone();
    done.map_err(|_| anyhow!("--exercises: {panic_text}"))
}

/// χ² of the lap's graph, solved by the student from the chain of its odometry.
fn solved_again(record: &LapRecord) -> Option<f64> {
    let edges = record.lap.edges(record.ticks());
    edges.iter().find(|edge| edge.kind == EdgeKind::Loop)?;
    let slam = &record.config.slam;
    let mut graph = PoseGraph::new();
    graph.add_fixed_node(record.config.drive.start.into());
    let node = |k: usize| (k as u32).into();
    for edge in edges {
        if edge.kind == EdgeKind::Odometry {
            let before = graph.pose(node(edge.from));
            graph.add_node(before * edge.measurement.into());
        }
        graph.add_edge(
            node(edge.from),
            node(edge.to),
            edge.measurement.into(),
            edge.information,
            edge.kind,
        );
    }
    exercises::optimize(
        &mut graph,
        slam.optimizer_iterations,
        slam.optimizer_tolerance,
        slam.huber,
    );
    Some(graph.chi2())
}

impl ExerciseLap {
    /// Prints the exercises in use, and their results.
    pub fn print(&self) {
        say!("steered by your functions:");
        say!("  trimmed_icp      registers every scan and every loop");
        if self.by_histogram {
            say!("  range_histogram  proposes loops");
        }
        if !self.verdicts.is_empty() {
            say!("  verify_loop      what it rejects is not tried; ours tests the others again");
        }
        for (new, old, found) in &self.verdicts {
            let verdict = if found.accepted {
                "accepted"
            } else {
                "rejected"
            };
            say!(
                "    {new} to {old}: chi2 {:.3}, rmse {:.3} m, {} pairs: {verdict}",
                found.chi2,
                found.rmse,
                found.inliers
            );
        }
        if let Some(chi2) = self.chi2 {
            say!("beside the lap, which our optimizer solves:");
            say!("  gauss_newton     brings the finished graph from odometry to chi2 {chi2:.4}");
        }
    }
}
