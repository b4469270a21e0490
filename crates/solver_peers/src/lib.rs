//! Published pose-graph solvers, timed beside ours in one run.
//!
//! Every solver gets the same g2o file, starts from what it reads there, and runs on one thread.
//! Runs are interleaved, so that a busy machine slows all of them alike, and the fastest of each
//! counts. Each solver is judged by the χ² of its own residual, which differs a little between
//! them: ours and factrs' is the log, arael's model here has g2o's.

pub mod arael_peer;
pub mod clock;
pub mod factrs_peer;
pub mod ours;

/// What one timed solve gave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// CPU time of the thread, ms, without reading the file.
    pub cpu_ms: f64,
    /// Cost at the end in the solver's own residual, as χ² = Σ eᵀΩe.
    pub chi2: f64,
    /// Linear systems solved; 0 where the solver does not say.
    pub iterations: usize,
}

/// A solver with a graph loaded.
pub trait Peer {
    /// Name as printed.
    fn name(&self) -> &'static str;

    /// A solve with nothing known about the graph: ordering and analysis included.
    fn solve_cold(&mut self) -> Timing;

    /// A solve that may use what earlier ones learnt about the pattern; `None` where the solver
    /// cannot keep it.
    fn solve_warm(&mut self) -> Option<Timing>;
}
