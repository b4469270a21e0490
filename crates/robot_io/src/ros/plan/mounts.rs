//! Where a laser sits, by the transforms of the whole recording.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use crate::laser_mount::LaserMount;
use crate::log::LogOptions;
use crate::ros::survey::Survey;
use crate::ros::transforms::mount_of;

/// A mounting, and how it was found.
pub struct Found {
    /// In the plane.
    pub mount: LaserMount,
    /// With height and lean.
    pub body_from_sensor: Isometry3<f64>,
    /// The frame of the body that it is on.
    pub body: String,
    /// Whether transforms or the user gave it.
    pub is_known: bool,
    /// What was missing.
    pub warning: Option<String>,
}

/// Where `sensor` sits on `body`.
pub fn find(
    survey: &Survey,
    body: &str,
    sensor: &str,
    ground: Option<&str>,
    options: &LogOptions,
) -> Found {
    let transforms = &survey.transforms;
    let mut found = Found {
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
        // The body of the odometry is in no transform: the highest frame that the laser is fixed to is
        // the robot's.
        chain = transforms.body_from_sensor(root, sensor, ground);
        if chain.is_some() {
            found.warning = Some(format!(
                "no transform leads from {body} to {sensor}; {root} leads there and is taken for the body. Choose another with --body-frame"
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
    let why = match chain.as_ref().map(mount_of) {
        Some(Ok(mount)) => {
            found.mount = mount;
            found.body_from_sensor = chain.unwrap_or_default();
            found.is_known = true;
            if transforms.moves_on(&found.body, sensor) {
                found.warning = Some(format!(
                    "{sensor} moves on {}; its newest place is taken for all scans. Fix it, or give its place with --laser x,y,degrees",
                    found.body
                ));
            }
            return found;
        }
        Some(Err(problem)) => problem,
        None if sensor.is_empty() => "the scans do not name their frame".to_owned(),
        None => format!("no transform leads from {body} to {sensor}"),
    };
    if let Some(mount) = options.laser_before {
        found.mount = mount;
        found.is_known = true;
        found.warning = Some(format!(
            "{why}; the laser is taken to sit where the session has it"
        ));
        return found;
    }
    found.warning = Some(format!(
        "{why}; the laser is taken to sit at the body's origin, looking ahead. Set its place with --laser x,y,degrees"
    ));
    found
}

/// A mounting in words.
pub fn sentence(found: &Found) -> String {
    let [x, y, theta] = found.mount.body_from_sensor.to_array();
    format!(
        "the laser sits at {x:.3} m, {y:.3} m, {:.2}° on {}{}",
        theta.to_degrees(),
        found.body,
        if found.mount.is_flipped {
            ", upside down"
        } else {
            ""
        }
    )
}
