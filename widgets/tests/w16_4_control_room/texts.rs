//! The claims of the control room's notes and presets, against the runs of the presets.

use widget_kit::model::{Activity, Assessment, Model as _};
use widgets::w16_4_control_room::model::ControlRoom;
use widgets::w16_4_control_room::spec::SPEC;

use crate::support::fact;

fn after(preset: &str) -> ControlRoom {
    let mut room = ControlRoom::default();
    room.press(preset).unwrap();
    room.finish_work();
    room
}

/// The help of a preset makes this claim.
fn assert_promised(preset: &str, words: &str) {
    let help = SPEC.presets.iter().find(|p| p.id == preset).unwrap().help;
    assert!(help.contains(words), "`{help}` does not say `{words}`");
}

#[test]
fn every_preset_is_tested_here() {
    let tested = ["watch", "blurred", "rebuilt", "noisy", "wrong-loop", "open"];
    let presets: Vec<_> = SPEC.presets.iter().map(|preset| preset.id).collect();
    assert_eq!(presets, tested);
}

#[test]
fn watching_goes_from_the_first_sweep_to_the_end_over_three_loops() {
    let mut room = after("watch");
    assert_eq!(room.values().number("t"), 0.0);
    assert_eq!(fact(&room, "keyframes"), 1.0);
    while room.advance(0.25) == Activity::Busy {}
    assert_eq!(room.outcome().verdict, "run finished");
    assert_eq!(fact(&room, "loops"), 3.0);
    assert_promised("watch", "three loops");
}

#[test]
fn the_first_loop_brings_the_passes_together_and_sharpens_the_walls() {
    let before = after("blurred");
    let at = after("rebuilt");
    assert_eq!(fact(&before, "loops"), 0.0);
    assert_eq!(at.outcome().verdict, "loop accepted");
    assert_eq!(at.values().number("t"), before.values().number("t") + 1.0);
    let apart =
        |room: &ControlRoom| format!("disagree by {:.2} m", fact(room, "map_disagreement_m"));
    assert_promised("blurred", &apart(&before));
    assert_promised("rebuilt", &apart(&at));
    let sure = |room: &ControlRoom| fact(room, "sure_cells");
    let sharpen = format!("rises from {} to {}.", sure(&before), sure(&at));
    assert!(
        SPEC.notice.iter().any(|note| note.ends_with(&sharpen)),
        "{sharpen}"
    );
    assert!(sure(&at) > sure(&before));
}

#[test]
fn four_times_the_noise_opens_the_threshold() {
    let noisy = after("noisy");
    let mut quiet = after("noisy");
    quiet.set("noise", 1.0).unwrap();
    quiet.finish_work();
    let (from, to) = (fact(&quiet, "tau_m"), fact(&noisy, "tau_m"));
    assert!(from < to);
    assert_promised("noisy", &format!("from {from:.2} m to {to:.2} m"));
}

#[test]
fn a_wrong_loop_that_passes_every_test_is_reported_as_wrong() {
    let room = after("wrong-loop");
    let outcome = room.outcome();
    assert_eq!(outcome.standing, Assessment::Bad);
    assert_eq!(outcome.verdict, "false loop accepted");
    let sentence = outcome.sentence;
    let expected = "false loop 29 to 7 accepted, chi-squared 4.93 below 7.815, history moved 0.32 m: \
         its measurement is 0.36 m and 1.7° from the truth";
    assert!(sentence.starts_with(expected), "{sentence}");
    assert_promised("wrong-loop", "0.36 m out");
    let first = &room.timeline().unwrap().marks[0];
    assert_eq!(first.standing, Assessment::Bad);
    assert_eq!(first.at, room.values().number("t"), "it is the first loop");
}

#[test]
fn without_loops_the_passes_stay_apart_and_the_walls_blurred() {
    let open = after("open");
    let mut closed = ControlRoom::default();
    closed.set("t", open.values().number("t")).unwrap();
    assert!(open.timeline().unwrap().marks.is_empty());
    let apart = |room: &ControlRoom| fact(room, "map_disagreement_m");
    let sure = |room: &ControlRoom| fact(room, "sure_cells");
    assert!(apart(&open) > apart(&closed) && sure(&open) < sure(&closed));
    assert_promised(
        "open",
        &format!(
            "end {:.2} m apart instead of {:.2} m, and {} cells are clearly occupied instead of {}",
            apart(&open),
            apart(&closed),
            sure(&open),
            sure(&closed),
        ),
    );
}

#[test]
fn the_back_end_works_only_at_keyframes() {
    let mut room = ControlRoom::default();
    let tables = room.tables();
    let log = tables
        .iter()
        .find(|table| table.id == "control-room-events");
    let rows = &log.unwrap().rows;
    let loops: Vec<_> = rows
        .iter()
        .filter(|row| row[2].starts_with("loop "))
        .collect();
    assert_eq!(loops.len(), 3);
    for row in loops {
        let keyframe = |other: &Vec<String>| other[0] == row[0] && other[2].starts_with("keyframe");
        assert!(rows.iter().any(keyframe), "{row:?}");
    }
    // "Next event" steps through the log, and starts over at its end.
    let ticks: Vec<f64> = rows.iter().map(|row| row[0].parse().unwrap()).collect();
    room.set("t", 0.0).unwrap();
    let mut expected = ticks.clone();
    expected.dedup();
    expected.push(ticks[0]);
    for tick in expected {
        room.press("next-event").unwrap();
        assert_eq!(room.values().number("t"), tick);
    }
}
