//! Names of printed numbers, and how the core computes each.
//!
//! A name is a path: `basin.p2l.180.rmse` registers from 180° with point to plane and reads the
//! rmse. So a new sentence needs a new name, seldom new code here.

use std::cell::OnceCell;
use std::collections::HashMap;

use ch16_slam2d::basin::{BasinOutcome, BasinScene, BasinStart, Minimum};
use ch16_slam2d::chi_squared::gate_threshold;
use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::graph::{EdgeKind, PoseGraph};
use ch16_slam2d::icp::{
    IcpVariant, IcpWorkspace, closed_form, correspondences, icp_information, regularize,
};
use ch16_slam2d::loops::GateModel;
use ch16_slam2d::ndt::{NdtConfig, NdtMap, NdtResult, ndt_align};
use ch16_slam2d::slam::{LapRecord, LapRunner, LapTrace, LoopAttempt, SlamConfig};
use ch16_slam2d::terrain::{
    Ball, BallConfig, Objective, SceneKind, Terrain, TerrainProbe, TerrainScene, TerrainSettings,
};
use nalgebra::{Matrix2, Matrix3};
use pr_geom::{SE2, Translation, Vector2};
use pr_sim::{Lidar, LidarConfig, Rng, World};

use super::sweep::Sweep;

/// The worked example of alignment: source points, and their partners in the target.
const POINTS: [([f64; 2], [f64; 2]); 4] = [
    ([1.0, 0.0], [2.8, 1.6]),
    ([0.0, 1.0], [1.4, 1.8]),
    ([-1.0, 0.0], [1.2, 0.4]),
    ([0.0, -1.0], [2.6, 0.2]),
];
/// The worked example of the pose graph: each odometry edge, and the loop edge, m.
const ODOMETRY_M: f64 = 1.0;
const LOOP_M: f64 = 2.6;
/// Other τ of w16.1 that the exercises ask about, m.
const WIDE_TAU_M: f64 = 1.4;
const SHORT_TAU_M: f64 = 0.1;
/// The shift at which the text compares landscapes, m.
const PROBE_M: f64 = 0.6;

/// The core, asked by name; what is slow is computed once.
#[derive(Default)]
pub struct Figures {
    laps: HashMap<String, LapRecord>,
    basin: OnceCell<BasinScene>,
    sweep: OnceCell<Sweep>,
}

impl Figures {
    /// The value of that name; none where there is no such name.
    pub fn value(&mut self, name: &str) -> Option<f64> {
        let path: Vec<&str> = name.split('.').collect();
        match path.as_slice() {
            ["world", what] => world(what),
            ["setup", what @ ..] => setup(what),
            ["example", "points", what] => four_points(what),
            ["example", "poses", what] => three_poses(what),
            ["gate", what] => gate(what),
            ["basin", what @ ..] => self.basin(what),
            ["ndt", start, what] => ndt(start, what),
            ["terrain", what @ ..] => terrain(what),
            ["ball", place, objective, reach_cm, dx_cm, dy_cm, "rest_m"] => {
                ball(place, objective, [reach_cm, dx_cm, dy_cm])
            }
            ["grid", run, what] => self.grid(run, what),
            ["lap", run, what @ ..] => self.lap(run, what),
            ["sweep", what @ ..] => self.sweep.get_or_init(Sweep::run).value(what),
            _ => None,
        }
    }

