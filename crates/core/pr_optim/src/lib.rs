#![doc = include_str!("../README.md")]
//!
//! Sparse nonlinear least squares over SE(2) blocks (Chapter 15).
//!
//! A [`Problem`] holds poses and measurements between them. An [`Optimizer`] minimizes `Σ ρ(eᵀΩe)` by Gauss–Newton
//! or Levenberg–Marquardt, one [`step`](Optimizer::step) at a time or to the end with [`run`](Optimizer::run), and
//! reports why it stopped. A [`SolveSession`] also chooses the initial guess, and tries another one if the first
//! converges to a suspicious minimum. Covariances of poses come [from the factor](Optimizer::joint_covariance),
//! exact to first order.
//!
//! Data flow of an iteration: [`Problem`] → [`structure`] (which 3×3 blocks there are, in the order
//! of [`ordering`]) → [`system`] (their values) → [`block_cholesky`] on [`supernodes`] → step.
//!
//! The crate reads no clock, depends on no hash order and calls no mathematics of the platform: the same input
//! gives the same bits natively and in WebAssembly.

#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]

mod best;
pub mod block_cholesky;
mod custom;
mod damping;
mod dense_kernel;
mod elimination;
mod error;
mod factor;
pub mod g2o;
mod incremental;
pub mod init;
mod kernel;
mod linear;
mod marginals;
mod optimizer;
pub mod ordering;
mod problem;
mod report;
pub mod robust;
mod selected_inverse;
mod session;
mod settings;
pub mod structure;
pub mod supernodes;
pub mod system;

pub use custom::CustomGaussNewton;
pub use error::OptimizeError;
pub use factor::{Between, JacobianModel, Jacobians, Linearization, PreparedFactor, PreparedPose};
pub use kernel::RobustKernel;
pub use linear::LinearSolver;
pub use marginals::JointCovariance;
pub use optimizer::Optimizer;
pub use problem::Problem;
pub use report::{Report, StepReport, StopReason};
pub use session::{SUSPICIOUS_TURN_RAD, SessionOutcome, SolveSession, Start, TriedStart};
pub use settings::{FactorUse, Method, Settings};
