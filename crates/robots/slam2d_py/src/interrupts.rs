//! Ctrl-C during a computation that has released the interpreter's lock.

use std::time::{Duration, Instant};

use pyo3::prelude::*;

/// Longest time without listening, beside that of a step.
const LISTEN_EVERY: Duration = Duration::from_millis(50);

/// Listens to Ctrl-C, at most every 50 ms.
pub struct Listener(Instant);

impl Default for Listener {
    fn default() -> Self {
        Self(Instant::now())
    }
}

impl Listener {
    /// Raises what a handler of a signal raises, such as `KeyboardInterrupt`.
    pub fn listen(&mut self) -> PyResult<()> {
        if self.0.elapsed() > LISTEN_EVERY {
            Python::attach(|py| py.check_signals())?;
            self.0 = Instant::now();
        }
        Ok(())
    }
}
