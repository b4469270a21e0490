//! Sessions saved and opened, another log on the map, and recordings with several topics.

use ch16_slam2d::localize::StartPose;
use log_messages::{LocalizationState, LoopDecision, MapperOrder, MapperReport, OtherLog, Stage};
use pr_geom::SE2;
use robot_io::log::LogOptions;
use robot_io::log_format::LogFormat;
use robot_io::run::LogRun;
use robot_io::session::Session;
use robot_io::trajectory::Trajectory;
use slam_robot::engine::Engine;
use slam_robot::given::{Given, options};
use slam_robot::sample;
use slam_robot::update::Update;

use crate::engine::{files, finished, given, of, open, ordered, reject_first};

fn saved() -> Vec<u8> {
    let mut engine = finished(&files().0);
    engine.file("session.slam2d").unwrap()
}

fn opened(session: &[u8]) -> Engine<'_> {
    let mut engine = open(session, "monday.slam2d").unwrap();
    while engine.step() {}
    engine
}

fn edges(engine: &mut Engine<'_>) -> usize {
    let graph = String::from_utf8(engine.file("graph.g2o").unwrap()).unwrap();
    graph.matches("EDGE_SE2").count()
}

#[test]
fn a_saved_session_is_the_file_that_a_run_leaves() {
    let (log, _) = files();
    let mut reader = LogFormat::open(&log[..], "ring.log", &LogOptions::default()).unwrap();
    let mut run = LogRun::default();
    while let Some(frame) = reader.next_frame().unwrap() {
        run.step(frame);
    }
    run.finish();
    assert!(saved() == run.session().unwrap().to_bytes());
}

#[test]
fn a_session_is_opened_with_its_map_and_loops_and_saved_as_it_was() {
    let session = saved();
    let mut log = finished(&files().0);
    let mut engine = opened(&session);
    assert_eq!(engine.stage(), Stage::Done);
    assert!(engine.file("session.slam2d").unwrap() == session);
    let (before, after) = (log.updates(), engine.updates());
    let has_scans = |update: &Update| {
        matches!(
            update,
            Update::Report(MapperReport::File {
                has_scans: true,
                ..
            })
        )
    };
    assert!(after.iter().any(has_scans));
    assert_eq!(of!(before, Progress).scans, of!(after, Progress).scans);
    let [then, now] = [&before, &after].map(|updates| of!(updates, Keyframes));
    assert_eq!(then.len(), now.len());
    for (then, now) in then.iter().zip(&now) {
        assert_eq!((then.stamp_s, then.pose), (now.stamp_s, now.pose));
        // 1e-9 m: the same graph with its loops in another order.
        assert!(
            (then.sigma_m - now.sigma_m).abs() < 1e-9,
            "σ {} and {}",
            then.sigma_m,
            now.sigma_m
        );
    }
    let closed = |updates: &[Update]| {
        let loops = of!(updates, Loops).into_iter();
        let closed = loops.filter(|found| found.decision == LoopDecision::Closed);
        let mut chi2: Vec<f64> = closed.map(|found| found.chi2).collect();
        chi2.sort_by(f64::total_cmp);
        chi2
    };
    let [then, now] = [closed(&before), closed(&after)];
    assert_eq!(then.len(), now.len());
    // 1e-6: χ² of the same loops against the same graph.
    assert!(then.iter().zip(&now).all(|(a, b)| (a - b).abs() < 1e-6));
    assert!(engine.file("map.pgm").unwrap().starts_with(b"P5"));
    assert_eq!(
        engine.file("graph.g2o").unwrap(),
        log.file("graph.g2o").unwrap()
    );
}

#[test]
fn a_session_is_edited_further_and_what_was_changed_is_saved_with_it() {
    let session = saved();
    let mut engine = opened(&session);
    let all = edges(&mut engine);
    engine.updates();
    reject_first(&mut engine);
    engine.order(MapperOrder::Look(3));
    assert!(of!(engine.updates(), Scan).points.len() > 25);
    let changed = engine.file("session.slam2d").unwrap();
    let mut again = opened(&changed);
    assert_eq!(edges(&mut again), all - 1);
    let [x, y, _] = of!(again.updates(), Keyframes)[20].pose;
    ordered(&mut again, MapperOrder::Pin(20, [x + 0.5, y, 0.0]));
    let pinned = again.file("session.slam2d").unwrap();
    let mut third = opened(&pinned);
    assert_eq!(of!(third.updates(), Keyframes)[20].pose[0], x + 0.5);
    // A continued run starts from the scans, not from what was pinned.
    let session = Session::from_bytes(&pinned, "pinned").unwrap();
    assert!(LogRun::resume(&session).is_ok());
}

