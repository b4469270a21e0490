//! What the values of the parameter list mean to the core.

use ch16_lab::moving_box::{BoxConfig, BoxMethods};
use ch16_slam2d::icp::IcpVariant;
use kit::values::Values;

/// The sweeps above the curves.
pub fn config(values: &Values) -> BoxConfig {
    BoxConfig {
        seed: values.get("seed") as u32,
        share: values.get("share") / 100.0,
        moved_m: values.get("moved"),
    }
}

/// What becomes of long pairs.
pub fn methods(values: &Values) -> BoxMethods {
    BoxMethods {
        variant: if values.get("variant") == 0.0 {
            IcpVariant::PointToPoint
        } else {
            IcpVariant::PointToPlane
        },
        tau_m: values.get("tau"),
        dropped: values.get("dropped") / 100.0,
        huber_width_m: values.get("huber"),
    }
}
