//! Iterative closest point: pair every point with its nearest, move the cloud, repeat.
//!
//! With `T = target_from_source`, one iteration pairs each moved point `T p_k` with the nearest
//! map point `q_k` closer than τ, finds the motion that fits the pairs best, and composes it:
//! `T ← increment ∘ T`. Point-to-point minimizes `Σ ‖p − q‖²` in closed form (Besl & McKay 1992),
//! point-to-plane takes one Gauss–Newton step on `Σ (n·(p − q))²` (Chen & Medioni 1992).
//!
//! ICP finds the minimum of the basin of convergence in which it starts. It cannot detect a local minimum:
//! a small `rmse` means that the pairs agree, not that they are correct.
//!
//! A result claims only what pairs measured. Point to plane uses the pairs with a normal; without them the pose
//! is the guess, and a direction that no pair measures keeps that of the guess: [`StopReason`] says so, and
//! [`StopReason::converged`] is false.
//!
//! [`icp`] runs to the end. [`Icp`] runs one iteration at a time, and does not allocate if its
//! [`IcpWorkspace`] is kept between registrations.

mod align;
mod config;
mod information;
mod pairing;
mod rejection;
mod stepper;

pub use align::{RigidAlignment, closed_form, point_to_plane_step, svd_align};
pub use config::{IcpConfig, IcpVariant, huber_weight};
pub(crate) use information::weighted_information;
pub use information::{
    INFORMATION_CAP, INFORMATION_RIDGE, centroid, icp_information, icp_information_along,
    move_information, regularize,
};
pub use pairing::{IcpTrace, IcpWorkspace, Pair, correspondences};
pub use rejection::{Accepted, MaxDistance, PairRejection, Trimmed};
pub use stepper::{Icp, IcpResult, IcpStep, IcpSummary, Increment, StopReason, icp};
