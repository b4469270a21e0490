//! `ch16-mark` on files as the page saves them, changed ones, and ones that are none.

use std::fs;
use std::path::PathBuf;

use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use crate::support::{assert_rejected, ch16_mark, json};

/// Fields of an answer, in the order of the digest.
const FIELDS: [&str; 7] = [
    "exercise",
    "widget",
    "state",
    "prediction",
    "result",
    "attempts",
    "time",
];

fn answer(exercise: &str, widget: &str, state: &str, prediction: &str, result: &str) -> Value {
    json!({
        "exercise": exercise, "widget": widget, "state": state, "prediction": prediction, "result": result,
        "attempts": 1, "time": "2026-11-27T02:06:47.000Z",
    })
}

fn mirror(prediction: &str) -> Value {
    answer(
        "16.1",
        "w16.11",
        "shape=two",
        prediction,
        "turn and mirror image tie",
    )
}

fn rank(prediction: &str) -> Value {
    answer("16.2", "w16.3", "scene=corridor", prediction, "2")
}

/// A file with a digest that fits.
fn file(student: &str, answers: &[Value]) -> Value {
    let schema = "slam2d-answers/1";
    let mut rows = vec![json!(schema), json!(student)];
    rows.extend(
        answers
            .iter()
            .map(|answer| FIELDS.iter().map(|field| answer[field].clone()).collect()),
    );
    let digest = Sha256::digest(Value::Array(rows).to_string());
    let digest: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
    json!({"schema": schema, "student": student, "answers": answers, "digest": digest})
}

/// A folder that holds `content` as `answers.json`.
fn saved(content: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("answers.json");
    fs::write(&path, content).unwrap();
    (folder, path)
}

fn marks(file: &Value) -> Value {
    let (_folder, path) = saved(&file.to_string());
    json(&[path.to_str().unwrap(), "--json"])
}

#[test]
fn answers_are_marked_by_what_the_core_computes() {
    let answers = [
        mirror("turn and mirror image tie"),
        rank("2"),
        answer(
            "16.variants",
            "w16.1",
            "heading=180&dx=0&dy=0&variant=point-to-plane",
            "larger",
            "0.015",
        ),
    ];
    let sheet = marks(&file("", &answers));
    assert_eq!(sheet["intact"], true);
    assert_eq!(
        (&sheet["right"], &sheet["exercises"]),
        (&json!(2), &json!(11))
    );
    let marked = sheet["answers"].as_array().unwrap();
    let given: Vec<_> = marked.iter().map(|a| a["mark"].as_str().unwrap()).collect();
    assert_eq!(given, ["right", "right", "wrong"]);
    assert_eq!(marked[2]["right"], "smaller");
    // The chapter prints 0.015; the page saves every digit.
    let note = marked[2]["note"].as_str().unwrap();
    assert!(note.contains("showed `0.015`, but"), "{note}");
}

#[test]
fn a_number_beside_the_right_one_is_within_tolerance_or_wrong() {
    for (prediction, mark) in [
        ("2.4", "within-tolerance"),
        ("3", "wrong"),
        ("two", "not-marked"),
    ] {
        let sheet = marks(&file("", &[rank(prediction)]));
        assert_eq!(sheet["answers"][0]["mark"], mark, "{prediction}");
    }
}

#[test]
fn a_changed_file_is_marked_and_its_digest_is_broken() {
    let mut changed = file("", &[mirror("a turn fits best")]);
    changed["answers"][0]["prediction"] = json!("turn and mirror image tie");
    let (_folder, path) = saved(&changed.to_string());
    for format in [&["--json"][..], &["--csv"], &["--csv", "--long"], &[]] {
        let output = ch16_mark(&[&[path.to_str().unwrap()], format].concat());
        assert_eq!(output.status.code(), Some(2), "{format:?}");
        let errors = String::from_utf8(output.stderr).unwrap();
        let told = "answers.json was changed after the page saved it";
        assert_eq!(errors.matches(told).count(), 1, "{format:?}: {errors}");
        if format == ["--json"] {
            let sheet: Value = serde_json::from_slice(&output.stdout).unwrap();
            assert_eq!(sheet["intact"], false);
            assert_eq!(sheet["answers"][0]["mark"], "right");
        }
    }
}

