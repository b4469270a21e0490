//! Work that is of no use, to show that tests do not depend on an idle machine.

use std::hint;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};

/// One busy thread for each core, until it is dropped.
pub struct Load {
    ends: Arc<AtomicBool>,
    threads: Vec<JoinHandle<u64>>,
}

impl Load {
    /// Starts the threads.
    pub fn on_every_core() -> Self {
        let ends = Arc::new(AtomicBool::new(false));
        let cores = thread::available_parallelism().map_or(1, usize::from);
        let busy = |_| {
            let ends = Arc::clone(&ends);
            thread::spawn(move || spin(&ends))
        };
        let threads = (0..cores).map(busy).collect();
        Self { ends, threads }
    }

    /// How many they are.
    pub fn threads(&self) -> usize {
        self.threads.len()
    }
}

impl Drop for Load {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Relaxed);
        for thread in self.threads.drain(..) {
            // A thread that only counts does not panic.
            let _ = thread.join();
        }
    }
}

/// Counts until told to end.
fn spin(ends: &AtomicBool) -> u64 {
    let mut count = 0_u64;
    while !ends.load(Ordering::Relaxed) {
        count = hint::black_box(count.wrapping_add(1));
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_load_has_a_thread_for_each_core_and_ends_when_dropped() {
        let load = Load::on_every_core();
        assert_eq!(
            load.threads(),
            thread::available_parallelism().map_or(1, usize::from)
        );
        let ends = Arc::clone(&load.ends);
        drop(load);
        // Only this handle is left: every thread has ended.
        assert_eq!(Arc::strong_count(&ends), 1);
    }
}
