//! Maps as smooth fields, and hill climbing of a scan on them.
//!
//! [`FieldTiles`] stores known cells and grows on demand. A field interpolates it bicubically and returns the
//! score of a point with gradient and curvature ([`PointScores`]). [`ScanClimb`] maximizes the sum
//! over a scan's points, plus a prior of its pose: the registration of the
//! [`IncrementalMapper`](crate::IncrementalMapper) on its likelihood field.

mod bicubic;
mod climb;
#[cfg(test)]
pub(crate) mod test_corner;
mod tiled_grid;

pub use bicubic::{FieldSample, bicubic};
pub use climb::{
    Climb, ClimbConfig, ClimbStep, ClimbStop, PointScore, PointScores, PosePrior, ScanClimb,
};
pub use tiled_grid::FieldTiles;
