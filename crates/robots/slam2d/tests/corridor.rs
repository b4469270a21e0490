//! A log of a robot in a hall.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

/// A log of a robot that drives along x in a hall 6 m wide, 0.1 m per scan, with odometry that is a tenth too long.
pub fn corridor(folder: &TempDir, scans: usize) -> PathBuf {
    corridor_with(folder, scans, 1.1)
}

/// The same with odometry that is too long by this factor.
pub fn corridor_with(folder: &TempDir, scans: usize, scale: f64) -> PathBuf {
    let mut text = String::new();
    for scan in 0..scans {
        let x = 0.1 * scan as f64;
        text.push_str("FLASER 90");
        for beam in 0..90 {
            let bearing = f64::to_radians(-90.0 + 2.0 * f64::from(beam));
            let side = 3.0 / bearing.sin().abs();
            let end = (9.0 - x) / bearing.cos();
            text.push_str(&format!(" {:.4}", side.min(end)));
        }
        let odometry = format!("{:.4} 0 0", scale * x);
        text.push_str(&format!(" {odometry} {odometry} {} h 0\n", 100 + scan));
    }
    write(folder, "corridor.clf", &text)
}

/// Writes a file of this name.
pub fn write(folder: &TempDir, name: &str, text: &str) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    path
}

/// The text of a path.
pub fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}
