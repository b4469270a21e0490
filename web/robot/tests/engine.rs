//! Runs the sample through the engine, and executes a user's orders.

use std::sync::OnceLock;

use robot_io::log::LogOptions;
use robot_io::log_bytes::LogBytes;
use robot_io::log_format::LogFormat;
use robot_io::run::LogRun;
use slam_robot::engine::Engine;
use slam_robot::given::{Choices, Given};
use slam_robot::sample;
use slam_robot::update::{Stage, Update};

pub fn files() -> &'static (Vec<u8>, Vec<u8>) {
    static FILES: OnceLock<(Vec<u8>, Vec<u8>)> = OnceLock::new();
    FILES.get_or_init(sample::ring)
}

pub fn given<'a>(bytes: &'a [u8], name: &str) -> Given<'a> {
    Given::one(name, bytes.len() as u64, bytes)
}

pub fn open<'a>(bytes: &'a [u8], name: &str) -> Result<Engine<'a>, String> {
    Engine::open(given(bytes, name), &Choices::default())
}

pub fn finished(bytes: &[u8]) -> Engine<'_> {
    let mut engine = open(bytes, "ring.log").unwrap();
    while engine.step() {}
    engine
}

/// Removes the first loop of the list; returns the updates.
pub fn refuse_first(engine: &mut Engine<'_>) -> Vec<Update> {
    engine.order("turn 0");
    while engine.step() {}
    let updates = engine.updates();
    let text = &of(&updates, "answer").text;
    assert!(text.contains("was removed from the graph"), "{text}");
    updates
}

pub fn of<'u>(updates: &'u [Update], kind: &str) -> &'u Update {
    updates
        .iter()
        .find(|update| update.kind == kind)
        .unwrap_or_else(|| panic!("no update of {kind}"))
}

#[test]
fn the_sample_becomes_a_map_with_loops_and_its_grade() {
    let (log, truth) = files();
    let mut engine = finished(log);
    assert_eq!(engine.stage(), Stage::Done);
    engine.take_reference(truth, "ring-truth.tum").unwrap();
    let updates = engine.updates();
    let stage = &of(&updates, "stage").numbers;
    assert_eq!((stage[0], stage[1]), (5.0, 1.0));
    assert!(stage[2] > 100.0, "scans: {}", stage[2]);
    let keyframes = of(&updates, "keyframes").numbers.len() / 6;
    let map = of(&updates, "map");
    assert_eq!(map.numbers[0] * map.numbers[1], map.bytes.len() as f64);
    assert!(map.bytes.contains(&0) && map.bytes.iter().any(|&cell| cell > 240));
    let loops = &of(&updates, "loops").numbers;
    assert!(loops.chunks(10).any(|found| found[8] == 0.0), "none closed");
    let grade = of(&updates, "grade");
    // The sensor has a resolution of a centimetre and the ring is 40 m long: a larger error would mean divergence.
    assert!(grade.numbers[2] < 0.1, "{}", grade.text);
    assert_eq!(of(&updates, "errors").numbers.len(), keyframes);
}

/// Loops of an update: newer and older keyframe, χ² and its gate, and the verdict.
fn sent_loops(updates: &[Update]) -> Vec<([usize; 2], f64, f64, f64)> {
    let loops = of(updates, "loops").numbers.chunks(10);
    loops
        .map(|sent| {
            let ends = [sent[0] as usize, sent[1] as usize];
            (ends, sent[6], sent[7], sent[8])
        })
        .collect()
}

#[test]
fn loops_stand_in_the_order_of_doubt_each_with_its_own_evidence() {
    let (log, _) = files();
    let mut engine = finished(log);
    let sent = sent_loops(&engine.updates());
    let closed: Vec<_> = sent.iter().filter(|sent| sent.3 == 0.0).collect();
    assert!(closed.len() > 5);
    assert!(
        closed.windows(2).all(|two| two[0].1 >= two[1].1),
        "{sent:?}"
    );

    // The same log through the command's reader.
    let mut reader = LogFormat::open(&log[..], "ring.log", &LogOptions::default()).unwrap();
    let mut run = LogRun::default();
    while let Some(frame) = reader.next_frame().unwrap() {
        run.step(frame);
    }
    run.finish();
    let quality = run.quality();
    assert_eq!(quality.links.len(), closed.len());
    for link in &quality.links {
        let found = closed.iter().find(|sent| sent.0 == [link.from, link.to]);
        assert_eq!(found.map(|sent| Some(sent.1)), Some(link.chi2), "{link:?}");
    }
    // A loop keeps its number while it is removed, even if it is no longer the most doubtful.
    let after = sent_loops(&refuse_first(&mut engine));
    let ends =
        |sent: &[([usize; 2], f64, f64, f64)]| sent.iter().map(|sent| sent.0).collect::<Vec<_>>();
    assert_eq!(ends(&after), ends(&sent));
}

