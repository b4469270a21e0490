//! A log with another mounting of its laser.

use crate::laser_mount::LaserMount;
use crate::log::{LogError, LogFrame, LogNotes, LogReader};

/// A log whose laser has the mounting that an option sets.
pub(crate) struct MountedReader<'a> {
    inner: Box<dyn LogReader + 'a>,
    mount: LaserMount,
    notes: LogNotes,
}

impl<'a> MountedReader<'a> {
    /// Yields the frames of `inner` with their laser at `mount`.
    pub(crate) fn new(inner: Box<dyn LogReader + 'a>, mount: LaserMount) -> Self {
        Self {
            inner,
            mount,
            notes: LogNotes::default(),
        }
    }
}

impl LogReader for MountedReader<'_> {
    fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError> {
        let frame = self.inner.next_frame();
        self.notes.clone_from(self.inner.notes());
        self.notes.laser = Some(self.mount);
        Ok(frame?.map(|mut frame| {
            self.mount.apply(&mut frame.scan);
            frame
        }))
    }

    fn notes(&self) -> &LogNotes {
        &self.notes
    }
}