#[test]
fn the_lap_of_a_neighbour_is_not_marked() {
    let neighbours = answer(
        "16.5a",
        "w16.2",
        "noise=3.75&t=129&seed=14",
        "as before",
        "1",
    );
    let bob = marks(&file("Bob", std::slice::from_ref(&neighbours)));
    assert_ne!(bob["answers"][0]["mark"], "not-marked", "{bob}");
    let ann = marks(&file("Ann", &[neighbours]));
    assert_eq!(ann["answers"][0]["mark"], "not-marked");
    let note = ann["answers"][0]["note"].as_str().unwrap();
    assert!(note.contains("which is `noise=4&t=129&seed=23`"), "{note}");
}

#[test]
fn an_unknown_exercise_or_choice_is_not_marked_and_says_which_there_are() {
    let unknown = [answer("17.1", "w16.1", "", "a", "a"), mirror("none")];
    let sheet = marks(&file("", &unknown));
    let note = |k: usize| sheet["answers"][k]["note"].as_str().unwrap();
    assert!(
        note(0).contains("there are 16.1, 16.2") && note(1).contains("choices: a turn"),
        "{sheet}"
    );
}

#[test]
fn what_is_no_file_of_answers_is_rejected_in_one_line() {
    let twice = file("", &[rank("2"), rank("2")]).to_string();
    let newer = file("", &[]).to_string().replace("answers/1", "answers/2");
    for (content, expected) in [
        (
            "{\"schema\": ",
            "line 1 column 11; give a file that the page saved",
        ),
        ("[]", "give a file that the page saved"),
        (
            newer.as_str(),
            "has the schema `slam2d-answers/2`, not `slam2d-answers/1`",
        ),
        (twice.as_str(), "answers exercise 16.2 twice"),
        (&" ".repeat((1 << 20) + 1), "more than 1048576 bytes"),
    ] {
        let (_folder, path) = saved(content);
        assert_rejected(&[path.to_str().unwrap()], expected);
    }
    assert_rejected(&["nowhere.json"], "nowhere.json: ");
}

#[test]
fn one_bad_file_of_many_leaves_the_marks_of_the_others() {
    let (_folder, good) = saved(&file("", &[rank("=1+1")]).to_string());
    let output = ch16_mark(&["nowhere.json", good.to_str().unwrap(), "--csv", "--long"]);
    assert_eq!(output.status.code(), Some(2));
    let table = String::from_utf8(output.stdout).unwrap();
    let rows: Vec<&str> = table.lines().collect();
    assert_eq!(rows.len(), 2, "{table}");
    assert!(
        rows[1].contains(",,yes,16.2,not-marked,'=1+1,2,2,,1,2026-11-27T02:06:47.000Z,`=1+1`"),
        "{table}"
    );
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(errors.contains("1 of 2 files are not marked"), "{errors}");
}

/// Saves a file for each student of a list in one folder.
fn class(files: &[(&str, &str, Vec<Value>)]) -> (tempfile::TempDir, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let paths = files.iter().map(|(name, student, answers)| {
        let path = folder.path().join(name);
        // Some editors begin a file with a byte order mark.
        fs::write(&path, format!("\u{feff}{}", file(student, answers))).unwrap();
        path.display().to_string()
    });
    let paths = paths.collect();
    (folder, paths)
}

fn csv(arguments: &[&str], files: &[String]) -> (Option<i32>, Vec<Vec<String>>, String) {
    let mut all = vec!["--csv"];
    all.extend(arguments);
    all.extend(files.iter().map(String::as_str));
    let output = ch16_mark(&all);
    let rows = String::from_utf8(output.stdout).unwrap();
    let rows = rows
        .lines()
        .map(|row| row.split(',').map(str::to_owned).collect());
    let errors = String::from_utf8(output.stderr).unwrap();
    (output.status.code(), rows.collect(), errors)
}

