//! The registration table: `ch16 register` on generated clouds, beside nanoflann's k-d tree.

use std::path::{Path, PathBuf};
use std::process::Command;

use ch16_lab::samples::RegistrationSample;
use pr_geom::SE2;
use serde::Deserialize;

use crate::clouds::{self, Clouds};

/// Registrations per program and round; the fastest counts.
const REPEATS: u32 = 60;
/// Number of rounds, in which the programs take turns; the fastest counts.
const ROUNDS: u32 = 5;
/// Correspondence distance τ, m.
const TAU_M: f64 = 0.5;

/// The measured time of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Span {
    /// The registration alone, without building the map.
    Registration,
    /// Building the map and the registration.
    BuildAndRegistration,
}

/// A row of the table.
struct Row {
    case: &'static str,
    /// The name on the command line, and the label.
    method: (&'static str, &'static str),
    span: Span,
}

/// The same registration in C++, with nearest-neighbour queries in nanoflann's tree.
const DRIVER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/peer/nanoflann.cpp");

/// Text of a row if the driver could not be built.
const NOT_BUILT: &str = "not timed: a C++ compiler or nanoflann is missing";

/// Largest difference of two poses that count as the same optimum, m and rad.
const SAME_POSE: f64 = 1e-6;

const METHODS: [(&str, &str); 2] = [("p2l", "point-to-plane"), ("p2p", "point-to-point")];

/// The rows of each pair of clouds, in the order of [`clouds::all`].
fn rows() -> [[Row; 2]; 2] {
    let row = |case, span, method: usize| Row {
        case,
        method: METHODS[method],
        span,
    };
    let large = "720 points on a map of 5,000";
    let small = "180 on 180 points, with the build";
    [
        [
            row(large, Span::Registration, 0),
            row(large, Span::Registration, 1),
        ],
        [
            row(small, Span::BuildAndRegistration, 0),
            row(small, Span::BuildAndRegistration, 1),
        ],
    ]
}

/// The output of `ch16 register --json` and of the driver, as far as the table needs it.
#[derive(Deserialize)]
struct Found {
    /// The version of the driver's library.
    version: Option<String>,
    pose: [f64; 3],
    iterations: usize,
    us: f64,
    us_build: f64,
}

impl Found {
    /// The measured time, µs.
    fn us(&self, span: Span) -> f64 {
        match span {
            Span::Registration => self.us,
            Span::BuildAndRegistration => self.us + self.us_build,
        }
    }

    /// The faster of this round and the earlier ones; the results must be equal.
    fn fastest(self, before: Option<Self>) -> Self {
        let Some(before) = before else { return self };
        Self {
            us: self.us.min(before.us),
            us_build: self.us_build.min(before.us_build),
            ..self
        }
    }

    fn is_at(&self, other: &Self) -> bool {
        let mut pairs = self.pose.iter().zip(&other.pose);
        pairs.all(|(a, b)| (a - b).abs() < SAME_POSE)
    }
}

/// Writes the clouds into `folder`, registers them with `ch16` and, if a C++ compiler finds it, with
/// nanoflann, and returns the table.
///
/// # Errors
/// One sentence if a file cannot be written or a command fails.
pub fn table(ch16: &Path, folder: &Path) -> Result<String, String> {
    clouds::write(folder)?;
    let driver = build_driver(folder);
    let mut version = None;
    let mut lines = Vec::new();
    for (clouds, rows) in clouds::all().iter().zip(rows()) {
        for row in rows {
            let (mut ours, mut peer) = (None, None);
            for _ in 0..ROUNDS {
                let found = register(ch16, folder, clouds, row.method.0)?;
                ours = Some(found.fastest(ours));
                if let Some(driver) = &driver {
                    let found = register_peer(driver, folder, clouds, row.method.0)?;
                    peer = Some(found.fastest(peer));
                }
            }
            let Some(ours) = ours else { continue };
            lines.push(line(&row, &ours, peer.as_ref(), &clouds.sample));
            version = peer.and_then(|peer| peer.version);
        }
    }
    let header = [
        format!(
            "| case | method | iterations | off by | ours | nanoflann {} | ours / nanoflann |",
            version.unwrap_or_default()
        ),
        "|---|---|--:|--:|--:|--:|--:|".to_owned(),
    ];
    Ok([&header[..], &lines[..]].concat().join("\n"))
}

