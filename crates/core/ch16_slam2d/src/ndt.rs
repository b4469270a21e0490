//! The normal distributions transform: a map of Gaussians instead of points.
//!
//! Every cell with enough points becomes a mean `μ` and a covariance `Σ`. A point scores
//! `Σ_cells exp(−½ dᵀ Σ⁻¹ d)`, `d = T p − μ`, over the 3×3 cells around it (no unit; a point on a wall scores
//! about 1). The score is smooth inside a cell, so it has a gradient where nearest-neighbour costs are
//! discontinuous. It vanishes a few standard deviations off the walls: the basin of convergence is as wide as a
//! cell, not wider.
//!
//! Source: Biber & Straßer 2003.

mod align;
mod map;

pub use align::{NdtAlign, NdtConfig, NdtResult, NdtStep, NdtStop, ndt_align};
pub use map::{NdtCell, NdtMap};
