//! Bytes as a session's file: with the lengths and the checksum that would stop every other change.
//!
//! `docs/sessions.md` describes the file.

use ch16_slam2d::digest::Digest;
use ch16_slam2d::loops::DetectorKind;
use ch16_slam2d::matching::{
    MatcherKind, NdtMatcherConfig, SearchMatcherConfig, StagedMatcherConfig,
};
use ch16_slam2d::places::PlaceDetectorConfig;
use ch16_slam2d::scan::LaserScan;
use ch16_slam2d::slam::SlamConfig;
use robot_io::session::{MAGIC, VERSION, config_text};

/// The sections in their order.
const SECTIONS: [&[u8; 4]; 10] = [
    b"CONF", b"SENS", b"STAT", b"NODE", b"EDGE", b"HELD", b"SCAN", b"MAPD", b"WAYS", b"FRNT",
];

/// A file around these sections.
pub fn sealed(body: &[u8]) -> Vec<u8> {
    let mut file = MAGIC.to_vec();
    file.extend_from_slice(&VERSION.to_le_bytes());
    file.extend_from_slice(&(body.len() as u64).to_le_bytes());
    file.extend_from_slice(body);
    let mut digest = Digest::new();
    for word in file.chunks(8) {
        let mut whole = [0; 8];
        whole[..word.len()].copy_from_slice(word);
        digest.add_bits(u64::from_le_bytes(whole));
    }
    file.extend_from_slice(&digest.value().to_le_bytes());
    file
}

/// The sections of `text`, which follow each other by their letters alone, with their lengths. The
/// parameters of `kind` stand for the lines that the first section lacks.
pub fn with_lengths(kind: usize, mut text: &[u8]) -> Vec<u8> {
    let mut body = Vec::new();
    for (number, tag) in SECTIONS.iter().enumerate() {
        text = text.strip_prefix(&tag[..]).unwrap_or(text);
        let next = SECTIONS.get(number + 1);
        let end = next.and_then(|next| text.windows(4).position(|letters| letters == &next[..]));
        let (content, rest) = text.split_at(end.unwrap_or(text.len()));
        text = rest;
        let content = match number {
            0 => parameters(kind, content),
            _ => content.to_vec(),
        };
        body.extend_from_slice(&tag[..]);
        body.extend_from_slice(&(content.len() as u64).to_le_bytes());
        body.extend_from_slice(&content);
    }
    body
}

/// The parameters of `kind` with these lines in place of its own.
fn parameters(kind: usize, lines: &[u8]) -> Vec<u8> {
    let kinds = configs();
    let mut text = config_text(&kinds[kind % kinds.len()]).into_bytes();
    // Of two lines of one name the last one counts.
    text.extend_from_slice(lines);
    text
}

/// One of each kind of part.
fn configs() -> [SlamConfig; 8] {
    let plain = SlamConfig::default();
    let matched = |matcher| plain.clone().with_matcher(matcher);
    let detecting = |places| {
        let mut config = plain.clone();
        config.loops.detector = DetectorKind::Place(places);
        config
    };
    [
        SlamConfig::for_robot(&LaserScan::default()),
        matched(MatcherKind::PointToPoint),
        matched(MatcherKind::Ndt(NdtMatcherConfig::default())),
        matched(MatcherKind::Staged(StagedMatcherConfig::default())),
        matched(MatcherKind::Search(SearchMatcherConfig::default())),
        detecting(PlaceDetectorConfig::histogram(0)),
        detecting(PlaceDetectorConfig::context(0)),
        plain.clone().with_submaps(),
    ]
}

#[cfg(test)]
mod tests {
    use pr_geom::SE2;
    use robot_io::log::LogFrame;
    use robot_io::run::{LogRun, OdometryUse};

    use super::*;

    /// What [`sealed`] and [`with_lengths`] put around the sections of a file.
    fn taken_apart(kind: usize, file: &[u8]) -> Vec<u8> {
        let mut rest = &file[20..file.len() - 8];
        let mut text = Vec::new();
        for tag in SECTIONS {
            let length = u64::from_le_bytes(rest[4..12].try_into().unwrap()) as usize;
            let (content, after) = rest[12..].split_at(length);
            text.extend_from_slice(&tag[..]);
            if tag == b"CONF" {
                let own = config_text(&configs()[kind]);
                let lines = core::str::from_utf8(content).unwrap().lines();
                for line in lines.filter(|line| !own.lines().any(|known| known == *line)) {
                    text.extend_from_slice(line.as_bytes());
                    text.push(b'\n');
                }
            } else {
                text.extend_from_slice(content);
            }
            rest = after;
        }
        text
    }

    #[test]
    fn a_file_that_is_taken_apart_and_put_together_is_a_session_again() {
        for kind in 0..configs().len() {
            let mut run = LogRun::new(OdometryUse::Log).with_config(configs()[kind].clone());
            for step in 0..3 {
                let along_m = 0.4 * f64::from(step);
                run.step(LogFrame {
                    stamp_s: f64::from(step),
                    odometry: Some(SE2::new(along_m, 0.0, 0.0)),
                    scan: LaserScan {
                        angle_step_rad: 0.75,
                        ranges_m: (0..8).map(|beam| 1.0 + 0.125 * f64::from(beam)).collect(),
                        ..LaserScan::default()
                    },
                });
            }
            run.finish();
            let session = run.session().unwrap();
            let file = sealed(&with_lengths(kind, &taken_apart(kind, &session.to_bytes())));
            let again = robot_io::session::Session::of_bytes(&file, "x").unwrap();
            assert_eq!(again, session, "{kind}");
        }
    }
}