    fn basin(&self, path: &[&str]) -> Option<f64> {
        let scene = self.basin.get_or_init(BasinScene::new);
        match *path {
            ["points"] => Some(scene.source().len() as f64),
            ["success_m"] => Some(ch16_slam2d::basin::SUCCESS_RADIUS_M),
            [variant, "from_deg"] => basin_edge(scene, variant, 0.7, -1),
            [variant, "to_deg"] => basin_edge(scene, variant, 0.7, 1),
            [variant, "wide", "from_deg"] => basin_edge(scene, variant, WIDE_TAU_M, -1),
            [variant, "wide", "to_deg"] => basin_edge(scene, variant, WIDE_TAU_M, 1),
            [_, "short", "starts"] => Some(whole_degrees().count() as f64),
            [variant, "short", "right"] => {
                let ends_right = |degrees: &i32| {
                    register(scene, variant, SHORT_TAU_M, f64::from(*degrees))
                        .is_some_and(|found| found.minimum == Minimum::Right)
                };
                Some(whole_degrees().filter(ends_right).count() as f64)
            }
            [variant, heading_deg, "std_mm"] => {
                claimed_std_mm(scene, variant, heading_deg.parse().ok()?)
            }
            [variant, heading_deg, "lost"] => {
                let found = register(scene, variant, 0.7, heading_deg.parse().ok()?)?;
                Some((scene.source().len() - found.inliers) as f64)
            }
            [variant, heading_deg, what] => {
                let found = register(scene, variant, 0.7, heading_deg.parse().ok()?)?;
                registration(&found, what)
            }
            _ => None,
        }
    }

    fn grid(&mut self, run: &str, what: &str) -> Option<f64> {
        let record = self.run(run)?;
        let grid = record.occupancy_grid(record.ticks());
        match what {
            "occupied" => Some(grid.occupied_cells() as f64),
            "free" => Some(grid.free_cells() as f64),
            _ => None,
        }
    }

    fn lap(&mut self, run: &str, path: &[&str]) -> Option<f64> {
        let record = self.run(run)?;
        match *path {
            ["seed"] => Some(f64::from(record.config.drive.seed)),
            ["turn", what] => turn(&record.lap, what),
            ["loop", index, what] => {
                let attempt = record.lap.loop_attempts().nth(index.parse().ok()?)?;
                loop_attempt(attempt, &record.lap, what)
            }
            ["right_refused"] => Some(right_refused(&record.lap)),
            [what] => summary(&record.lap, what),
            _ => None,
        }
    }

    fn run(&mut self, name: &str) -> Option<&LapRecord> {
        let config = match name {
            "canonical" => SlamConfig::default(),
            "noloops" => SlamConfig::default().without_loops(),
            "noisy" => noisy(),
            "tight" => {
                let mut config = noisy();
                config.loops.gate_chi2 = gate_threshold(0.9);
                config
            }
            "locked" => drifting(),
            "exact" => {
                let mut config = drifting();
                config.loops.gate_model = GateModel::ExactMarginal;
                config
            }
            "six" => SlamConfig::with_seed_and_noise(6, 1.0),
            _ => return None,
        };
        let record = self
            .laps
            .entry(name.to_owned())
            .or_insert_with(|| LapRunner::new().run(&config));
        Some(record)
    }
}

/// The canonical run with four times the wheel noise.
fn noisy() -> SlamConfig {
    let mut config = SlamConfig::default();
    config.drive.noise_factor = 4.0;
    config
}

/// A lap that drifts farther than the gate allows for.
fn drifting() -> SlamConfig {
    SlamConfig::with_seed_and_noise(2, 3.0)
}

fn world(what: &str) -> Option<f64> {
    let size = |bounds: pr_sim::Bounds| bounds.max - bounds.min;
    let rooms = World::apartment_rooms();
    let (a, d) = (rooms[0].bounds, rooms[3].bounds);
    match what {
        "width" => Some(size(World::apartment().bounds()).x),
        "height" => Some(size(World::apartment().bounds()).y),
        "corridor_width" => Some(d.min.y - a.max.y),
        "room_a_width" => Some(size(a).x),
        "room_a_height" => Some(size(a).y),
        _ => None,
    }
}

