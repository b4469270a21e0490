//! The result in words and numbers.

use ch16_lab::relocalization::{LocalizationRun, Moment};
use ch16_slam2d::localize::Verdict;
use widget_kit::model::{Assessment, Fact, Outcome};

use super::Relocalization;

/// A pose with a larger error counts as wrong, m.
const WRONG_POSE_M: f64 = 0.5;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    Computing,
    Unknown,
    Found,
    WrongPose,
    Ambiguous,
    Lost,
}

/// What is known at the moment on screen.
pub fn so_far(back: &Relocalization) -> Ending {
    match back.finished() {
        None => Ending::Computing,
        Some((_, run)) if back.place() < back.decided(run) => Ending::Unknown,
        Some((_, run)) => ending(run),
    }
}

/// How a run ends.
pub fn ending(run: &LocalizationRun) -> Ending {
    let ticks = 0..run.reports().len();
    let is_localized = |tick: &usize| run.reports()[*tick].verdict.is_localized();
    let is_off = |tick: usize| run.error_m(tick).is_some_and(|m| m > WRONG_POSE_M);
    if ticks.clone().filter(is_localized).any(is_off) {
        return Ending::WrongPose;
    }
    match run.found() {
        Some(_) => Ending::Found,
        None if run.reports().iter().any(|report| report.search.is_some()) => Ending::Ambiguous,
        None => Ending::Lost,
    }
}

/// Good is a localized robot.
pub fn standing(ending: Ending) -> Assessment {
    match ending {
        Ending::Computing | Ending::Unknown | Ending::Ambiguous | Ending::Lost => {
            Assessment::Neutral
        }
        Ending::Found => Assessment::Good,
        Ending::WrongPose => Assessment::Bad,
    }
}

/// The run in a few words.
pub fn verdict(ending: Ending) -> &'static str {
    match ending {
        Ending::Unknown => "where am I?",
        Ending::Computing => "a lap is driven",
        Ending::Found => "found",
        Ending::WrongPose => "in the wrong place",
        Ending::Ambiguous => "places look alike",
        Ending::Lost => "lost",
    }
}

pub fn outcome(back: &Relocalization) -> Outcome {
    let ending = so_far(back);
    let sentence = match (ending, back.finished()) {
        (Ending::Unknown, _) => "The robot is switched on, but not told where. It compares what it sees with the whole saved map. Each ring is a candidate place, and rings that cannot win disappear.".to_owned(),
        (Ending::Found, Some((_, run))) => found_words(run),
        (Ending::WrongPose, _) => "The robot is localized at a wrong pose, and drives on. It takes only a place that looks the same, and no later scan to contradict it.".to_owned(),
        (Ending::Ambiguous, Some((_, run))) => format!(
            "After {} scans the two best places on the map still fit about equally well. The robot reports that it is unsure. A different path or heading would resolve it.",
            run.reports().len()
        ),
        (Ending::Lost, Some((_, run))) => format!(
            "After {} scans no place on the map fits well enough. The robot reports that it is lost, because what it sees is not on the saved map.",
            run.reports().len()
        ),
        // As long as the text that follows, so that the page below does not move.
        _ => "A lap is driven and its map is saved. On another day, the robot is switched on where you put it, and searches the whole map for its pose, box by box.".to_owned(),
    };
    Outcome {
        standing: standing(ending),
        verdict: verdict(ending).to_owned(),
        sentence,
        facts: facts(back),
    }
}

fn found_words(run: &LocalizationRun) -> String {
    let found = run.found().unwrap_or_default();
    let report = &run.reports()[found];
    let margin = match report.margin() {
        Some(margin) => format!("the next place was {margin:.2} behind"),
        None => "no other place came near".to_owned(),
    };
    let scans = match found {
        0 => "at the first scan".to_owned(),
        more => format!("after {} scans", more + 1),
    };
    format!(
        "Found {scans}, {:.2} m from the truth: {margin}. Then {} of {} scans track it, each registered on the map around it.",
        run.error_m(found).unwrap_or(f64::NAN),
        localized_after(run, found),
        run.reports().len() - found - 1
    )
}

fn localized_after(run: &LocalizationRun, found: usize) -> usize {
    let after = run.reports()[found + 1..].iter();
    after.filter(|report| report.verdict.is_localized()).count()
}

fn facts(back: &Relocalization) -> Vec<Fact> {
    let finished = back.finished();
    let run = finished.map(|(_, run)| run);
    let known = finished.map(|(known, _)| known);
    let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let found = run.and_then(LocalizationRun::found);
    let searches = run.into_iter().flat_map(LocalizationRun::reports);
    let first = searches.filter_map(|report| report.search).next();
    let error_at = |tick: Option<usize>| number(run.zip(tick).and_then(|(m, k)| m.error_m(k)));
    let last = run.and_then(|run| run.reports().len().checked_sub(1));
    vec![
        Fact::count(
            "scans",
            "scans until found",
            number(found.map(|k| k as f64 + 1.0)),
        ),
        Fact::metres(
            "found_error_m",
            "position error when found",
            error_at(found),
        ),
        Fact::metres("end_error_m", "position error at the end", error_at(last)),
        Fact::new(
            "first_score",
            "best place's score, first search",
            number(first.map(|f| f.best.score)),
            "",
            3,
        ),
        Fact::new(
            "first_margin",
            "margin over the next place",
            number(first.and_then(|f| f.margin())),
            "",
            3,
        ),
        Fact::count(
            "scored",
            "scores computed, first search",
            number(first.map(|f| f.counts.scored() as f64)),
        ),
        Fact::count(
            "window",
            "poses on the whole map",
            number(first.map(|f| f.counts.window as f64)),
        ),
        Fact::count(
            "keyframes",
            "keyframes of the map",
            number(known.map(|k| k.map.keyframes().len() as f64)),
        ),
        Fact::metres(
            "map_rms_m",
            "the map's own error",
            number(known.map(|k| k.numbers.map_rms_m)),
        ),
        Fact::count(
            "wardrobe_points",
            "points where the wardrobe stood",
            number(known.map(|k| k.numbers.wardrobe_points as f64)),
        ),
    ]
}

pub fn summary(back: &Relocalization) -> String {
    let Some((known, _)) = back.finished() else {
        return "A lap is driven, and its map is saved.".to_owned();
    };
    let start = back.start();
    format!(
        "A saved map of {} keyframes, and a robot that is switched on at {:.1} m, {:.1} m. {}.",
        known.map.keyframes().len(),
        start.x(),
        start.y(),
        now(back)
    )
}

/// The current moment in words.
pub fn now(back: &Relocalization) -> String {
    let Some(moment) = back.moment() else {
        let is_saved = back.known.is_some();
        let state = if is_saved {
            "The robot is switched on"
        } else {
            "The lap is driven and its map saved"
        };
        return state.to_owned();
    };
    let Moment {
        tick,
        counts,
        report,
        ..
    } = moment;
    match (report, counts) {
        (Some(report), _) => {
            let state = match report.verdict {
                Verdict::Found => "found",
                Verdict::Tracking => "tracks its pose",
                Verdict::Doubtful => "in doubt",
                Verdict::Lost => "lost",
            };
            format!("Scan {}: {state}", tick + 1)
        }
        (None, Some(counts)) => format!(
            "Scan {}: searching, {} scores computed",
            tick + 1,
            counts.scored()
        ),
        (None, None) => format!("Scan {}", tick + 1),
    }
}
