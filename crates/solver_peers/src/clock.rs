//! CPU time of the calling thread.

/// The result of `work`, and the milliseconds that it kept this thread busy.
pub fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = now_s();
    let result = work();
    (result, 1e3 * (now_s() - start))
}

#[cfg(unix)]
fn now_s() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

#[cfg(not(unix))]
fn now_s() -> f64 {
    use std::sync::OnceLock;
    use std::time::Instant;
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}
