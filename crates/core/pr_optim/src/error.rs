//! Errors of a solve.

use thiserror::Error;

/// Why a step could not be computed.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum OptimizeError {
    /// The factorization met a pivot that is not positive.
    #[error(
        "the normal equations are not positive definite at node {node}: \
         a connection to a fixed node is missing, its measurements leave a direction unconstrained, \
         or an information matrix is indefinite"
    )]
    NotPositiveDefinite {
        /// Index of the pose at whose block the factorization stopped.
        node: usize,
    },
    /// The cost or the step is infinite or not a number.
    #[error(
        "the cost or the step is not finite: \
         a pose, a measurement or an information matrix has too large a value"
    )]
    NotFinite,
}
