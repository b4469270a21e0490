//! Measures CPU time, which does not depend on the load of the machine.

/// A stopwatch over the CPU time of the calling thread; wall time if the system has no such clock.
#[derive(Debug)]
pub struct CpuClock {
    started_s: f64,
    elapsed_s: f64,
}

impl CpuClock {
    /// Creates a running clock.
    #[must_use]
    pub fn start() -> Self {
        Self {
            started_s: now_s(Whose::Thread),
            elapsed_s: 0.0,
        }
    }

    /// Pauses the clock.
    pub fn pause(&mut self) {
        self.elapsed_s += now_s(Whose::Thread) - self.started_s;
    }

    /// Resumes the clock.
    pub fn resume(&mut self) {
        self.started_s = now_s(Whose::Thread);
    }

    /// Returns the milliseconds up to the last pause.
    #[must_use]
    pub fn elapsed_ms(&self) -> f64 {
        1e3 * self.elapsed_s
    }
}

/// Returns the result of `work` and the CPU time that it took on this thread, ms.
pub fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let mut clock = CpuClock::start();
    let result = work();
    clock.pause();
    (result, clock.elapsed_ms())
}

/// Whose CPU time is measured.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Whose {
    /// The calling thread.
    Thread,
    /// All threads of the process.
    Process,
}

/// Returns the CPU time up to now, s; wall time if the system has no such clock.
#[cfg(unix)]
pub(crate) fn now_s(whose: Whose) -> f64 {
    use rustix::time::{ClockId, clock_gettime};
    let time = clock_gettime(match whose {
        Whose::Thread => ClockId::ThreadCPUTime,
        Whose::Process => ClockId::ProcessCPUTime,
    });
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

#[cfg(not(unix))]
pub(crate) fn now_s(_whose: Whose) -> f64 {
    use std::sync::OnceLock;
    use std::time::Instant;
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Keeps the thread busy for at least this CPU time.
    fn work(milliseconds: f64) {
        let mut clock = CpuClock::start();
        while clock.elapsed_ms() < milliseconds {
            clock.pause();
            clock.resume();
        }
    }

    #[test]
    fn work_counts_and_a_pause_does_not() {
        let (found, busy_ms) = timed(|| {
            work(5.0);
            7
        });
        assert_eq!(found, 7);
        assert!(busy_ms >= 5.0, "{busy_ms} ms");

        let mut clock = CpuClock::start();
        clock.pause();
        work(40.0);
        clock.resume();
        clock.pause();
        assert!(clock.elapsed_ms() < 40.0, "{} ms", clock.elapsed_ms());
    }
}
