//! Mounting of a laser by the transforms of the whole recording.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use crate::laser_mount::LaserMount;
use crate::log::LogOptions;
use crate::ros::survey::Survey;
use crate::ros::transforms::planar_mount;

/// A mounting, and how it was determined.
pub struct FoundMount {
    /// Mounting in the plane.
    pub mount: LaserMount,
    /// Mounting in 3-D.
    pub body_from_sensor: Isometry3<f64>,
    /// The body frame that it refers to.
    pub body: String,
    /// Whether transforms or the user define it.
    pub is_known: bool,
    /// What was missing.
    pub warning: Option<String>,
}

/// Determines the mounting of `sensor` on `body`.
pub fn find(
    survey: &Survey,
    body: &str,
    sensor: &str,
    ground: Option<&str>,
    options: &LogOptions,
) -> FoundMount {
    let transforms = &survey.transforms;
    let mut found = FoundMount {
        mount: LaserMount::default(),
        body_from_sensor: Isometry3::identity(),
        body: body.to_owned(),
        is_known: false,
        warning: None,
    };
    let mut chain = transforms.body_from_sensor(body, sensor, ground);
    if chain.is_none()
        && options.body_frame.is_none()
        && let Some(root) = transforms.root_of(sensor, ground)
    {
        // The odometry's body frame is in no transform: take the highest frame that the laser is fixed to.
        chain = transforms.body_from_sensor(root, sensor, ground);
        if chain.is_some() {
            found.warning = Some(format!(
                "there is no transform from {body} to {sensor}; {root} is connected to it and is used as the body. Choose another with --body-frame"
            ));
            found.body = root.to_owned();
        }
    }
    if let Some(mount) = options.laser {
        let [x, y, theta] = mount.body_from_sensor.to_array();
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), theta);
        let height_m = chain.map_or(0.0, |chain| chain.translation.z);
        found.mount = mount;
        found.body_from_sensor = Isometry3::from_parts(Translation3::new(x, y, height_m), turn);
        found.is_known = true;
        found.warning = None;
        return found;
    }
    let why = match chain.as_ref().map(planar_mount) {
        Some(Ok(mount)) => {
            found.mount = mount;
            found.body_from_sensor = chain.unwrap_or_default();
            found.is_known = true;
            if transforms.moves_on(&found.body, sensor) {
                found.warning = Some(format!(
                    "{sensor} moves relative to {}; its latest pose is used for all scans. Fix it, or set its mounting with --laser x,y,degrees",
                    found.body
                ));
            }
            return found;
        }
        Some(Err(problem)) => problem,
        None if sensor.is_empty() => "the scans have no frame".to_owned(),
        None => format!("there is no transform from {body} to {sensor}"),
    };
    if let Some(mount) = options.laser_before {
        found.mount = mount;
        found.is_known = true;
        found.warning = Some(format!("{why}; the mounting of the session is used"));
        return found;
    }
    found.warning = Some(format!(
        "{why}; the laser is assumed at the body's origin, facing forward. Set its mounting with --laser x,y,degrees"
    ));
    found
}

/// A mounting in words.
pub fn sentence(found: &FoundMount) -> String {
    let [x, y, theta] = found.mount.body_from_sensor.to_array();
    format!(
        "the laser is at {x:.3} m, {y:.3} m, {:.2}° on {}{}",
        theta.to_degrees(),
        found.body,
        if found.mount.is_flipped {
            ", upside down"
        } else {
            ""
        }
    )
}