#[test]
fn the_gradebook_has_a_row_for_each_student_and_a_column_for_each_question() {
    let (_folder, files) = class(&[
        (
            "a.json",
            "Ann",
            vec![mirror("turn and mirror image tie"), rank("2.4")],
        ),
        (
            "b.json",
            "Bob",
            vec![mirror("a turn fits best"), rank("two")],
        ),
        ("c.json", "Ann", vec![rank("2")]),
    ]);
    let (code, rows, errors) = csv(&[], &files);
    assert_eq!(rows[0][..4], ["student", "16.1", "16.2", "16.3"]);
    assert_eq!(rows[0].last().unwrap(), "total");
    assert_eq!(rows.len(), 3, "{rows:?}");
    assert!(rows.iter().all(|row| row.len() == 13), "{rows:?}");
    assert_eq!(
        (&rows[1][..4], rows[1][12].as_str()),
        (&["Ann", "1", "1", ""].map(str::to_owned)[..], "2")
    );
    assert_eq!(
        (&rows[2][..4], rows[2][12].as_str()),
        (&["Bob", "0", "", ""].map(str::to_owned)[..], "0")
    );
    assert_eq!(code, Some(2));
    assert!(
        errors.contains("a.json and") && errors.contains("c.json are both of Ann"),
        "{errors}"
    );
}

#[test]
fn a_gradebook_of_80_joins_the_roster_of_canvas_and_of_moodle_by_column_names() {
    let names: Vec<(String, String)> = (0..80)
        .map(|k| (format!("{k}.json"), format!("s{k:02}")))
        .collect();
    let students: Vec<_> = names
        .iter()
        .map(|(name, student)| (name.as_str(), student.as_str(), vec![rank("2")]))
        .collect();
    let (folder, mut files) = class(&students);
    let write = |name: &str, text: String| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let rows = |row: fn(usize) -> String| (0..81).rev().map(row).collect::<String>();
    let canvas = write(
        "canvas.csv",
        format!(
            "\u{feff}Student,ID,SIS User ID,SIS Login ID,Section,Old (1)\n    Points Possible,,,,,10\n{}",
            rows(|k| format!("\"Doe, N{k}\",{k},u{k},s{k:02},A,\n"))
        ),
    );
    let (code, found, errors) = csv(&["--roster", &canvas, "--columns", "canvas"], &files);
    assert_eq!((code, errors.as_str()), (Some(0), ""));
    assert_eq!(
        found[0][..6],
        [
            "Student",
            "ID",
            "SIS User ID",
            "SIS Login ID",
            "Section",
            "Question 16.1"
        ]
    );
    assert_eq!(found.len(), 82);
    // The name holds a comma. The last of the roster has no answers.
    assert_eq!(found[1][..6], ["\"Doe", " N80\"", "80", "u80", "s80", "A"]);
    assert!(found[1][6..].iter().all(String::is_empty), "{:?}", found[1]);
    assert_eq!(
        (found[2][4].as_str(), found[2].last().unwrap().as_str()),
        ("s79", "1")
    );
    let moodle = write(
        "moodle.csv",
        format!(
            "First name,Email address,ID number\n{}",
            rows(|k| format!("N{k},n{k}@x.org,s{k:02}\n"))
        ),
    );
    files.push(write("zed.json", file("Zed", &[rank("2")]).to_string()));
    let (code, found, errors) = csv(&["--roster", &moodle, "--columns", "moodle"], &files);
    assert_eq!(
        found[0][..3],
        ["ID number", "Email address", "Question 16.1"]
    );
    assert_eq!((found.len(), found[2].last().unwrap().as_str()), (82, "1"));
    assert_eq!(code, Some(2));
    assert!(
        errors.contains("zed.json: Zed is in no row of the roster"),
        "{errors}"
    );
    let nameless = write("bad.csv", "Height\n1\n".to_owned());
    assert_rejected(
        &["--csv", "--roster", &nameless, &files[0]],
        "bad.csv has no column that identifies a student",
    );
}