#[test]
fn sessions_that_are_broken_are_answered_in_one_sentence() {
    let session = saved();
    let mut newer = session.clone();
    newer[8] = 9;
    let mut spoilt = session.clone();
    spoilt[session.len() / 2] ^= 1;
    for (bytes, expected) in [
        (&b""[..], "is empty"),
        (b"SLAM2D", "ends at byte 6"),
        (
            &session[..session.len() / 2],
            "copy it again, or run the log again",
        ),
        (&newer, "is a session of version 9"),
        (&spoilt, "is damaged"),
        (b"hello", "is not a session"),
    ] {
        let update = open(bytes, "monday.slam2d").err().unwrap();
        assert!(update.starts_with("monday.slam2d "), "{update}");
        assert!(update.contains(expected), "{update}");
        assert_eq!(update.lines().count(), 1);
    }
    let huge = Engine::open(
        Given::one("x.slam2d", 1 << 30, &session[..]),
        &LogOptions::default(),
    );
    assert!(huge.err().unwrap().contains("larger than 512 MB"));
    // A session is recognized by its first bytes alone.
    assert!(open(&session, "monday.log").is_ok());
}

fn look<'a>(engine: &mut Engine<'a>, log: &'a [u8], start: StartPose) -> OtherLog {
    engine.updates();
    let begun = engine.locate(given(log, "tuesday.log"), &LogOptions::default(), start);
    begun.unwrap();
    while engine.step() {}
    of!(engine.updates(), OtherLog)
}

#[test]
fn the_robot_of_another_day_is_found_on_the_map_and_followed() {
    let day = sample::another_day();
    let session = saved();
    let mut engine = opened(&session);
    assert!(
        engine
            .file("where.tum")
            .unwrap_err()
            .contains("No other log")
    );
    let other = look(&mut engine, &day, StartPose::Anywhere);
    assert_eq!(other.name, "tuesday.log");
    assert_eq!((other.share, other.is_over), (1.0, true));
    let scans = other.places.len();
    assert_eq!(other.counts.iter().sum::<usize>(), scans);
    let [found, tracking, ..] = other.counts;
    assert!(found >= 1 && 2 * tracking > scans, "{:?}", other.counts);
    let written = engine.file("where.tum").unwrap();
    let way = Trajectory::read_tum(&written[..], "where.tum").unwrap();
    assert_eq!(way.poses().len(), other.localized());

    // The same as on the command line, which reads the session from the file.
    let session = Session::from_bytes(&session, "monday").unwrap();
    let mut run = robot_io::localize::LocalizeRun::new(&session, StartPose::Anywhere).unwrap();
    let mut reader = LogFormat::open(&day[..], "day", &LogOptions::default()).unwrap();
    while let Some(frame) = reader.next_frame().unwrap() {
        run.step(frame);
    }
    for (report, place) in run.reports().iter().zip(&other.places) {
        let pose = report.pose.map_or([f64::NAN; 3], |pose| pose.to_array());
        // 1e-9: the pose was stored relative to a keyframe.
        let is_same = |a: f64, b: f64| (a - b).abs() < 1e-9 || a.is_nan() && b.is_nan();
        assert!([0, 1, 2].iter().all(|&i| is_same(place.pose[i], pose[i])));
    }
}

#[test]
fn a_start_that_is_given_is_where_the_robot_is_looked_for() {
    let day = sample::another_day();
    let session = saved();
    let mut engine = opened(&session);
    let other = look(&mut engine, &day, StartPose::Anywhere);
    // The best pose of the whole map at the first scan, localized or not.
    let mut poses = other.places.iter().map(|place| place.pose);
    let found = poses.find(|pose| pose[0].is_finite()).unwrap();
    let at = SE2::new(found[0], found[1], found[2]);
    // A wrong initial guess by three metres does not localize the first scan; the right one does.
    let near = look(&mut engine, &day[..], StartPose::Near(at));
    let first = |other: &OtherLog| other.first.unwrap_or(usize::MAX);
    let far = SE2::new(at.x() + 30.0, at.y() + 30.0, at.theta());
    let away = look(&mut engine, &day[..], StartPose::Near(far));
    assert!(
        first(&near) <= first(&away),
        "{} and {}",
        first(&near),
        first(&away)
    );
    assert!(near.places[0].state != LocalizationState::Lost);
}

