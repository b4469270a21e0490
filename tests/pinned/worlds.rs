//! The laps of `docs/worlds.md`: what was written down is what the core drives.
//!
//! A thousand laps by NDT take minutes, so the figures are those that the command of the page wrote
//! down. Some of the laps are driven again, and their bits compared.

use ch16_lab::lap::{BuiltInWorld, Choice, LapConfig, LapMatcher, LapRunner};
use ch16_slam2d::matching::InformationFrame;

use serde_json::Value;

use crate::page::document::source;

/// What `slam2d sweep` said of the laps in `world` with the information in `frame`.
fn recorded(world: &str, frame: &str) -> Option<Value> {
    let known = ["apartment", "ring"].contains(&world) && ["exact", "chapter"].contains(&frame);
    let text = known.then(|| source(&format!("tests/pinned/sweeps/{world}-{frame}.json")))?;
    let levels: Value = serde_json::from_str(&text).expect("the command writes JSON");
    Some(levels[0].clone())
}

/// `ring.exact.with_loops.rms.median`, `apartment.chapter.closed_percent`: by world and frame.
fn value(path: &[&str]) -> Option<f64> {
    let [world, frame, what @ ..] = path else {
        return None;
    };
    let level = recorded(world, frame)?;
    match what {
        ["closed_percent"] => Some(100.0 * (1.0 - level["loop_shares"][0].as_f64()?)),
        ["false"] => level["false_acceptances"].as_f64(),
        ["accepted"] => level["accepted_loops"].as_f64(),
        [column, row, quantile] => {
            let mut entries = level["entries"].as_array()?.iter();
            let entry = entries.find(|entry| entry["column"] == *column && entry["row"] == *row)?;
            let key = match *quantile {
                "low" => "p05",
                "median" => "median",
                "high" => "p95",
                _ => return None,
            };
            entry[key].as_f64()
        }
        _ => None,
    }
}

#[test]
fn laps_of_the_recorded_sweeps_have_the_recorded_bits() {
    for &world in BuiltInWorld::ALL {
        for &frame in InformationFrame::ALL {
            let level = recorded(world.name(), frame.name()).expect("it is recorded");
            let samples = level["samples"].as_array().unwrap();
            assert!(samples.len() >= 20);
            let mut runner = LapRunner::new();
            // Every fourth: the sweeps themselves take minutes.
            for sample in samples.iter().step_by(4) {
                let seed = sample["seed"].as_u64().unwrap() as u32;
                let config = LapConfig::in_world(world, seed, 1.0)
                    .with_matcher(LapMatcher::Ndt)
                    .with_information(frame);
                let digest = format!("{:016x}", runner.run(&config).digest());
                assert_eq!(
                    sample["digest"], digest,
                    "{world:?}, {frame:?}, seed {seed}"
                );
            }
        }
    }
}

#[test]
fn the_table_of_the_worlds_holds_the_recorded_figures() {
    let page = source("docs/worlds.md");
    for &world in BuiltInWorld::ALL {
        for &frame in InformationFrame::ALL {
            let of = |what: &str| {
                let path: Vec<&str> = [world.name(), frame.name()]
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
                "| {} | {} | {:.1} % | {} of {} | {} | {} | {} |",
                world.name(),
                frame.name(),
                of("closed_percent"),
                of("false"),
                of("accepted"),
                error("end_error"),
                error("rms"),
                error("max_error"),
            );
            assert!(page.contains(&row), "docs/worlds.md lacks the row\n{row}");
        }
    }
}
