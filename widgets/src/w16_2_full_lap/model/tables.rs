//! The tables: this run beside the canonical one, the loops, and the data of every plot.
//!
//! They end at the last tick that is shown.

use ch16_lab::lap::{
    LapSummary, RecordedEdge, RecordedLoopAttempt, RecordedLoopEffect, edge_strain,
};
use ch16_slam2d::loops::LoopRejection;
use widget_kit::model::{Table, TablePlace};

use super::moment::LapState;
use super::pick::GraphPart;
use super::picture::part_of;
use super::runs::{ResultsTable, Runs};
use super::texts::{ends, model_name};

/// The tables beside the picture.
pub fn shown(runs: &Runs, seen: usize, canonical: &[ResultsTable]) -> Vec<Table> {
    let when = |last: usize| {
        if seen < last {
            format!("after tick {seen}")
        } else {
            "at the end".to_owned()
        }
    };
    let chapters_last = canonical.len() - 1;
    vec![
        results(
            "run",
            format!("This run {}", when(runs.ticks())),
            &runs.results_at(seen),
        ),
        results(
            "canonical",
            format!("The chapter's run {}", when(chapters_last)),
            &canonical[seen.min(chapters_last)],
        ),
        loops(runs, seen),
    ]
}

/// All tables, the shown ones first.
pub fn all(runs: &Runs, seen: usize, canonical: &[ResultsTable]) -> Vec<Table> {
    let mut tables = shown(runs, seen, canonical);
    tables.extend([
        loop_attempts(runs, seen),
        over_time(runs, seen),
        keyframes(runs, seen),
        walls(runs),
        map(runs, seen),
    ]);
    tables
}

fn results(id: &'static str, title: String, results: &ResultsTable) -> Table {
    let ResultsTable { front_end, graph } = results;
    let keyframes = |name: &str, of: fn(&LapSummary) -> String| {
        vec![name.to_owned(), String::new(), of(front_end), of(graph)]
    };
    let with_odometry = |name: &str, odometry: f64, of: fn(&LapSummary) -> f64| {
        vec![
            name.to_owned(),
            metres(odometry),
            metres(of(front_end)),
            metres(of(graph)),
        ]
    };
    Table {
        id,
        title,
        columns: vec![
            "error in m".to_owned(),
            "odometry".to_owned(),
            "front end".to_owned(),
            match graph.loops {
                1 => "+ 1 loop".to_owned(),
                loops => format!("+ {loops} loops"),
            },
        ],
        rows: vec![
            with_odometry("newest keyframe", graph.odometry_end_error_m, |lap| {
                lap.keyframe_end_error_m
            }),
            with_odometry("rms", graph.odometry_rms_m, |lap| lap.keyframe_rms_m),
            keyframes("last nine keyframes", |lap| {
                let (least, most) = lap.last_keyframes_m;
                format!("{least:.2}–{most:.2}")
            }),
            keyframes("largest", |lap| format!("{:.2}", lap.keyframe_max_m)),
            keyframes("map disagreement", |lap| {
                metres(lap.map_disagreement_m.unwrap_or(f64::NAN))
            }),
        ],
        place: TablePlace::Shown,
    }
}

fn loops(runs: &Runs, seen: usize) -> Table {
    let head = [
        "loop",
        "χ² path",
        "χ² exact",
        "rmse (m)",
        "moved (m)",
        "verdict",
    ];
    let row = |attempt: &RecordedLoopAttempt| {
        let loop_ = &attempt.verification;
        let gates = runs.gates(attempt);
        let moved = attempt.effect.map(|effect| effect.max_shift_m);
        vec![
            ends(attempt),
            format!("{:.3}", gates.path.test.chi2),
            format!("{:.3}", gates.exact.test.chi2),
            format!("{:.3}", loop_.rmse_m),
            moved.map_or("–".to_owned(), |moved| format!("{moved:.3}")),
            verdict_with_reason(attempt).to_owned(),
        ]
    };
    Table::shown(
        "loops",
        format!(
            "Loops tried, {} gate χ² {:.3}",
            model_name(runs.loop_config().gate_model),
            runs.gate_chi2()
        ),
        &head,
        runs.attempts_until(seen).iter().map(row).collect(),
    )
}

/// All data of each attempt.
fn loop_attempts(runs: &Runs, seen: usize) -> Table {
    let head = [
        "tick",
        "new node",
        "old node",
        "χ²",
        "gate χ²",
        "χ² path",
        "χ² exact",
        "rmse (m)",
        "pairs",
        "off the truth (m)",
        "off the truth (°)",
        "moved (m)",
        "keyframe rms before (m)",
        "keyframe rms after (m)",
        "verdict",
    ];
    let row = |attempt: &RecordedLoopAttempt| {
        let loop_ = &attempt.verification;
        let gates = runs.gates(attempt);
        let error = runs.graph.lap().loop_error(attempt);
        let effect = |of: fn(&RecordedLoopEffect) -> f64| {
            exact(attempt.effect.as_ref().map_or(f64::NAN, of))
        };
        vec![
            attempt.tick.to_string(),
            loop_.from_node.to_string(),
            loop_.candidate.node.to_string(),
            exact(loop_.gate.chi2),
            exact(loop_.gate.gate_chi2),
            exact(gates.path.test.chi2),
            exact(gates.exact.test.chi2),
            exact(loop_.rmse_m),
            loop_.inliers.to_string(),
            exact(error.position_m),
            exact(error.heading_deg),
            effect(|effect| effect.max_shift_m),
            effect(|effect| effect.keyframe_rms_m.before),
            effect(|effect| effect.keyframe_rms_m.after),
            verdict_with_reason(attempt).to_owned(),
        ]
    };
    Table::exported(
        "loop-attempts",
        "Loops tried",
        &head,
        runs.attempts_until(seen).iter().map(row).collect(),
    )
}

