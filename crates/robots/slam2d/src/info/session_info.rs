//! Summary of a session.

use std::path::Path;

use ch16_slam2d::graph::EdgeKind;
use ch16_slam2d::metrics::position_error_m;
use robot_io::session::{Session, VERSION};
use robot_io::settings::SETTINGS;
use serde::Serialize;

use crate::session_file::read_session;
use command_line::output::{print_json, say};

#[derive(Serialize)]
struct SessionJson {
    version: u32,
    bytes: u64,
    bytes_per_keyframe: Option<f64>,
    scans: usize,
    keyframes: usize,
    points: usize,
    edges: usize,
    loops: usize,
    /// Whether the final pass over the map was done.
    refined: bool,
    path_length_m: f64,
    first_stamp_s: Option<f64>,
    last_stamp_s: Option<f64>,
    last_pose: [f64; 3],
    parameters: Vec<String>,
}

impl SessionJson {
    fn new(session: &Session, bytes: u64) -> Self {
        let snapshot = &session.snapshot;
        let graph = session.graph();
        let steps = graph.poses().windows(2);
        let keyframes = snapshot.keyframes.len();
        let loops = graph
            .edges()
            .filter(|view| view.edge.kind == EdgeKind::Loop);
        Self {
            version: VERSION,
            bytes,
            bytes_per_keyframe: (keyframes > 0).then(|| bytes as f64 / keyframes as f64),
            scans: snapshot.frames,
            keyframes,
            points: snapshot.keyframes.iter().map(|k| k.scan.len()).sum(),
            edges: graph.edge_count(),
            loops: loops.count(),
            refined: session.mapped.is_some(),
            path_length_m: steps.map(|two| position_error_m(&two[0], &two[1])).sum(),
            first_stamp_s: snapshot.keyframes.first().map(|keyframe| keyframe.stamp_s),
            last_stamp_s: snapshot
                .last_stamp_s
                .is_finite()
                .then_some(snapshot.last_stamp_s),
            last_pose: snapshot.front_end.estimate.to_array(),
            parameters: SETTINGS
                .iter()
                .map(|setting| {
                    let robot = snapshot.config.local_map.unwrap_or_default();
                    format!("{} {}", setting.name, setting.value(&robot))
                })
                .collect(),
        }
    }
}

/// Reads a session and prints its summary.
///
/// # Errors
/// If it cannot be used.
pub fn run(path: &Path, as_json: bool) -> anyhow::Result<()> {
    let (session, bytes) = read_session(path)?;
    let info = SessionJson::new(&session, bytes);
    if as_json {
        print_json(&info);
        return Ok(());
    }
    say!(
        "session          version {}, {} bytes",
        info.version,
        info.bytes
    );
    say!("scans            {}", info.scans);
    say!("keyframes        {}", info.keyframes);
    if let Some(each) = info.bytes_per_keyframe {
        say!("bytes            {each:.0} per keyframe");
    }
    say!(
        "edges            {}, {} of them loops",
        info.edges,
        info.loops
    );
    say!("path             {:.1} m", info.path_length_m);
    if let (Some(first_s), Some(last_s)) = (info.first_stamp_s, info.last_stamp_s) {
        say!("stamps           {first_s} s to {last_s} s");
    }
    let [x, y, heading_rad] = info.last_pose;
    say!(
        "ends at          {x:.2} m, {y:.2} m, {:.1}°",
        heading_rad.to_degrees()
    );
    say!(
        "map              {}",
        if info.refined {
            "after the final pass"
        } else {
            "as built during the run"
        }
    );
    Ok(())
}
