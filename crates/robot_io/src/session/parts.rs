//! The sections of a session file, in order.

use std::sync::Arc;

use ch16_slam2d::graph::{EdgeKind, EdgeView, PoseEdge, PoseNode};
use ch16_slam2d::loops::PendingLoop;
use ch16_slam2d::pipeline::ScanPose;
use ch16_slam2d::scan::LaserScan;
use ch16_slam2d::slam::{
    FrontEndSnapshot, Keyframe, RobotConfig, SlamConfig, SlamSnapshot, WindowSweep,
};
use pr_geom::{SE2, Vector3};

use super::bytes::{Broken, Cursor, Writer};
use super::{MappedGraph, Session, pending, scans};

/// Mean bytes per keyframe's scan: with its node, its pose on the map, eight scan poses
/// and five edges a keyframe stays below 3,000.
pub const SCAN_BYTES: usize = 2110;
/// Two nodes, the kind, the measurement, the information.
const EDGE_BYTES: usize = 105;
/// Fixed flag, pose, frame, stamp.
const NODE_BYTES: usize = 41;
/// Three 64-bit floats.
const POSE_BYTES: usize = 24;
/// Stamp, keyframe, pose.
const PLACE_BYTES: usize = 36;
/// Frame and pose of a sweep, and the minimum of a scan.
const SWEEP_BYTES: usize = 46;

pub fn write(session: &Session, out: &mut Writer) {
    let Session {
        driven,
        mapped,
        scan_poses,
        sensor,
        last_odometry,
    } = session;
    let radius_m = driven.config.scan.normal_radius_m;
    out.section(b"CONF", |out| {
        let robot = driven.config.robot.unwrap_or_default();
        out.pose(&driven.config.start);
        out.bytes(&serde_json::to_vec(&robot).expect("plain numbers"));
    });
    out.section(b"SENS", |out| {
        out.maybe(sensor.as_ref(), |out, sensor| {
            let LaserScan {
                first_angle_rad,
                angle_step_rad,
                range_min_m,
                range_max_m,
                body_from_sensor,
                beam_interval_s,
                ranges_m: _,
            } = sensor;
            for value in [first_angle_rad, angle_step_rad, range_min_m, range_max_m] {
                out.f64(*value);
            }
            out.pose(body_from_sensor);
            out.f64(*beam_interval_s);
        });
        out.maybe(last_odometry.as_ref(), Writer::pose);
    });
    out.section(b"STAT", |out| {
        out.u64(driven.frames as u64);
        out.f64(driven.last_stamp_s);
        out.maybe(driven.last_attempt_node, Writer::count);
        out.count(driven.last_loop_node);
        out.count(driven.optimized_edges);
    });
    out.section(b"NODE", |out| {
        out.count(driven.nodes.len());
        for (node, keyframe) in driven.nodes.iter().zip(&driven.keyframes) {
            out.u8(u8::from(node.fixed));
            out.pose(&node.pose);
            out.u64(keyframe.frame as u64);
            out.f64(keyframe.stamp_s);
        }
    });
    out.section(b"EDGE", |out| write_edges(&driven.edges, out));
    out.section(b"HELD", |out| {
        out.count(driven.pending.len());
        let waiting = driven.pending.iter();
        waiting.for_each(|waiting| pending::write(waiting, out));
    });
    out.section(b"SCAN", |out| {
        let keyframes = driven.keyframes.iter();
        let scans = keyframes.map(|keyframe| keyframe.scan.as_ref());
        scans::write_all(scans, radius_m, SCAN_BYTES, out);
    });
    out.section(b"MAPD", |out| {
        out.maybe(mapped.as_ref(), |out, mapped| {
            out.count(mapped.poses.len());
            mapped.poses.iter().for_each(|pose| out.pose(pose));
            write_edges(&mapped.loops, out);
        });
    });
    out.section(b"WAYS", |out| {
        out.count(scan_poses.len());
        for scan in scan_poses {
            out.f64(scan.stamp_s);
            out.count(scan.keyframe);
            out.pose(&scan.keyframe_from_body);
        }
    });
    let front = &driven.front_end;
    out.section(b"FRNT", |out| {
        out.pose(&front.estimate);
        front.velocity.iter().for_each(|value| out.f64(*value));
        out.f64(front.last_dt_s);
        out.f64(front.deviations_m2);
        out.u64(front.deviations as u64);
        out.matrix(&front.motion_covariance);
        out.maybe(front.unregistered.as_ref(), Writer::matrix);
        out.count(front.window.len());
        for (sweep, scan) in front.window.iter().zip(&front.scans) {
            out.u64(sweep.frame as u64);
            out.pose(&sweep.pose);
            scans::write_exactly(scan, radius_m, out);
        }
    });
}

