//! The result in words and numbers.

use ch16_lab::basin::{BasinOutcome, Minimum};
use ch16_slam2d::search::{BoxFate, SearchGoal};
use pr_geom::SE2;
use widget_kit::model::{Assessment, Fact, Outcome};

use super::WholeWindow;

use crate::w16_6_whole_window::spec::HEADING;

/// The assessment of the result.
pub fn standing(window: &WholeWindow) -> Assessment {
    match (&window.search_task.found, window.refined()) {
        (None, _) => Assessment::Neutral,
        (_, Some(refined)) if refined.outcome.ending == Minimum::Right => Assessment::Good,
        _ => Assessment::Bad,
    }
}

/// The assessment of a registration.
pub fn standing_of(end: &BasinOutcome) -> Assessment {
    match end.ending {
        Minimum::Right => Assessment::Good,
        _ => Assessment::Bad,
    }
}

/// Where ICP stops, after "stops".
pub fn stop(end: &BasinOutcome) -> String {
    match end.ending {
        Minimum::Right => "at the truth".to_owned(),
        Minimum::NotConverged => "before it converged".to_owned(),
        Minimum::WrongHeading => "with a wrong heading".to_owned(),
        Minimum::Other => "in another false minimum".to_owned(),
        turn => format!("a {} off", turn.name()),
    }
}

/// The result in a few words.
pub fn verdict(window: &WholeWindow) -> &'static str {
    match (&window.search_task.found, window.refined()) {
        (None, _) => "searching",
        (_, None) => "no place fits",
        (_, Some(refined)) => match refined.outcome.ending {
            Minimum::Right => "the search finds the truth",
            other => other.name(),
        },
    }
}

pub fn outcome(window: &WholeWindow) -> Outcome {
    let counts = window.search_task.window.search().counts();
    let alone = &window.search_task.alone.outcome;
    let start = format!(
        "From {:.0}° off, ICP alone ends {}",
        window.values.get(&HEADING),
        stop(alone)
    );
    let but = if alone.ending == Minimum::Right {
        "and"
    } else {
        "but"
    };
    let work = format!(
        "{} scores settle {} poses",
        grouped(counts.scored()),
        grouped(counts.window)
    );
    let result = window.search_task.window.result();
    let answer = match (&window.search_task.found, window.refined(), &result) {
        (Some(_), Some(refined), Some(result)) => {
            let ahead = result.margin().map_or(String::new(), |margin| {
                format!(", {margin:.3} ahead of the next place")
            });
            format!(
                "{start}, {but} {work}. The best pose scores {:.3}{ahead}, and ICP from there ends {}.",
                result.best.score,
                ending(&refined.outcome)
            )
        }
        (Some(_), ..) => format!("{start}, {but} {work}: none of them fits half the points."),
        // As long as the text that follows, so that the page below does not move.
        (None, ..) => format!(
            "The search splits the box of poses with the largest bound, and drops every box whose bound is below the best score. Then ICP starts from the best pose. {start}."
        ),
    };
    Outcome {
        standing: standing(window),
        verdict: verdict(window).to_owned(),
        sentence: answer,
        facts: facts(window),
    }
}