/// A loop to look into: its index, the newer and older keyframe, and the points of both scans.
type Evidence = (usize, [usize; 2], [Vec<[f64; 2]>; 2]);

/// Their count, and the first few.
fn evidence(updates: &[Update]) -> (f64, Vec<Evidence>) {
    let (&count, mut rest) = of(updates, "evidence").numbers.split_first().unwrap();
    let mut found = Vec::new();
    while let [index, new, old, chi2, gate, older, newer, more @ ..] = rest {
        assert!(chi2 > gate, "{chi2} of {gate}");
        let (first, more) = more.split_at(2 * *older as usize);
        let (second, more) = more.split_at(2 * *newer as usize);
        let points = |of: &[f64]| of.chunks(2).map(|point| [point[0], point[1]]).collect();
        let ends = [new, old].map(|k| *k as usize);
        found.push((*index as usize, ends, [points(first), points(second)]));
        rest = more;
    }
    (count, found)
}

#[test]
fn a_contradicting_loop_shows_both_scans_and_is_accepted_or_refused_once() {
    let (log, _) = files();
    let mut engine = finished(log);
    let mut ordered = |order: &str| {
        engine.order(order);
        while engine.step() {}
        engine.updates()
    };
    let first = ordered("look 0");
    assert_eq!(of(&first, "evidence").numbers, [0.0], "the sample is clean");
    // A keyframe held beside its place contradicts the loops that end there.
    let ends = sent_loops(&first)[0].0;
    let at = &of(&first, "keyframes").numbers[6 * ends[0]..];
    let added = ordered(&format!(
        "pin {} {} {} {}",
        ends[0],
        at[1] + 0.5,
        at[2],
        at[3]
    ));
    let (count, shown) = evidence(&added);
    assert!(count >= 1.0 && shown.len() <= 6);
    let (wrong, of_it, scans) = &shown[0];
    assert_eq!(*of_it, sent_loops(&added)[*wrong].0);
    assert!(scans.iter().all(|scan| scan.len() > 50));
    let doubts = |updates: &[Update]| of(updates, "doubts").numbers.len();

    let accepted = ordered(&format!("accept {wrong}"));
    assert_eq!(evidence(&accepted).0, count - 1.0);
    assert_eq!(sent_loops(&accepted)[*wrong].3, 4.0);
    assert!(doubts(&accepted) < doubts(&added));

    let refused = ordered(&format!("refuse {wrong}"));
    assert_eq!(sent_loops(&refused)[*wrong].3, 2.0);
    assert!(of(&refused, "answer").text.contains("was removed"));
    let again = ordered(&format!("refuse {wrong}"));
    assert_eq!(
        of(&again, "answer").text,
        format!("there is no loop {wrong} in the graph")
    );
    assert!(again.iter().all(|update| update.kind != "loops"));
}

#[test]
fn a_loop_that_is_refused_leaves_the_graph_and_comes_back() {
    let (log, _) = files();
    let mut engine = finished(log);
    let before = engine.updates();
    let edges = |engine: &mut Engine<'_>| {
        let graph = String::from_utf8(engine.file("graph.g2o").unwrap()).unwrap();
        graph.matches("EDGE_SE2").count()
    };
    let all = edges(&mut engine);
    assert_eq!(
        of(&before, "loops").numbers[8],
        0.0,
        "closed ones come first"
    );
    let after = refuse_first(&mut engine);
    assert_eq!(of(&after, "loops").numbers[8], 2.0);
    assert_eq!(edges(&mut engine), all - 1);
    engine.order("turn 0");
    while engine.step() {}
    assert_eq!(edges(&mut engine), all);
    let back = engine.updates();
    let [old, new] = [&before, &back].map(|updates| &of(updates, "keyframes").numbers);
    // 1e-3 m: the solver stops at small steps, from another start.
    let off = |k: &usize| (old[*k] - new[*k]).abs() > 1e-3;
    let places = (0..old.len()).filter(|k| [1, 2].contains(&(k % 6)));
    assert_eq!(places.filter(off).count(), 0);
}