fn setup(path: &[&str]) -> Option<f64> {
    let config = SlamConfig::default();
    let loops = &config.loops;
    let basin = BasinScene::config(IcpVariant::PointToPoint, 0.7);
    Some(match *path {
        ["lap", "beams"] => config.drive.lidar.beams as f64,
        ["lap", "window"] => config.window_sweeps as f64,
        ["lap", "keyframe_m"] => config.keyframe_distance_m,
        ["lap", "keyframe_rad"] => config.keyframe_turn_rad,
        ["loop", "every_ordinal"] => loops.attempt_every_nodes as f64,
        ["loop", "radius_m"] => loops.radius_m,
        ["loop", "min_gap"] => loops.min_gap_nodes as f64,
        ["loop", "max_rmse_m"] => loops.max_rmse_m,
        ["loop", "min_inliers"] => loops.min_inliers as f64,
        ["loop", "drift_m"] => loops.drift_sigma_m,
        ["loop", "drift_rad"] => loops.drift_sigma_rad,
        ["loop", "inflate"] => loops.trust.inflate,
        ["odometry", "inflate"] => config.odometry_trust.inflate,
        ["information", "ridge"] => regularize(&Matrix3::zeros())[(0, 0)],
        ["information", "cap"] => information_cap(),
        ["information", "cap_std_m"] => 1.0 / information_cap().sqrt(),
        ["basin", "tau"] => basin.tau,
        ["basin", "tau_wide"] => WIDE_TAU_M,
        ["basin", "max_iters"] => basin.max_iters as f64,
        ["normals", "min_neighbors"] => min_neighbors() as f64,
        ["terrain", "span_m"] => TerrainSettings::default().span_m,
        _ => return None,
    })
}

fn information_cap() -> f64 {
    regularize(&(Matrix3::identity() * 1e9))[(0, 0)]
}

/// The fewest points in a line that give each other normals.
fn min_neighbors() -> usize {
    let has_normals = |count: &usize| {
        let line = (0..*count).map(|k| Vector2::new(0.05 * k as f64, 0.0));
        let mut cloud: PointCloud = line.collect();
        cloud.estimate_normals(0.3);
        cloud.normal(0).is_some()
    };
    (1..10)
        .find(has_normals)
        .expect("ten points in a line give normals")
}

fn four_points(what: &str) -> Option<f64> {
    let source = POINTS.map(|(p, _)| Vector2::from(p));
    let target = POINTS.map(|(_, q)| Vector2::from(q));
    let aligned = closed_form(&source, &target);
    let centroid = |points: &[Vector2<f64>; 4]| points.iter().sum::<Vector2<f64>>() / 4.0;
    let (p_mean, q_mean) = (centroid(&source), centroid(&target));
    let spread = |points: &[Vector2<f64>; 4], mean: Vector2<f64>| -> f64 {
        points.iter().map(|p| (p - mean).norm_squared()).sum()
    };
    let moments: Matrix2<f64> = source
        .iter()
        .zip(&target)
        .map(|(p, q)| (p - p_mean) * (q - q_mean).transpose())
        .sum();
    let residual =
        |(p, q): (&Vector2<f64>, &Vector2<f64>)| (aligned.pose.transform(*p) - q).norm_squared();
    Some(match what {
        "x" => aligned.pose.x(),
        "y" => aligned.pose.y(),
        "theta_deg" => aligned.pose.theta().to_degrees(),
        "cos" => aligned.pose.rotation().cos,
        "sin" => aligned.pose.rotation().sin,
        "trace_bound" => aligned.trace_bound,
        "sigma" => moments.singular_values().min(),
        "spread_p" => spread(&source, p_mean),
        "spread_q" => spread(&target, q_mean),
        "residual" => source.iter().zip(&target).map(residual).sum(),
        _ => {
            let mut letters = what.chars();
            let (cloud, index, axis) = (letters.next()?, letters.next()?, letters.next()?);
            let points = if cloud == 'p' { source } else { target };
            let point = points.get(index.to_digit(10)? as usize)?;
            if axis == 'x' { point.x } else { point.y }
        }
    })
}

