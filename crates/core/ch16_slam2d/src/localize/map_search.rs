//! The search for a pose on the map, one box at a time.

use pr_geom::math;

use super::{KnownMap, LocalizeConfig};
use crate::cloud::PointCloud;
use crate::search::{ScanSearch, SearchResult, SearchWindow};

/// Half the side and half the heading range of the window around a similar keyframe, m and rad.
const SIMILAR_WINDOW: (f64, f64) = (0.75, 0.2);
/// Tolerance for the score of a small window's result: both searches place their poses differently within a cell.
const CELL_TOLERANCE: f64 = 0.01;

/// Searches small windows first, for a lower bound of the score, and then the requested window.
#[derive(Clone, Debug)]
pub struct MapSearch {
    trail: PointCloud,
    /// Windows around similar keyframes, the next one last.
    alike: Vec<SearchWindow>,
    /// The requested window; `None` once its search has started.
    requested: Option<SearchWindow>,
    floor: f64,
    /// Sums over the points in earlier windows.
    sums: u64,
    under_way: Option<ScanSearch>,
    result: Option<SearchResult>,
}

impl MapSearch {
    /// A search in one window.
    pub(super) fn within(trail: PointCloud, window: SearchWindow, min_score: f64) -> Self {
        Self {
            trail,
            alike: Vec::new(),
            requested: Some(window),
            floor: min_score,
            sums: 0,
            under_way: None,
            result: None,
        }
    }

    /// A search of the whole map; keyframes similar to `scan` give a lower bound of the score.
    pub(super) fn whole(
        map: &KnownMap,
        trail: PointCloud,
        scan: &PointCloud,
        config: &LocalizeConfig,
    ) -> Self {
        let (half_width_m, half_turn_rad) = SIMILAR_WINDOW;
        let guesses = map.alike(scan, config.alike);
        let windows = guesses.iter().rev();
        Self {
            alike: windows
                .map(|guess| SearchWindow::around(guess.pose, half_width_m, half_turn_rad))
                .collect(),
            ..Self::within(trail, map.whole(), config.min_score)
        }
    }

    /// The running branch and bound; `None` between two of them.
    #[must_use]
    pub fn under_way(&self) -> Option<&ScanSearch> {
        self.under_way.as_ref()
    }

    /// Sums over the points so far.
    #[must_use]
    pub fn sums(&self) -> u64 {
        let under_way = self.under_way.as_ref();
        self.sums + under_way.map_or(0, |search| search.counts().scored())
    }

    /// Whether the requested window is being searched, not a small one before it.
    #[must_use]
    pub fn is_at_last(&self) -> bool {
        self.requested.is_none()
    }

    /// Expands one box, or starts the next window; returns false once finished.
    pub(super) fn step(&mut self, map: &KnownMap, config: &LocalizeConfig) -> bool {
        let Some(search) = &mut self.under_way else {
            return self.begin_next(map, config);
        };
        // A search that exceeds its limit of sums has no result.
        let is_given_up = search.counts().scored() >= config.most_sums;
        if !is_given_up && search.step().is_some() {
            return true;
        }
        let found = search.result().filter(|_| !is_given_up);
        self.sums += search.counts().scored();
        self.under_way = None;
        if self.requested.is_none() {
            self.result = found;
            return false;
        }
        if let Some(found) = found {
            self.floor = math::max(self.floor, found.best.score - CELL_TOLERANCE);
        }
        true
    }

    /// The best pose of the requested window, and the best distinct one.
    pub(super) fn result(&self) -> Option<SearchResult> {
        self.result
    }

    fn begin_next(&mut self, map: &KnownMap, config: &LocalizeConfig) -> bool {
        let Some(window) = self.alike.pop().or_else(|| self.requested.take()) else {
            return false;
        };
        // Small windows accept any score that fits at all.
        let floor = if self.requested.is_some() {
            config.min_score
        } else {
            self.floor
        };
        let search = map.search(&self.trail, &window, &config.neighborhood);
        self.under_way = search.ok().map(|search| {
            let search = search.with_min_score(floor);
            search.with_margin(config.unconfirmed_margin)
        });
        self.under_way.is_some() || self.requested.is_some()
    }
}
