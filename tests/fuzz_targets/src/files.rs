//! Small text formats: trajectories, relations, graphs, and worlds in files and links.
//!
//! The first byte selects the format, the rest is the text.

use pr_geom::SE2;
use pr_sim::course::Course;
use pr_sim::sketch::Sketch;
use robot_io::evaluate::{Alignment, relation_errors, truth_errors};
use robot_io::graph_file::GraphFile;
use robot_io::relations::{Relation, read_relations};
use robot_io::trajectory::{StampedPose, Trajectory};

use crate::sentences::{NAME, assert_rejection, assert_sentence};

/// A text is rejected in one sentence, or survives a round trip through writing and reading.
pub fn fuzz(data: &[u8]) {
    let Some((format, text)) = data.split_first() else {
        return;
    };
    match format % 6 {
        0 => trajectory(text),
        1 => relations(text),
        2 => graph(text),
        3 => world(text),
        4 => sketch(&String::from_utf8_lossy(text)),
        // Also reads the text with a valid checksum.
        _ => sketch(&with_checksum(&String::from_utf8_lossy(text))),
    }
}

/// The value that was read, or `None` after checking that the error is one sentence.
fn accepted<T, E: std::error::Error>(read: Result<T, E>) -> Option<T> {
    read.map_err(|rejection| assert_rejection(&rejection.to_string()))
        .ok()
}

fn trajectory(text: &[u8]) {
    let Some(read) = accepted(Trajectory::read_tum(text, NAME)) else {
        return;
    };
    let mut written = Vec::new();
    read.write_tum(&mut written).expect("memory takes it");
    let again = Trajectory::read_tum(&written[..], NAME).expect("what was written can be read");
    assert_eq!(again.poses().len(), read.poses().len());
    for (old, new) in read.poses().iter().zip(again.poses()) {
        assert_eq!(old.stamp_s.to_bits(), new.stamp_s.to_bits());
        assert_same(&old.pose, &new.pose);
    }
    if let Ok(report) = truth_errors(&read, &again, Alignment::None) {
        // 1e-9: a shift by Earth's size, turned by the last bit of a heading.
        assert!(report.ate.max <= 1e-9, "{report:?}");
        assert!(report.rpe.trans.max.is_finite() && report.rpe.rot_deg.max < 1e-9);
    }
    if let Ok(report) = truth_errors(&read, &again, Alignment::Se2) {
        assert!(report.ate.max.is_finite(), "{report:?}");
    }
    let [first, last] = [read.poses().first(), read.poses().last()];
    if let (Some(first), Some(last)) = (first, last) {
        let way = Relation {
            first_s: first.stamp_s,
            second_s: last.stamp_s,
            motion: first.pose.between(&last.pose),
        };
        let errors = relation_errors(&read, &[way]);
        assert_eq!(errors.outside, 0);
        assert!(errors.report().trans.mean < 1e-6, "{errors:?}");
    }
    let carried = read.carried_by(&again);
    carried.poses().iter().for_each(assert_stamped);
}

fn assert_stamped(stamped: &StampedPose) {
    crate::runs::assert_finite(&stamped.pose);
}

fn relations(text: &[u8]) {
    let Some(read) = accepted(read_relations(text, NAME)) else {
        return;
    };
    let line = |relation: &Relation| {
        let [x, y, theta] = relation.motion.to_array();
        let [first_s, second_s] = [relation.first_s, relation.second_s];
        format!("{first_s} {second_s} {x} {y} 0 0 0 {theta}\n")
    };
    let written: String = read.iter().map(line).collect();
    let again = read_relations(written.as_bytes(), NAME).expect("what was written can be read");
    assert_eq!(again.len(), read.len());
    for (old, new) in read.iter().zip(&again) {
        assert_eq!((old.first_s, old.second_s), (new.first_s, new.second_s));
        assert_same(&old.motion, &new.motion);
    }
}

fn graph(text: &[u8]) {
    let Some((read, _)) = accepted(GraphFile::read(text, NAME)) else {
        return;
    };
    let json = serde_json::to_vec(&read).expect("finite numbers can be written");
    let (again, _) = GraphFile::read(&json, NAME).expect("what was written can be read");
    assert_eq!(again, read);
    for text in [read.to_g2o(), read.to_toro()] {
        let (again, _) =
            GraphFile::read(text.as_bytes(), NAME).expect("what was written can be read");
        assert_eq!(again.nodes.len(), read.nodes.len());
        for (old, new) in read.nodes.iter().zip(&again.nodes) {
            assert_eq!(old.id, new.id);
            assert_same(&pose(old.pose), &pose(new.pose));
        }
        assert_eq!(again.edges.len(), read.edges.len());
        for (old, new) in read.edges.iter().zip(&again.edges) {
            assert_eq!((old.from, old.to), (new.from, new.to));
            assert_eq!(old.information, new.information);
            assert_same(&pose(old.measurement), &pose(new.measurement));
        }
    }
}

fn pose([x, y, theta]: [f64; 3]) -> SE2 {
    SE2::new(x, y, theta)
}

/// Positions have equal bits; headings may be wrapped again when they are read.
fn assert_same(old: &SE2, new: &SE2) {
    assert_eq!((old.x(), old.y()), (new.x(), new.y()));
    let turn = (old.theta() - new.theta()).abs();
    // 1e-12: a few last bits of an angle, which may be a whole turn.
    let is_turn = turn < 1e-12 || (turn - core::f64::consts::TAU).abs() < 1e-12;
    assert!(is_turn, "{old:?} is not {new:?}");
}

fn world(text: &[u8]) {
    match Course::from_json(text) {
        Ok(course) => sketched(&Sketch::from_course(&course)),
        Err(rejection) => assert_sentence(&rejection.to_string()),
    }
}

fn sketch(text: &str) {
    match Sketch::from_text(text) {
        Ok(sketch) => sketched(&sketch),
        Err(rejection) => assert_sentence(&rejection.to_string()),
    }
}

/// A flat is passed as text and as a file, with the same course.
fn sketched(sketch: &Sketch) {
    assert_eq!(Sketch::from_text(&sketch.to_text()).as_ref(), Ok(sketch));
    let json = sketch.to_json();
    assert_eq!(Course::from_json(json.as_bytes()), sketch.course());
    match sketch.course() {
        Ok(course) => assert_eq!(&Sketch::from_course(&course), sketch),
        Err(rejection) => assert_sentence(&rejection.to_string()),
    }
}

/// Appends the five check digits that `pr_sim::sketch` describes.
fn with_checksum(text: &str) -> String {
    const DIGITS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
    let step = |hash: u32, byte: u8| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193);
    let sum = text.bytes().fold(0x811c_9dc5, step);
    let digits = (0..5).map(|place| char::from(DIGITS[(sum >> (6 * place)) as usize % 64]));
    text.chars().chain(digits).collect()
}
