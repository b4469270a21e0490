//! Maps that are fields: a number for every place, smooth in between, and a scan that climbs on it.
//!
//! [`TiledGrid`] holds what is known of cells and grows where something is learnt. A field reads it
//! between the cells by bicubic interpolation and says of each point how well it lies there
//! ([`PointScores`]): its score with slope and curvature. [`ScanClimb`] moves a scan uphill on the sum
//! over its points, with a belief about its pose as one more term: the registration of the
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
pub use tiled_grid::TiledGrid;
