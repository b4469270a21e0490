//! The laps of `docs/worlds.md` and of the page: the recorded results agree with the core.
//!
//! Thousands of laps take minutes, so the numbers are the recorded output of the commands in
//! `docs/worlds.md`. Some of the laps are run again, and their bits compared.

use ch16_lab::lap::{BuiltInWorld, LapConfig, LapMatcher, LapRunner, NamedChoice, PATH_SHARES};
use ch16_slam2d::chapter::InformationFrame;

use serde_json::Value;

use crate::page::document::source;

/// Worlds and matchers of sweeps. Point to point closes no loop on the ring.
pub const TRIALS: [(BuiltInWorld, LapMatcher); 5] = [
    (BuiltInWorld::Apartment, LapMatcher::PointToPoint),
    (BuiltInWorld::Apartment, LapMatcher::PointToPlane),
    (BuiltInWorld::Apartment, LapMatcher::Ndt),
    (BuiltInWorld::Ring, LapMatcher::PointToPlane),
    (BuiltInWorld::Ring, LapMatcher::Ndt),
];

/// Height of the page's picture of errors along the path, m, and of its panels, px.
const PICTURE_M: f64 = 0.3;
const PICTURE_PX: f64 = 90.0;

/// The sweeps of `docs/worlds.md`, each with both frames of information.
fn sweeps() -> impl Iterator<Item = (BuiltInWorld, LapMatcher, InformationFrame)> {
    TRIALS.into_iter().flat_map(|(world, matcher)| {
        InformationFrame::all().map(move |frame| (world, matcher, frame))
    })
}

/// The output of `ch16 sweep` for the laps in `world` with `matcher` and the information in `frame`.
fn recorded(world: &str, matcher: &str, frame: &str) -> Option<Value> {
    let known = sweeps().any(|(w, m, f)| [w.name(), m.name(), f.name()] == [world, matcher, frame]);
    let file = format!("tests/pinned/sweeps/{world}-{matcher}-{frame}.json");
    let levels: Value = serde_json::from_str(&known.then(|| source(&file))?).expect("it is JSON");
    Some(levels[0].clone())
}

/// `ring.p2l.exact.with_loops.rms.median`, `apartment.p2p.chapter.closed_percent`: by world, matcher and frame.
pub fn value(path: &[&str]) -> Option<f64> {
    let (world, matcher, frame, what) = match path {
        [world, matcher, frame, what @ ..] => (world, matcher, frame, what),
        _ => return None,
    };
    let level = recorded(world, matcher, frame)?;
    let entry = |column: &str, row: &str, key: &str| {
        let mut entries = level["entries"].as_array()?.iter();
        let entry = entries.find(|entry| entry["column"] == *column && entry["row"] == *row)?;
        entry[key].as_f64()
    };
    match what {
        ["seeds"] => level["runs"].as_f64(),
        ["closed_percent"] => Some(100.0 * (1.0 - level["loop_shares"][0].as_f64()?)),
        ["false"] => level["attempts"]["of_false"][0].as_f64(),
        ["accepted"] => level["accepted_loops"].as_f64(),
        [row, "fall_percent"] => {
            let [before, after] =
                ["front_end", "with_loops"].map(|column| entry(column, row, "median"));
            Some(100.0 * (1.0 - after? / before?))
        }
        [column, row, "low"] => entry(column, row, "p05"),
        [column, row, "median"] => entry(column, row, "median"),
        [column, row, "high"] => entry(column, row, "p95"),
        _ => None,
    }
}

#[test]
fn laps_of_the_recorded_sweeps_have_the_recorded_bits() {
    for (world, matcher, frame) in sweeps() {
        let level = recorded(world.name(), matcher.name(), frame.name()).expect("it is recorded");
        assert_eq!(level["runs"], 1000);
        let samples = level["samples"].as_array().unwrap();
        assert!(samples.len() >= 20);
        let mut runner = LapRunner::new();
        // Every fourth: the complete sweeps take minutes.
        for sample in samples.iter().step_by(4) {
            let seed = sample["seed"].as_u64().unwrap() as u32;
            let config = LapConfig::in_world(world, seed, 1.0)
                .with_matcher(matcher)
                .with_information(frame);
            let digest = format!("{:016x}", runner.run(&config).digest());
            assert_eq!(
                sample["digest"], digest,
                "{world:?}, {matcher:?}, {frame:?}, seed {seed}"
            );
        }
    }
}

