//! Names of the panels.

/// The world with the graph.
pub const MAP: &str = "map";
/// Close-up of one loop.
pub const LOOP: &str = "loop";
/// χ² of each loop tried.
pub const GATE: &str = "gate";
/// √χ² of each edge.
pub const STRAIN: &str = "strain";
