//! Runs the sample through the engine, and executes a user's orders.

use std::sync::OnceLock;

use log_messages::{KeyframeReport, LoopDecision, LoopReport, MapperOrder, MapperReport, Stage};
use robot_io::log::LogOptions;
use robot_io::log_bytes::LogBytes;
use robot_io::log_format::LogFormat;
use robot_io::run::LogRun;
use slam_robot::engine::Engine;
use slam_robot::given::Given;
use slam_robot::sample;
use slam_robot::update::{LoopEvidence, Update};

/// The first report of a kind, as it arrives.
macro_rules! of {
    ($updates:expr, $kind:ident) => {{
        let sent = $updates.iter().find_map(|update| match update {
            slam_robot::update::Update::Report(report @ log_messages::MapperReport::$kind(_)) => {
                log_messages::MapperReport::from_bytes(&report.to_bytes())
            }
            _ => None,
        });
        match sent {
            Some(log_messages::MapperReport::$kind(content)) => content,
            _ => panic!("no report {}", stringify!($kind)),
        }
    }};
}
pub(crate) use of;

pub fn files() -> &'static (Vec<u8>, Vec<u8>) {
    static FILES: OnceLock<(Vec<u8>, Vec<u8>)> = OnceLock::new();
    FILES.get_or_init(sample::ring)
}

pub fn given<'a>(bytes: &'a [u8], name: &str) -> Given<'a> {
    Given::one(name, bytes.len() as u64, bytes)
}

pub fn open<'a>(bytes: &'a [u8], name: &str) -> Result<Engine<'a>, String> {
    Engine::open(given(bytes, name), &LogOptions::default())
}

pub fn finished(bytes: &[u8]) -> Engine<'_> {
    let mut engine = open(bytes, "ring.log").unwrap();
    while engine.step() {}
    engine
}

/// Executes an order, and everything that follows of it.
pub fn ordered(engine: &mut Engine<'_>, order: MapperOrder) -> Vec<Update> {
    engine.order(order);
    while engine.step() {}
    engine.updates()
}

/// Removes the first loop of the list; returns the updates.
pub fn reject_first(engine: &mut Engine<'_>) -> Vec<Update> {
    let updates = ordered(engine, MapperOrder::Turn(0));
    let text = of!(updates, Answer);
    assert!(text.contains("was removed from the graph"), "{text}");
    updates
}

#[test]
fn the_sample_becomes_a_map_with_loops_and_its_grade() {
    let (log, truth) = files();
    let mut engine = finished(log);
    assert_eq!(engine.stage(), Stage::Done);
    engine.take_reference(truth, "ring-truth.tum").unwrap();
    let updates = engine.updates();
    let progress = of!(updates, Progress);
    assert_eq!((progress.stage, progress.share), (Stage::Done, 1.0));
    assert!(progress.scans > 100, "scans: {}", progress.scans);
    let keyframes = of!(updates, Keyframes).len();
    let map = of!(updates, Map);
    assert_eq!(map.cells.len() % map.columns, 0);
    assert!(map.cells.contains(&0) && map.cells.iter().any(|&cell| cell > 240));
    let loops = of!(updates, Loops);
    let is_closed = |link: &LoopReport| link.decision == LoopDecision::Closed;
    assert!(loops.iter().any(is_closed), "none closed");
    let grade = of!(updates, Grade);
    // The sensor has a resolution of a centimetre and the ring is 40 m long: a larger error would mean divergence.
    assert!(grade.error_m < 0.1, "{}", grade.words);
    assert_eq!(grade.errors_m.len(), keyframes);
}

/// The ends of loops, in their order.
fn ends(loops: &[LoopReport]) -> Vec<[usize; 2]> {
    loops.iter().map(|link| [link.new, link.old]).collect()
}

