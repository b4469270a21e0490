//! Progress of reading a log, on standard error.

use std::fs::File;
use std::io::{self, IsTerminal as _, Read, Seek, SeekFrom, stderr};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::output::name;

/// Progress, speed and time left: a bar in a terminal, otherwise a line every ten seconds.
#[derive(Clone)]
pub struct Progress {
    pub(crate) bar: ProgressBar,
    started: Instant,
    reported: Instant,
}

impl Progress {
    const EVERY: Duration = Duration::from_secs(10);

    pub(crate) fn new(bytes: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(bytes), ProgressDrawTarget::stderr());
        let style = ProgressStyle::with_template("{wide_bar} {percent}%  {msg}  {eta} left")
            .expect("the template is well formed");
        bar.set_style(style);
        let now = Instant::now();
        Self {
            bar,
            started: now,
            reported: now,
        }
    }

    /// Reports the number of scans done.
    pub fn report(&mut self, scans: usize) {
        let seconds = self.started.elapsed().as_secs_f64();
        let per_second = scans as f64 / seconds.max(1e-3);
        if stderr().is_terminal() {
            self.bar
                .set_message(format!("{scans} scans, {per_second:.0} per second"));
        } else if self.reported.elapsed() >= Self::EVERY {
            self.reported = Instant::now();
            let left = self.bar.eta().as_secs();
            eprintln!(
                "{}: {scans} scans, {per_second:.0} per second, {left} s left",
                name()
            );
        }
    }

    /// Goes back to the start of the scans: those of another robot follow.
    pub(crate) fn restart(&self) {
        self.bar
            .set_position(self.bar.length().unwrap_or_default() / 2);
    }

    /// Removes the bar.
    pub fn end(&self) {
        self.bar.finish_and_clear();
    }
}

/// A reader that advances a progress bar.
pub(crate) struct Counted {
    pub(crate) source: File,
    pub(crate) bar: ProgressBar,
}

impl Read for Counted {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.source.read(buffer)?;
        self.bar.inc(count as u64);
        Ok(count)
    }
}

impl Seek for Counted {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.source.seek(to)
    }
}