#[test]
fn the_table_of_the_worlds_holds_the_recorded_figures() {
    let page = source("docs/worlds.md");
    let mut missing = Vec::new();
    for (world, matcher, frame) in sweeps() {
        let of = |what: &str| {
            let path: Vec<&str> = [world.name(), matcher.name(), frame.name()]
                .into_iter()
                .chain(what.split('.'))
                .collect();
            value(&path).unwrap_or_else(|| panic!("{path:?}"))
        };
        let error = |row: &str| {
            let [before, after] =
                ["front_end", "with_loops"].map(|column| of(&format!("{column}.{row}.median")));
            format!("{before:.3} → {after:.3}")
        };
        let row = format!(
            "| {} | {} | {} | {:.1} % | {} of {} | {} | {} | {} | {} |",
            world.name(),
            matcher.name(),
            frame.name(),
            of("closed_percent"),
            of("false"),
            of("accepted"),
            error("end_error"),
            error("rms"),
            error("half_way"),
            error("half_way_sigma"),
        );
        if !page.contains(&row) {
            missing.push(row);
        }
    }
    assert!(
        missing.is_empty(),
        "docs/worlds.md lacks\n{}",
        missing.join("\n")
    );
}

/// The lines and marks of one panel, whose lower left corner is at `left`.
fn panel(world: BuiltInWorld, left: f64) -> String {
    let level = recorded(world.name(), "p2l", "exact").expect("it is recorded");
    let [front_end, with_loops] = ["front_end", "with_loops"].map(|column| {
        let medians = level["along_the_way"][column].as_array().unwrap().iter();
        let points: Vec<[f64; 2]> = medians
            .enumerate()
            .map(|(k, error)| {
                let x = left + 130.0 * k as f64 / PATH_SHARES as f64;
                let share = error.as_f64().unwrap() / PICTURE_M;
                assert!((0.0..=1.0).contains(&share), "the picture is too low");
                [x, 10.0 + PICTURE_PX * (1.0 - share)]
            })
            .collect();
        assert_eq!(points.len(), PATH_SHARES + 1);
        points
    });
    let line = |points: &[[f64; 2]]| {
        let points = points.iter().map(|[x, y]| format!("{x:.1} {y:.1}"));
        format!("M{}", points.collect::<Vec<_>>().join("L"))
    };
    let marks = |points: &[[f64; 2]], mark: fn(&[f64; 2]) -> String| -> String {
        points.iter().skip(5).step_by(5).map(mark).collect()
    };
    format!(
        "<g class=\"error-lines\"><path d=\"{}\"/><path d=\"{}\"/></g>\n\
         <g class=\"front-end-marks\">{}</g>\n<g class=\"with-loops-marks\">{}</g>",
        line(&front_end),
        line(&with_loops),
        marks(&front_end, |[x, y]| format!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.5\"/>"
        )),
        marks(&with_loops, |[x, y]| format!(
            "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"7\" height=\"7\"/>",
            x - 3.5,
            y - 3.5
        )),
    )
}

#[test]
fn the_picture_of_errors_along_the_path_shows_the_recorded_medians() {
    let lines_of = |text: &str| -> Vec<String> {
        let lines = text.lines().map(str::trim);
        lines
            .filter(|line| !line.is_empty())
            .map(str::to_owned)
            .collect()
    };
    let page = source("index.html");
    let (_, drawn) = page
        .split_once("<!-- errors along the way -->")
        .expect("the picture");
    let (drawn, _) = drawn
        .split_once("<!-- end -->")
        .expect("the end of the picture");
    let expected = [
        panel(BuiltInWorld::Apartment, 20.0),
        panel(BuiltInWorld::Ring, 175.0),
    ]
    .join("\n");
    assert_eq!(
        lines_of(drawn),
        lines_of(&expected),
        "draw this:\n{expected}"
    );
}
