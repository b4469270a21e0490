//! Completes bytes to a session file, with lengths and the checksum, without which every mutation would be
//! rejected.
//!
//! `docs/sessions.md` describes the file.

use ch16_slam2d::digest::Digest;
use ch16_slam2d::slam::RobotConfig;
use robot_io::session::{MAGIC, VERSION};
use robot_io::settings::Setting;

/// The sections in their order.
const SECTIONS: [&[u8; 4]; 10] = [
    b"CONF", b"SENS", b"STAT", b"NODE", b"EDGE", b"HELD", b"SCAN", b"MAPD", b"WAYS", b"FRNT",
];

/// A pose: three numbers of 64 bits.
const START_BYTES: usize = 24;

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

/// Adds the lengths to the sections of `text`, which are separated only by their tags. Lines `NAME VALUE` of
/// the first section change the default parameters.
pub fn with_lengths(mut text: &[u8]) -> Vec<u8> {
    let mut body = Vec::new();
    for (number, tag) in SECTIONS.iter().enumerate() {
        text = text.strip_prefix(&tag[..]).unwrap_or(text);
        let next = SECTIONS.get(number + 1);
        let end = next.and_then(|next| text.windows(4).position(|letters| letters == &next[..]));
        let (content, rest) = text.split_at(end.unwrap_or(text.len()));
        text = rest;
        let content = match number {
            0 => parameters(content),
            _ => content.to_vec(),
        };
        body.extend_from_slice(&tag[..]);
        body.extend_from_slice(&(content.len() as u64).to_le_bytes());
        body.extend_from_slice(&content);
    }
    body
}

/// The start at the origin, and the default parameters with the changes of the lines.
fn parameters(lines: &[u8]) -> Vec<u8> {
    let mut config = RobotConfig::default();
    for line in String::from_utf8_lossy(lines).lines() {
        let Some((name, value)) = line.split_once(' ') else {
            continue;
        };
        if let (Ok(setting), Ok(value)) = (Setting::named(name), value.parse()) {
            config = setting.set(&config, value).unwrap_or(config);
        }
    }
    let mut section = vec![0; START_BYTES];
    section.extend(serde_json::to_vec(&config).expect("plain numbers"));
    section
}

#[cfg(test)]
mod tests {
    use ch16_slam2d::scan::LaserScan;
    use pr_geom::SE2;
    use robot_io::log::LogFrame;
    use robot_io::run::{LogRun, OdometryUse};

    use super::*;

    /// Removes what [`sealed`] and [`with_lengths`] add to the sections of a file.
    fn taken_apart(file: &[u8]) -> Vec<u8> {
        let mut rest = &file[20..file.len() - 8];
        let mut text = Vec::new();
        for tag in SECTIONS {
            let length = u64::from_le_bytes(rest[4..12].try_into().unwrap()) as usize;
            let (content, after) = rest[12..].split_at(length);
            text.extend_from_slice(&tag[..]);
            // The scanner of the test has the default parameters except for one.
            if tag == b"CONF" {
                text.extend_from_slice(b"scan_normal_radius_m 0.7\n");
            } else {
                text.extend_from_slice(content);
            }
            rest = after;
        }
        text
    }

    #[test]
    fn a_file_without_lengths_and_checksum_is_restored_to_a_session() {
        let mut run = LogRun::new(OdometryUse::Log);
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
        let file = sealed(&with_lengths(&taken_apart(&session.to_bytes())));
        let again = robot_io::session::Session::of_bytes(&file, "x").unwrap();
        assert_eq!(again, session);
    }
}
