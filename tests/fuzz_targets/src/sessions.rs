//! Saved sessions: loaded, written, continued, mapped, and used for localization.
//!
//! The first byte selects how much of the file is added, see [`crate::sealed`]; the rest is the file
//! or its content.

use std::f64::consts::TAU;

use ch16_slam2d::localize::StartPose;
use ch16_slam2d::scan::LaserScan;
use pr_geom::SE2;
use robot_io::localize::LocalizeRun;
use robot_io::log::LogFrame;
use robot_io::map_image::build_session_map;
use robot_io::run::LogRun;
use robot_io::session::Session;
use robot_io::settings::SETTINGS;

use crate::runs::{assert_finite, assert_loads, drive};
use crate::sealed::{sealed, with_parameters};
use crate::sentences::{NAME, assert_rejection, assert_sentence};

/// Larger sessions are loaded and written, but not continued: this target tests the file format.
const MAX_KEYFRAMES: usize = 6;
/// Sessions with more points in a scan are not continued either.
const MAX_POINTS: usize = 64;
/// Sessions with larger parameters are not continued either: iterations, for example, would take too long.
const MAX_SETTING: f64 = 100.0;
/// Cell size of a map, m.
const CELL_M: f64 = 0.5;

/// A file is rejected in one sentence, or it survives a round trip and can be used.
pub fn fuzz(data: &[u8]) {
    let Some((&how, text)) = data.split_first() else {
        return;
    };
    let how = usize::from(how);
    let file = match how % 4 {
        0 => text.to_vec(),
        1 => sealed(text),
        _ => sealed(&with_parameters(text)),
    };
    let session = match Session::from_bytes(&file, NAME) {
        Ok(session) => session,
        Err(rejection) => return assert_rejection(&rejection.to_string()),
    };
    let written = session.to_bytes();
    let again = Session::from_bytes(&written, NAME).expect("what was written can be loaded");
    assert!(again.to_bytes() == written);
    // Debug prints every bit of a number, and also NaN.
    assert_eq!(format!("{again:?}"), format!("{session:?}"));
    if is_small(&session) {
        continue_run(&session);
        localize(&session);
        reopen(&session);
    }
}

fn is_small(session: &Session) -> bool {
    let snapshot = &session.snapshot;
    let scans = snapshot.keyframes.iter().map(|keyframe| &keyframe.scan);
    let mut scans = scans.chain(&snapshot.front_end.scans);
    let robot = snapshot.config.local_map.unwrap_or_default();
    let mut values = SETTINGS.iter().map(|setting| setting.value(&robot));
    snapshot.keyframes.len() <= MAX_KEYFRAMES
        && snapshot.front_end.scans.len() <= MAX_KEYFRAMES
        && scans.all(|scan| scan.len() <= MAX_POINTS)
        && values.all(|value| value <= MAX_SETTING)
}

/// Further scans: a round room, with odometry that moves on.
fn frames(session: &Session) -> impl Iterator<Item = LogFrame> + '_ {
    (1..=2).map(|step| LogFrame {
        stamp_s: session.snapshot.last_stamp_s + 0.25 * f64::from(step),
        odometry: Some(SE2::new(0.5 * f64::from(step), 0.0, 0.1)),
        scan: LaserScan {
            angle_step_rad: TAU / 24.0,
            ranges_m: vec![2.0; 24],
            ..LaserScan::default()
        },
    })
}

fn continue_run(session: &Session) {
    match LogRun::resume(session) {
        // Numbers at the limit of what can be loaded may grow beyond it.
        Ok(mut run) => {
            let saved = drive(&mut run, frames(session)).expect("a run goes on");
            if let Err(rejection) = Session::from_bytes(&saved, NAME) {
                assert_rejection(&rejection.to_string());
            }
        }
        Err(rejection) => assert_sentence(&rejection.to_string()),
    }
}

fn localize(session: &Session) {
    let start = StartPose::Near(session.poses().first().copied().unwrap_or_default());
    for start in [StartPose::Anywhere, start] {
        let mut run = match LocalizeRun::new(session, start) {
            Ok(run) => run,
            Err(rejection) => return assert_sentence(&rejection.to_string()),
        };
        for report in frames(session).filter_map(|frame| run.step(frame).cloned()) {
            report.pose.iter().for_each(assert_finite);
            assert!(report.score.is_none_or(f64::is_finite), "{report:?}");
        }
    }
}

fn reopen(session: &Session) {
    match LogRun::reopen(session) {
        Ok(mut run) => assert_loads(&drive(&mut run, []).expect("it has keyframes")),
        Err(rejection) => assert_sentence(&rejection.to_string()),
    }
    match build_session_map(session, CELL_M) {
        Ok(map) => assert_eq!(map.counts().iter().sum::<usize>(), map.width * map.height),
        Err(rejection) => assert_sentence(&rejection.to_string()),
    }
}