/// Three points fit in many places, and one in all.
#[test]
fn a_robot_that_sees_too_little_is_shown_nowhere() {
    let day = String::from_utf8(sample::another_day()).unwrap();
    let session = saved();
    for returns in [3, 1] {
        let thin = day.lines().map(|line| {
            let mut words: Vec<&str> = line.split(' ').collect();
            if words[0] == "ROBOTLASER1" {
                let count: usize = words[8].parse().unwrap();
                for (beam, range) in words[9..9 + count].iter_mut().enumerate() {
                    if beam * returns % count >= returns {
                        *range = "0";
                    }
                }
            }
            words.join(" ") + "\n"
        });
        let thin = thin.collect::<String>().into_bytes();
        assert_ne!(thin, day.as_bytes());
        let mut engine = opened(&session);
        let start = StartPose::Near(SE2::identity());
        let other = look(&mut engine, &thin, start);
        assert!(other.places.len() > 10, "{returns}");
        let [found, tracking, ..] = other.counts;
        assert_eq!(
            (found, tracking, other.localized()),
            (0, 0, 0),
            "{returns} returns"
        );
    }
}

#[test]
fn poses_move_with_the_map() {
    let day = sample::another_day();
    let session = saved();
    let mut engine = opened(&session);
    let before = look(&mut engine, &day, StartPose::Anywhere);
    let moved = of!(ordered(&mut engine, MapperOrder::Turn(0)), OtherLog);
    assert_eq!(moved.places.len(), before.places.len());
    let back = of!(ordered(&mut engine, MapperOrder::Turn(0)), OtherLog);
    for (old, new) in before.places.iter().zip(&back.places) {
        let (old, new) = (old.pose[0], new.pose[0]);
        // 1e-3 m: the solver stops at small steps, from another start.
        assert!(old.is_nan() || (old - new).abs() < 1e-3);
    }
}

#[test]
fn files_that_are_not_logs_are_reported_and_change_nothing() {
    let day = sample::another_day();
    let session = saved();
    let mut engine = opened(&session);
    look(&mut engine, &day, StartPose::Anywhere);
    let choices = LogOptions::default();
    let mut tried =
        |bytes: &'static [u8]| engine.locate(given(bytes, "x.log"), &choices, StartPose::Anywhere);
    assert!(tried(b"").unwrap_err().contains("is empty"));
    assert!(
        tried(b"\x1f\x8b")
            .unwrap_err()
            .contains("cannot be decompressed")
    );
    assert!(tried(b"SLAM2D\r\n").is_err());
    assert!(engine.file("where.tum").is_ok());
    let begun = engine.locate(given(b"hello\n", "x.log"), &choices, StartPose::Anywhere);
    begun.unwrap();
    while engine.step() {}
    let other = of!(engine.updates(), OtherLog);
    assert!(other.remarks[0].contains("x.log"), "{:?}", other.remarks);
    assert!(other.places.is_empty());
    assert_eq!(engine.stage(), Stage::Done);
    let (log, _) = files();
    let graph = finished(log).file("graph.g2o").unwrap();
    let mut of_graph = open(&graph, "x.g2o").unwrap();
    while of_graph.step() {}
    let reply = of_graph.locate(given(log, "x.log"), &choices, StartPose::Anywhere);
    assert!(reply.unwrap_err().contains("no scans"));
}

#[test]
fn a_search_is_stopped_and_keeps_what_was_found() {
    let day = sample::another_day();
    let session = saved();
    let mut engine = opened(&session);
    let begun = engine.locate(
        given(&day, "day.log"),
        &LogOptions::default(),
        StartPose::Anywhere,
    );
    begun.unwrap();
    for _ in 0..5 {
        engine.step();
    }
    engine.cancel();
    while engine.step() {}
    let other = of!(engine.updates(), OtherLog);
    assert!(other.is_over);
    assert_eq!(other.places.len(), 5);
}

#[test]
fn a_recording_says_what_its_options_could_choose_and_takes_them() {
    let recording = include_bytes!("../../robot_io/recordings/plain.mcap");
    let mut engine = open(recording, "plain.mcap").unwrap();
    while engine.step() {}
    let offers = of!(engine.updates(), Offers);
    let mut scans = offers.iter().filter(|offer| offer.option == "scan-topic");
    let scans = scans.next().unwrap();
    assert!(scans.names.contains(&scans.taken), "{offers:?}");
    let choices = options("scan-topic /nowhere").unwrap();
    let mut engine = Engine::open(given(recording, "plain.mcap"), &choices).unwrap();
    while engine.step() {}
    let reply = of!(engine.updates(), Progress).problem;
    assert!(reply.contains("/nowhere is not one of"), "{reply}");
}
