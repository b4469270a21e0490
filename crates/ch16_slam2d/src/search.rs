//! Correlative matching: every pose of a window has a score, and bounds spare most of the work.
//!
//! The map becomes a [`LikelihoodGrid`]: a cell's score says how near the next point of the map is.
//! A pose puts every point of the scan into a cell, and its score is the sum over the points,
//! `S(ξ) = Σ_k M(T_ξ p_k)`, whole numbers all of them. A [`SearchMap`] keeps the largest scores of
//! squares of 2, 4, 8 … cells beside it, so one sum over the points bounds a whole box of poses from
//! above. [`ScanSearch`] splits the most promising box and drops those whose bound is below the best
//! pose that was scored: depth-first branch and bound over x, y and the heading. What it finds is
//! what [`ScanSearch::exhaustive`] finds, to the last bit and with the same choice among equals.
//!
//! A window around a guess makes it a matcher for loops
//! ([`SearchMatcher`](crate::matching::SearchMatcher)); a window as large as the map finds a robot
//! that is lost. It says by how much the best *other* place is behind. It cannot tell apart what
//! looks alike: a corridor's score is the same all along it, and then the margin says so.
//!
//! Sources: Olson, "Real-time correlative scan matching", ICRA 2009; Hess, Kohler, Rapp, Andor,
//! "Real-time loop closure in 2D LIDAR SLAM", ICRA 2016, §IV. Theirs branches over x and y at one
//! heading; here far boxes hold neighbouring headings as well.

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
pub use likelihood_grid::{LikelihoodConfig, LikelihoodGrid, MAX_GRID_CELLS};
pub use pyramid::SearchMap;
pub use report::{
    BoxFate, PoseBox, ScoredPose, SearchCounts, SearchGoal, SearchReport, SearchResult,
};
pub use scan_search::ScanSearch;
pub use window::{SearchNeighborhood, SearchWindow};

#[cfg(test)]
mod tests;
