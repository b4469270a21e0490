//! Wraps bytes as a session file with a valid length and checksum, without which every mutation would be rejected.
//!
//! `docs/sessions.md` describes the file.

use ch16_slam2d::digest::Digest;
use ch16_slam2d::local_map::LocalMapConfig;
use robot_io::session::{MAGIC, VERSION};

/// A file with this content.
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

/// The content of a session with the default parameters; `rest` follows them.
pub fn with_parameters(rest: &[u8]) -> Vec<u8> {
    let json = serde_json::to_string(&LocalMapConfig::default()).expect("plain numbers");
    let mut body = postcard::to_stdvec(&json).expect("a text");
    body.extend_from_slice(rest);
    body
}

#[cfg(test)]
mod tests {
    use ch16_slam2d::scan::LaserScan;
    use pr_geom::SE2;
    use robot_io::log::LogFrame;
    use robot_io::run::LogRun;
    use robot_io::session::Session;

    use super::*;

    #[test]
    fn a_session_without_its_parameters_and_checksum_is_completed_to_a_session() {
        let mut run = LogRun::default();
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
        let file = session.to_bytes();
        let content = &file[20..file.len() - 8];
        let (_, rest): (String, _) = postcard::take_from_bytes(content).unwrap();
        let completed = sealed(&with_parameters(rest));
        let mut again = Session::from_bytes(&completed, "x").unwrap();
        again.snapshot.config = session.snapshot.config.clone();
        assert_eq!(again, session);
    }
}
