//! What a session file holds between its head and its checksum, serialized by postcard.

use std::borrow::Cow;
use std::sync::Arc;

use ch16_slam2d::graph::EdgeView;
use ch16_slam2d::local_map::LocalMapConfig;
use ch16_slam2d::slam::SlamConfig;
use pr_geom::SE2;
use serde::{Deserialize, Serialize};

use super::Session;
use super::scans::{self, StoredScan};

/// Mean bytes per keyframe's scan: with its node, its pose on the map, eight scan poses
/// and five edges a keyframe stays below 3,000.
pub const SCAN_BYTES: usize = 2111;

/// The fields in the order of the file.
#[derive(Serialize, Deserialize)]
struct Body<'a> {
    /// The parameters as JSON, so that each is found by its name.
    robot: Cow<'a, str>,
    start: SE2,
    /// Everything but the parameters and the scans.
    session: Cow<'a, Session>,
    keyframe_scans: Vec<StoredScan>,
    window_scans: Vec<StoredScan>,
}

/// Serializes a session.
pub fn write(session: &Session) -> Vec<u8> {
    let snapshot = &session.snapshot;
    let robot = snapshot.config.local_map.unwrap_or_default();
    let radius_m = snapshot.config.scan.normal_radius_m;
    let keyframe_scans = snapshot.keyframes.iter().map(|keyframe| &*keyframe.scan);
    let window_scans = snapshot.front_end.scans.iter();
    let body = Body {
        robot: serde_json::to_string(&robot).expect("plain numbers").into(),
        start: snapshot.config.start,
        session: Cow::Borrowed(session),
        keyframe_scans: scans::store_all(keyframe_scans, radius_m, SCAN_BYTES),
        window_scans: window_scans
            .map(|scan| scans::store_exactly(scan, radius_m))
            .collect(),
    };
    postcard::to_stdvec(&body).expect("lengths are known")
}

/// Reads a session; its consistency is not checked.
///
/// # Errors
/// What is wrong with the bytes.
pub fn read(bytes: &[u8]) -> Result<Session, String> {
    let (body, rest): (Body<'_>, _) =
        postcard::take_from_bytes(bytes).map_err(|problem| format!("its content: {problem}"))?;
    if !rest.is_empty() {
        return Err(format!("{} bytes follow its content", rest.len()));
    }
    let robot: LocalMapConfig = serde_json::from_str(&body.robot)
        .map_err(|problem| format!("its parameters: {problem}"))?;
    let config = SlamConfig {
        start: body.start,
        ..SlamConfig::from_local_map(
            crate::settings::checked(robot).map_err(|error| error.to_string())?,
        )
    };
    let radius_m = config.scan.normal_radius_m;
    let restored = |scan: StoredScan| scan.restored(radius_m).map(Arc::new);
    let mut session = body.session.into_owned();
    if let Some(sensor) = &mut session.sensor {
        sensor.ranges_m.clear();
    }
    let snapshot = &mut session.snapshot;
    snapshot.config = config;
    if body.keyframe_scans.len() != snapshot.keyframes.len() {
        return Err("its numbers of scans and keyframes differ".to_owned());
    }
    for (keyframe, scan) in snapshot.keyframes.iter_mut().zip(body.keyframe_scans) {
        keyframe.scan = restored(scan)?;
    }
    let window_scans = body.window_scans.into_iter();
    snapshot.front_end.scans = window_scans.map(restored).collect::<Result<_, _>>()?;
    number(&mut snapshot.edges);
    if let Some(mapped) = &mut session.mapped {
        number(&mut mapped.loops);
    }
    Ok(session)
}

fn number(edges: &mut [EdgeView]) {
    for (index, view) in edges.iter_mut().enumerate() {
        view.id = index.into();
    }
}