#[test]
fn a_written_function_is_marked_by_the_tests_of_the_page() {
    let gate = "function gate([x, y, t], gap, [a, b], limit) {\n  const chi2 = (x * x + y * y) / (gap * a * a) + t * t / (gap * b * b);\n  return {chi2, accepted: chi2 <= limit};\n}\n";
    let written = |code: &str| {
        let (function, time) = ("gate", "2026-11-27T02:06:47.000Z");
        let mut file = file("Ann", &[]);
        let digest = Sha256::digest(
            json!(["slam2d-answers/1", "Ann", [function, code, 2, time]]).to_string(),
        );
        let digest: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
        file["code"] = json!([{"function": function, "code": code, "attempts": 2, "time": time}]);
        file["digest"] = json!(digest);
        file
    };
    let sheet = marks(&written(gate));
    assert_eq!(sheet["intact"], true);
    assert_eq!(
        (&sheet["right"], &sheet["exercises"]),
        (&json!(1), &json!(12))
    );
    let marked = &sheet["answers"][0];
    assert_eq!(
        (&marked["exercise"], &marked["mark"]),
        (&json!("code.gate"), &json!("right"))
    );
    let mut shown = written(gate);
    shown["code"][0]["help"] = json!(4);
    let row = json!(["gate", gate, 2, "2026-11-27T02:06:47.000Z", 4]);
    let digest = Sha256::digest(json!(["slam2d-answers/1", "Ann", row]).to_string());
    let digest: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
    shown["digest"] = json!(digest);
    let marked = &marks(&shown)["answers"][0];
    assert_eq!(
        (&marked["mark"], &marked["note"]),
        (&json!("right"), &json!("the page had shown its solution"))
    );
    let wrong = written(&gate.replace("<= limit", "< limit"));
    let marked = &marks(&wrong)["answers"][0];
    assert_eq!(marked["mark"], "wrong");
    assert_eq!(marked["result"], "6 tests");
    let note = marked["note"].as_str().unwrap();
    assert!(
        note.starts_with("At the limit: expected χ² 4.000 and accepted true"),
        "{note}"
    );
    // The gradebook has a column for each function then.
    let (_folder, path) = saved(&wrong.to_string());
    let output = ch16_mark(&[path.to_str().unwrap(), "--csv"]);
    let text = String::from_utf8(output.stdout).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let (head, row) = (lines.next().unwrap(), lines.next().unwrap());
    let column = head.iter().position(|name| *name == "code.gate").unwrap();
    assert_eq!((row[column], row[row.len() - 1]), ("0", "0"));
}

