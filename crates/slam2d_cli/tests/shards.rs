//! Sharded sweeps and their merge.

use std::fs;
use std::path::Path;

use crate::support::{assert_refused, slam2d};

const SWEEP: [&str; 5] = ["sweep", "--seeds", "1..=6", "--noise", "0.25,1"];

/// The arguments of shard `part`, whose rows are stored in `rows`.
fn of_shard<'a>(part: &'a str, rows: &'a Path) -> Vec<&'a str> {
    let rows = rows.to_str().unwrap();
    [&SWEEP[..], &["--shard", part, "--rows", rows]].concat()
}

fn printed_by(arguments: &[&str]) -> String {
    let output = slam2d(arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn shards_put_together_print_what_one_process_prints_to_the_last_digit() {
    let folder = tempfile::tempdir().unwrap();
    let rows = ["1/2", "2/2"].map(|part| {
        let rows = folder.path().join(format!("{}.jsonl", &part[..1]));
        let text = printed_by(&of_shard(part, &rows));
        assert!(text.starts_with("6 laps: "), "{text}");
        rows
    });
    let [first, second] = rows.each_ref().map(|rows| rows.to_str().unwrap());
    let whole = printed_by(&[&SWEEP[..], &["--json"]].concat());
    // The order of the files does not matter.
    assert_eq!(
        printed_by(&["sweep", "--merge", second, first, "--json"]),
        whole
    );
    assert_eq!(
        printed_by(&["sweep", "--merge", first, second]),
        printed_by(&SWEEP)
    );
    assert_refused(
        &["sweep", "--merge", second],
        "6 of 12 laps are missing, the first is seed 1 at noise ×0.25",
    );
}

#[test]
fn a_sweep_killed_within_a_row_resumes() {
    let folder = tempfile::tempdir().unwrap();
    let rows = folder.path().join("rows.jsonl");
    let kept_in = ["--rows", rows.to_str().unwrap(), "--json"];
    let printed = printed_by(&[&SWEEP[..], &kept_in].concat());
    let text = fs::read_to_string(&rows).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 13);
    // The header, three rows, and a partial row.
    let kept = lines[..4].join("\n") + "\n";
    fs::write(&rows, kept.clone() + &lines[4][..30]).unwrap();
    let resumed = printed_by(&of_shard("1/1", &rows));
    assert!(
        resumed.starts_with("12 laps, 3 of them from an earlier run: "),
        "{resumed}"
    );
    let again = fs::read_to_string(&rows).unwrap();
    assert!(again.starts_with(&kept));
    let sorted = |text: &str| {
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        lines.sort();
        lines
    };
    assert_eq!(sorted(&again), sorted(&text));
    assert_eq!(
        printed_by(&["sweep", "--merge", rows.to_str().unwrap(), "--json"]),
        printed
    );
}

#[test]
fn rows_that_do_not_belong_together_are_refused_in_one_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let rows = folder.path().join("rows.jsonl");
    let path = rows.to_str().unwrap();
    // With one thread, seed 1 is the first row.
    let sweep = [
        "sweep",
        "--seeds",
        "1..=2",
        "--noise",
        "1",
        "--rows",
        path,
        "--threads",
        "1",
    ];
    printed_by(&sweep);
    let other = |option: &[&'static str]| [&sweep[..], option].concat();
    assert_refused(
        &other(&["--matcher", "p2l"]),
        "holds rows of another sweep: its world, matcher or another option differs; give another file",
    );
    assert_refused(
        &["sweep", "--seeds", "1..=3", "--noise", "1", "--rows", path],
        "its seeds are 1..=2, not 1..=3",
    );
    let text = fs::read_to_string(&rows).unwrap();
    let bent = folder.path().join("bent.jsonl");
    let bent_path = bent.to_str().unwrap();
    fs::write(&bent, text.replacen("\"loops\":", "\"loops\":1", 1)).unwrap();
    assert_refused(
        &["sweep", "--merge", path, bent_path],
        "bent.jsonl: line 2: seed 1 at noise ×1 differs from an earlier row",
    );
    fs::write(&bent, "x,y\n1,2\n").unwrap();
    assert_refused(
        &["sweep", "--merge", bent_path],
        "line 1: expected the header of a sweep",
    );
    assert_refused(&["sweep", "--merge", "no-such-file"], "no-such-file");
    assert_refused(
        &["sweep", "--shard", "3/2", "--rows", path],
        "not a part such as 2/4",
    );
    assert_refused(&["sweep", "--shard", "1/2"], "--rows");
    assert_refused(&["sweep", "--merge", path, "--seeds", "1..=2"], "--merge");
}
