//! The outcome in words, numbers and tables.

use ch16_lab::basin::{BasinOutcome, Minimum};
use ch16_slam2d::icp::{IcpVariant, StopReason};
use kit::model::{Fact, Outcome, Standing, Table, TablePlace};
use kit::ticks::signed;
use pr_geom::{SE2, math};

use super::BasinExplorer;
use super::basins::{COLUMNS, ROWS};
use super::settings::{other_variant, variant, variant_name};

/// At the right place, a heading this far off is worth a sentence, degrees.
const WORTH_SAYING_DEG: f64 = 10.0;

/// How the minimum is judged that a run reached: the same that colours its cell of a basin map.
pub fn standing(minimum: Minimum) -> Standing {
    match minimum {
        Minimum::Right => Standing::Good,
        _ => Standing::Bad,
    }
}

/// What the verdict leaves out: the chapter counts the position alone.
fn caveat(end: &BasinOutcome) -> &'static str {
    if end.minimum == Minimum::Right && end.error_deg.abs() > WORTH_SAYING_DEG {
        " The verdict counts the place alone: the heading is not home."
    } else {
        ""
    }
}

pub fn outcome(explorer: &BasinExplorer) -> Outcome {
    let end = &explorer.run.outcome;
    Outcome {
        standing: standing(end.minimum),
        verdict: end.minimum.name().to_owned(),
        sentence: format!(
            "From {:.0}° off, {} ends {:.2} m and {:.1}° from the truth: rmse {:.3} m over {} \
             pairs; it {} {}.{}",
            explorer.values.get("heading"),
            variant_name(variant(&explorer.values)),
            end.error_m,
            end.error_deg.abs(),
            end.rmse,
            end.inliers,
            stop_words(&end.stop),
            iterations(end.iterations),
            caveat(end),
        ),
        facts: vec![
            Fact::new("error_m", "position error", end.error_m, "m", 3),
            Fact::new("error_deg", "heading error", end.error_deg, "°", 1),
            Fact::new("rmse_m", "rmse of the pairs", end.rmse, "m", 3),
            Fact::new("pairs", "pairs", end.inliers as f64, "", 0),
            Fact::new("iterations", "iterations", end.iterations as f64, "", 0),
            Fact::yes_or_no("converged", "converged", end.stop.converged()),
        ],
    }
}

pub fn summary(explorer: &BasinExplorer) -> String {
    let shown = explorer.shown();
    let truth = explorer.scene.truth();
    format!(
        "Two laser sweeps of one room, {} and {} points. At iteration {} of {} the source lies \
         {:.2} m from where it belongs, with {} pairs and rmse {:.3} m. {} Two basin maps show the \
         minimum reached from every heading and offset.",
        explorer.scene.target().len(),
        explorer.scene.source().len(),
        explorer.iteration(),
        explorer.last(),
        error_m(&truth, &shown.pose),
        shown.pairs,
        shown.rmse,
        outcome(explorer).sentence,
    )
}

/// The end of both variants from the same start.
pub fn variants(explorer: &BasinExplorer) -> Table {
    let chosen = variant(&explorer.values);
    let row = |variant: IcpVariant, end: &BasinOutcome| {
        vec![
            variant_name(variant).to_owned(),
            end.minimum.name().to_owned(),
            format!("{:.3}", end.error_m),
            signed(end.error_deg, 1),
            format!("{:.3}", end.rmse),
            end.iterations.to_string(),
        ]
    };
    let mut rows = vec![
        row(chosen, &explorer.run.outcome),
        row(other_variant(chosen), &explorer.other),
    ];
    if chosen == IcpVariant::PointToPlane {
        rows.swap(0, 1);
    }
    Table {
        id: "variants",
        title: "Both errors from this start".to_owned(),
        columns: [
            "error", "ends in", "off (m)", "off (°)", "rmse (m)", "steps",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows,
        place: TablePlace::Shown,
    }
}

pub fn tables(explorer: &BasinExplorer) -> Vec<Table> {
    let truth = explorer.scene.truth();
    let iterations = explorer.run.trace.iter().enumerate().map(|(k, state)| {
        let pose = state.pose;
        vec![
            k.to_string(),
            state.pairs.to_string(),
            state.rmse.to_string(),
            error_m(&truth, &pose).to_string(),
            pose.x().to_string(),
            pose.y().to_string(),
            pose.theta().to_string(),
        ]
    });
    let columns = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
    vec![
        variants(explorer),
        Table {
            id: "iterations",
            title: "Every iteration".to_owned(),
            columns: columns(&[
                "iteration",
                "pairs",
                "rmse (m)",
                "error (m)",
                "x (m)",
                "y (m)",
                "theta (rad)",
            ]),
            rows: iterations.collect(),
            place: TablePlace::ExportOnly,
        },
        Table {
            id: "basins",
            title: "The minimum reached from every start".to_owned(),
            columns: columns(&[
                "heading (°)",
                "Δx (m)",
                "Δy (m)",
                "point to point",
                "point to plane",
            ]),
            rows: basin_rows(explorer),
            place: TablePlace::ExportOnly,
        },
    ]
}

/// One row a cell; a cell that is not computed yet is empty.
fn basin_rows(explorer: &BasinExplorer) -> Vec<Vec<String>> {
    let point = explorer.basins.map(IcpVariant::PointToPoint);
    let plane = explorer.basins.map(IcpVariant::PointToPlane);
    let cells = (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| (column, row)));
    cells
        .map(|(column, row)| {
            let start = point.axes().start(column, row);
            let name = |minimum: Option<Minimum>| minimum.map_or("", Minimum::name).to_owned();
            vec![
                start.heading_deg.to_string(),
                start.dx_m.to_string(),
                start.dy_m.to_string(),
                name(point.minimum(column, row)),
                name(plane.minimum(column, row)),
            ]
        })
        .collect()
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
        StopReason::TooFewPairs { .. } => "gave up for want of pairs after",
    }
}

fn iterations(count: usize) -> String {
    match count {
        1 => "1 iteration".to_owned(),
        count => format!("{count} iterations"),
    }
}
