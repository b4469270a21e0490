//! A solution of every exercise in code. Four of them are unchanged listings of the chapter.

mod gauss_newton;
mod range_histogram;
mod residual;

pub use ch16_listings::{icp, point_to_plane_step, svd_align, verify_loop};
pub use gauss_newton::{optimize, optimize_once};
pub use range_histogram::{chi2_distance, detect_by_histogram, range_histogram};
pub use residual::{jacobians, residual};
