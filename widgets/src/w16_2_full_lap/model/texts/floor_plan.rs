//! Texts about a flat during editing, and if it cannot be driven.

use pr_sim::Sketch;
use pr_sim::sketch::{PlaceCm, to_m};
use widget_kit::model::Assessment;
use widget_kit::plural::plural;

use super::Statement;
use crate::w16_2_full_lap::model::moment::Drawn;
use crate::w16_2_full_lap::model::plan_element::PlanElement;

/// `18 walls, 3 waypoints`.
pub fn counts(sketch: &Sketch) -> String {
    let walls = plural(sketch.walls_cm.len(), "wall");
    let way_points = plural(sketch.way_points_cm.len(), "waypoint");
    format!("{walls}, {way_points}")
}

/// The main statement about a flat: why the last edit was rejected, why it cannot be driven, or the
/// selection. `lap` is the statement about the lap on screen.
pub fn statement(drawn: &Drawn, lap: Statement) -> Statement {
    let neutral = |sentence: String| Statement {
        standing: Assessment::Neutral,
        verdict: "your own flat".to_owned(),
        sentence,
    };
    if let Some(note) = drawn.note {
        return neutral(note.to_owned());
    }
    let piece = drawn.piece.map(|piece| piece_words(drawn.sketch, piece));
    if let Some(problem) = drawn.problem {
        let piece = piece.map_or_else(String::new, |words| format!("{words}; "));
        return Statement {
            standing: Assessment::Bad,
            verdict: "cannot be driven".to_owned(),
            sentence: format!("{piece}this floor plan cannot be driven: {problem}"),
        };
    }
    match (drawn.tool, piece) {
        (None, _) => lap,
        (Some(_), Some(piece)) => neutral(format!("{piece}; {}", lap.sentence)),
        (Some(_), None) => neutral(format!("{}; {}", counts(drawn.sketch), lap.sentence)),
    }
}

/// `wall 3 of 18, from (0, 3.8) to (1.6, 3.8) m`.
pub fn piece_words(sketch: &Sketch, piece: PlanElement) -> String {
    let number = piece.index() + 1;
    let count = piece.count(sketch);
    let at = |cm: PlaceCm| {
        let [x, y] = cm.map(to_m);
        format!("({x}, {y})")
    };
    match piece {
        PlanElement::Wall(index) => {
            let [from, to] = sketch.walls_cm[index].map(at);
            format!("wall {number} of {count}, from {from} to {to} m")
        }
        PlanElement::FirstEnd(index) => {
            let end = at(sketch.walls_cm[index][0]);
            format!("first end of wall {number} of {count}, at {end} m")
        }
        PlanElement::SecondEnd(index) => {
            let end = at(sketch.walls_cm[index][1]);
            format!("second end of wall {number} of {count}, at {end} m")
        }
        PlanElement::WayPoint(index) => {
            let place = at(sketch.way_points_cm[index]);
            let turn = if sketch.turn == Some(index) {
                ", from which the robot revisits known places"
            } else {
                ""
            };
            format!("waypoint {number} of {count}, at {place} m{turn}")
        }
        PlanElement::Start => format!("the start, at {} m", at(sketch.start_cm)),
        PlanElement::Heading => format!("the start faces {}°", sketch.heading_deg),
    }
}

/// The flat's part of the text alternative.
pub fn summary(drawn: &Drawn) -> String {
    let counts = counts(drawn.sketch);
    let mut words = match drawn.tool {
        None => format!(" The flat has {counts}."),
        Some(_) => format!(" The floor plan is being edited: {counts}."),
    };
    if let Some(piece) = drawn.piece {
        words += &format!(" Selected: {}.", piece_words(drawn.sketch, piece));
    }
    if let Some(problem) = drawn.problem {
        words +=
            &format!(" It cannot be driven: {problem}. The plots show the last lap that could be.");
    }
    words
}
