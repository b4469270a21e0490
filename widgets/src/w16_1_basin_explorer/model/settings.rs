//! Converts the values of the parameters to the types of the core.

use ch16_lab::basin::{BasinScene, BasinStart, OffsetAxis};
use ch16_slam2d::icp::{IcpConfig, IcpVariant};
use widget_kit::values::Values;

use crate::w16_1_basin_explorer::spec::{
    AXIS, DX, DY, HEADING, HUBER, HUBER_OFF_M, LIMIT, SCENE, SEED, TAU, TRIM, VARIANT,
};

/// The selected sweeps.
pub fn scene(values: &Values) -> BasinScene {
    BasinScene::at(values.get(&SCENE), values.get(&SEED))
}

/// The selected initial guess.
pub fn start(values: &Values) -> BasinStart {
    BasinStart {
        heading_deg: values.get(&HEADING),
        dx_m: values.get(&DX),
        dy_m: values.get(&DY),
    }
}

/// The error that ICP reduces.
pub fn variant(values: &Values) -> IcpVariant {
    values.get(&VARIANT)
}

/// The other variant.
pub fn other_variant(variant: IcpVariant) -> IcpVariant {
    match variant {
        IcpVariant::PointToPoint => IcpVariant::PointToPlane,
        IcpVariant::PointToPlane => IcpVariant::PointToPoint,
    }
}

/// Label of a variant.
pub fn variant_name(variant: IcpVariant) -> &'static str {
    match variant {
        IcpVariant::PointToPoint => "point-to-point",
        IcpVariant::PointToPlane => "point-to-plane",
    }
}

/// The offset on the axis of the basin maps.
pub fn axis(values: &Values) -> OffsetAxis {
    values.get(&AXIS)
}

/// The settings of every registration with that variant.
pub fn config(values: &Values, variant: IcpVariant) -> IcpConfig {
    let huber_m = values.get(&HUBER);
    IcpConfig {
        trim: values.get(&TRIM),
        max_iterations: values.get(&LIMIT),
        huber_width_m: if huber_m < HUBER_OFF_M {
            huber_m
        } else {
            f64::INFINITY
        },
        ..BasinScene::config(variant, values.get(&TAU))
    }
}
