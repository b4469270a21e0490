//! Simulated recordings as logs.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use ch16_lab::buildings::{Kind, recorded};
use ch16_lab::lap::{BuiltInWorld, Drive, DriveConfig};
use robot_io::carmen::write_carmen;
use robot_io::json_log::write_frames;
use robot_io::log::LogFrame;

/// Writes the canonical lap in a world as lines of JSON.
pub fn lap_log(world: BuiltInWorld, path: &Path) {
    let drive = Drive::simulate(&DriveConfig::default().on_course(&world.course()));
    let frames = drive.log_frames().enumerate();
    let mut file = BufWriter::new(File::create(path).unwrap());
    write_frames(
        frames.map(|(tick, frame)| (frame, drive.truth(tick))),
        &mut file,
    )
    .unwrap();
}

/// Writes the recording of a building as a CARMEN log.
pub fn building_log(kind: Kind, seed: u32, path: &Path) {
    let mut file = BufWriter::new(File::create(path).unwrap());
    for frame in recorded(kind, seed).0.frames {
        let frame = LogFrame {
            stamp_s: frame.stamp_s,
            odometry: Some(frame.odometry),
            scan: frame.scan,
        };
        write_carmen(&frame, &mut file).unwrap();
    }
}
