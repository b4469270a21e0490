//! The parameter of the error that ICP reduces, shared by the widgets that register by either.

use ch16_slam2d::icp::IcpVariant;
use widget_kit::one_of;
use widget_kit::param::OneOf;

/// The error that ICP reduces.
pub static VARIANT: OneOf<IcpVariant> = one_of!(
    IcpVariant,
    "variant",
    "error that ICP reduces",
    &[
        (IcpVariant::PointToPoint, "point-to-point", "point-to-point"),
        (IcpVariant::PointToPlane, "point-to-plane", "point-to-plane"),
    ],
)
.help("The distance between paired points, or only its part along the wall's normal.");
