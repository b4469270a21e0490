//! Laps by name, and their entries in the results table.

use ch16_lab::lap::{
    BuiltInWorld, CANONICAL_SEED, Claim, GateUse, LapConfig, LapMatcher, LapRecord, LapTrace,
    NamedChoice as _, OwnKernel, OwnLoopRequest,
};
use ch16_slam2d::chi_squared::gate_threshold;
use ch16_slam2d::icp::INFORMATION_CAP;
use ch16_slam2d::slam::Registration;
use pr_geom::SE2;

use super::loops;

/// The smallest odometry noise on the page.
const QUIET_NOISE: f64 = 0.25;

/// The parameters of the lap of that name.
pub fn config(name: &str) -> Option<LapConfig> {
    Some(match name {
        "canonical" => LapConfig::default(),
        "noloops" => LapConfig::default().without_loops(),
        "noisy" => noisy(),
        "tight" => {
            let mut config = noisy();
            config.slam.chapter.loops.gate_chi2 = gate_threshold(0.9);
            config
        }
        "twins" => LapConfig::in_world(BuiltInWorld::TwinRooms, CANONICAL_SEED, 1.0),
        "corridor" => LapConfig::in_world(BuiltInWorld::Corridor, CANONICAL_SEED, 1.0),
        "p2l" => LapConfig::default().with_matcher(LapMatcher::PointToPlane),
        "p2l-narrow" => narrow_normals(),
        "p2p-wide" => wide_normals(),
        "misses" => misses(),
        "ndt" => LapConfig::default().with_matcher(LapMatcher::Ndt),
        "quiet" => quiet(LapMatcher::PointToPoint),
        "quiet-p2l" => quiet(LapMatcher::PointToPlane),
        "quiet-ndt" => quiet(LapMatcher::Ndt),
        "corridor-p2l" => bare(LapMatcher::PointToPlane),
        "corridor-ndt" => bare(LapMatcher::Ndt),
        "six" => LapConfig::with_seed_and_noise(6, 1.0),
        _ => return None,
    })
}

/// The canonical run with four times the odometry noise.
fn noisy() -> LapConfig {
    let mut config = LapConfig::default();
    config.drive.noise_factor = 4.0;
    config
}

/// Point to plane with the normals of the chapter's lap, which only weight edges there.
fn narrow_normals() -> LapConfig {
    let config = LapConfig::default();
    let scan = config.slam.scan;
    config
        .with_matcher(LapMatcher::PointToPlane)
        .with_scan(scan)
}

/// Point to point with the normals of the lap by point to plane.
fn wide_normals() -> LapConfig {
    let scan = LapConfig::default()
        .with_matcher(LapMatcher::PointToPlane)
        .slam
        .scan;
    LapConfig::default().with_scan(scan)
}

/// The canonical run with readings at the maximum range kept as points.
fn misses() -> LapConfig {
    let mut config = LapConfig::default();
    config.drive.lidar.keeps_misses = true;
    config
}

/// The canonical run with almost exact odometry.
fn quiet(matcher: LapMatcher) -> LapConfig {
    LapConfig::with_seed_and_noise(CANONICAL_SEED, QUIET_NOISE).with_matcher(matcher)
}

/// A corridor without doors.
fn bare(matcher: LapMatcher) -> LapConfig {
    LapConfig::in_world(BuiltInWorld::Corridor, CANONICAL_SEED, 1.0).with_matcher(matcher)
}

/// `rms`, `turn.short_m`, `loop.0.chi2`, `front_end.rms`: results of a lap, by name.
pub fn value(record: &LapRecord, path: &[&str]) -> Option<f64> {
    match *path {
        ["seed"] => Some(f64::from(record.config.drive.seed)),
        ["noise"] => Some(record.config.drive.noise_factor),
        ["turn", what] => turn(&record.lap, what),
        ["loop", index, what] => {
            let attempt = record.lap.loop_attempts().nth(index.parse().ok()?)?;
            loops::attempt(attempt, &record.lap, what)
        }
        ["own", claim, from, to, kernel, what] => own(record, [from, to], claim, kernel, what),
        ["front_end", "turn", what] => turn(&record.front_end, what),
        ["capped_percent"] => Some(capped_percent(&record.lap)),
        ["rms_fall_percent"] => {
            let [front_end, lap] = [&record.front_end, &record.lap];
            let left = lap.summary.keyframe_rms_m / front_end.summary.keyframe_rms_m;
            Some(100.0 * (1.0 - left))
        }
        ["moved_cm"] => Some(100.0 * moved_m(&record.lap)),
        ["normals_cells"] => {
            let scan = record.config.slam.scan;
            Some(scan.normal_radius_m / scan.cell_m)
        }
        ["front_end", "driven_percent"] => driven_percent(&record.front_end),
        ["front_end", what] => summary(&record.front_end, what),
        [what] => summary(&record.lap, what),
        _ => None,
    }
}

