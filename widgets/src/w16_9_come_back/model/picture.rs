//! The panels: the map with the localization, and the scores over the scans.

use ch16_slam2d::search::PoseBox;
use kit::scene::{Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight};
use pr_geom::SE2;

use super::hands::turn_handle;
use super::words::now;
use super::{ComeBack, panel};
use crate::w16_9_come_back::spec::PLAN_M;

pub fn scene(back: &ComeBack) -> Scene {
    Scene {
        panels: vec![map(back), scores(back)],
    }
}

fn map(back: &ComeBack) -> Panel {
    let mut layers = Vec::new();
    if let Some(known) = &back.known {
        let walls = known.tomorrow.world.walls().iter();
        layers.push(Layer::segments(
            walls
                .map(|wall| [[wall.start.x, wall.start.y], [wall.end.x, wall.end.y]])
                .collect(),
            Stroke::Solid,
            Tone::Faint,
            3.0,
        ));
        let points = known.map.points().iter().map(|p| [p.x, p.y]).collect();
        layers.push(Layer::points(points, Mark::Dot, Tone::Ink, 1.4));
    }
    layers.extend(localization(back));
    let start = back.start();
    let turn = turn_handle(&start);
    layers.extend([
        Layer::segments(
            vec![[[start.x(), start.y()], [turn.x, turn.y]]],
            Stroke::Solid,
            Tone::Prior,
            1.5,
        ),
        Layer::Handle {
            at: [turn.x, turn.y],
            tone: Tone::Prior,
            label: "turn the robot; drag it to put it elsewhere",
        },
        pose(start, Mark::Circle, Tone::Prior),
    ]);
    if back.moment().is_none_or(|moment| moment.best.is_none()) {
        // Nobody has told the robot where it is.
        layers.push(Layer::label([start.x(), start.y()], "?".to_owned(), 10.0));
    }
    let axis = |most: f64| Axis::hidden(-0.5, most + 0.5);
    Panel {
        id: panel::MAP,
        title: now(back),
        weight: Weight::Main,
        aspect: Aspect::Equal,
        x: axis(PLAN_M[0]),
        y: axis(PLAN_M[1]),
        layers,
        legend: vec![
            LegendEntry::mark("the saved map", Tone::Ink, Mark::Dot),
            LegendEntry::mark("switched on here, to be put", Tone::Prior, Mark::Circle),
            LegendEntry::line("box that waits", Tone::Series(0), Stroke::Solid),
            LegendEntry::mark("best place, with the scan", Tone::Posterior, Mark::Square),
            LegendEntry::mark("next place", Tone::Series(1), Mark::Triangle),
            LegendEntry::mark("truth", Tone::Truth, Mark::Plus),
        ],
        color_bar: None,
    }
}

/// The localization at the current moment.
fn localization(back: &ComeBack) -> Vec<Layer> {
    let Some(((_, run), moment)) = back.finished().zip(back.moment()) else {
        return Vec::new();
    };
    let drive = run.drive();
    let truth = |tick: usize| drive.truth(tick);
    let way = (0..=moment.tick).map(|tick| [truth(tick).x(), truth(tick).y()]);
    let mut layers = vec![
        boxes(&moment.boxes),
        Layer::line(way.collect(), Stroke::Dashed, Tone::Truth, 1.5),
        pose(truth(moment.tick), Mark::Plus, Tone::Truth),
    ];
    if let Some(next) = moment.runner_up {
        layers.push(pose(next.pose, Mark::Triangle, Tone::Series(1)));
    }
    let finished = moment.report.as_ref().and_then(|report| report.pose);
    if let Some(best) = finished.or(moment.best.map(|best| best.pose)) {
        let scan = drive.prepared(moment.tick).cloud.transformed(&best);
        let points = scan.iter().map(|p| [p.x, p.y]).collect();
        layers.push(Layer::points(points, Mark::Square, Tone::Posterior, 2.0));
        layers.push(pose(best, Mark::Square, Tone::Posterior));
    }
    layers
}

fn pose(pose: SE2, mark: Mark, tone: Tone) -> Layer {
    Layer::pose(pose.to_array(), mark, tone, 6.0)
}

/// The outlines of boxes from above.
fn boxes(boxes: &[PoseBox]) -> Layer {
    let outline = |seen: &PoseBox| {
        let ([west, east], [south, north]) = (seen.x_m, seen.y_m);
        [
            [west, south],
            [east, south],
            [east, north],
            [west, north],
            [west, south],
            [f64::NAN; 2],
        ]
    };
    Layer::line(
        boxes.iter().flat_map(outline).collect(),
        Stroke::Solid,
        Tone::Series(0),
        1.0,
    )
}

fn scores(back: &ComeBack) -> Panel {
    let mut layers = Vec::new();
    let mut last = 40.0;
    if let Some((_, run)) = back.finished() {
        let reports = run.reports();
        last = (reports.len() as f64).max(2.0);
        let at = |tick: usize, score: f64| [tick as f64 + 1.0, score];
        let fits = reports.iter().enumerate().filter_map(|(tick, report)| {
            let is_told = report.verdict.is_localized();
            Some(at(tick, report.score.filter(|_| is_told)?))
        });
        let best = reports
            .iter()
            .enumerate()
            .filter_map(|(tick, report)| Some(at(tick, report.search?.best.score)));
        let next = reports
            .iter()
            .enumerate()
            .filter_map(|(tick, report)| Some(at(tick, report.runner_up()?.score)));
        let now = back.moment().map_or(1.0, |moment| moment.tick as f64 + 1.0);
        layers = vec![
            Layer::line(
                vec![[now, 0.0], [now, 1.04]],
                Stroke::Solid,
                Tone::Faint,
                2.0,
            ),
            Layer::line(fits.collect(), Stroke::Solid, Tone::Measurement, 1.75),
            Layer::points(next.collect(), Mark::Triangle, Tone::Series(1), 4.0),
            Layer::points(best.collect(), Mark::Square, Tone::Posterior, 4.0),
        ];
    }
    Panel {
        id: panel::SCORES,
        title: "How well the best place fits, and the next one".to_owned(),
        weight: Weight::Half,
        aspect: Aspect::Free,
        x: Axis::new("scan", 0.0, last + 1.0),
        y: Axis::new("score", 0.0, 1.04),
        layers,
        legend: vec![
            LegendEntry::mark("best place of a search", Tone::Posterior, Mark::Square),
            LegendEntry::mark("next place", Tone::Series(1), Mark::Triangle),
            LegendEntry::line(
                "scan that follows its place",
                Tone::Measurement,
                Stroke::Solid,
            ),
        ],
        color_bar: None,
    }
}
