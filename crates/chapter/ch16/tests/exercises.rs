//! `ch16 lap --exercises`, with the exercises as they are and with the solutions.

#[allow(dead_code, reason = "the tests of the other commands use the rest")]
mod support;

use support::assert_rejected;

#[test]
fn what_no_exercise_does_is_rejected() {
    for (argument, value, instead) in [
        ("--matcher", "ndt", "p2p or p2l"),
        ("--detector", "context", "nearby or histogram"),
    ] {
        assert_rejected(&["lap", "--exercises", argument, value], instead);
    }
}

/// Of no use once a student has written it.
#[cfg(not(feature = "exercise_solutions"))]
#[test]
fn what_is_not_written_is_named() {
    let text = include_str!("../../../../teaching/exercises/src/trimmed_icp.rs");
    if text.contains("not_written(") {
        assert_rejected(&["lap", "--exercises"], "trimmed_icp is not written yet");
    }
}

#[cfg(feature = "exercise_solutions")]
mod solved {
    use serde_json::Value;
    use slam2d_tests::{assert_close, reference};

    use crate::support::ch16;

    fn printed(arguments: &[&str]) -> String {
        let output = ch16(arguments);
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// The number after `word` in the line that starts with `line`.
    fn number(text: &str, line: &str, word: &str) -> f64 {
        let line = text.lines().find(|text| text.trim().starts_with(line));
        let rest = line.and_then(|line| line.split_once(word)).unwrap().1;
        let digits = rest.trim().split([' ', ',']).next().unwrap();
        digits.parse().unwrap()
    }

    #[test]
    fn the_solutions_drive_the_chapters_lap() {
        let laps: Vec<Value> = reference("lap.json");
        let text = printed(&["lap", "--exercises"]);
        // 2e-3: a point of the start lies on the edge of a cell in the third loop's submap, and the last bit decides.
        for (line, field) in [
            ("keyframes, rms", "keyframe_rms"),
            ("keyframes, end", "keyframe_end_error"),
        ] {
            let expected = laps[0][field].as_f64().unwrap();
            assert_close(field, number(&text, line, line), expected, 2e-3);
        }
        for event in &laps[0]["events"].as_array().unwrap()[..2] {
            let line = format!("{} to {}: chi2", event["from"], event["to"]);
            // 6e-4: three digits are printed.
            let expected = event["chi2"].as_f64().unwrap();
            assert_close(&line, number(&text, &line, "chi2"), expected, 6e-4);
        }
        let ours = number(&text, "graph chi2", "chi2");
        assert_close("χ²", number(&text, "gauss_newton", "chi2"), ours, 2e-4);
    }

    #[test]
    fn the_histogram_proposes_if_it_is_asked_to() {
        let text = printed(&["lap", "--exercises", "--detector", "histogram"]);
        assert!(text.contains("range_histogram"), "{text}");
        assert!(!printed(&["lap", "--exercises"]).contains("range_histogram"));
    }
}
