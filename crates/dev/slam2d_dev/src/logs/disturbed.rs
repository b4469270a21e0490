//! `slam2d-dev logs FOLDER --disturbed`: what disturbances of each log do to its error and to its ellipses.

use std::cmp::Ordering;

use pr_geom::{Matrix2, SE2, Vector2, math};
use rayon::prelude::*;
use robot_io::evaluate::{Alignment, onto_truth};
use robot_io::run::LogRun;
use robot_io::settings::{Setting, SettingError};
use robot_io::trajectory::Trajectory;
use serde::Serialize;

use super::disturbance::Disturbance;
use super::{Bench, Reference, SLACK_S, mapped_by};

/// Standard deviation of the references along each axis, m: GMapping's poses and relations by hand.
const REFERENCE_SIGMA_M: f64 = 0.1;
/// The 95 % quantile of χ² with two degrees of freedom, −2 ln 0.05.
const GATE_CHI2: f64 = 5.991;
/// Relations that are compared with their ellipses, at most.
const RELATIONS: usize = 300;
/// A disturbed run is sound within this error, m, or within this many times the plain run's.
const SOUND: (f64, f64) = (0.3, 3.0);
/// It is honest if this share of its keyframes lies within their ellipses.
const HONEST: f64 = 0.8;

/// Result for a log under a disturbance.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DisturbedResult {
    log: String,
    disturbance: String,
    /// Error of the kind of the log's reference, m; null if nothing can be compared.
    error_m: Option<f64>,
    /// Share of the keyframes, or of the relations, within their 95 % ellipses; null if nothing can be compared.
    within_95: Option<f64>,
}

/// Maps every log under every disturbance, with a parameter of this value or all as they are; all outcomes of a log
/// together, in the order of [`Disturbance::ALL`].
pub(super) fn outcomes(
    benches: &[Bench],
    seed: u32,
    setting: Option<(&'static Setting, f64)>,
) -> Result<Vec<Vec<DisturbedResult>>, SettingError> {
    let of_log = |bench: &Bench| {
        let disturbances = Disturbance::ALL.par_iter();
        disturbances
            .map(|disturbance| {
                let run = match setting {
                    Some((setting, value)) => LogRun::default().with_setting(setting, value)?,
                    None => LogRun::default(),
                };
                Ok(bench.outcome(*disturbance, seed, run))
            })
            .collect()
    };
    benches.iter().map(of_log).collect()
}

/// How good the runs of a log are; of several logs the sum.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Score {
    /// Runs that are sound or honest.
    pub(super) held: usize,
    /// Mean logarithm of the errors, ln m.
    pub(super) ln_error: f64,
}

impl Score {
    pub(super) fn of(log: &[DisturbedResult]) -> Self {
        let errors = log.iter().filter_map(|outcome| outcome.error_m);
        let (sum, count) = errors.fold((0.0, 0), |(sum, count), error_m| {
            (sum + math::ln(error_m), count + 1)
        });
        Self {
            held: log.iter().filter(|run| is_held(run, &log[0])).count(),
            ln_error: sum / f64::from(count.max(1)),
        }
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            held: self.held + other.held,
            ln_error: self.ln_error + other.ln_error,
        }
    }

    /// By the runs that are held, then by smaller errors.
    pub(super) fn compare(&self, other: &Self) -> Ordering {
        let by_error = || other.ln_error.total_cmp(&self.ln_error);
        self.held.cmp(&other.held).then_with(by_error)
    }
}

impl Bench {
    fn outcome(&self, disturbance: Disturbance, seed: u32, run: LogRun) -> DisturbedResult {
        let frames = disturbance.frames(&self.frames, seed);
        let mut run = mapped_by(run, &frames);
        let trajectory = disturbance.as_recorded(&self.frames, &run.trajectory());
        DisturbedResult {
            log: self.name.clone(),
            disturbance: disturbance.name(),
            error_m: self.error_m(&trajectory),
            within_95: self.within_95(&mut run, disturbance),
        }
    }

    fn within_95(&self, run: &mut LogRun, disturbance: Disturbance) -> Option<f64> {
        let within = match &self.reference {
            Reference::Poses(truth) => self.keyframes_within(run, truth, disturbance),
            Reference::Relations(_) => self.relations_within(run, disturbance),
        };
        let right = within.iter().filter(|within| **within).count();
        (!within.is_empty()).then(|| right as f64 / within.len() as f64)
    }

    /// Whether each keyframe lies within its ellipse of the reference, after alignment.
    fn keyframes_within(
        &self,
        run: &mut LogRun,
        truth: &Trajectory,
        disturbance: Disturbance,
    ) -> Vec<bool> {
        let trajectory = disturbance.as_recorded(&self.frames, &run.trajectory());
        let Ok(aligned) = onto_truth(&trajectory, truth, Alignment::Se2) else {
            return Vec::new();
        };
        let Some(slam) = run.slam_mut() else {
            return Vec::new();
        };
        let Ok(covariances) = slam.aligned_covariances() else {
            return Vec::new();
        };
        let errors = slam.keyframes().iter().filter_map(|keyframe| {
            let stamp_s = disturbance.recorded_stamp_s(&self.frames, keyframe.stamp_s);
            let pose = aligned * slam.graph().pose(keyframe.node);
            let error = pose.between(&truth.at(stamp_s, SLACK_S)?);
            Some(is_within(&error, covariances[keyframe.node]))
        });
        errors.collect()
    }