#[test]
fn loops_stand_in_the_order_of_doubt_each_with_its_own_evidence() {
    let (log, _) = files();
    let mut engine = finished(log);
    let sent = of!(engine.updates(), Loops);
    let is_closed = |link: &&LoopReport| link.decision == LoopDecision::Closed;
    let closed: Vec<_> = sent.iter().filter(is_closed).collect();
    assert!(closed.len() > 5);
    assert!(
        closed.windows(2).all(|two| two[0].chi2 >= two[1].chi2),
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
        let found = closed
            .iter()
            .find(|sent| (sent.new, sent.old) == (link.from, link.to));
        assert_eq!(
            found.map(|sent| Some(sent.chi2)),
            Some(link.chi2),
            "{link:?}"
        );
    }
    // A loop keeps its number while it is removed, even if it is no longer the most doubtful.
    let after = of!(reject_first(&mut engine), Loops);
    assert_eq!(ends(&after), ends(&sent));
}

/// The number of loops in doubt, and the first few.
fn evidence(updates: &[Update]) -> (usize, Vec<LoopEvidence>) {
    let mut found = updates.iter().filter_map(|update| match update {
        Update::Evidence(evidence) => Some((evidence.count, evidence.loops.clone())),
        _ => None,
    });
    found.next().expect("evidence")
}

#[test]
fn a_contradicting_loop_shows_both_scans_and_is_accepted_or_rejected_once() {
    let (log, _) = files();
    let mut engine = finished(log);
    let first = ordered(&mut engine, MapperOrder::Look(0));
    assert_eq!(evidence(&first).0, 0, "the sample is clean");
    // A keyframe held beside its place contradicts the loops that end there.
    let held = of!(first, Loops)[0].new;
    let [x, y, theta] = of!(first, Keyframes)[held].pose;
    let added = ordered(&mut engine, MapperOrder::Pin(held, [x + 0.5, y, theta]));
    let (count, shown) = evidence(&added);
    assert!(count >= 1 && shown.len() <= 6);
    assert!(shown.iter().all(|wrong| wrong.chi2 > wrong.gate_chi2));
    let wrong = &shown[0];
    assert_eq!(wrong.ends, ends(&of!(added, Loops))[wrong.index]);
    assert!(wrong.scans.iter().all(|scan| scan.len() > 50));
    let doubts = |updates: &[Update]| {
        let doubts = updates.iter().find_map(|update| match update {
            Update::Report(MapperReport::Doubts { keyframes, .. }) => Some(keyframes.len()),
            _ => None,
        });
        doubts.expect("doubts")
    };

    let order = |request: &str| MapperOrder::from_request(request).unwrap();
    let accepted = ordered(&mut engine, order(&wrong.accept));
    assert_eq!(evidence(&accepted).0, count - 1);
    let decision = |updates: &[Update]| of!(updates, Loops)[wrong.index].decision;
    assert_eq!(decision(&accepted), LoopDecision::Confirmed);
    assert!(doubts(&accepted) < doubts(&added));

    let rejected = ordered(&mut engine, order(&wrong.reject));
    assert_eq!(decision(&rejected), LoopDecision::Removed);
    assert!(of!(rejected, Answer).contains("was removed"));
    let again = ordered(&mut engine, order(&wrong.reject));
    assert_eq!(
        of!(again, Answer),
        format!("there is no loop {} in the graph", wrong.index)
    );
    assert!(again.iter().all(|update| update.kind() != "loops"));
}

