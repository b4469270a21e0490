//! Sharded sweeps and their merge.

use std::fs;

use tempfile::TempDir;

use crate::support::{assert_rejected, ch16};

const SWEEP: [&str; 5] = ["sweep", "--seeds", "1..=6", "--noise", "0.25,1"];

fn printed_by(arguments: &[&str]) -> String {
    let output = ch16(arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}

/// The file of a part of a sweep.
fn driven(folder: &TempDir, sweep: &[&str], part: &str, name: &str) -> String {
    let file = folder.path().join(name).to_str().unwrap().to_owned();
    printed_by(&[sweep, &["--shard", part, "-o", &file]].concat());
    file
}

#[test]
fn shards_put_together_print_what_one_process_prints_to_the_last_digit() {
    let folder = TempDir::new().unwrap();
    let first = driven(&folder, &SWEEP, "1/2", "first.json");
    let second = driven(&folder, &SWEEP, "2/2", "second.json");
    let whole = printed_by(&[&SWEEP[..], &["--json"]].concat());
    // The order of the files does not matter.
    assert_eq!(
        printed_by(&["sweep", "--merge", &second, &first, "--json"]),
        whole
    );
    assert_eq!(
        printed_by(&["sweep", "--merge", &first, &second]),
        printed_by(&SWEEP)
    );
    assert_rejected(
        &["sweep", "--merge", &second],
        "3 of 6 seeds are missing, the first is 1; pass the file of their part as well",
    );
}

#[test]
fn parts_that_do_not_belong_together_are_rejected_in_one_sentence() {
    let folder = TempDir::new().unwrap();
    let sweep = ["sweep", "--seeds", "1..=2", "--noise", "1"];
    let part = driven(&folder, &sweep, "1/1", "part.json");
    for (name, option) in [
        ("matcher.json", ["--matcher", "p2l"]),
        ("noise.json", ["--noise", "2"]),
    ] {
        let sweep = match option[0] {
            "--noise" => [&sweep[..3], &option].concat(),
            _ => [&sweep[..], &option].concat(),
        };
        let other = driven(&folder, &sweep, "1/1", name);
        assert_rejected(
            &["sweep", "--merge", &part, &other],
            &format!("{name} are of different sweeps"),
        );
    }
    let bent = folder.path().join("bent.json");
    let text = fs::read_to_string(&part).unwrap();
    fs::write(&bent, text.replacen("\"loops\":", "\"loops\":1", 1)).unwrap();
    let bent_path = bent.to_str().unwrap();
    assert_rejected(
        &["sweep", "--merge", &part, bent_path],
        "bent.json: seed 1 differs from an earlier file",
    );
    fs::write(&bent, "x,y\n1,2\n").unwrap();
    assert_rejected(
        &["sweep", "--merge", bent_path],
        "pass a file that ch16 sweep --shard wrote",
    );
    assert_rejected(&["sweep", "--merge", "no-such-file"], "no-such-file");
    assert_rejected(
        &["sweep", "--shard", "3/2", "-o", &part],
        "not a part such as 2/4",
    );
    assert_rejected(&["sweep", "--shard", "1/2"], "--output");
    assert_rejected(&["sweep", "--merge", &part, "--seeds", "1..=2"], "--merge");
}
