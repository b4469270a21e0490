//! The result in words and numbers.

use ch16_lab::lap::NamedChoice;
use ch16_lab::places::GRADED;
use widget_kit::model::{Assessment, Fact, Outcome};

use super::PlaceRecognition;
use super::lap::{DetectorCounts, Places};
use super::settings::distance_label;

/// The grade of the selected detector.
fn grade(been: &PlaceRecognition) -> Option<(&Places, DetectorCounts)> {
    let places = been.places.as_ref().filter(|_| been.work.is_none())?;
    let detector = been.detector();
    Some((places, places.graded_at(detector, been.threshold(detector))))
}

/// Good is a threshold without a false pair.
pub fn standing(been: &PlaceRecognition) -> Assessment {
    match grade(been) {
        None => Assessment::Neutral,
        Some((_, grade)) if grade.called == 0 => Assessment::Neutral,
        Some((_, grade)) if grade.right == grade.called => Assessment::Good,
        Some(_) => Assessment::Bad,
    }
}

/// The grade in a few words.
pub fn verdict(been: &PlaceRecognition) -> &'static str {
    match grade(been) {
        None => "driving",
        Some((_, DetectorCounts { called: 0, .. })) => "no pair is called the same",
        Some((_, grade)) if grade.right == grade.called => "no false pair",
        Some((_, grade)) if 2 * grade.right >= grade.called => "some pairs are false",
        Some(_) => "most pairs are false",
    }
}

pub fn outcome(been: &PlaceRecognition) -> Outcome {
    let sentence = match grade(been) {
        // As long as the text that follows, so that the page below does not move.
        None => "The lap is driven, and its keyframes are compared pair by pair: which show the same place, according to nearness, range histograms and Scan Context. Then every threshold is graded against the truth, alongside a guess and a perfect detector."
            .to_owned(),
        Some((places, grade)) => {
            let called = format!(
                "With {}, {} pairs are called the same place, and {} of them are; {} are missed.",
                GRADED[been.detector()].label(),
                grade.called,
                grade.right,
                grade.same - grade.right
            );
            let beside = match grade.point(0.0) {
                Some(point) => format!(
                    " That is a precision of {:.2}, against {:.2} for a guess and {:.2} for a perfect detector.",
                    point.precision,
                    places.chance(),
                    places.perfect(grade.called)
                ),
                None => String::new(),
            };
            format!("{called}{beside} {}", pair_words(been))
        }
    };
    Outcome {
        standing: standing(been),
        verdict: verdict(been).to_owned(),
        sentence,
        facts: facts(been),
    }
}

/// The selected pair by its names.
pub fn pair_title(been: &PlaceRecognition) -> String {
    been.pair().map_or_else(
        // As high as the title that follows.
        || "Two places of the lap".to_owned(),
        |[old, new]| format!("The views of keyframes {old} and {new}"),
    )
}

/// The selected pair, and what the detector makes of it.
fn pair_judged(been: &PlaceRecognition) -> String {
    let judged = been.places.as_ref().zip(been.pair());
    let judged = judged.and_then(|(places, [old, new])| {
        let pair = places.study.pair(old, new)?;
        Some((pair, places.study.is_loop(pair.nodes)))
    });
    let Some((pair, is_loop)) = judged else {
        return String::new();
    };
    let detector = been.detector();
    let is_called = pair.distances[detector] <= been.threshold(detector);
    let judged = match (is_called, pair.is_same) {
        _ if !is_loop => "are neighbours in time",
        (true, true) => "are rightly called the same",
        (true, false) => "are wrongly called the same",
        (false, true) => "are the same place, but missed",
        (false, false) => "are rightly told apart",
    };
    let [old, new] = pair.nodes;
    format!("Keyframes {old} and {new} {judged}")
}

/// The selected pair, in a sentence.
fn pair_words(been: &PlaceRecognition) -> String {
    let pair = been.places.as_ref().zip(been.pair());
    let pair = pair.and_then(|(places, [old, new])| places.study.pair(old, new));
    pair.map_or_else(String::new, |pair| {
        let distance = pair.distances[been.detector()];
        format!("{}: distance {distance:.2}.", pair_judged(been))
    })
}

fn facts(been: &PlaceRecognition) -> Vec<Fact> {
    let graded = grade(been);
    let point = |detector: usize| {
        let (places, _) = graded?;
        let threshold = been.threshold(detector);
        places.graded_at(detector, threshold).point(threshold)
    };
    let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let pair = been.places.as_ref().zip(been.pair());
    let distances = pair.and_then(|(places, [old, new])| places.study.pair(old, new));
    let turn = pair.map(|(places, [old, new])| places.study.turned(old, new).turn_rad);
    let curve = |detector: usize| graded.map(|(places, _)| &places.curves[detector]);
    let ids = [
        ("nearby_precision", "nearby_recall", "nearby_area"),
        ("histogram_precision", "histogram_recall", "histogram_area"),
        ("context_precision", "context_recall", "context_area"),
    ];
    let labels = [
        (
            "nearness: precision",
            "nearness: recall",
            "nearness: area below the curve",
        ),
        (
            "ranges: precision",
            "ranges: recall",
            "ranges: area below the curve",
        ),
        (
            "Scan Context: precision",
            "Scan Context: recall",
            "Scan Context: area below the curve",
        ),
    ];
    let mut facts = Vec::new();
    for (detector, (id, label)) in ids.into_iter().zip(labels).enumerate() {
        let at = point(detector);
        let area = curve(detector).map(|curve| curve.average_precision);
        facts.extend([
            Fact::new(id.0, label.0, number(at.map(|at| at.precision)), "", 2),
            Fact::new(id.1, label.1, number(at.map(|at| at.recall)), "", 2),
            Fact::new(id.2, label.2, number(area), "", 2),
        ]);
    }
    let threshold = graded.map(|_| been.threshold(been.detector()));
    facts.extend([
        Fact::new(
            "threshold",
            distance_label(been.detector()),
            number(threshold.filter(|threshold| *threshold >= 0.0)),
            "",
            3,
        ),
        Fact::new(
            "pair_histogram",
            "the pair: range distance",
            number(distances.map(|pair| pair.distances[1])),
            "",
            3,
        ),
        Fact::new(
            "pair_context",
            "the pair: context distance",
            number(distances.map(|pair| pair.distances[2])),
            "",
            3,
        ),
        Fact::new(
            "pair_turn_deg",
            "the pair: Scan Context rotation",
            number(turn.map(f64::to_degrees)),
            "°",
            0,
        ),
        Fact::new(
            "chance_precision",
            "a guess: precision",
            number(graded.map(|(places, _)| places.chance())),
            "",
            2,
        ),
        Fact::new(
            "perfect_precision",
            "a perfect detector: precision",
            number(graded.map(|(places, grade)| places.perfect(grade.called))),
            "",
            2,
        ),
        Fact::count("graded", "pairs graded", {
            number(graded.map(|(places, _)| places.study.graded().count() as f64))
        }),
        Fact::count(
            "same",
            "pairs that are the same place",
            number(graded.map(|(places, _)| places.same as f64)),
        ),
    ]);
    facts
}

pub fn summary(been: &PlaceRecognition) -> String {
    let Some(places) = &been.places else {
        return "A lap is driven; then its keyframes are compared pair by pair: by nearness in the graph, by range histogram, and by Scan Context."
            .to_owned();
    };
    format!(
        "A lap of {} keyframes, compared pair by pair; keyframe {} is the newest.",
        places.study.places().len(),
        been.newest(),
    )
}
