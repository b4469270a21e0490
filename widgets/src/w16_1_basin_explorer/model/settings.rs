//! What the values of the parameter list mean to the core.

use ch16_lab::basin::{BasinPlace, BasinScene, BasinStart, OffsetAxis};
use ch16_slam2d::icp::{IcpConfig, IcpVariant};
use kit::values::Values;

use crate::w16_1_basin_explorer::spec::HUBER_OFF_M;

/// The two sweeps that the reader chose.
pub fn scene(values: &Values) -> BasinScene {
    let place = if values.get("scene") == 0.0 {
        BasinPlace::Room
    } else {
        BasinPlace::Fence
    };
    BasinScene::at(place, values.get("seed") as u32)
}

/// The first guess that the reader chose.
pub fn start(values: &Values) -> BasinStart {
    BasinStart {
        heading_deg: values.get("heading"),
        dx_m: values.get("dx"),
        dy_m: values.get("dy"),
    }
}

/// The error that ICP reduces.
pub fn variant(values: &Values) -> IcpVariant {
    if values.get("variant") == 0.0 {
        IcpVariant::PointToPoint
    } else {
        IcpVariant::PointToPlane
    }
}

/// The one that is not chosen.
pub fn other_variant(variant: IcpVariant) -> IcpVariant {
    match variant {
        IcpVariant::PointToPoint => IcpVariant::PointToPlane,
        IcpVariant::PointToPlane => IcpVariant::PointToPoint,
    }
}

/// What a reader calls it.
pub fn variant_name(variant: IcpVariant) -> &'static str {
    match variant {
        IcpVariant::PointToPoint => "point to point",
        IcpVariant::PointToPlane => "point to plane",
    }
}

/// The offset on the basin maps.
pub fn axis(values: &Values) -> OffsetAxis {
    if values.get("axis") == 0.0 {
        OffsetAxis::Dx
    } else {
        OffsetAxis::Dy
    }
}

/// The settings of every registration in that variant.
pub fn config(values: &Values, variant: IcpVariant) -> IcpConfig {
    let huber_m = values.get("huber");
    IcpConfig {
        trim: values.get("trim"),
        huber_width_m: if huber_m < HUBER_OFF_M {
            huber_m
        } else {
            f64::INFINITY
        },
        ..BasinScene::config(variant, values.get("tau"))
    }
}
