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
    /// The given start around which to search; `None` for the whole map.
    pub(super) start: Option<SE2>,
    pub(super) search: Option<MapSearch>,
    /// The motion since the search began, in an earlier frame.
    pub(super) since: SE2,
    /// Its sums over the points in earlier frames.
    pub(super) sums_before: u64,
    pub(super) report: LocalizeReport,
}

impl PendingFix {
    /// The running search; `None` if none is needed or it has ended.
    #[must_use]
    pub fn search(&self) -> Option<&MapSearch> {
        self.search.as_ref()
    }

    /// The report so far, and at the end the final one.
    #[must_use]
    pub fn report(&self) -> &LocalizeReport {
        &self.report
    }
}