fn three_poses(what: &str) -> Option<f64> {
    let mut graph = PoseGraph::new();
    let step = SE2::translation(ODOMETRY_M, 0.0);
    let first = graph.add_fixed_node(SE2::identity());
    let second = graph.add_node(step);
    let third = graph.add_node(step * step);
    let weight = Matrix3::identity();
    graph.add_edge(first, second, step, weight, EdgeKind::Odometry);
    graph.add_edge(second, third, step, weight, EdgeKind::Odometry);
    let seen = SE2::translation(LOOP_M, 0.0);
    graph.add_edge(first, third, seen, weight, EdgeKind::Loop);
    let before = graph.clone();
    graph.optimize(10, 1e-9);
    let x = |graph: &PoseGraph, node: usize| graph.pose(node).translation().x;
    Some(match what {
        "fixed" => x(&graph, 0),
        "odometry" => ODOMETRY_M,
        "loop" => LOOP_M,
        "gap" => LOOP_M - x(&before, 2),
        "start1" => x(&before, 1),
        "start2" => x(&before, 2),
        "end1" => x(&graph, 1),
        "end2" => x(&graph, 2),
        "share" => x(&graph, 1) - ODOMETRY_M,
        "chi2_before" => before.chi2(),
        "chi2_after" => graph.chi2(),
        _ => return None,
    })
}

fn gate(what: &str) -> Option<f64> {
    match what {
        "chi2" => Some(SlamConfig::default().loops.gate_chi2),
        "quantile_percent" => {
            let gate = SlamConfig::default().loops.gate_chi2;
            Some(100.0 * ch16_slam2d::chi_squared::cdf3(gate))
        }
        "tight_chi2" => Some(gate_threshold(0.9)),
        _ => None,
    }
}

fn variant(name: &str) -> Option<IcpVariant> {
    match name {
        "p2p" => Some(IcpVariant::PointToPoint),
        "p2l" => Some(IcpVariant::PointToPlane),
        _ => None,
    }
}

/// Registers from the right position with a wrong heading.
fn register(scene: &BasinScene, name: &str, tau: f64, heading_deg: f64) -> Option<BasinOutcome> {
    let start = BasinStart {
        heading_deg,
        dx_m: 0.0,
        dy_m: 0.0,
    };
    let config = BasinScene::config(variant(name)?, tau);
    Some(scene.register_from(&start, &config, &mut IcpWorkspace::new()))
}

/// The standard deviation of the position, in its loosest direction, that a registration claims.
fn claimed_std_mm(scene: &BasinScene, name: &str, heading_deg: f64) -> Option<f64> {
    /// Range noise of the scene's sensor, m.
    const SIGMA_M: f64 = 0.012;
    let config = BasinScene::config(variant(name)?, 0.7);
    let found = register(scene, name, 0.7, heading_deg)?;
    let pairs = correspondences(scene.source(), scene.map(), found.pose, &config);
    let information = icp_information(&pairs, SIGMA_M, 1.0, 0.0);
    let position = information.fixed_view::<2, 2>(0, 0).into_owned();
    Some(1e3 / position.symmetric_eigenvalues().min().sqrt())
}

fn registration(found: &BasinOutcome, what: &str) -> Option<f64> {
    Some(match what {
        "error_m" => found.error_m,
        "error_deg" => found.error_deg.abs(),
        "rmse" => found.rmse,
        "inliers" => found.inliers as f64,
        "iterations" => found.iterations as f64,
        _ => return None,
    })
}

fn whole_degrees() -> impl Iterator<Item = i32> {
    -180..=180
}

/// The last whole degree, going from 0 to one side, from which the right minimum is reached.
fn basin_edge(scene: &BasinScene, name: &str, tau: f64, side: i32) -> Option<f64> {
    let comes_home = |degrees: i32| {
        let found = register(scene, name, tau, f64::from(side * degrees));
        found.is_some_and(|found| found.minimum == Minimum::Right)
    };
    variant(name)?;
    let first_failure = (0..=180).find(|&degrees| !comes_home(degrees))?;
    Some(f64::from(side * (first_failure - 1)))
}

