//! The registration table: `slam2d register` on made clouds, beside published libraries.

use std::path::Path;
use std::process::Command;

use ch16_lab::samples::RegistrationSample;
use pr_geom::SE2;
use serde::Deserialize;

use crate::clouds::{self, Clouds};

/// Registrations of one row; the fastest counts.
const REPEATS: u32 = 300;
/// Correspondence distance τ, m.
const TAU_M: f64 = 0.5;

/// What of a row's time is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Span {
    /// The registration alone; the map was built before.
    Registration,
    /// Building the map and the registration.
    BuildAndRegistration,
}

/// A row of the table.
struct Row {
    case: &'static str,
    /// As the command line names it, and as a reader does.
    method: (&'static str, &'static str),
    span: Span,
    /// Libraries in C++ and Rust with a k-d tree, on a machine of the same kind, µs. The figures
    /// are those that the project was given; their clouds and their rules for stopping are not ours.
    peers_us: f64,
}

const METHODS: [(&str, &str); 2] = [("p2l", "point to plane"), ("p2p", "point to point")];

/// The rows of each pair of clouds, in the order of [`clouds::all`].
fn rows() -> [[Row; 2]; 2] {
    let row = |case, span, method: usize, peers_us| Row {
        case,
        method: METHODS[method],
        span,
        peers_us,
    };
    let large = "720 points on a map of 5,000";
    let small = "180 on 180 points, with the build";
    [
        [
            row(large, Span::Registration, 0, 280.0),
            row(large, Span::Registration, 1, 1065.0),
        ],
        [
            row(small, Span::BuildAndRegistration, 0, 60.0),
            row(small, Span::BuildAndRegistration, 1, 123.0),
        ],
    ]
}

/// What `slam2d register --json` reports, as far as the table needs it.
#[derive(Deserialize)]
struct Found {
    pose: [f64; 3],
    iterations: usize,
    us: f64,
    us_build: f64,
}

/// Writes the clouds into `folder`, registers them with the command `slam2d`, returns the table.
///
/// # Errors
/// One sentence where a file cannot be written or the command fails.
pub fn table(slam2d: &Path, folder: &Path) -> Result<String, String> {
    clouds::write(folder)?;
    let mut lines = vec![
        "| case | method | iterations | off by | ours | k-d tree peers |".to_owned(),
        "|---|---|--:|--:|--:|--:|".to_owned(),
    ];
    for (clouds, rows) in clouds::all().iter().zip(rows()) {
        for row in rows {
            let found = register(slam2d, folder, clouds, row.method.0)?;
            lines.push(line(&row, &found, &clouds.sample));
        }
    }
    Ok(lines.join("\n"))
}

fn register(slam2d: &Path, folder: &Path, clouds: &Clouds, method: &str) -> Result<Found, String> {
    let output = Command::new(slam2d)
        .arg("register")
        .args([clouds.map_file, clouds.scan_file].map(|file| folder.join(file)))
        .args(["--method", method, "--tau", &TAU_M.to_string()])
        .args(["--repeat", &REPEATS.to_string(), "--json"])
        .output()
        .map_err(|error| format!("{}: {error}", slam2d.display()))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(format!("{} register: {}", slam2d.display(), said.trim()));
    }
    serde_json::from_slice(&output.stdout)
        .map_err(|error| format!("{} register: {error}", slam2d.display()))
}

fn line(row: &Row, found: &Found, sample: &RegistrationSample) -> String {
    let us = match row.span {
        Span::Registration => found.us,
        Span::BuildAndRegistration => found.us + found.us_build,
    };
    let [x, y, theta] = found.pose;
    // The file's points were put where the guess says: the pose found comes on top of it.
    let world_from_scan = SE2::new(x, y, theta) * sample.guess;
    let error = sample.truth.between(&world_from_scan).log();
    format!(
        "| {} | {} | {} | {:.1} mm | {us:.0} µs | {:.0} µs |",
        row.case,
        row.method.1,
        found.iterations,
        1e3 * error.x.hypot(error.y),
        row.peers_us,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a registration that finds the truth, or 2 mm beside it, would report.
    fn found(sample: &RegistrationSample, beside_m: f64) -> Found {
        let pose = sample.truth * SE2::new(beside_m, 0.0, 0.0) * sample.guess.inverse();
        Found {
            pose: pose.to_array(),
            iterations: 7,
            us: 100.0,
            us_build: 20.0,
        }
    }

    #[test]
    fn a_row_has_its_error_and_the_time_that_is_compared() {
        let sample = RegistrationSample::small();
        let [[large, _], [small, _]] = rows();
        assert_eq!(
            line(&large, &found(&sample, 0.0), &sample),
            "| 720 points on a map of 5,000 | point to plane | 7 | 0.0 mm | 100 µs | 280 µs |"
        );
        assert_eq!(
            line(&small, &found(&sample, 0.002), &sample),
            "| 180 on 180 points, with the build | point to plane | 7 | 2.0 mm | 120 µs | 60 µs |"
        );
    }

    #[test]
    fn a_command_that_is_missing_is_named() {
        let [large, _] = clouds::all();
        let missing = Path::new("no-such-command");
        let Err(message) = register(missing, Path::new("."), &large, "p2l") else {
            panic!("there is no such command");
        };
        assert!(message.starts_with("no-such-command: "), "{message}");
    }
}
