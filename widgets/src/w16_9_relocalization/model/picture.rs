//! The panels: the map with the localization, and the scores over the scans.

use ch16_lab::laps::wardrobe_corners;
use ch16_lab::relocalization::Moment;
use ch16_slam2d::localize::LocalizeConfig;
use ch16_slam2d::search::PoseBox;
use pr_geom::{Point2, SE2};
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::interaction::turn_handle;
use super::texts::{Ending, now, so_far};
use super::{Relocalization, panel};
use crate::w16_9_relocalization::spec::PLAN_M;

/// Tone of the poses that are not ruled out.
const RING: Tone = Tone::Series(0);

pub fn scene(back: &Relocalization) -> Scene {
    Scene {
        panels: vec![map(back), scores(back)],
    }
}

fn map(back: &Relocalization) -> Panel {
    let mut layers = Vec::new();
    if let Some(known) = &back.known {
        let walls = known.tomorrow.world.walls().iter();
        let ends = walls.map(|wall| [[wall.start.x, wall.start.y], [wall.end.x, wall.end.y]]);
        layers.push(Layer::Walls(ends.collect()));
        let points = known.map.points().iter().map(|p| [p.x, p.y]).collect();
        layers.push(Layer::points(points, Mark::Dot, Tone::Ink, 1.4));
        if back.has_wardrobe() {
            layers.extend(wardrobe());
        }
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
    if !is_found(back) && back.place() == 0 {
        // Nobody has told the robot where it is.
        let at = [start.x(), start.y()];
        layers.push(Layer::label(at, "where am I?".to_owned(), 10.0));
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
            LegendEntry::mark("start, where it is switched on", Tone::Prior, Mark::Circle),
            LegendEntry::mark("it may be here", RING, Mark::Circle),
            LegendEntry::mark("best place, with the scan", Tone::Posterior, Mark::Square),
        ],
        color_bar: None,
    }
}

/// The localization at the current moment.
fn localization(back: &Relocalization) -> Vec<Layer> {
    let Some(((_, run), moment)) = back.finished().zip(back.moment()) else {
        return Vec::new();
    };
    let drive = run.drive();
    let truth = |tick: usize| drive.truth(tick);
    let way = (0..=moment.tick).map(|tick| [truth(tick).x(), truth(tick).y()]);
    let walls = drive.config().world.bounds();
    let inside = |seen: &&PoseBox| {
        let [x, y] = [seen.x_m, seen.y_m].map(middle);
        (walls.min.x..=walls.max.x).contains(&x) && (walls.min.y..=walls.max.y).contains(&y)
    };
    // The search window is a rectangle around the map, so its boxes reach beyond the walls.
    let mut layers = rings(moment.boxes.iter().filter(inside));
    layers.extend([
        Layer::line(way.collect(), Stroke::Dashed, Tone::Truth, 1.5),
        pose(truth(moment.tick), Mark::Plus, Tone::Truth),
    ]);
    // What the last search left in doubt stays until the next one has ended.
    let is_doubted = |earlier: &&Moment| earlier.report.is_some() && earlier.runner_up.is_some();
    let mut until_now = run.moments()[..=back.place()].iter().rev();
    let asked = until_now.find(is_doubted);
    let is_found = is_found(back);
    let asked = asked.filter(|_| !is_found).unwrap_or(moment);
    let scan = drive.prepared(asked.tick).cloud;
    let mut candidate = |at: SE2, mark, tone, words: &str| {
        let scan = scan.transformed(&at);
        let points = scan.iter().map(|p| [p.x, p.y]).collect();
        layers.push(Layer::points(points, mark, tone, 2.0));
        layers.push(pose(at, mark, tone));
        if !is_found {
            layers.push(Layer::label([at.x(), at.y()], words.to_owned(), 12.0));
        }
    };
    if let Some(next) = asked.runner_up {
        candidate(next.pose, Mark::Triangle, Tone::Series(1), "or here?");
    }
    let finished = asked.report.as_ref().and_then(|report| report.pose);
    if let Some(best) = finished.or(asked.best.map(|best| best.pose)) {
        candidate(best, Mark::Square, Tone::Posterior, "here?");
    }
    layers
}