/// The effect of a custom loop at the end of the lap, without the gate.
fn own(record: &LapRecord, ends: [&str; 2], claim: &str, kernel: &str, what: &str) -> Option<f64> {
    let request = OwnLoopRequest {
        tick: record.ticks(),
        nodes: [ends[0].parse().ok()?, ends[1].parse().ok()?],
        claim: Claim::named(claim)?,
        gate: GateUse::Bypassed,
        kernel: OwnKernel::named(kernel)?,
    };
    let attempt = record.own_loop(&request).ok()?.attempt;
    let effect = attempt.effect?;
    let truth = |node: usize| record.lap.keyframes[node].truth.translation();
    Some(match what {
        "apart_m" => (truth(request.nodes[0]) - truth(request.nodes[1])).norm(),
        "from" => request.nodes[0] as f64,
        "to" => request.nodes[1] as f64,
        "gate_chi2" => attempt.verification.gate.chi2,
        "max_shift" => effect.max_shift_m,
        "chi2_after" => effect.chi2.after,
        _ => return None,
    })
}

/// Cells of the grid of a whole lap.
pub fn grid(record: &LapRecord, what: &str) -> Option<f64> {
    let grid = record.occupancy_grid(record.ticks());
    match what {
        "occupied" => Some(grid.occupied_cells() as f64),
        "free" => Some(grid.free_cells() as f64),
        _ => None,
    }
}

fn summary(lap: &LapTrace, what: &str) -> Option<f64> {
    let summary = &lap.summary;
    Some(match what {
        "ticks" => summary.ticks as f64,
        "loops" => lap.graph_summary.loops as f64,
        "keyframes" => lap.keyframes.len() as f64,
        "odometry_end_error" => summary.odometry_end_error_m,
        "odometry_rms" => summary.odometry_rms_m,
        "end_error" => summary.keyframe_end_error_m,
        "rms" => summary.keyframe_rms_m,
        "max_error" => summary.keyframe_max_m,
        "last_nine_min" => summary.last_keyframes_m.0,
        "last_nine_max" => summary.last_keyframes_m.1,
        "map_disagreement" => summary.map_disagreement_m?,
        _ => return None,
    })
}

/// The turn's keyframe against the truth: too short along the corridor.
fn turn(lap: &LapTrace, what: &str) -> Option<f64> {
    let node = lap.turn_node?;
    let error =
        lap.poses(lap.summary.ticks)[node].translation() - lap.keyframes[node].truth.translation();
    match what {
        "short_m" => Some(-error.x),
        _ => None,
    }
}

/// Distance between the start and the farthest keyframe, as a share of the true one.
pub fn driven_percent(lap: &LapTrace) -> Option<f64> {
    let poses = lap.poses(lap.summary.ticks);
    let truths = lap.keyframes.iter().map(|keyframe| keyframe.truth);
    let reach = |pose: SE2, start: SE2| (pose.translation() - start.translation()).norm();
    let start = lap.keyframes[0].truth;
    let (node, far) = truths
        .map(|truth| reach(truth, start))
        .enumerate()
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(100.0 * reach(poses[node], poses[0]) / far)
}

/// Largest distance by which a registration moved the predicted position, m.
fn moved_m(lap: &LapTrace) -> f64 {
    let moved = lap.reports.iter().map(|report| {
        let Registration {
            prediction,
            estimate,
            ..
        } = report.registration;
        (estimate.translation() - prediction.translation()).norm()
    });
    moved.fold(0.0, f64::max)
}

/// Share of the edges whose information is that of the cap.
fn capped_percent(lap: &LapTrace) -> f64 {
    let graph = lap.graph(lap.summary.ticks);
    let capped = graph.edges().filter(|edge| {
        // 1e-9: rounding of the scaling.
        edge.edge.information.diagonal().max() > INFORMATION_CAP * (1.0 - 1e-9)
    });
    100.0 * capped.count() as f64 / graph.edges().count() as f64
}