fn verdict_with_reason(attempt: &RecordedLoopAttempt) -> &'static str {
    match attempt.verification.rejection {
        None if attempt.verification.waits.is_some() => "waits for others",
        None => "accepted",
        Some(LoopRejection::PoorFit { .. }) => "rejected: rmse",
        Some(LoopRejection::FewInliers { .. }) => "rejected: pairs",
        Some(LoopRejection::LowScore { .. }) => "rejected: score",
        Some(LoopRejection::NoPlace { .. }) => "rejected: no place",
        Some(LoopRejection::Ambiguous { .. }) => "rejected: ambiguous",
        Some(LoopRejection::OutsideGate(_)) => "rejected: χ²",
        Some(LoopRejection::NoCovariance(_)) => "rejected: no covariance",
        Some(
            LoopRejection::Outlier
            | LoopRejection::OptimizationFailed(_)
            | LoopRejection::CostRose { .. },
        ) => "taken back",
    }
}

fn over_time(runs: &Runs, seen: usize) -> Table {
    let head = [
        "tick",
        "odometry error (m)",
        "front end error (m)",
        "pose graph error (m)",
        "front end keyframe rms (m)",
        "pose graph keyframe rms (m)",
        "front end map disagreement (m)",
        "pose graph map disagreement (m)",
    ];
    let row = |tick: usize| {
        let columns = [
            runs.odometry_errors_m[tick],
            runs.front_end.errors_m[tick],
            runs.graph.errors_m[tick],
            runs.front_end.keyframe_rms_m[tick],
            runs.graph.keyframe_rms_m[tick],
            runs.front_end.disagreement_m[tick],
            runs.graph.disagreement_m[tick],
        ];
        let cells = columns.into_iter().map(exact);
        core::iter::once(tick.to_string()).chain(cells).collect()
    };
    Table::exported(
        "errors-over-time",
        "Errors over time",
        &head,
        (0..=seen).map(row).collect(),
    )
}

fn keyframes(runs: &Runs, seen: usize) -> Table {
    let head = [
        "node",
        "tick",
        "true x (m)",
        "true y (m)",
        "x (m)",
        "y (m)",
        "heading (rad)",
    ];
    let poses = runs.graph.poses_at(seen);
    let row = |(node, pose): (usize, &pr_geom::SE2)| {
        let tick = runs.graph.keyframe_tick(node);
        let truth = runs.truth(tick);
        let columns = [truth.x(), truth.y(), pose.x(), pose.y(), pose.theta()];
        let cells = columns.into_iter().map(exact);
        [node.to_string(), tick.to_string()]
            .into_iter()
            .chain(cells)
            .collect()
    };
    Table::exported(
        "keyframes",
        format!("Keyframes after tick {seen}"),
        &head,
        poses.iter().enumerate().map(row).collect(),
    )
}

fn walls(runs: &Runs) -> Table {
    let row = |wall: &pr_sim::Wall| {
        let ends = [wall.start.x, wall.start.y, wall.end.x, wall.end.y];
        ends.map(exact).to_vec()
    };
    Table::exported(
        "walls",
        "The true walls",
        &["from x (m)", "from y (m)", "to x (m)", "to y (m)"],
        runs.world().walls().iter().map(row).collect(),
    )
}

/// The points of every keyframe's scan at the keyframe's pose.
fn map(runs: &Runs, seen: usize) -> Table {
    let poses = runs.graph.poses_at(seen);
    let points = poses.iter().enumerate().flat_map(|(node, pose)| {
        let row =
            move |[x, y]: [f64; 2]| vec![node.to_string(), format!("{x:.3}"), format!("{y:.3}")];
        runs.sweep_at(node, *pose).map(row)
    });
    Table::exported(
        "map",
        format!("The map after tick {seen}"),
        &["node", "x (m)", "y (m)"],
        points.collect(),
    )
}

/// Every edge of the graph at the current tick.
pub fn edges(moment: &LapState) -> Table {
    let head = [
        "from node",
        "to node",
        "kind",
        "χ²",
        "left ahead (m)",
        "left aside (m)",
        "left turn (rad)",
    ];
    let row = |edge: &RecordedEdge| {
        let strain = edge_strain(edge, &moment.nodes);
        let kind = match part_of(moment, edge) {
            GraphPart::Own => "your loop",
            GraphPart::Loop(_) => "loop",
            GraphPart::Edge(_) | GraphPart::Keyframe(_) => "odometry",
        };
        let numbers = [
            strain.chi2,
            strain.residual.x,
            strain.residual.y,
            strain.residual.z,
        ];
        [edge.from.to_string(), edge.to.to_string(), kind.to_owned()]
            .into_iter()
            .chain(numbers.map(exact))
            .collect()
    };
    Table::exported(
        "edges",
        format!("Edges after tick {}", moment.tick),
        &head,
        moment.edges_with_own().map(row).collect(),
    )
}

/// Four digits, like the chapter's table; a dash if there is no value.
fn metres(value: f64) -> String {
    if value.is_finite() {
        format!("{value:.4}")
    } else {
        "–".to_owned()
    }
}

/// All digits; empty if there is no value.
fn exact(value: f64) -> String {
    if value.is_finite() {
        value.to_string()
    } else {
        String::new()
    }
}
