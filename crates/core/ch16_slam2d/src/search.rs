//! Correlative scan matching: scores every pose of a window, and skips most of them by bounds.
//!
//! The map becomes a [`LikelihoodGrid`]: a cell's score decreases with its distance to the nearest point of the
//! map. A pose puts every point of the scan into a cell, and its score is the sum over the points,
//! `S(ξ) = Σ_k M(T_ξ p_k)`, in integers. A [`SearchMap`] also stores the largest scores of squares of 2, 4, 8 …
//! cells, so one sum over the points bounds a whole box of poses from above. [`ScanSearch`] splits the most
//! promising box and drops those whose bound is below the best scored pose: depth-first branch and bound over x, y
//! and the heading. The result is that of [`ScanSearch::exhaustive`], to the last bit and with the same choice
//! among equals.
//!
//! With a window around a guess it is a matcher for loops ([`SearchMatcher`](crate::matching::SearchMatcher));
//! with a window as large as the map it relocalizes a lost robot. It also returns the margin to the best
//! *distinct* pose. It cannot resolve ambiguity: the score is the same all along a corridor, and then the margin
//! is small.
//!
//! Sources: Olson, "Real-time correlative scan matching", ICRA 2009; Hess, Kohler, Rapp, Andor,
//! "Real-time loop closure in 2D LIDAR SLAM", ICRA 2016, §IV. Theirs branches over x and y at one
//! heading; here coarse boxes also contain neighbouring headings.

mod error;
mod lattice;
mod likelihood_grid;
mod pyramid;
mod report;
mod scan_search;
mod score_scale;
mod turned_scan;
mod window;

pub use error::SearchError;
pub use likelihood_grid::{LikelihoodConfig, LikelihoodGrid};
pub use pyramid::SearchMap;
pub use report::{
    BoxFate, PoseBox, ScoredPose, SearchCounts, SearchGoal, SearchReport, SearchResult,
};
pub use scan_search::ScanSearch;
pub use window::{SearchNeighborhood, SearchWindow};

/// Largest number of cells of a grid: 105 m × 105 m at 0.05 m. The levels above it take ten times the memory.
pub const MAX_GRID_CELLS: u64 = 1 << 22;

#[cfg(test)]
mod tests;
