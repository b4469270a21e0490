//! Ctrl-C, SIGTERM and SIGHUP: the first ends the work early, a second one ends the process.

use std::process::{ExitCode, exit};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Exit code of work that was cut short, as shells have it for Ctrl-C.
const EXIT_CODE: u8 = 130;

/// The exit code of work that was done, or cut short.
pub fn exit_code(is_interrupted: bool) -> ExitCode {
    if is_interrupted {
        EXIT_CODE.into()
    } else {
        ExitCode::SUCCESS
    }
}

/// Whether a signal asked the command to end.
#[derive(Clone, Debug, Default)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Watches from now on. If the handler cannot be set, a signal ends the process without results.
    pub fn watch() -> Self {
        let interrupt = Self::default();
        let flag = Arc::clone(&interrupt.0);
        let _ = ctrlc::set_handler(move || {
            if flag.swap(true, Ordering::Relaxed) {
                exit(EXIT_CODE.into());
            }
        });
        interrupt
    }

    /// Whether a signal came.
    pub fn came(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
