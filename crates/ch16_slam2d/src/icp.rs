//! Iterative closest point: pair every point with its nearest, move the cloud, repeat.
//!
//! With `T = target_from_source`, one iteration pairs each moved point `T p_k` with the nearest
//! map point `q_k` closer than τ, finds the motion that fits the pairs best, and puts it in front:
//! `T ← increment ∘ T`. Point-to-point minimizes `Σ ‖p − q‖²` in closed form (Besl & McKay 1992),
//! point-to-plane takes one Gauss–Newton step on `Σ (n·(p − q))²` (Chen & Medioni 1992).
//!
//! ICP finds the minimum of the basin in which it starts. It cannot tell a false minimum from the
//! right one: a small `rmse` says that pairs agree, not that they are the right pairs.
//!
//! [`icp`] runs to the end. [`Icp`] goes one iteration at a time, and with an [`IcpWorkspace`]
//! that is kept between registrations it does not allocate.

mod align;
mod config;
mod information;
mod pairing;
mod rejection;
mod stepper;

pub use align::{Alignment, closed_form, point_to_plane_step, svd_align};
pub use config::{IcpConfig, IcpVariant};
pub use information::{
    INFORMATION_CAP, INFORMATION_RIDGE, centroid, icp_information, icp_information_along,
    move_information, regularize,
};
pub use pairing::{IcpWorkspace, Pair, correspondences};
pub use rejection::{MaxDistance, PairRejection, Trimmed};
pub use stepper::{Icp, IcpResult, IcpStep, IcpSummary, IcpTrace, StopReason, icp};
