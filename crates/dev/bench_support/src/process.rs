//! CPU time and memory of this process.

use crate::cpu_clock::{Whose, now_s};

/// Returns the CPU time of all threads of this process, s; wall time if the system has no such
/// clock.
#[must_use]
pub fn cpu_s() -> f64 {
    now_s(Whose::Process)
}

/// Returns the peak memory of this process, in MB of 10⁶ bytes; `None` if the system does not report
/// it.
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
