//! What this process has used of the machine.

use crate::cpu_clock::{Whose, now_s};

/// Seconds that all threads of this process kept a core busy; wall time where the system has no such
/// clock.
#[must_use]
pub fn cpu_s() -> f64 {
    now_s(Whose::Process)
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
