//! Messages of ROS 2 for the map, the path and the transforms, with their definitions.
//!
//! Source: common_interfaces (nav_msgs, geometry_msgs, std_msgs), geometry2 (tf2_msgs), rcl_interfaces (builtin_interfaces).

use pr_geom::{SE2, math};
use robot_connection::{Cdr, Channel};
use robot_io::map_image::MapImage;

/// Number of each topic.
pub const MAP: usize = 0;
pub const PATH: usize = 1;
pub const TRANSFORMS: usize = 2;
/// Frame of the map.
pub const MAP_FRAME: &str = "map";

/// Definitions of types, each with the names of those that it contains.
const HEADER: (&str, &str) = (
    "std_msgs/Header",
    "builtin_interfaces/Time stamp\nstring frame_id",
);
const TIME: (&str, &str) = ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec");
const POSE: (&str, &str) = (
    "geometry_msgs/Pose",
    "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation",
);
const POINT: (&str, &str) = ("geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z");
const QUATERNION: (&str, &str) = (
    "geometry_msgs/Quaternion",
    "float64 x\nfloat64 y\nfloat64 z\nfloat64 w",
);

/// The topics.
pub fn channels() -> Vec<Channel> {
    let channel = |topic, schema_name, own: &str, contained: &[(&str, &str)]| {
        let mut schema = own.to_owned();
        for (name, fields) in contained {
            schema += &format!("\n{}\nMSG: {name}\n{fields}", "=".repeat(80));
        }
        Channel {
            topic,
            schema_name,
            schema,
        }
    };
    vec![
        channel(
            "/map",
            "nav_msgs/msg/OccupancyGrid",
            "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data",
            &[
                HEADER,
                TIME,
                (
                    "nav_msgs/MapMetaData",
                    "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\n\
                     geometry_msgs/Pose origin",
                ),
                POSE,
                POINT,
                QUATERNION,
            ],
        ),
        channel(
            "/path",
            "nav_msgs/msg/Path",
            "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses",
            &[
                HEADER,
                TIME,
                (
                    "geometry_msgs/PoseStamped",
                    "std_msgs/Header header\ngeometry_msgs/Pose pose",
                ),
                POSE,
                POINT,
                QUATERNION,
            ],
        ),
        channel(
            "/tf",
            "tf2_msgs/msg/TFMessage",
            "geometry_msgs/TransformStamped[] transforms",
            &[
                HEADER,
                TIME,
                (
                    "geometry_msgs/TransformStamped",
                    "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform",
                ),
                (
                    "geometry_msgs/Transform",
                    "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation",
                ),
                ("geometry_msgs/Vector3", POINT.1),
                QUATERNION,
            ],
        ),
    ]
}

/// Position and quaternion.
fn pose(message: &mut Cdr, pose: &SE2) {
    let (sin, cos) = math::sin_cos(pose.theta() / 2.0);
    message.f64s(&[pose.x(), pose.y(), 0.0, 0.0, 0.0, sin, cos]);
}

/// `nav_msgs/OccupancyGrid`: a row after the other from the lowest y, -1 unknown, 0 free, 100 occupied.
pub fn map(stamp_s: f64, map: &MapImage) -> Vec<u8> {
    let mut message = Cdr::default();
    message.header(stamp_s, MAP_FRAME);
    message.time(stamp_s);
    message.f32(map.cell_m as f32);
    message.u32(map.width as u32);
    message.u32(map.height as u32);
    let [x, y] = map.origin_m;
    pose(&mut message, &SE2::new(x, y, 0.0));
    let mut cells = Vec::with_capacity(map.width * map.height);
    let Ok(()) = map.rows(|row| {
        let pixels = MapImage::pixels(row).into_iter();
        cells.extend(pixels.map(|pixel| match pixel {
            0 => 100,
            254 => 0,
            _ => u8::MAX,
        }));
        Ok::<(), std::convert::Infallible>(())
    });
    let rows: Vec<u8> = cells.chunks(map.width).rev().flatten().copied().collect();
    message.bytes(&rows);
    message.finish()
}

/// `nav_msgs/Path` of these poses.
pub fn path(stamp_s: f64, poses: &[SE2]) -> Vec<u8> {
    let mut message = Cdr::default();
    message.header(stamp_s, MAP_FRAME);
    message.u32(poses.len() as u32);
    for one in poses {
        message.header(stamp_s, MAP_FRAME);
        pose(&mut message, one);
    }
    message.finish()
}

/// `tf2_msgs/TFMessage`: frames and the pose of the second in the first.
pub fn transforms(stamp_s: f64, transforms: &[(&str, &str, SE2)]) -> Vec<u8> {
    let mut message = Cdr::default();
    message.u32(transforms.len() as u32);
    for (parent, child, parent_from_child) in transforms {
        message.header(stamp_s, parent);
        message.text(child);
        pose(&mut message, parent_from_child);
    }
    message.finish()
}