/// A class of 80: each tenth has a name in another alphabet, ten saved a second file, five edited theirs.
#[test]
fn a_class_of_80_with_its_mishaps_is_imported_by_both_systems() {
    const NAMES: [&str; 10] = [
        "Βασίλης Παππάς",
        "Ольга Іваненко",
        "李小龍",
        "さくら",
        "김민준",
        "محمد",
        "שרה לוי",
        "Łukasz Żak",
        "Jürgen Groß",
        "อนันดา",
    ];
    let login = |k: usize| {
        if k.is_multiple_of(8) {
            NAMES[k / 8].to_owned()
        } else {
            format!("S{k:03}")
        }
    };
    let folder = tempfile::tempdir().unwrap();
    let save = |name: String, content: &Value| {
        let path = folder.path().join(name);
        fs::write(&path, content.to_string()).unwrap();
        path.display().to_string()
    };
    let mut files = Vec::new();
    for k in 0..80 {
        // A third types the token in lower case.
        let student = if k % 3 == 0 {
            login(k).to_lowercase()
        } else {
            login(k)
        };
        let mut content = file(&student, &[rank("2"), mirror("a turn fits best")]);
        if k % 16 == 1 {
            content["answers"][1]["prediction"] = json!("turn and mirror image tie");
        }
        files.push(save(format!("{k:02}.json"), &content));
        if k % 8 == 3 {
            files.push(save(
                format!("{k:02}-again.json"),
                &file(&student, &[rank("3")]),
            ));
        }
    }
    let rows = |separator: &str, row: &dyn Fn(usize) -> Vec<String>| -> String {
        (0..80)
            .map(|k| format!("{}\n", row(k).join(separator)))
            .collect()
    };
    let canvas = format!(
        "Student,ID,SIS User ID,SIS Login ID,Section,Old (7)\n,,,,,Manual Posting\n    Points Possible,,,,,10\n{}",
        rows(",", &|k| vec![
            format!("\"Doe, N{k}\""),
            k.to_string(),
            String::new(),
            login(k),
            "A".to_owned(),
            String::new()
        ])
    );
    let moodle = format!(
        "Vorname;Nachname;ID-Nummer\n{}",
        rows(";", &|k| vec![format!("N{k}"), "Doe".to_owned(), login(k)])
    );
    for (columns, roster, head, at) in [
        (
            "canvas",
            canvas,
            &[
                "Student",
                "ID",
                "SIS User ID",
                "SIS Login ID",
                "Section",
                "Question 16.1",
            ][..],
            4,
        ),
        ("moodle", moodle, &["ID-Nummer", "Question 16.1"][..], 0),
    ] {
        let path = folder.path().join(format!("{columns}.csv"));
        fs::write(&path, roster).unwrap();
        let path = path.display().to_string();
        let (code, found, errors) = csv(&["--roster", &path, "--columns", columns], &files);
        assert_eq!(code, Some(2), "{errors}");
        assert_eq!(found[0][..head.len()], *head);
        assert_eq!(
            found.len(),
            81,
            "{columns}: a header and a row for each student"
        );
        for (k, row) in found[1..].iter().enumerate() {
            assert_eq!(row[at], login(k), "{columns}");
            // The first file counts. An edited answer is marked, and named on standard error.
            let right = if k % 16 == 1 { "2" } else { "1" };
            assert_eq!(row.last().unwrap(), right, "{columns}: {row:?}");
        }
        assert_eq!(
            errors
                .matches("was changed after the page saved it")
                .count(),
            5,
            "{errors}"
        );
        assert_eq!(
            errors.matches("-again.json are both of").count(),
            10,
            "{errors}"
        );
        assert_eq!(
            errors.lines().count(),
            16,
            "a line each, and how many: {errors}"
        );
    }
}

#[test]
fn a_roster_names_its_column_or_says_what_it_has() {
    let (folder, files) = class(&[
        ("a.json", "s114", vec![rank("2")]),
        ("b.json", "S114", vec![rank("3")]),
    ]);
    let write = |text: &[u8]| {
        let path = folder.path().join("roster.csv");
        fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let by = |roster: &str, by: &[&str]| csv(&[&["--roster", roster], by].concat(), &files);
    // Two students whose tokens differ in their case alone.
    let roster = write(b"Token;Gruppe\nS114;1\ns114;2\n");
    let (code, found, errors) = by(&roster, &[]);
    assert_eq!((code, errors.as_str()), (Some(0), ""));
    assert_eq!(
        (found[1][2..].last(), found[2][2..].last()),
        (Some(&"0".to_owned()), Some(&"1".to_owned()))
    );
    // One student, and two files.
    let roster = write(b"Kennung\tGruppe\nS114\t1\n");
    let (code, _, errors) = by(&roster, &[]);
    assert_eq!(code, Some(2));
    let told = "has no column that identifies a student; its columns, with tabs between them, are Kennung | Gruppe; name the one that holds the names or tokens with --by COLUMN";
    assert!(errors.contains(told), "{errors}");
    let (_, _, errors) = by(&roster, &["--by", "Name"]);
    assert!(
        errors.contains("has not one column Name; its columns, with tabs"),
        "{errors}"
    );
    let (code, found, errors) = by(&roster, &["--by", "Kennung"]);
    assert_eq!((code, found.len()), (Some(2), 2));
    assert!(
        errors.contains("a.json and") && errors.contains("b.json are both of row 2 of the roster"),
        "{errors}"
    );
    let roster = write(b"Name\nJ\xfcrgen\n");
    assert!(
        by(&roster, &[]).2.contains("is not UTF-8; save it as"),
        "Latin-1"
    );
    // Without a roster they may be two students.
    let (code, found, errors) = csv(&[], &files);
    assert_eq!((code, found.len()), (Some(2), 3));
    assert!(
        errors.contains("is of s114 and") && errors.contains("if that is one student"),
        "{errors}"
    );
}