fn facts(window: &WholeWindow) -> Vec<Fact> {
    let counts = window.search_task.window.search().counts();
    let found = window.search_task.found.as_ref();
    let result = window
        .search_task
        .window
        .result()
        .filter(|_| found.is_some());
    let or_none = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let end = window.refined().map(|refined| &refined.outcome);
    let alone = &window.search_task.alone.outcome;
    let best = result.map(|result| result.best);
    let behind = |turns: &[usize]| {
        let rivals = turns.iter().filter_map(|&k| found?.rivals[k]);
        let score = rivals.map(|rival| rival.score).reduce(f64::max);
        or_none(best.zip(score).map(|(best, score)| best.score - score))
    };
    vec![
        Fact::metres(
            "error_m",
            "position error at the end",
            or_none(end.map(|e| e.error_m)),
        ),
        Fact::new(
            "error_deg",
            "heading error at the end",
            or_none(end.map(|e| e.error_deg)),
            "°",
            1,
        ),
        Fact::metres("icp_error_m", "position error of ICP alone", alone.error_m),
        Fact::new(
            "icp_error_deg",
            "heading error of ICP alone",
            alone.error_deg,
            "°",
            1,
        ),
        Fact::new(
            "score",
            "score of the best pose",
            or_none(best.map(|b| b.score)),
            "",
            3,
        ),
        Fact::new(
            "margin",
            "margin over the next place",
            or_none(result.and_then(|result| result.margin())),
            "",
            3,
        ),
        Fact::new(
            "quarter_behind",
            "margin over the quarter turn",
            behind(&[0, 1]),
            "",
            3,
        ),
        Fact::new(
            "half_behind",
            "margin over the half turn",
            behind(&[2]),
            "",
            3,
        ),
        Fact::count("scored", "scores computed", counts.scored() as f64),
        Fact::count("window", "poses in the window", counts.window as f64),
        Fact::new(
            "fewer",
            "times fewer",
            counts.window as f64 / counts.scored() as f64,
            "",
            0,
        ),
    ]
}

pub fn summary(window: &WholeWindow) -> String {
    let moments = window.search_task.window.moments();
    let moment = &moments[window.step()];
    let best = moment.best.map_or("no pose yet".to_owned(), |best| {
        format!("the best pose so far scores {:.3}", best.score)
    });
    let waiting = waiting(window);
    format!(
        "Two laser sweeps of one room, and a window of {} poses at {} headings. After {} boxes, {waiting} wait; {best}.",
        moment.counts.window,
        window.search_task.window.search().headings(),
        window.step()
    )
}

/// Number of open boxes at the current position.
pub fn waiting(window: &WholeWindow) -> usize {
    let boxes = window.search_task.window.boxes().iter();
    boxes.filter(|seen| seen.waits_after(window.step())).count()
}

/// The current position in words.
pub fn now(window: &WholeWindow) -> String {
    if let Some(k) = window.refining().filter(|k| *k > 0) {
        return format!("ICP from there, step {k}");
    }
    let search = &window.search_task.window;
    let moment = &search.moments()[window.step()];
    let Some(taken) = moment.taken else {
        return "Before the search: the start".to_owned();
    };
    let seen = &search.boxes()[taken];
    let became = match seen.fate {
        Some(BoxFate::Split { parts }) => format!("split into {parts}"),
        Some(BoxFate::Best) => "a pose, the best so far".to_owned(),
        Some(BoxFate::SamePlace) => "the same place as the best".to_owned(),
        Some(BoxFate::Pruned) | None => "dropped".to_owned(),
    };
    let goal = match moment.goal {
        SearchGoal::Best => "",
        SearchGoal::RunnerUp => ", for the runner-up",
    };
    format!(
        "Box {} of {}{goal}: {became}",
        window.step(),
        window.boxes_taken()
    )
}

/// Error of a heading, degrees.
pub fn heading_error_deg(window: &WholeWindow, heading_rad: f64) -> f64 {
    let turn = SE2::new(0.0, 0.0, heading_rad - window.scene.truth().theta());
    turn.theta().to_degrees()
}

/// A whole number in groups of three digits: `1,652,124`.
pub fn grouped(number: u64) -> String {
    let (rest, group) = (number / 1000, number % 1000);
    if rest == 0 {
        return group.to_string();
    }
    format!("{},{group:03}", grouped(rest))
}

fn ending(end: &BasinOutcome) -> String {
    let off = format!("{:.2} m and {:.1}° off", end.error_m, end.error_deg.abs());
    match end.ending {
        Minimum::Right => format!("at the truth, {off}"),
        Minimum::Other => format!("in another false minimum, {off}"),
        Minimum::NotConverged => format!("before it converged, {off}"),
        Minimum::WrongHeading => format!("at the right place with a wrong heading, {off}"),
        turn => format!("in the {}, {off}", turn.name()),
    }
}
