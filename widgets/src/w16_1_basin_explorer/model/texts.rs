//! The result in words and numbers.

use ch16_lab::basin::{BasinPlace, Minimum};
use ch16_slam2d::icp::StopReason;
use pr_geom::{SE2, math};
use widget_kit::model::{Assessment, Fact, Outcome};
use widget_kit::plural::plural;

use super::BasinExplorer;
use super::edge;
use super::settings::{variant, variant_name};
use crate::w16_1_basin_explorer::spec::{EDGE, Phase};

use crate::w16_1_basin_explorer::spec::HEADING;

/// The standing of the minimum that a run reached: the same that colours its cell of a basin map.
pub fn standing(minimum: Minimum) -> Assessment {
    match minimum {
        Minimum::Right => Assessment::Good,
        _ => Assessment::Bad,
    }
}

pub fn outcome(explorer: &BasinExplorer) -> Outcome {
    if let Some(asked) = edge::outcome(explorer) {
        return asked;
    }
    let end = &explorer.run.outcome;
    let (by, beside) = match explorer.driver() {
        Some(yours) => (
            format!("your {}", yours.orders.function.name()),
            format!(
                ". Ours ends {:.2} m and {:.1}° from the truth",
                yours.ours.error_m,
                yours.ours.error_deg.abs()
            ),
        ),
        None => {
            let variant = variant(&explorer.values);
            (variant_name(variant).to_owned(), String::new())
        }
    };
    Outcome {
        standing: standing(end.ending),
        verdict: end.ending.name().to_owned(),
        sentence: format!(
            "From {:.0}° off, {by} ends {:.2} m and {:.1}° from the truth. Its rmse is {:.3} m over \
             {} pairs; it {} {}{beside}.",
            explorer.values.get(&HEADING),
            end.error_m,
            end.error_deg.abs(),
            end.rmse_m,
            end.inliers,
            stop_words(&end.stop),
            plural(end.iterations, "iteration"),
        ),
        facts: vec![
            Fact::new("error_m", "position error", end.error_m, "m", 3),
            Fact::new("error_deg", "heading error", end.error_deg, "°", 1),
            Fact::new("rmse_m", "rmse of the pairs", end.rmse_m, "m", 3),
            Fact::new("pairs", "pairs", end.inliers as f64, "", 0),
            Fact::new("iterations", "iterations", end.iterations as f64, "", 0),
            Fact::yes_or_no("converged", "converged", end.stop.converged()),
        ],
    }
}

pub fn summary(explorer: &BasinExplorer) -> String {
    if explorer.values.get(&EDGE) == Phase::Marking {
        return "Two basin maps of headings and offsets, covered until the edge of the correct basin is marked."
            .to_owned();
    }
    let shown = explorer.shown();
    let truth = explorer.scene.truth();
    let place = match explorer.scene.place() {
        BasinPlace::Room => "one room",
        BasinPlace::Fence => "one row of equal posts",
    };
    let maps = if explorer.shows_maps() {
        " Two basin maps show the minimum reached from every heading and offset."
    } else {
        ""
    };
    format!(
        "Two laser sweeps of {place}, {} and {} points. At iteration {} of {} the source is {:.2} m from where it belongs, with {} pairs and an rmse of {:.3} m.{maps}",
        explorer.scene.target().len(),
        explorer.scene.source().len(),
        explorer.iteration(),
        explorer.last(),
        error_m(&truth, &shown.pose),
        shown.pairs,
        shown.rmse_m,
    )
}

/// Distance of a pose from the truth as the chapter measures it, m.
pub fn error_m(truth: &SE2, pose: &SE2) -> f64 {
    let error = truth.between(pose).log();
    math::norm2(error.x, error.y)
}

fn stop_words(stop: &StopReason) -> &'static str {
    match stop {
        StopReason::SmallStep { .. } => "converged after",
        StopReason::IterationLimit { .. } => "stopped at the limit of",
        StopReason::TooFewPairs { .. } => "stopped with too few pairs after",
        StopReason::TooFewNormals { .. } => "stopped with too few normals after",
        StopReason::TooFewInliers { .. } => "stopped with too few inliers after",
        StopReason::Unobservable { .. } => "stopped with an unobservable direction after",
        StopReason::NotFinite => "stopped at a non-finite value after",
    }
}