/// The registrations of `ndt.json`: its sweep, and two of its starts.
fn ndt(start: &str, what: &str) -> Option<f64> {
    let [dx, dy, turn] = match start {
        "good_start" => [0.4, 0.25, 0.05],
        "far_start" => [0.1, -0.4, 0.15],
        _ => return None,
    };
    let pose = SE2::new(2.0, 1.9, 0.0);
    let mut lidar = Lidar::new(LidarConfig {
        beams: 180,
        max_range_m: 6.0,
        range_sigma_m: 0.01,
        ..LidarConfig::default()
    });
    let ranges = lidar.sense(&World::apartment(), &pose, &mut Rng::new(0x5C0));
    let cloud: PointCloud = lidar.project(&ranges).collect();
    let cloud = cloud.downsample(0.08);
    let map = NdtMap::build(&cloud.transformed(&pose), 0.5, 4);
    let init = SE2::new(pose.x() + dx, pose.y() + dy, pose.theta() + turn);
    let NdtResult {
        pose: found, score, ..
    } = ndt_align(&cloud, &map, init, &NdtConfig::default());
    let distance_m = |to: &SE2| (to.translation() - pose.translation()).norm();
    match what {
        "offset_m" => Some(distance_m(&init)),
        "error_m" => Some(distance_m(&found)),
        "score" => Some(score),
        _ => None,
    }
}

fn terrain(path: &[&str]) -> Option<f64> {
    let settings = TerrainSettings::default();
    let (place, objective, what) = match *path {
        ["probe_m"] => return Some(PROBE_M),
        ["room", "next_stretch_m"] => return Some(settings.span_m - PROBE_M),
        [place, objective, what] => (place, objective, what),
        _ => return None,
    };
    let scene = TerrainScene::new(scene_kind(place)?, TerrainScene::DEFAULT_NDT_CELL_M);
    if objective == "information" {
        return known(&scene, what);
    }
    let probe = TerrainProbe::new(&scene, &settings);
    let at = |x, y| match objective {
        "icp" => probe.icp_cost_m2(Vector2::new(x, y)),
        _ => probe.ndt_score(Vector2::new(x, y)),
    };
    let n = settings.n;
    Some(match what {
        "x06" => at(PROBE_M, 0.0),
        "y06" => at(0.0, PROBE_M),
        "x13" => at(settings.span_m, 0.0),
        "peak" => at(0.0, 0.0),
        "beside_peak" => at(settings.offset_m(n / 2 + 1), 0.0),
        "x06_percent" => {
            100.0 * at(PROBE_M, 0.0) / Terrain::compute(&scene, &settings).ndt_maximum()?.value
        }
        "local_minima" => dents(Terrain::compute(&scene, &settings).icp_cost_m2(), n, 1.0),
        "local_maxima" => dents(Terrain::compute(&scene, &settings).ndt_score(), n, -1.0),
        _ => return None,
    })
}

/// How far from the truth a ball comes to rest. `reach` is τ for ICP and the cell for NDT; all in cm.
fn ball(place: &str, objective: &str, reach_and_start_cm: [&str; 3]) -> Option<f64> {
    let [reach, dx, dy] = reach_and_start_cm.map(|cm| cm.parse::<f64>().map(|cm| 0.01 * cm));
    let (reach_m, start_m) = (reach.ok()?, Vector2::new(dx.ok()?, dy.ok()?));
    let mut settings = TerrainSettings::default();
    let (objective, ndt_cell_m) = match objective {
        "icp" => {
            settings.tau_m = reach_m;
            (Objective::IcpCost, TerrainScene::DEFAULT_NDT_CELL_M)
        }
        "ndt" => (Objective::NdtScore, reach_m),
        _ => return None,
    };
    let scene = TerrainScene::new(scene_kind(place)?, ndt_cell_m);
    let probe = TerrainProbe::new(&scene, &settings);
    let mut ball = Ball::new(objective, start_m, BallConfig::default());
    loop {
        let step = ball.step(&probe);
        if step.stop.is_some() {
            return Some(step.offset_m.norm());
        }
    }
}