#[test]
fn changes_of_an_earlier_worker_are_made_again_before_the_map_counts_as_complete() {
    let (log, _) = files();
    let mut engine = finished(log);
    let turned = ordered(&mut engine, MapperOrder::Turn(0));
    let [x, y, theta] = of!(turned, Keyframes)[20].pose;
    for shift_m in [0.1, 0.2] {
        engine.order(MapperOrder::Pin(20, [x + shift_m, y, theta]));
    }
    // Nothing changes there.
    engine.order(MapperOrder::Turn(usize::MAX));
    while engine.step() {}
    let updates = engine.updates();
    let edits = updates.iter().rev().find_map(|update| match update {
        Update::Edits(edits) => Some(edits.clone()),
        _ => None,
    });
    let edits = edits.unwrap();
    assert_eq!(
        edits,
        [
            MapperOrder::Turn(0),
            MapperOrder::Pin(20, [x + 0.2, y, theta])
        ],
        "of a drag the last pose"
    );

    let mut again = open(log, "ring.log").unwrap();
    again.repeat(edits);
    while !again.is_mapped() {
        assert!(again.step());
    }
    while again.step() {}
    let edges = |engine: &mut Engine<'_>| {
        let graph = String::from_utf8(engine.file("graph.g2o").unwrap()).unwrap();
        graph.matches("EDGE_SE2").count()
    };
    assert_eq!(edges(&mut again), edges(&mut engine));
    assert_eq!(
        of!(again.updates(), Keyframes)[20].pose,
        [x + 0.2, y, theta]
    );
}

#[test]
fn a_loop_that_is_rejected_leaves_the_graph_and_comes_back() {
    let (log, _) = files();
    let mut engine = finished(log);
    let before = engine.updates();
    let edges = |engine: &mut Engine<'_>| {
        let graph = String::from_utf8(engine.file("graph.g2o").unwrap()).unwrap();
        graph.matches("EDGE_SE2").count()
    };
    let all = edges(&mut engine);
    assert_eq!(
        of!(before, Loops)[0].decision,
        LoopDecision::Closed,
        "closed ones come first"
    );
    let after = reject_first(&mut engine);
    assert_eq!(of!(after, Loops)[0].decision, LoopDecision::Removed);
    assert_eq!(edges(&mut engine), all - 1);
    engine.order(MapperOrder::Turn(0));
    while engine.step() {}
    assert_eq!(edges(&mut engine), all);
    let back = engine.updates();
    let [old, new] = [before, back].map(|updates| of!(updates, Keyframes));
    // 1e-3 m: the solver stops at small steps, from another start.
    let off = |(old, new): &(&KeyframeReport, &KeyframeReport)| {
        [0, 1]
            .iter()
            .any(|&axis| (old.pose[axis] - new.pose[axis]).abs() > 1e-3)
    };
    assert_eq!(old.iter().zip(&new).filter(off).count(), 0);
}

#[test]
fn a_keyframe_that_is_dragged_stays_there_until_it_is_let_go() {
    let (log, _) = files();
    let mut engine = finished(log);
    let before = engine.updates();
    let keyframes = of!(before, Keyframes);
    let [x, y, theta] = keyframes[20].pose;
    engine.order(MapperOrder::Pin(20, [x + 0.5, y, theta]));
    let moved = of!(engine.updates(), Keyframes);
    assert_eq!(moved[20].pose[0], x + 0.5);
    assert!(
        moved[19].pose[0] > keyframes[19].pose[0] + 0.1,
        "its neighbours follow"
    );
    let checked = |engine: &mut Engine| {
        while engine.step() {}
        engine.updates()
    };
    let are_doubted = |updates: &[Update]| {
        updates.iter().any(|update| match update {
            Update::Report(MapperReport::Doubts { sentences, .. }) => sentences
                .iter()
                .any(|doubt| doubt.contains("the path from keyframe")),
            _ => false,
        })
    };
    assert!(
        are_doubted(&checked(&mut engine)),
        "what was measured speaks against it"
    );
    engine.order(MapperOrder::Unpin);
    let back = checked(&mut engine);
    assert!(!are_doubted(&back));
    // 0.01 m: the same minimum, within the solver's last step.
    assert!((of!(back, Keyframes)[20].pose[0] - x).abs() < 0.01);
}