/// Compiles the driver; prints a note and returns `None` without compiler or nanoflann.
fn build_driver(folder: &Path) -> Option<PathBuf> {
    let driver = folder.join("nanoflann");
    let compiler = std::env::var_os("CXX").unwrap_or_else(|| "c++".into());
    let built = Command::new(&compiler)
        .args(["-O3", "-std=c++17", "-DNDEBUG", "-o"])
        .arg(&driver)
        .arg(DRIVER)
        .output();
    if built.is_ok_and(|output| output.status.success()) {
        return Some(driver);
    }
    eprintln!(
        "{} could not build {DRIVER}: `sudo apt-get install g++ libnanoflann-dev` brings what it needs",
        compiler.display()
    );
    None
}

fn register_peer(
    driver: &Path,
    folder: &Path,
    clouds: &Clouds,
    method: &str,
) -> Result<Found, String> {
    let mut command = Command::new(driver);
    command
        .args([clouds.map_file, clouds.scan_file].map(|file| folder.join(file)))
        .args([method, &TAU_M.to_string(), &REPEATS.to_string()]);
    answer(command, &driver.display().to_string())
}

fn register(ch16: &Path, folder: &Path, clouds: &Clouds, method: &str) -> Result<Found, String> {
    let mut command = Command::new(ch16);
    command
        .arg("register")
        .args([clouds.map_file, clouds.scan_file].map(|file| folder.join(file)))
        .args(["--method", method, "--tau", &TAU_M.to_string()])
        .args(["--repeat", &REPEATS.to_string(), "--json"]);
    answer(command, &format!("{} register", ch16.display()))
}

/// The JSON that a command prints.
fn answer(mut command: Command, name: &str) -> Result<Found, String> {
    let output = command
        .output()
        .map_err(|error| format!("{name}: {error}"))?;
    if !output.status.success() {
        let stderr = String::from_utf8_lossy(&output.stderr);
        return Err(format!("{name}: {}", stderr.trim()));
    }
    serde_json::from_slice(&output.stdout).map_err(|error| format!("{name}: {error}"))
}

fn line(row: &Row, found: &Found, peer: Option<&Found>, sample: &RegistrationSample) -> String {
    let us = found.us(row.span);
    let [x, y, theta] = found.pose;
    // The file's points are at the initial guess, so the result is relative to it.
    let world_from_scan = SE2::new(x, y, theta) * sample.guess;
    let error = sample.truth.between(&world_from_scan).log();
    let peer_us = peer.map(|peer| peer.us(row.span));
    let beside = match (peer, peer_us) {
        (Some(peer), Some(peer_us)) if peer.is_at(found) => {
            format!("{peer_us:.0} µs | {:.2}", us / peer_us)
        }
        (_, Some(peer_us)) => format!("{peer_us:.0} µs | another optimum"),
        (_, None) => format!("{NOT_BUILT} | –"),
    };
    format!(
        "| {} | {} | {} | {:.1} mm | {us:.0} µs | {beside} |",
        row.case,
        row.method.1,
        found.iterations,
        1e3 * error.x.hypot(error.y),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The report of a registration at the truth, or 2 mm off.
    fn found(sample: &RegistrationSample, beside_m: f64) -> Found {
        let pose = sample.truth * SE2::new(beside_m, 0.0, 0.0) * sample.guess.inverse();
        Found {
            version: None,
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
        let peer = Found {
            us: 200.0,
            ..found(&sample, 0.0)
        };
        assert_eq!(
            line(&large, &found(&sample, 0.0), Some(&peer), &sample),
            "| 720 points on a map of 5,000 | point-to-plane | 7 | 0.0 mm | 100 µs | 200 µs | 0.50 |"
        );
        assert_eq!(
            line(&small, &found(&sample, 0.002), None, &sample),
            "| 180 on 180 points, with the build | point-to-plane | 7 | 2.0 mm | 120 µs | not timed: a C++ compiler or nanoflann is missing | – |"
        );
        let elsewhere = line(&small, &found(&sample, 0.002), Some(&peer), &sample);
        assert!(
            elsewhere.ends_with("| 220 µs | another optimum |"),
            "{elsewhere}"
        );
    }

    #[test]
    fn a_missing_command_is_reported() {
        let [large, _] = clouds::all();
        let missing = Path::new("no-such-command");
        let Err(message) = register(missing, Path::new("."), &large, "p2l") else {
            panic!("there is no such command");
        };
        assert!(
            message.starts_with("no-such-command register: "),
            "{message}"
        );
    }
}