#[test]
fn a_keyframe_that_is_dragged_stays_there_until_it_is_let_go() {
    let (log, _) = files();
    let mut engine = finished(log);
    let before = engine.updates();
    let keyframes = &of(&before, "keyframes").numbers;
    let [x, y, theta] = [1, 2, 3].map(|at| keyframes[6 * 20 + at]);
    engine.order(&format!("pin 20 {} {y} {theta}", x + 0.5));
    let during = engine.updates();
    let moved = &of(&during, "keyframes").numbers;
    assert_eq!(moved[6 * 20 + 1], x + 0.5);
    assert!(
        moved[6 * 19 + 1] > keyframes[6 * 19 + 1] + 0.1,
        "its neighbours follow"
    );
    let checked = |engine: &mut Engine| {
        while engine.step() {}
        engine.updates()
    };
    let are_doubted = |updates: &[Update]| {
        let doubts = &of(updates, "doubts").text;
        doubts.contains("the path from keyframe")
    };
    assert!(
        are_doubted(&checked(&mut engine)),
        "what was measured speaks against it"
    );
    engine.order("unpin");
    let back = checked(&mut engine);
    assert!(!are_doubted(&back));
    // 0.01 m: the same minimum, within the solver's last step.
    assert!((of(&back, "keyframes").numbers[6 * 20 + 1] - x).abs() < 0.01);
}

#[test]
fn a_loop_is_added_if_two_scans_fit_and_otherwise_rejected_with_a_reason() {
    let (log, _) = files();
    let mut engine = finished(log);
    let updates = engine.updates();
    let keyframes = of(&updates, "keyframes").numbers.len() / 6;
    let loops = &of(&updates, "loops").numbers;
    let (new, old) = (loops[0], loops[1]);
    engine.order(&format!("add {new} {old}"));
    let text = of(&engine.updates(), "answer").text.clone();
    assert!(text.contains("closes a loop with"), "{text}");
    // Opposite sides of the ring see different corridors.
    engine.order(&format!("add 0 {}", keyframes / 4));
    let text = of(&engine.updates(), "answer").text.clone();
    assert!(text.contains("does not close a loop"), "{text}");
    engine.order("add 3 3");
    let text = of(&engine.updates(), "answer").text.clone();
    assert!(text.contains("two keyframes"), "{text}");
}

#[test]
fn a_reading_that_is_stopped_keeps_what_was_read() {
    let (log, truth) = files();
    let mut engine = open(log, "ring.log").unwrap();
    // The doctor's pass is complete before the first scan is mapped.
    let scans = |engine: &mut Engine<'_>| of(&engine.updates(), "stage").numbers[2];
    while scans(&mut engine) < 60.0 {
        engine.step();
    }
    engine.order("turn 0");
    engine.order("cancel");
    while engine.step() {}

    let mut unread = open(log, "ring.log").unwrap();
    unread.order("cancel");
    unread.take_reference(truth, "ring-truth.tum").unwrap();
    let updates = unread.updates();
    assert_eq!(
        of(&updates, "stage").text,
        "ring.log was stopped before its first scan"
    );
    assert!(updates.iter().all(|update| update.kind != "answer"));

    let updates = engine.updates();
    assert_eq!(engine.stage(), Stage::Done);
    assert_eq!(of(&updates, "stage").numbers[2], 60.0);
    let text: Vec<_> = updates
        .iter()
        .filter(|update| update.kind == "answer")
        .collect();
    assert!(text[0].text.contains("once the whole log is read"));
    assert_eq!(text[1].text, "Stopped after 60 scans.");
    assert!(engine.file("map.pgm").unwrap().starts_with(b"P5"));
}

#[test]
fn every_file_that_can_be_saved_is_what_its_name_says() {
    let (log, _) = files();
    let mut engine = finished(log);
    for (name, start) in [
        ("map.pgm", "P5\n"),
        ("map.yaml", "image: map.pgm\n"),
        ("map.png", "\u{fffd}PNG"),
        ("trajectory.tum", "0 "),
        ("graph.g2o", "VERTEX_SE2 0 "),
        ("report.html", "<!doctype html>"),
    ] {
        let bytes = engine.file(name).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        assert!(text.starts_with(start), "{name}: {:.20}", text);
    }
    assert!(engine.file("../x").is_err());
    for name in slam_robot::files::NAMES {
        // No other log was localized.
        assert_eq!(engine.file(name).is_ok(), name != "where.tum", "{name}");
    }
}

/// A file that another program moved or changed while it was read.
struct Torn<'a> {
    bytes: &'a [u8],
}

impl std::io::Read for Torn<'_> {
    fn read(&mut self, into: &mut [u8]) -> std::io::Result<usize> {
        match self.bytes.read(into)? {
            0 => Err(std::io::Error::other("it is gone")),
            count => Ok(count),
        }
    }
}

