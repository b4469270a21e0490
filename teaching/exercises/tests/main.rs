//! The tests that mark the exercises, a module each. They run over the student's functions, or with the feature
//! `solutions` over ours.

mod canonical;
mod gauss_newton;
mod point_to_plane_step;
mod range_histogram;
mod residual;
mod signatures;
mod svd_align;
mod trimmed_icp;
mod verify_loop;
