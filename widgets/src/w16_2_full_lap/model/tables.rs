//! The tables: this run beside the canonical one, the loops, and the data of every plot.
//!
//! They end at the last tick that is shown.

use ch16_lab::lap::{LapSummary, RecordedLoopAttempt, edge_strain};
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
    let ResultsTable {
        front_end,
        graph,
        loops,
    } = results;
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
            match loops {
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
            verdict_with_reason(attempt),
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
    let error = |attempt| runs.graph.lap().loop_error(attempt);
    Table::of_items(
        "loop-attempts",
        "Loops tried",
        runs.attempts_until(seen),
        &[
            ("tick", &|tried| tried.tick.into()),
            ("new node", &|tried| tried.verification.from_node.into()),
            ("old node", &|tried| {
                tried.verification.candidate.node.into()
            }),
            ("χ²", &|tried| tried.verification.gate.chi2.into()),
            ("gate χ²", &|tried| {
                tried.verification.gate.gate_chi2.into()
            }),
            ("χ² path", &|tried| {
                runs.gates(tried).path.test.chi2.into()
            }),
            ("χ² exact", &|tried| {
                runs.gates(tried).exact.test.chi2.into()
            }),
            ("rmse (m)", &|tried| tried.verification.rmse_m.into()),
            ("pairs", &|tried| tried.verification.inliers.into()),
            ("off the truth (m)", &|tried| error(tried).position_m.into()),
            ("off the truth (°)", &|tried| {
                error(tried).heading_deg.into()
            }),
            ("moved (m)", &|tried| {
                tried.effect.map(|effect| effect.max_shift_m).into()
            }),
            ("keyframe rms before (m)", &|tried| {
                let rms_m = tried.effect.map(|effect| effect.keyframe_rms_m);
                rms_m.map(|rms_m| rms_m.before).into()
            }),
            ("keyframe rms after (m)", &|tried| {
                let rms_m = tried.effect.map(|effect| effect.keyframe_rms_m);
                rms_m.map(|rms_m| rms_m.after).into()
            }),
            ("verdict", &|tried| {
                verdict_with_reason(tried).as_str().into()
            }),
        ],
    )
}

fn verdict_with_reason(attempt: &RecordedLoopAttempt) -> String {
    match attempt.verification.rejection {
        None if attempt.verification.waits.is_some() => "waits for others".to_owned(),
        None => "accepted".to_owned(),
        Some(why) => format!("rejected: {}", why.name()),
    }
}

fn over_time(runs: &Runs, seen: usize) -> Table {
    let Runs {
        front_end, graph, ..
    } = runs;
    Table::of_items(
        "errors-over-time",
        "Errors over time",
        0..=seen,
        &[
            ("tick", &|&tick| tick.into()),
            ("odometry error (m)", &|&tick| {
                runs.odometry_errors_m[tick].into()
            }),
            ("front end error (m)", &|&tick| {
                front_end.errors_m[tick].into()
            }),
            ("pose graph error (m)", &|&tick| graph.errors_m[tick].into()),
            ("front end keyframe rms (m)", &|&tick| {
                front_end.keyframe_rms_m[tick].into()
            }),
            ("pose graph keyframe rms (m)", &|&tick| {
                graph.keyframe_rms_m[tick].into()
            }),
            ("front end map disagreement (m)", &|&tick| {
                front_end.disagreement_m[tick].into()
            }),
            ("pose graph map disagreement (m)", &|&tick| {
                graph.disagreement_m[tick].into()
            }),
        ],
    )
}

fn keyframes(runs: &Runs, seen: usize) -> Table {
    let poses = runs.graph.poses_at(seen);
    let keyframes = poses.iter().enumerate().map(|(node, pose)| {
        let tick = runs.graph.keyframe_tick(node);
        (node, tick, runs.truth(tick), pose)
    });
    Table::of_items(
        "keyframes",
        format!("Keyframes after tick {seen}"),
        keyframes,
        &[
            ("node", &|(node, ..)| (*node).into()),
            ("tick", &|(_, tick, ..)| (*tick).into()),
            ("true x (m)", &|(.., truth, _)| truth.x().into()),
            ("true y (m)", &|(.., truth, _)| truth.y().into()),
            ("x (m)", &|(.., pose)| pose.x().into()),
            ("y (m)", &|(.., pose)| pose.y().into()),
            ("heading (rad)", &|(.., pose)| pose.theta().into()),
        ],
    )
}

fn walls(runs: &Runs) -> Table {
    Table::of_items(
        "walls",
        "The true walls",
        runs.world().walls(),
        &[
            ("from x (m)", &|wall| wall.start.x.into()),
            ("from y (m)", &|wall| wall.start.y.into()),
            ("to x (m)", &|wall| wall.end.x.into()),
            ("to y (m)", &|wall| wall.end.y.into()),
        ],
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
    let kind = |edge| match part_of(moment, edge) {
        GraphPart::Own => "your loop",
        GraphPart::Loop(_) => "loop",
        GraphPart::Edge(_) | GraphPart::Keyframe(_) => "odometry",
    };
    let edges = moment.edges_with_own();
    Table::of_items(
        "edges",
        format!("Edges after tick {}", moment.tick),
        edges.map(|edge| (edge, edge_strain(edge, &moment.nodes))),
        &[
            ("from node", &|(edge, _)| edge.from.into()),
            ("to node", &|(edge, _)| edge.to.into()),
            ("kind", &|(edge, _)| kind(edge).into()),
            ("χ²", &|(_, strain)| strain.chi2.into()),
            ("residual ahead (m)", &|(_, strain)| {
                strain.residual.x.into()
            }),
            ("residual aside (m)", &|(_, strain)| {
                strain.residual.y.into()
            }),
            ("residual turn (rad)", &|(_, strain)| {
                strain.residual.z.into()
            }),
        ],
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
