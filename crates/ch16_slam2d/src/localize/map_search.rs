//! The search for a place on the map, one box at a time.

use pr_geom::math;

use super::{KnownMap, LocalizeConfig};
use crate::cloud::PointCloud;
use crate::search::{ScanSearch, SearchResult, SearchWindow};

/// Half the side and half the range of headings of the window around a keyframe that looks alike, m and rad.
const ALIKE_WINDOW: (f64, f64) = (0.75, 0.2);
/// Both searches put their poses at other places of a cell: what a small one found may score so much less.
const BETWEEN_CELLS: f64 = 0.01;

/// Small windows first, which say what a place has to beat, and then the window that is asked about.
#[derive(Clone, Debug)]
pub struct MapSearch {
    trail: PointCloud,
    /// Windows around keyframes that look alike, the next one last.
    alike: Vec<SearchWindow>,
    /// The window that is asked about; `None` once it is under way.
    asked: Option<SearchWindow>,
    floor: f64,
    under_way: Option<ScanSearch>,
    result: Option<SearchResult>,
}

impl MapSearch {
    /// A search in one window.
    pub(super) fn within(trail: PointCloud, window: SearchWindow, min_score: f64) -> Self {
        Self {
            trail,
            alike: Vec::new(),
            asked: Some(window),
            floor: min_score,
            under_way: None,
            result: None,
        }
    }

    /// A search of the whole map; keyframes that look like `scan` say what a place has to beat.
    pub(super) fn whole(
        map: &KnownMap,
        trail: PointCloud,
        scan: &PointCloud,
        config: &LocalizeConfig,
    ) -> Self {
        let (half_width_m, half_turn_rad) = ALIKE_WINDOW;
        let guesses = map.alike(scan, config.alike);
        let windows = guesses.iter().rev();
        Self {
            alike: windows
                .map(|guess| SearchWindow::around(guess.pose, half_width_m, half_turn_rad))
                .collect(),
            ..Self::within(trail, map.whole(), config.min_score)
        }
    }

    /// The points that are looked for, body frame.
    #[must_use]
    pub fn trail(&self) -> &PointCloud {
        &self.trail
    }

    /// The branch and bound under way; none between two of them.
    #[must_use]
    pub fn under_way(&self) -> Option<&ScanSearch> {
        self.under_way.as_ref()
    }

    /// Whether it is the window that is asked about, and no small one before it.
    #[must_use]
    pub fn is_at_last(&self) -> bool {
        self.asked.is_none()
    }

    /// Takes up one box, or begins the next window; false once nothing is left to do.
    pub(super) fn step(&mut self, map: &KnownMap, config: &LocalizeConfig) -> bool {
        let Some(search) = &mut self.under_way else {
            return self.begin_next(map, config);
        };
        // One that is not decided after so many sums found nothing.
        let is_given_up = search.counts().scored() >= config.most_sums;
        if !is_given_up && search.step().is_some() {
            return true;
        }
        let found = search.result().filter(|_| !is_given_up);
        self.under_way = None;
        if self.asked.is_none() {
            self.result = found;
            return false;
        }
        if let Some(found) = found {
            self.floor = math::max(self.floor, found.best.score - BETWEEN_CELLS);
        }
        true
    }

    /// The best place of the window that was asked about, and the best other one.
    pub(super) fn result(&self) -> Option<SearchResult> {
        self.result
    }

    fn begin_next(&mut self, map: &KnownMap, config: &LocalizeConfig) -> bool {
        let Some(window) = self.alike.pop().or_else(|| self.asked.take()) else {
            return false;
        };
        // Small windows are asked for what fits at all.
        let floor = if self.asked.is_some() {
            config.min_score
        } else {
            self.floor
        };
        let search = map.search(&self.trail, &window, &config.neighborhood);
        self.under_way = search.ok().map(|search| {
            let search = search.with_min_score(floor);
            search.with_margin(config.unconfirmed_margin)
        });
        self.under_way.is_some() || self.asked.is_some()
    }
}
