//! Deserializes the messages of a log.

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

use super::scan_fields::ScanFields;
use super::wire::{Wire, WireError, WireReader};

/// Stamp and frame of a message.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// Stamp, s.
    pub stamp_s: f64,
    /// Frame.
    pub frame: String,
}

/// `nav_msgs/Odometry` or a stamped pose, reduced to what a planar robot needs.
#[derive(Clone, Debug, PartialEq)]
pub struct OdometryMessage {
    /// Stamp and odometry frame.
    pub header: Header,
    /// Body frame.
    pub child: String,
    /// Pose of the body in the odometry frame.
    pub pose: Isometry3<f64>,
    /// Whether its orientation was set: 0,0,0,0 is none.
    pub is_oriented: bool,
}

/// One transform of `tf2_msgs/TFMessage`.
#[derive(Clone, Debug, PartialEq)]
pub struct TransformMessage {
    /// Stamp and parent frame.
    pub header: Header,
    /// Child frame.
    pub child: String,
    /// Pose of the child in its parent.
    pub transform: Isometry3<f64>,
    /// Whether its rotation was set: 0,0,0,0 is none.
    pub is_oriented: bool,
}

/// The header of a message.
pub fn header(fields: &mut WireReader<'_>) -> Result<Header, WireError> {
    if fields.wire() == Wire::Ros1 {
        fields.u32("the sequence number")?;
    }
    Ok(Header {
        stamp_s: fields.stamp_s()?,
        // ROS 1 frames have a leading slash.
        frame: fields.name("the frame")?.trim_start_matches('/').to_owned(),
    })
}

/// `sensor_msgs/LaserScan`; the mounting is not in the message.
pub fn laser_scan(fields: &mut WireReader<'_>) -> Result<(Header, ScanFields), WireError> {
    let (header, mut scan) = scan_without_ranges(fields)?;
    scan.ranges_m = fields.f32_list("ranges")?;
    Ok((header, scan))
}

/// `sensor_msgs/MultiEchoLaserScan`: the first echo of each beam.
pub fn multi_echo_scan(fields: &mut WireReader<'_>) -> Result<(Header, ScanFields), WireError> {
    let (header, mut scan) = scan_without_ranges(fields)?;
    let count = fields.count("ranges", 4)?;
    scan.ranges_m = Vec::with_capacity(count);
    for _ in 0..count {
        let echoes = fields.f32_list("echoes")?;
        scan.ranges_m.push(echoes.first().copied().unwrap_or(0.0));
    }
    Ok((header, scan))
}

/// Fields before the ranges, shared by both kinds of scans.
fn scan_without_ranges(fields: &mut WireReader<'_>) -> Result<(Header, ScanFields), WireError> {
    let header = header(fields)?;
    let scan = ScanFields {
        angle_min: fields.f32("angle_min")?,
        angle_max: fields.f32("angle_max")?,
        angle_increment: fields.f32("angle_increment")?,
        time_increment: fields.f32("time_increment")?,
        scan_time: fields.f32("scan_time")?,
        range_min: fields.f32("range_min")?,
        range_max: fields.f32("range_max")?,
        ranges_m: Vec::new(),
    };
    Ok((header, scan))
}

/// `nav_msgs/Odometry`, or `geometry_msgs/TransformStamped`, whose fields begin alike.
pub fn odometry(fields: &mut WireReader<'_>) -> Result<OdometryMessage, WireError> {
    let header = header(fields)?;
    let child = fields.name("child_frame_id")?;
    let (pose, is_oriented) = pose(fields)?;
    Ok(OdometryMessage {
        header,
        child: child.trim_start_matches('/').to_owned(),
        pose,
        is_oriented,
    })
}

/// `geometry_msgs/PoseStamped` or `geometry_msgs/PoseWithCovarianceStamped`, which do not name the body frame.
pub fn stamped_pose(fields: &mut WireReader<'_>) -> Result<OdometryMessage, WireError> {
    let header = header(fields)?;
    let (pose, is_oriented) = pose(fields)?;
    Ok(OdometryMessage {
        header,
        child: String::new(),
        pose,
        is_oriented,
    })
}

/// `tf2_msgs/TFMessage`.
pub fn transforms(fields: &mut WireReader<'_>) -> Result<Vec<TransformMessage>, WireError> {
    // Header, name and seven numbers.
    let count = fields.count("transforms", 72)?;
    let mut all = Vec::with_capacity(count);
    for _ in 0..count {
        let header = header(fields)?;
        let child = fields.name("child_frame_id")?;
        let (transform, is_oriented) = pose(fields)?;
        all.push(TransformMessage {
            header,
            child: child.trim_start_matches('/').to_owned(),
            transform,
            is_oriented,
        });
    }
    Ok(all)
}

/// Position and quaternion, and whether the quaternion was set.
fn pose(fields: &mut WireReader<'_>) -> Result<(Isometry3<f64>, bool), WireError> {
    let mut numbers = [0.0; 7];
    for (slot, name) in numbers
        .iter_mut()
        .zip(["x", "y", "z", "qx", "qy", "qz", "qw"])
    {
        *slot = fields.f64(name)?;
    }
    let [x, y, z, qx, qy, qz, qw] = numbers;
    let quaternion = Quaternion::new(qw, qx, qy, qz);
    let is_oriented = quaternion.norm_squared() > 1e-12;
    let rotation = if is_oriented {
        UnitQuaternion::new_normalize(quaternion)
    } else {
        UnitQuaternion::identity()
    };
    let pose = Isometry3::from_parts(Translation3::new(x, y, z), rotation);
    Ok((pose, is_oriented))
}
