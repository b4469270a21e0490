//! The clouds of the registration table as files for `ch16 register`.
//!
//! `ch16 register` starts from the identity, so a scan's file contains its points at the initial guess. The
//! numbers are written so that reading restores the same bits.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use ch16_lab::samples::RegistrationSample;
use ch16_slam2d::cloud::PointCloud;

/// A map and a scan with the names of their files.
pub struct Clouds {
    /// File of the map, lines of `x,y,nx,ny`.
    pub map_file: &'static str,
    /// File of the scan, lines of `x,y`.
    pub scan_file: &'static str,
    /// Their contents.
    pub sample: RegistrationSample,
}

/// The two pairs of the table: the large one first.
pub fn all() -> [Clouds; 2] {
    [
        Clouds {
            map_file: "MAP-5000.csv",
            scan_file: "SCAN-720.csv",
            sample: RegistrationSample::large(),
        },
        Clouds {
            map_file: "MAP-180.csv",
            scan_file: "SCAN-180.csv",
            sample: RegistrationSample::small(),
        },
    ]
}

/// Writes the four files into a folder, which is created if it is missing.
///
/// # Errors
/// One sentence with the file or folder that cannot be written.
pub fn write(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let say = |path: &Path, error: std::io::Error| format!("{}: {error}", path.display());
    fs::create_dir_all(folder).map_err(|error| say(folder, error))?;
    let mut written = Vec::new();
    for Clouds {
        map_file,
        scan_file,
        sample,
    } in all()
    {
        let guessed = sample.scan.transformed(&sample.guess);
        for (file, cloud) in [(map_file, &sample.map), (scan_file, &guessed)] {
            let path = folder.join(file);
            fs::write(&path, lines(cloud)).map_err(|error| say(&path, error))?;
            written.push(path);
        }
    }
    Ok(written)
}

/// A line for each point, with its normal if the cloud has normals.
fn lines(cloud: &PointCloud) -> String {
    let mut text = String::new();
    for (index, point) in cloud.iter().enumerate() {
        let _ = write!(text, "{},{}", point.x, point.y);
        if cloud.has_normals() {
            let normal = cloud.normal(index).unwrap_or_default();
            let _ = write!(text, ",{},{}", normal.x, normal.y);
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_holds_every_bit_of_its_cloud() {
        let [_, small] = all();
        let text = lines(&small.sample.map);
        let mut rows = text.lines();
        for (index, point) in small.sample.map.iter().enumerate() {
            let row = rows.next().expect("a line for each point");
            let numbers: Vec<f64> = row.split(',').map(|n| n.parse().unwrap()).collect();
            let normal = small.sample.map.normal(index).unwrap_or_default();
            assert_eq!(numbers, [point.x, point.y, normal.x, normal.y]);
        }
        assert_eq!(rows.next(), None);
        assert_eq!(lines(&small.sample.scan).lines().count(), 180);
        assert!(
            lines(&small.sample.scan)
                .lines()
                .all(|row| row.split(',').count() == 2)
        );
    }
}
