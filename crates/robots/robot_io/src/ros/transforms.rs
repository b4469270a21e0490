//! Tree of coordinate frames, and the mounting of a laser on the body.

use std::collections::BTreeMap;

use nalgebra::Isometry3;
use pr_geom::{SE2, math};

use super::messages::TransformMessage;
use crate::laser_mount::LaserMount;

/// Longer chains of frames are cyclic.
const LONGEST_CHAIN: usize = 64;
/// More frames than any robot has: garbage has an unbounded number of names.
const MAX_FRAMES: usize = 10_000;
/// A laser whose axis is tilted farther does not scan the plane, as the cosine of 30°.
const MIN_UPRIGHT: f64 = 0.866;

/// A frame that moves by more from its first pose is not static, m.
const MOVED_M: f64 = 0.01;
/// The same for its rotation, rad.
const MOVED_RAD: f64 = 0.01;

/// Whether the name is that of a world-fixed frame by ROS convention (REP 105).
pub fn is_ground(frame: &str) -> bool {
    let name = frame.rsplit('/').next().unwrap_or(frame);
    name.contains("odom") || matches!(name, "map" | "world" | "earth")
}

/// Projects the mounting of a laser onto the plane.
///
/// # Errors
/// If the laser is tilted too far to scan the plane.
pub fn planar_mount(body_from_sensor: &Isometry3<f64>) -> Result<LaserMount, String> {
    let turn = body_from_sensor.rotation.to_rotation_matrix();
    let upright = turn.matrix()[(2, 2)];
    if upright.abs() < MIN_UPRIGHT {
        return Err("the laser is tilted by more than 30° and does not scan the plane".to_owned());
    }
    Ok(LaserMount {
        body_from_sensor: planar(body_from_sensor),
        is_flipped: upright < 0.0,
    })
}

/// Transform of a frame to its parent.
#[derive(Clone, Debug)]
struct Edge {
    parent: String,
    /// The latest transform.
    transform: Isometry3<f64>,
    first: Isometry3<f64>,
    moves: bool,
}

/// The latest transform of each frame to its parent.
#[derive(Clone, Debug, Default)]
pub struct Transforms {
    above: BTreeMap<String, Edge>,
}

impl Transforms {
    /// Adds a transform.
    pub fn add(&mut self, message: &TransformMessage) {
        if let Some(edge) = self.above.get_mut(&message.child) {
            let moved = edge.first.inverse() * message.transform;
            let is_elsewhere =
                moved.translation.vector.norm() > MOVED_M || moved.rotation.angle() > MOVED_RAD;
            edge.moves |= is_elsewhere && edge.parent == message.header.frame;
            edge.transform = message.transform;
            edge.parent.clone_from(&message.header.frame);
        } else if self.above.len() < MAX_FRAMES {
            let edge = Edge {
                parent: message.header.frame.clone(),
                transform: message.transform,
                first: message.transform,
                moves: false,
            };
            self.above.insert(message.child.clone(), edge);
        }
    }

    /// Whether any transform from `sensor` up to `body` changes.
    pub fn moves_on(&self, body: &str, sensor: &str) -> bool {
        let mut frame = sensor;
        for _ in 0..LONGEST_CHAIN {
            let Some(edge) = self.above.get(frame).filter(|_| frame != body) else {
                return false;
            };
            if edge.moves {
                return true;
            }
            frame = &edge.parent;
        }
        false
    }

    /// The highest frame that `sensor` is fixed to; `None` if it has no parent.
    pub fn root_of(&self, sensor: &str, ground: Option<&str>) -> Option<&str> {
        let mut root = None;
        let mut frame = sensor;
        for _ in 0..LONGEST_CHAIN {
            let Some(edge) = self.above.get(frame) else {
                break;
            };
            if edge.moves || is_ground(&edge.parent) || ground == Some(edge.parent.as_str()) {
                break;
            }
            root = Some(edge.parent.as_str());
            frame = &edge.parent;
        }
        root
    }

    /// Pose of `sensor` on `body`, through their lowest common ancestor; `None` if they have none.
    /// `ground` is the frame that the body moves in; its children are not fixed to the body.
    pub fn body_from_sensor(
        &self,
        body: &str,
        sensor: &str,
        ground: Option<&str>,
    ) -> Option<Isometry3<f64>> {
        let above_body = self.chain(body, ground);
        let above_sensor = self.chain(sensor, ground);
        above_sensor.into_iter().find_map(|(frame, of_sensor)| {
            let (_, of_body) = above_body.iter().find(|(above, _)| *above == frame)?;
            Some(of_body.inverse() * of_sensor)
        })
    }