fn scene_kind(place: &str) -> Option<SceneKind> {
    match place {
        "room" => Some(SceneKind::Room),
        "corridor" => Some(SceneKind::Corridor),
        _ => None,
    }
}

/// What a registration at the truth knows along the corridor, and in the direction known best.
fn known(scene: &TerrainScene, what: &str) -> Option<f64> {
    let information = scene.information(TerrainSettings::default().tau_m);
    match what {
        "along_std_mm" => Some(1e3 / information.eigenvalues[0].sqrt()),
        "across_std_mm" => Some(1e3 / information.matrix[(1, 1)].sqrt()),
        _ => None,
    }
}

/// Inner cells that lie below all of their eight neighbours, after a change of sign.
fn dents(values: &[f64], n: usize, sign: f64) -> f64 {
    let is_dent = |&(column, row): &(usize, usize)| {
        let here = sign * values[row * n + column];
        let block =
            (row - 1..=row + 1).flat_map(|r| (column - 1..=column + 1).map(move |c| (c, r)));
        block
            .filter(|&cell| cell != (column, row))
            .all(|(c, r)| sign * values[r * n + c] > here)
    };
    let inner = (1..n - 1).flat_map(|row| (1..n - 1).map(move |column| (column, row)));
    inner.filter(is_dent).count() as f64
}

fn summary(lap: &LapTrace, what: &str) -> Option<f64> {
    let summary = &lap.summary;
    Some(match what {
        "ticks" => summary.ticks as f64,
        "loops" => summary.loops as f64,
        "turn_node" => lap.turn_node? as f64,
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

/// The turn's keyframe against the truth: too short along the corridor, and off to the side.
fn turn(lap: &LapTrace, what: &str) -> Option<f64> {
    let node = lap.turn_node?;
    let error =
        lap.poses(lap.summary.ticks)[node].translation() - lap.keyframes[node].truth.translation();
    match what {
        "short_m" => Some(-error.x),
        "side_m" => Some(error.y.abs()),
        _ => None,
    }
}

fn loop_attempt(attempt: &LoopAttempt, lap: &LapTrace, what: &str) -> Option<f64> {
    let verification = &attempt.verification;
    let gate_std = |axis: usize| 1.0 / verification.gate_information[(axis, axis)].sqrt();
    Some(match what {
        "tick" => attempt.tick as f64,
        "from" => verification.from_node as f64,
        "to" => verification.candidate.node as f64,
        "gap" => verification.gap() as f64,
        "chi2" => verification.gate.chi2,
        "rmse" => verification.rmse_m,
        "accepted" => f64::from(u8::from(attempt.accepted())),
        "gate_std_m" => gate_std(0),
        "gate_std_deg" => gate_std(2).to_degrees(),
        "max_shift" => attempt.effect?.max_shift_m,
        "rms_before" => attempt.effect?.keyframe_rms_m.before,
        "rms_after" => attempt.effect?.keyframe_rms_m.after,
        "error_m" => lap.loop_error(attempt).position_m,
        "error_deg" => lap.loop_error(attempt).heading_deg,
        _ => return None,
    })
}

/// Attempts that the gate alone turned away although they were right.
fn right_refused(lap: &LapTrace) -> f64 {
    let is_right = |attempt: &&LoopAttempt| !lap.loop_error(attempt).is_false();
    let refused = lap
        .loop_attempts()
        .filter(|attempt| !attempt.verification.gate.passes());
    refused.filter(is_right).count() as f64
}