    /// Whether relations between keyframes lie within the ellipses of the relative pose.
    fn relations_within(&self, run: &mut LogRun, disturbance: Disturbance) -> Vec<bool> {
        let Reference::Relations(relations) = &self.reference else {
            return Vec::new();
        };
        let trajectory = disturbance.as_recorded(&self.frames, &run.trajectory());
        let Some(slam) = run.slam_mut() else {
            return Vec::new();
        };
        let mut keyframes: Vec<(f64, usize)> = slam
            .keyframes()
            .iter()
            .map(|keyframe| {
                let stamp_s = disturbance.recorded_stamp_s(&self.frames, keyframe.stamp_s);
                (stamp_s, keyframe.node)
            })
            .collect();
        keyframes.sort_by(|one, other| one.0.total_cmp(&other.0));
        let node = |stamp_s: f64| {
            let after = keyframes.partition_point(|keyframe| keyframe.0 <= stamp_s);
            keyframes
                .get(after.saturating_sub(1))
                .map(|keyframe| keyframe.1)
        };
        let every = relations.len().div_ceil(RELATIONS).max(1);
        let mut within = Vec::new();
        for relation in relations.iter().step_by(every) {
            let [first, second] = [relation.first_s, relation.second_s];
            let (Some(from), Some(to)) = (
                trajectory.at(first, SLACK_S),
                trajectory.at(second, SLACK_S),
            ) else {
                continue;
            };
            let error = relation.motion.between(&from.between(&to));
            let covariance = match (node(first), node(second)) {
                (Some(from), Some(to)) if from != to => match slam.relative_covariance(from, to) {
                    Ok(covariance) => covariance.fixed_view::<2, 2>(0, 0).into_owned(),
                    Err(_) => continue,
                },
                _ => Matrix2::zeros(),
            };
            within.push(is_within(&error, covariance));
        }
        within
    }
}

/// Whether the position of an error lies within its 95 % ellipse and that of the reference.
fn is_within(error: &SE2, covariance: Matrix2<f64>) -> bool {
    let reference = Matrix2::identity() * (REFERENCE_SIGMA_M * REFERENCE_SIGMA_M);
    let error = Vector2::new(error.x(), error.y());
    (covariance + reference)
        .try_inverse()
        .is_some_and(|information| error.dot(&(information * error)) <= GATE_CHI2)
}

/// The table in Markdown: a row for each disturbance, a column for each log.
pub(super) fn table(outcomes: &[Vec<DisturbedResult>]) -> String {
    let row = |name: String, cells: Vec<String>| format!("| {name} | {} |", cells.join(" | "));
    let number = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.2}"));
    let names = outcomes.iter().map(|log| log[0].log.clone());
    let mut lines = vec![
        row("disturbance".to_owned(), names.collect()),
        row("---".to_owned(), vec!["---:".to_owned(); outcomes.len()]),
    ];
    for (index, disturbance) in Disturbance::ALL.into_iter().enumerate() {
        let cells = outcomes.iter().map(|log| {
            let DisturbedResult {
                error_m, within_95, ..
            } = &log[index];
            let within =
                within_95.map_or("–".to_owned(), |share| format!("{:.0} %", 100.0 * share));
            let is_held = is_held(&log[index], &log[0]);
            let mark = if is_held { "" } else { "**" };
            format!("{mark}{}{mark} ({within})", number(*error_m))
        });
        lines.push(row(disturbance.name(), cells.collect()));
    }
    let starts = outcomes.iter().map(|log| {
        let started = Disturbance::ALL
            .iter()
            .zip(log)
            .filter(|(start, _)| start.is_start());
        let mut errors: Vec<f64> = started.filter_map(|(_, outcome)| outcome.error_m).collect();
        errors.sort_by(f64::total_cmp);
        let median = errors.get(errors.len() / 2).copied();
        format!("{}, {}", number(median), number(errors.last().copied()))
    });
    lines.push(row(
        "starts 0, 1, 2, 5: median, worst".to_owned(),
        starts.collect(),
    ));
    let held = outcomes
        .iter()
        .map(|log| format!("{} of {}", Score::of(log).held, log.len()));
    lines.push(row("sound or honest".to_owned(), held.collect()));
    lines.join("\n")
}

/// Whether a run is as good as the plain one, or says how bad it is.
fn is_held(outcome: &DisturbedResult, plain: &DisturbedResult) -> bool {
    let most_m = plain
        .error_m
        .map_or(SOUND.0, |plain_m| math::max(SOUND.0, SOUND.1 * plain_m));
    outcome.error_m.is_some_and(|error_m| error_m <= most_m)
        || outcome.within_95.is_some_and(|share| share >= HONEST)
}