/// Whether the robot knows its pose, rightly or wrongly, at the moment on screen.
fn is_found(back: &Relocalization) -> bool {
    matches!(so_far(back), Ending::Found | Ending::WrongPose)
}

fn pose(pose: SE2, mark: Mark, tone: Tone) -> Layer {
    Layer::pose(pose.to_array(), mark, tone, 6.0)
}

/// Number of sizes of the rings.
const SIZES: usize = 3;

fn middle([low, high]: [f64; 2]) -> f64 {
    0.5 * (low + high)
}

/// A ring in the middle of each place that has a box, the larger the higher its bound.
fn rings<'a>(boxes: impl Iterator<Item = &'a PoseBox> + Clone) -> Vec<Layer> {
    let bounds = boxes.clone().map(|seen| seen.bound);
    let low = bounds.clone().fold(f64::INFINITY, f64::min);
    let high = bounds.fold(f64::NEG_INFINITY, f64::max);
    let size_of = |seen: &PoseBox| {
        let share = (seen.bound - low) / (high - low).max(f64::MIN_POSITIVE);
        ((share * SIZES as f64) as usize).min(SIZES - 1)
    };
    // The most promising box of a place comes first; its other headings would be the same ring.
    let mut places: [Vec<[f64; 2]>; SIZES] = Default::default();
    for seen in boxes {
        let place = [seen.x_m, seen.y_m].map(middle);
        if !places.iter().flatten().any(|known| *known == place) {
            places[size_of(seen)].push(place);
        }
    }
    let sized = places.into_iter().zip(0_u8..);
    sized
        .map(|(places, size)| {
            Layer::points(places, Mark::Circle, RING, 3.0 + 2.0 * f32::from(size))
        })
        .collect()
}

/// The wardrobe where the map has it, and where it stands now.
fn wardrobe() -> Vec<Layer> {
    let outline = |corners: [Point2<f64>; 4]| {
        let closed = corners.iter().chain([&corners[0]]);
        closed
            .map(|corner| [corner.x, corner.y])
            .collect::<Vec<_>>()
    };
    let [before, now] = wardrobe_corners().map(outline);
    let label = |points: &[[f64; 2]], text: &str| {
        Layer::label([points[0][0] + 0.35, points[2][1]], text.to_owned(), 4.0)
    };
    vec![
        label(&before, "wardrobe yesterday"),
        label(&now, "wardrobe today"),
        Layer::line(before, Stroke::Dotted, Tone::Ink, 2.0),
        Layer::line(now, Stroke::Solid, Tone::Ink, 2.5),
    ]
}

fn scores(back: &Relocalization) -> Panel {
    let mut layers = Vec::new();
    let mut last = 40.0;
    if let Some((_, run)) = back.finished() {
        let reports = run.reports();
        last = (reports.len() as f64).max(2.0);
        // Scans of later moments are not yet taken.
        let taken = back.moment().map_or(0, |moment| {
            moment.tick + usize::from(moment.report.is_some())
        });
        let reports = &reports[..taken];
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
    let found = LocalizeConfig::default().found_score;
    layers.push(Layer::line(
        vec![[0.0, found], [last + 1.0, found]],
        Stroke::Dashed,
        Tone::Ink,
        1.25,
    ));
    if back.place() == 0 {
        layers = vec![Layer::Question(
            "Which place fits, and how well?".to_owned(),
        )];
    }
    Panel {
        id: panel::SCORES,
        title: "Fit of the two best places".to_owned(),
        weight: Weight::Half,
        aspect: Aspect::Free,
        x: Axis::new("scan", 0.0, last + 1.0),
        y: Axis::new("score", 0.0, 1.04),
        layers,
        legend: vec![
            LegendEntry::mark("best place of a search", Tone::Posterior, Mark::Square),
            LegendEntry::mark("next place", Tone::Series(1), Mark::Triangle),
            LegendEntry::line("tracks its pose", Tone::Measurement, Stroke::Solid),
            LegendEntry::line("fits well enough", Tone::Ink, Stroke::Dashed),
        ],
        color_bar: None,
    }
}
