//! Published pose-graph solvers, timed beside ours in one run.
//!
//! Every solver gets the same g2o file, starts from what it reads there, and runs on one thread.
//! Runs are interleaved, so that a busy machine slows all of them alike, and the fastest of each
//! counts. All are judged by one χ², that of the log residual at the poses where they end. Only ours
//! lowers just that: arael's model here has g2o's residual, and factrs 0.3 takes the log for one sign
//! of the heading residual only. Their optima lie a little beside.

pub mod arael_peer;
pub mod compare;
pub mod factrs_peer;
pub mod ours;

use pr_geom::SE2;

/// What one timed solve gave.
#[derive(Clone, Debug, PartialEq)]
pub struct Solve {
    /// CPU time of the thread, ms, without reading the file.
    pub cpu_ms: f64,
    /// The poses at the end in the order of the file; none where the solver gave up.
    pub poses: Option<Vec<SE2>>,
    /// Linear systems solved; none where the solver does not say.
    pub iterations: Option<usize>,
}

/// A solver with a graph loaded.
pub trait Peer {
    /// Name as printed.
    fn name(&self) -> &'static str;

    /// A solve with nothing known about the graph: ordering and analysis included.
    fn solve_cold(&mut self) -> Solve;

    /// A solve that may use what earlier ones learnt about the pattern; `None` where the solver
    /// cannot keep it.
    fn solve_warm(&mut self) -> Option<Solve>;
}