    /// A frame and its ancestors, nearest first, each with the pose of the frame in it.
    fn chain<'a>(&'a self, frame: &'a str, ground: Option<&str>) -> Vec<(&'a str, Isometry3<f64>)> {
        let mut chain = vec![(frame, Isometry3::identity())];
        let (mut frame, mut pose) = chain[0];
        while let Some(edge) = self.above.get(frame)
            && chain.len() < LONGEST_CHAIN
            && ground != Some(edge.parent.as_str())
        {
            pose = edge.transform * pose;
            frame = &edge.parent;
            chain.push((frame, pose));
        }
        chain
    }

    /// Every (parent, child) pair in the order of names.
    pub fn edges(&self) -> impl Iterator<Item = (&str, &str)> {
        let edges = self.above.iter();
        edges.map(|(child, edge)| (edge.parent.as_str(), child.as_str()))
    }
}

/// Projects a transform onto the plane: position and yaw.
pub fn planar(transform: &Isometry3<f64>) -> SE2 {
    let turn = transform.rotation.to_rotation_matrix();
    let turn = turn.matrix();
    let offset = &transform.translation;
    SE2::new(offset.x, offset.y, math::atan2(turn[(1, 0)], turn[(0, 0)]))
}

#[cfg(test)]
mod tests {
    use core::f64::consts::{FRAC_PI_2, PI};

    use nalgebra::{Quaternion, Translation3, UnitQuaternion};

    use ch16_slam2d::scan::LaserScan;

    use super::*;
    use crate::ros::messages::Header;

    fn message(parent: &str, child: &str, x: f64, q: [f64; 4]) -> TransformMessage {
        let [qx, qy, qz, qw] = q;
        TransformMessage {
            header: Header {
                stamp_s: 0.0,
                frame: parent.to_owned(),
            },
            child: child.to_owned(),
            transform: Isometry3::from_parts(
                Translation3::new(x, 0.0, 0.3),
                UnitQuaternion::new_normalize(Quaternion::new(qw, qx, qy, qz)),
            ),
            is_oriented: true,
        }
    }

    #[test]
    fn a_laser_hangs_on_the_body_by_a_chain_and_may_hang_upside_down() {
        let mut frames = Transforms::default();
        let quarter = [0.0, 0.0, FRAC_PI_2.sqrt(), FRAC_PI_2.sqrt()];
        frames.add(&message("base", "mast", 1.0, quarter));
        frames.add(&message("mast", "laser", 0.5, [1.0, 0.0, 0.0, 0.0]));
        let chain = frames.body_from_sensor("base", "laser", None).unwrap();
        let mount = planar_mount(&chain).unwrap();
        let [x, y, theta] = mount.body_from_sensor.to_array();
        // 1e-12: a dozen roundings of numbers about 1.
        assert!((x - 1.0).abs() < 1e-12 && (y - 0.5).abs() < 1e-12);
        assert!((theta - FRAC_PI_2).abs() < 1e-12 && mount.is_flipped);
        let mut scan = LaserScan {
            first_angle_rad: -1.0,
            angle_step_rad: 0.5,
            ..LaserScan::default()
        };
        mount.apply(&mut scan);
        assert_eq!((scan.first_angle_rad, scan.angle_step_rad), (1.0, -0.5));
        assert_eq!(frames.body_from_sensor("base", "camera", None), None);
    }

    #[test]
    fn a_body_below_the_frame_that_the_laser_hangs_on_has_its_laser_all_the_same() {
        // For example, base_footprint is a child of base_link: odometry moves the former, the laser is on the latter.
        let mut frames = Transforms::default();
        let straight = [0.0, 0.0, 0.0, 1.0];
        let quarter = [0.0, 0.0, FRAC_PI_2.sqrt(), FRAC_PI_2.sqrt()];
        frames.add(&message("link", "footprint", -0.5, quarter));
        frames.add(&message("link", "laser", 0.25, straight));
        frames.add(&message("odom", "link", 7.0, quarter));
        let ground = Some("odom");
        let chain = frames
            .body_from_sensor("footprint", "laser", ground)
            .unwrap();
        let [x, y, theta] = planar_mount(&chain).unwrap().body_from_sensor.to_array();
        // 0.75 m ahead on the link, to the right of the footprint; 1e-12: a dozen roundings.
        assert!(x.abs() < 1e-12 && (y + 0.75).abs() < 1e-12, "{x} {y}");
        assert!((theta + FRAC_PI_2).abs() < 1e-12);
        // Another robot in the same odometry frame is not part of this one.
        frames.add(&message("odom", "camera", 9.0, straight));
        assert_eq!(frames.body_from_sensor("footprint", "camera", ground), None);
    }

    #[test]
    fn a_circle_of_frames_ends() {
        let mut frames = Transforms::default();
        frames.add(&message("a", "b", 1.0, [0.0, 0.0, 0.0, 1.0]));
        frames.add(&message("b", "a", 1.0, [0.0, 0.0, 0.0, 1.0]));
        assert_eq!(frames.body_from_sensor("base", "a", None), None);
        assert!(frames.body_from_sensor("b", "a", None).is_some());
    }

    #[test]
    fn a_laser_that_looks_at_the_floor_is_rejected() {
        let forward = UnitQuaternion::from_euler_angles(0.0, PI / 4.0, 0.0);
        let leaning = Isometry3::from_parts(Translation3::identity(), forward);
        assert!(planar_mount(&leaning).unwrap_err().contains("tilted"));
    }
}