fn write_edges(edges: &[EdgeView], out: &mut Writer) {
    out.count(edges.len());
    for EdgeView { from, to, edge, .. } in edges {
        out.count(from.index());
        out.count(to.index());
        out.u8(match edge.kind {
            EdgeKind::Odometry => 0,
            EdgeKind::Loop => 1,
        });
        out.pose(&edge.measurement);
        // All nine entries: the two triangles may differ in the last bit.
        out.matrix(&edge.information);
    }
}

pub fn read(from: &mut Cursor<'_>) -> Result<Session, Broken> {
    let config = from.section(b"CONF", |from| {
        let start = from.pose()?;
        let json = from.take(from.left())?;
        let robot: RobotConfig = serde_json::from_slice(json)
            .map_err(|problem| from.broken(format!("expected parameters: {problem}")))?;
        let robot = crate::settings::checked(robot).map_err(|problem| from.broken(problem))?;
        Ok(SlamConfig {
            start,
            ..SlamConfig::from_robot(robot)
        })
    })?;
    let radius_m = config.scan.normal_radius_m;
    let (sensor, last_odometry) = from.section(b"SENS", |from| {
        Ok((from.maybe(read_sensor)?, from.maybe(Cursor::pose)?))
    })?;
    let counters = from.section(b"STAT", Counters::read)?;
    let node_rows = from.section(b"NODE", |from| {
        let count = from.count(NODE_BYTES)?;
        (0..count)
            .map(|_| read_node(from))
            .collect::<Result<Vec<_>, _>>()
    })?;
    let edges = from.section(b"EDGE", read_edges)?;
    let waiting = from.section(b"HELD", |from| {
        let count = from.count(pending::BYTES)?;
        let loops: Result<Vec<PendingLoop>, Broken> =
            (0..count).map(|_| pending::read(from)).collect();
        loops
    })?;
    let keyframes = from.section(b"SCAN", |from| {
        let mut keyframes = Vec::new();
        for (node, (_, frame, stamp_s)) in node_rows.iter().enumerate() {
            keyframes.push(Keyframe {
                node,
                frame: *frame,
                stamp_s: *stamp_s,
                scan: Arc::new(scans::read(from, radius_m)?),
            });
        }
        Ok(keyframes)
    })?;
    let mapped = from.section(b"MAPD", |from| {
        from.maybe(|from| {
            let count = from.count(POSE_BYTES)?;
            let poses: Result<Vec<SE2>, Broken> = (0..count).map(|_| from.pose()).collect();
            Ok(MappedGraph {
                poses: poses?,
                loops: read_edges(from)?,
            })
        })
    })?;
    let scan_poses = from.section(b"WAYS", |from| {
        let count = from.count(PLACE_BYTES)?;
        let read_pose = |_| {
            Ok(ScanPose {
                stamp_s: from.f64()?,
                keyframe: from.u32()? as usize,
                keyframe_from_body: from.pose()?,
            })
        };
        (0..count)
            .map(read_pose)
            .collect::<Result<Vec<_>, Broken>>()
    })?;
    let front_end = from.section(b"FRNT", |from| {
        let estimate = from.pose()?;
        let velocity = Vector3::new(from.number()?, from.number()?, from.number()?);
        // Infinite before the first motion.
        let last_dt_s = from.f64()?;
        let deviations_m2 = from.number()?;
        let deviations = read_number(from)?;
        let motion_covariance = from.matrix()?;
        let unregistered = from.maybe(Cursor::matrix)?;
        let count = from.count(SWEEP_BYTES)?;
        let (mut window, mut window_scans) = (Vec::new(), Vec::new());
        for _ in 0..count {
            window.push(WindowSweep {
                frame: read_number(from)?,
                pose: from.pose()?,
            });
            window_scans.push(Arc::new(scans::read(from, radius_m)?));
        }
        Ok(FrontEndSnapshot {
            estimate,
            velocity,
            last_dt_s,
            window,
            scans: window_scans,
            deviations_m2,
            deviations,
            motion_covariance,
            unregistered,
        })
    })?;
    if from.left() > 0 {
        return Err(from.broken("expected the end of the file"));
    }
    Ok(Session {
        driven: SlamSnapshot {
            config,
            frames: counters.frames,
            last_stamp_s: counters.last_stamp_s,
            nodes: node_rows.into_iter().map(|(node, ..)| node).collect(),
            optimized_edges: counters.optimized_edges,
            edges,
            keyframes,
            last_attempt_node: counters.last_attempt_node,
            last_loop_node: counters.last_loop_node,
            pending: waiting,
            front_end,
        },
        mapped,
        scan_poses,
        sensor,
        last_odometry,
    })
}

