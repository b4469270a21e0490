//! A frame of a localizer between its parts.

use std::sync::Arc;

use pr_geom::SE2;

use super::{LocalizeReport, MapSearch};
use crate::cloud::PointCloud;

/// A frame between its parts; see [`Localizer::begin`](super::Localizer::begin).
#[derive(Clone, Debug)]
pub struct PendingFix {
    pub(super) scan: Arc<PointCloud>,
    /// Whether the sweep joined the trail.
    pub(super) joined: bool,
    /// The given start around which is looked; `None` if it is everywhere.
    pub(super) start: Option<SE2>,
    pub(super) search: Option<MapSearch>,
    pub(super) report: LocalizeReport,
}

impl PendingFix {
    /// The search under way; `None` if none is needed, or where it has ended.
    #[must_use]
    pub fn search(&self) -> Option<&MapSearch> {
        self.search.as_ref()
    }

    /// What the frame says so far, or in the end.
    #[must_use]
    pub fn report(&self) -> &LocalizeReport {
        &self.report
    }
}
