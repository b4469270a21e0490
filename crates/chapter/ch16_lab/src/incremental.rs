//! Incremental mapping on the drives of laps: the same frames, judged by the same truth.
//!
//! Map, keyframes and noise follow from the lap's estimator, so only the method differs.

use ch16_slam2d::metrics::{DisagreementConfig, MapDisagreement, position_error_m, rms};
use ch16_slam2d::slam::SlamConfig;
use incremental_mapping::{CycleTest, CycleVerdict, IncrementalConfig, IncrementalMapper};
use pr_geom::SE2;
use serde::{Deserialize, Serialize};

use crate::lap::{Drive, IncrementalKind, LapConfig, LapSummary, PathErrors, RecordedKeyframe};

impl IncrementalKind {
    /// Creates the mapper with the lengths and the noise of a lap's estimator; the particles' seed is the
    /// drive's.
    #[must_use]
    pub fn config(self, lap: &LapConfig) -> IncrementalConfig {
        let slam = SlamConfig {
            start: lap.drive.start,
            scan: lap.drive.scan,
            ..lap.slam.clone()
        };
        let alone = IncrementalConfig::from_slam_config(&slam);
        match self {
            Self::MaximumLikelihood => alone,
            Self::WithCycles => alone.with_cycles(&slam, lap.drive.seed),
        }
    }
}

/// Results of one incremental run that statistics need.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct IncrementalOutcome {
    /// The rows of the results table.
    pub summary: LapSummary,
    /// Cycles that were closed.
    pub cycles: usize,
    /// Errors along the path; without standard deviations.
    pub way: PathErrors,
}

/// The history of an incremental method on a drive.
#[derive(Clone, Debug, PartialEq)]
pub struct IncrementalTrace {
    /// Keyframes in order, with their truth.
    pub keyframes: Vec<RecordedKeyframe>,
    /// Their poses at the end, `world_from_body`.
    pub poses: Vec<SE2>,
    /// The estimate after every tick, `world_from_body`.
    pub estimates: Vec<SE2>,
    /// The particles' tests, at every keyframe but the first.
    pub tests: Vec<CycleTest>,
    /// Rows of the results table.
    pub outcome: IncrementalOutcome,
}

impl IncrementalTrace {
    /// Runs an incremental method over a drive; `lap.drive` must describe it.
    #[must_use]
    pub fn run(kind: IncrementalKind, lap: &LapConfig, drive: &Drive) -> Self {
        Self::from_mapper(IncrementalMapper::new(kind.config(lap)), drive)
    }

    /// Runs a new mapper over a drive.
    #[must_use]
    pub fn from_mapper(mut mapper: IncrementalMapper, drive: &Drive) -> Self {
        let ticks = drive.ticks().len();
        let mut estimates = Vec::with_capacity(ticks);
        let mut tests = Vec::new();
        for tick in 0..=ticks {
            let report = mapper
                .step_prepared(&drive.prepared(tick))
                .expect("frames of a drive are usable");
            tests.extend(report.cycle);
            if tick > 0 {
                estimates.push(report.estimate);
            }
        }
        let keyframes: Vec<RecordedKeyframe> = mapper
            .keyframes()
            .iter()
            .map(|keyframe| RecordedKeyframe {
                node: keyframe.node,
                tick: keyframe.frame,
                truth: drive.truth(keyframe.frame),
            })
            .collect();
        Self {
            outcome: outcome(&mapper, &keyframes, &tests, drive),
            poses: mapper.poses().to_vec(),
            keyframes,
            estimates,
            tests,
        }
    }

    /// Position errors of the keyframes, m.
    pub fn keyframe_errors_m(&self) -> impl Iterator<Item = f64> + '_ {
        let keyframes = self.poses.iter().zip(&self.keyframes);
        keyframes.map(|(pose, keyframe)| position_error_m(pose, &keyframe.truth))
    }
}

fn outcome(
    mapper: &IncrementalMapper,
    keyframes: &[RecordedKeyframe],
    tests: &[CycleTest],
    drive: &Drive,
) -> IncrementalOutcome {
    let poses = mapper.poses().iter().zip(keyframes);
    let errors: Vec<f64> = poses
        .map(|(pose, keyframe)| position_error_m(pose, &keyframe.truth))
        .collect();
    let wheels = drive.ticks().iter();
    let wheels: Vec<f64> = wheels
        .map(|tick| position_error_m(&tick.dead_reckoning, &tick.truth))
        .collect();
    let ticks: Vec<usize> = keyframes.iter().map(|keyframe| keyframe.tick).collect();
    let is_closed = |test: &&CycleTest| matches!(test.verdict, CycleVerdict::Closed(_));
    IncrementalOutcome {
        summary: LapSummary::from_errors(
            wheels.len(),
            [
                wheels.last().copied().unwrap_or(0.0),
                rms(wheels.iter().copied()),
            ],
            &errors,
            disagreement_m(mapper, keyframes, drive),
        ),
        cycles: tests.iter().filter(is_closed).count(),
        way: PathErrors::along_path(drive, &ticks, &errors, None),
    }
}

/// Distance between the map of the outward path and what the return path saw, at the final poses.
fn disagreement_m(
    mapper: &IncrementalMapper,
    keyframes: &[RecordedKeyframe],
    drive: &Drive,
) -> Option<f64> {
    let turn = drive.config().turn?;
    let reached = drive.ticks().iter().position(|t| t.reached == Some(turn))?;
    // Ticks are counted from 1; the keyframe of the turn's own tick belongs to the return path.
    let out = keyframes.partition_point(|keyframe| keyframe.tick < reached + 1);
    let scans = mapper.keyframes().iter().map(|keyframe| &*keyframe.scan);
    let mut maps = mapper.poses().iter().zip(scans);
    let mut disagreement = MapDisagreement::new(DisagreementConfig::default());
    disagreement.start(maps.by_ref().take(out));
    for (pose, scan) in maps {
        disagreement.compare(pose, scan);
    }
    disagreement.value_m()
}