/// Counters of the estimator.
struct Counters {
    frames: usize,
    last_stamp_s: f64,
    last_attempt_node: Option<usize>,
    last_loop_node: usize,
    optimized_edges: usize,
}

impl Counters {
    fn read(from: &mut Cursor<'_>) -> Result<Self, Broken> {
        let node = |from: &mut Cursor<'_>| Ok(from.u32()? as usize);
        Ok(Self {
            frames: read_number(from)?,
            last_stamp_s: from.f64()?,
            last_attempt_node: from.maybe(node)?,
            last_loop_node: node(from)?,
            optimized_edges: node(from)?,
        })
    }
}

fn read_number(from: &mut Cursor<'_>) -> Result<usize, Broken> {
    let value = from.u64()?;
    usize::try_from(value).map_err(|_| from.broken(format!("{value} is too large a number")))
}

fn read_sensor(from: &mut Cursor<'_>) -> Result<LaserScan, Broken> {
    Ok(LaserScan {
        first_angle_rad: from.f64()?,
        angle_step_rad: from.f64()?,
        range_min_m: from.f64()?,
        range_max_m: from.f64()?,
        body_from_sensor: from.pose()?,
        beam_interval_s: from.f64()?,
        ranges_m: Vec::new(),
    })
}

fn read_node(from: &mut Cursor<'_>) -> Result<(PoseNode, usize, f64), Broken> {
    let fixed = from.flag()?;
    let pose = from.pose()?;
    Ok((PoseNode { pose, fixed }, read_number(from)?, from.f64()?))
}

fn read_edges(from: &mut Cursor<'_>) -> Result<Vec<EdgeView>, Broken> {
    let count = from.count(EDGE_BYTES)?;
    let edge = |number: usize| {
        let (start, end) = (from.u32()? as usize, from.u32()? as usize);
        let kind = match from.u8()? {
            0 => EdgeKind::Odometry,
            1 => EdgeKind::Loop,
            other => {
                return Err(from.broken(format!("expected an edge of kind 0 or 1, found {other}")));
            }
        };
        Ok(EdgeView {
            id: number.into(),
            from: start.into(),
            to: end.into(),
            edge: PoseEdge {
                measurement: from.pose()?,
                information: from.matrix()?,
                kind,
            },
        })
    };
    (0..count).map(edge).collect()
}
