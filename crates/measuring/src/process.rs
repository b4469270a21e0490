//! What this process has used of the machine.

/// Seconds that all threads of this process kept a core busy; wall time where the system has no such
/// clock.
#[must_use]
pub fn cpu_s() -> f64 {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
        time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
    }
    #[cfg(not(unix))]
    {
        use std::sync::OnceLock;
        use std::time::Instant;
        static START: OnceLock<Instant> = OnceLock::new();
        START.get_or_init(Instant::now).elapsed().as_secs_f64()
    }
}

/// Most memory that this process has held at once, in MB of 10⁶ bytes; none where the system does not
/// tell.
#[must_use]
pub fn peak_mb() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: f64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kibibytes * 1024.0 / 1e6)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_buffer_that_was_written_counts() {
        let Some(before) = peak_mb() else {
            return;
        };
        let buffer = vec![1_u8; 64_000_000];
        let after = peak_mb().unwrap();
        assert!(buffer.iter().all(|&byte| byte == 1));
        assert!(after >= 60.0 && after >= before, "{before} {after}");
        assert!(cpu_s() > 0.0);
    }
}