impl std::io::Seek for Torn<'_> {
    fn seek(&mut self, _: std::io::SeekFrom) -> std::io::Result<u64> {
        Err(std::io::Error::other("a log of lines is read in its order"))
    }
}

#[test]
fn a_file_that_goes_while_it_is_read_leaves_a_map_of_a_part_and_says_so() {
    let (log, _) = files();
    let half = log[..log.len() / 2].iter().rposition(|&byte| byte == b'\n');
    let bytes = &log[..=half.unwrap()];
    let source = LogBytes::new(move || Ok(std::io::BufReader::new(Torn { bytes })));
    let given = Given::one("ring.log", log.len() as u64, source);
    let mut engine = Engine::open(given, &Choices::default()).unwrap();
    while engine.step() {}
    assert_eq!(engine.stage(), Stage::Done);
    let text = of(&engine.updates(), "answer").text.clone();
    assert!(text.contains("it is gone"), "{text}");
}

#[test]
fn the_map_s_text_names_the_picture_that_was_saved_with_it() {
    let (log, _) = files();
    let mut engine = finished(log);
    let names = |engine: &mut Engine<'_>, image: &str| {
        let text = engine.file("map.yaml").unwrap();
        text.starts_with(format!("image: {image}\n").as_bytes())
    };
    assert!(names(&mut engine, "map.pgm"));
    engine.file("map.png").unwrap();
    engine.file("trajectory.tum").unwrap();
    assert!(names(&mut engine, "map.png"));
    engine.file("map.pgm").unwrap();
    assert!(names(&mut engine, "map.pgm"));
}

#[test]
fn a_graph_is_solved_and_edited_without_scans() {
    let (log, _) = files();
    let mut source = finished(log);
    let graph = source.file("graph.g2o").unwrap();
    let mut engine = open(&graph, "graph.g2o").unwrap();
    while engine.step() {}
    let updates = engine.updates();
    assert_eq!(engine.stage(), Stage::Done);
    assert_eq!(of(&updates, "file").numbers[1], 0.0);
    assert!(!of(&updates, "loops").numbers.is_empty());
    refuse_first(&mut engine);
    engine.order("add 3 30");
    assert!(of(&engine.updates(), "answer").text.contains("no scans"));
    assert!(engine.file("map.png").unwrap_err().contains("no map"));
    assert!(engine.file("graph.g2o").unwrap().starts_with(b"VERTEX_SE2"));
}

#[test]
fn files_that_are_no_logs_are_answered_in_one_sentence() {
    let (log, _) = files();
    let half = &log[..log.len() / 2];
    let mut engine = open(half, "half.log").unwrap();
    while engine.step() {}
    assert_eq!(engine.stage(), Stage::Done);
    let updates = engine.updates();
    let text = &of(&updates, "remarks").text;
    assert!(text.contains("incomplete"), "{text}");
    let text = &of(&updates, "answer").text;
    assert!(
        text.contains("incomplete"),
        "it is no map of all of it: {text}"
    );

    assert_eq!(
        open(b"", "x.log").err().unwrap(),
        "x.log is empty; give a recorded log"
    );
    assert!(
        open(b"\x1f\x8b\x08", "x.gz")
            .err()
            .unwrap()
            .contains("cannot be decompressed")
    );
    assert!(
        open(b"VERTEX_SE2 0 0\n", "x.g2o")
            .err()
            .unwrap()
            .contains("line 1")
    );
    let blind = String::from_utf8_lossy(log).replace("0.01 0 120 ", "90 0 120 ");
    let blind = blind.replace("5.97 90 0 120", "0.001 90 0 120");
    let mut engine = open(blind.as_bytes(), "blind.log").unwrap();
    while engine.step() {}
    assert_eq!(engine.stage(), Stage::Failed);
    let text = of(&engine.updates(), "stage").text.clone();
    assert!(text.contains("no beam of any keyframe"), "{text}");
    let expected = "photo.png is a map or a picture, not a log of scans";
    let picture = [0x89, 0x50, 0x4e, 0x47, 0, 1, 2, 3];
    assert!(
        open(&picture, "photo.png")
            .err()
            .unwrap()
            .starts_with(expected)
    );
    let mut engine = open(b"hello\nworld\n", "photo.png").unwrap();
    while engine.step() {}
    assert_eq!(engine.stage(), Stage::Failed);
    let text = of(&engine.updates(), "stage").text.clone();
    assert!(text.starts_with(expected), "{text}");
    engine.order("turn 0");
    assert!(of(&engine.updates(), "answer").text.contains("no graph"));
    assert!(engine.file("graph.g2o").is_err());
}
