//! Published pose-graph solvers, timed beside ours in one run.
//!
//! Every solver reads the same g2o file, starts from its poses, and runs on one thread. Runs are
//! interleaved, because load on the machine then affects all of them alike, and the fastest run of each
//! counts. All are compared by one χ², that of the log residual at their final poses. Only ours
//! minimizes exactly this: arael's model here has g2o's residual, and factrs 0.3 uses the log for one
//! sign of the heading residual only. Their optima differ slightly.

pub mod arael_peer;
pub mod compare;
pub mod factrs_peer;
pub mod ours;

use pr_geom::SE2;

/// Result of one timed solve.
#[derive(Clone, Debug, PartialEq)]
pub struct Solve {
    /// CPU time of the thread, ms, without reading the file.
    pub cpu_ms: f64,
    /// The final poses in the order of the file; `None` if the solver failed.
    pub poses: Option<Vec<SE2>>,
    /// Linear systems solved; `None` if the solver does not report it.
    pub iterations: Option<usize>,
}

/// A solver with a graph loaded.
pub trait Peer {
    /// Name as printed.
    fn name(&self) -> &'static str;

    /// A cold solve, with ordering and symbolic analysis.
    fn solve_cold(&mut self) -> Solve;

    /// A warm solve, which may reuse the symbolic analysis; `None` if the solver cannot keep it.
    fn solve_warm(&mut self) -> Option<Solve>;
}