#[test]
fn a_loop_is_added_if_two_scans_fit_and_otherwise_rejected_with_a_reason() {
    let (log, _) = files();
    let mut engine = finished(log);
    let updates = engine.updates();
    let keyframes = of!(updates, Keyframes).len();
    let first = &of!(updates, Loops)[0];
    engine.order(MapperOrder::Add(first.new, first.old));
    let text = of!(engine.updates(), Answer);
    assert!(text.contains("closes a loop with"), "{text}");
    // Opposite sides of the ring see different corridors.
    engine.order(MapperOrder::Add(0, keyframes / 4));
    let text = of!(engine.updates(), Answer);
    assert!(text.contains("does not close a loop"), "{text}");
    engine.order(MapperOrder::Add(3, 3));
    let text = of!(engine.updates(), Answer);
    assert!(text.contains("two keyframes"), "{text}");
}

#[test]
fn a_reading_that_is_stopped_keeps_what_was_read() {
    let (log, truth) = files();
    let mut engine = open(log, "ring.log").unwrap();
    // The doctor's pass is complete before the first scan is mapped.
    let scans = |engine: &mut Engine<'_>| of!(engine.updates(), Progress).scans;
    while scans(&mut engine) < 60 {
        engine.step();
    }
    engine.order(MapperOrder::Turn(0));
    engine.cancel();
    while engine.step() {}

    let mut unread = open(log, "ring.log").unwrap();
    unread.cancel();
    unread.take_reference(truth, "ring-truth.tum").unwrap();
    let updates = unread.updates();
    assert_eq!(
        of!(updates, Progress).problem,
        "ring.log was stopped before its first scan"
    );
    assert!(updates.iter().all(|update| update.kind() != "answer"));

    let updates = engine.updates();
    assert_eq!(engine.stage(), Stage::Done);
    assert_eq!(of!(updates, Progress).scans, 60);
    let answers = updates.iter().filter_map(|update| match update {
        Update::Report(MapperReport::Answer(answer)) => Some(answer.as_str()),
        _ => None,
    });
    let answers: Vec<&str> = answers.collect();
    assert!(answers[0].contains("once the whole log is read"));
    assert_eq!(answers[1], "Stopped after 60 scans.");
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
    let mut engine = Engine::open(given, &LogOptions::default()).unwrap();
    while engine.step() {}
    assert_eq!(engine.stage(), Stage::Done);
    let text = of!(engine.updates(), Answer);
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
    let mut graph = source.file("graph.g2o").unwrap();
    graph.extend_from_slice(b"VERTEX_XY 9999 1 1\n");
    let mut engine = open(&graph, "graph.g2o").unwrap();
    let remarks = of!(engine.updates(), Remarks);
    assert!(
        remarks[0].contains("landmarks are not optimized"),
        "{remarks:?}"
    );
    while engine.step() {}
    let updates = engine.updates();
    assert_eq!(engine.stage(), Stage::Done);
    let has_scans = updates.iter().any(|update| {
        matches!(
            update,
            Update::Report(MapperReport::File {
                has_scans: true,
                ..
            })
        )
    });
    assert!(!has_scans);
    assert!(!of!(updates, Loops).is_empty());
    reject_first(&mut engine);
    engine.order(MapperOrder::Add(3, 30));
    assert!(of!(engine.updates(), Answer).contains("no scans"));
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
    let text = of!(updates, Remarks).join("\n");
    assert!(text.contains("incomplete"), "{text}");
    let text = of!(updates, Answer);
    assert!(
        text.contains("incomplete"),
        "it is no map of all of it: {text}"
    );

    assert_eq!(
        open(b"", "x.log").err().unwrap(),
        "x.log is empty; use a recorded log"
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
    let text = of!(engine.updates(), Progress).problem;
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
    let text = of!(engine.updates(), Progress).problem;
    assert!(text.starts_with(expected), "{text}");
    engine.order(MapperOrder::Turn(0));
    assert!(of!(engine.updates(), Answer).contains("no graph"));
    assert!(engine.file("graph.g2o").is_err());
}
