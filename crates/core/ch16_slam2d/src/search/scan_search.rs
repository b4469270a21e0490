//! Branch and bound over the poses of a window, one box at a time.

mod exhaustive;

use core::cmp::Ordering;
use std::sync::Arc;

use super::lattice::{Lattice, LatticePose, Nearness};
use super::pyramid::NEAR_SIDE;
use super::turned_scan::{BoxShape, TurnedScan};
use super::{
    BoxFate, PoseBox, ScoredPose, SearchCounts, SearchError, SearchGoal, SearchMap,
    SearchNeighborhood, SearchReport, SearchResult, SearchWindow,
};
use crate::cloud::PointCloud;

/// A search for the pose of a scan on a map.
///
/// [`ScanSearch::step`] expands one box and reports the result; [`ScanSearch::run`] runs to the end.
/// It first finds the best pose, then the best distinct one. Both are exact: a dropped box could not have won.
#[derive(Clone, Debug)]
pub struct ScanSearch {
    map: Arc<SearchMap>,
    lattice: Lattice,
    shapes: Vec<BoxShape>,
    scan: TurnedScan,
    nearness: Nearness,
    goal: SearchGoal,
    /// Boxes to be expanded, the most promising one last.
    open: Vec<OpenBox>,
    /// Boxes that do not contain the best pose, but may contain the runner-up.
    set_aside: Vec<OpenBox>,
    /// Boxes of the last split.
    parts: Vec<OpenBox>,
    /// Smallest score of an accepted best pose.
    floor: u32,
    /// Largest margin of a runner-up of interest.
    margin: u32,
    best: Option<OpenBox>,
    runner_up: Option<OpenBox>,
    counts: SearchCounts,
}

/// A box with its bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct OpenBox {
    bound: u32,
    /// Index of its shape in the schedule.
    shape: usize,
    /// Its first pose.
    first: LatticePose,
}

impl OpenBox {
    /// Orders boxes by bound, then by earlier start; the better one is greater.
    fn promise(&self, other: &Self) -> Ordering {
        let by_bound = self.bound.cmp(&other.bound);
        by_bound.then_with(|| other.first.cmp(&self.first))
    }

    /// Whether a pose in it could be better than `champion`.
    fn challenges(&self, champion: Option<&Self>) -> bool {
        champion.is_none_or(|champion| self.promise(champion) == Ordering::Greater)
    }
}

impl ScanSearch {
    /// A new search of `window`.
    ///
    /// # Errors
    /// If the scan has no finite point or the window has too many poses.
    pub fn new(
        map: Arc<SearchMap>,
        scan: &PointCloud,
        window: &SearchWindow,
        neighborhood: &SearchNeighborhood,
    ) -> Result<Self, SearchError> {
        let lattice = Lattice::new(window, scan, map.grid())?;
        let shapes = BoxShape::schedule(lattice.columns, lattice.rows, lattice.headings);
        let scan = TurnedScan::new(scan, &lattice, map.grid(), &shapes);
        let mut search = Self {
            nearness: lattice.nearness(neighborhood),
            counts: SearchCounts {
                window: lattice.len(),
                ..SearchCounts::default()
            },
            map,
            lattice,
            shapes,
            scan,
            goal: SearchGoal::Best,
            open: Vec::new(),
            set_aside: Vec::new(),
            parts: Vec::new(),
            floor: 0,
            margin: u32::MAX,
            best: None,
            runner_up: None,
        };
        search.bound_parts(LatticePose::default(), search.lattice.last(), 0);
        core::mem::swap(&mut search.open, &mut search.parts);
        search.open.sort_by(OpenBox::promise);
        Ok(search)
    }

    /// The same search for a pose with a score of at least `min_score`, 0 to 1; the runner-up may score
    /// less.
    ///
    /// If the scan fits nowhere, all poses have similar scores, and finding the best of them takes almost an
    /// exhaustive search. With a minimum the search ends early.
    #[must_use]
    pub fn with_min_score(mut self, min_score: f64) -> Self {
        self.floor = (min_score * f64::from(self.scan.full_score())).ceil() as u32;
        self
    }

    /// The same search without a runner-up whose margin exceeds `margin`, 0 to 1, for callers that only need to
    /// know whether a competing pose is that close.
    #[must_use]
    pub fn with_margin(mut self, margin: f64) -> Self {
        self.margin = (margin * f64::from(self.scan.full_score())).ceil() as u32;
        self
    }

    /// Expands one box; `None` once the search is finished.
    pub fn step(&mut self) -> Option<SearchReport> {
        if self.open.is_empty() && self.goal == SearchGoal::Best {
            self.start_runner_up_search();
        }
        let taken = self.open.pop()?;
        let fate = match self.goal {
            SearchGoal::Best => self.evaluate_for_best(taken),
            SearchGoal::RunnerUp => self.evaluate_for_runner_up(taken),
        };
        Some(SearchReport {
            goal: self.goal,
            taken: self.pose_box(&taken),
            fate,
        })
    }

    /// Runs to the end; `None` if no pose reaches the minimum score.
    #[must_use]
    pub fn run(mut self) -> Option<SearchResult> {
        loop {
            if self.open.is_empty() && self.goal == SearchGoal::Best {
                self.start_runner_up_search();
            }
            let Some(taken) = self.open.pop() else {
                return self.result();
            };
            match self.goal {
                SearchGoal::Best => self.evaluate_for_best(taken),
                SearchGoal::RunnerUp => self.evaluate_for_runner_up(taken),
            };
        }
    }

    /// The result so far; `None` before a pose was found.
    ///
    /// It is final once [`ScanSearch::step`] returns `None`.
    #[must_use]
    pub fn result(&self) -> Option<SearchResult> {
        Some(SearchResult {
            best: self.scored(&self.best?),
            runner_up: self.runner_up.map(|pose| self.scored(&pose)),
            counts: self.counts,
        })
    }

    /// The boxes to be expanded, the most promising one last.
    pub fn open_boxes(&self) -> impl ExactSizeIterator<Item = PoseBox> + '_ {
        self.open.iter().map(|open| self.pose_box(open))
    }

    /// The work so far.
    #[must_use]
    pub fn counts(&self) -> SearchCounts {
        self.counts
    }

    /// Number of headings of the window.
    #[must_use]
    pub fn headings(&self) -> usize {
        self.lattice.headings as usize
    }

    /// A heading of the window, not wrapped, rad.
    #[must_use]
    pub fn heading_rad(&self, heading: usize) -> f64 {
        self.lattice.heading_rad(heading as i32)
    }

    /// The scores of all positions at one heading, 0 to 1, row by row from the lowest y.
    ///
    /// A slice through the score surface, for display; it is not counted as work of the search.
    pub fn scores_at(&self, heading: usize, scores: &mut Vec<f64>) {
        scores.clear();
        let poses = self.poses_at(heading as i32);
        scores.extend(poses.map(|pose| self.share(pose.bound)));
    }

    /// Number of rows and columns of positions at every heading.
    #[must_use]
    pub fn places(&self) -> [usize; 2] {
        [self.lattice.rows as usize, self.lattice.columns as usize]
    }

    /// Extent of the positions, including half a cell all around: lowest x and y, highest x and y, m.
    #[must_use]
    pub fn extent_m(&self) -> [[f64; 2]; 2] {
        let corner = |column: f64, row: f64| [self.lattice.x_m(column), self.lattice.y_m(row)];
        let last = self.lattice.last();
        [
            corner(-0.5, -0.5),
            corner(f64::from(last.column) + 0.5, f64::from(last.row) + 0.5),
        ]
    }

    /// The scores of one row of [`ScanSearch::scores_at`], from the lowest x.
    pub fn row_scores(&self, heading: usize, row: usize) -> impl Iterator<Item = f64> + '_ {
        let at = LatticePose {
            heading: heading as i32,
            row: row as i32,
            column: 0,
        };
        let finest = self.shapes.len() - 1;
        (0..self.lattice.columns).map(move |column| {
            let pose = self.bounded(LatticePose { column, ..at }, finest, 0);
            self.share(pose.bound)
        })
    }

    fn evaluate_for_best(&mut self, taken: OpenBox) -> BoxFate {
        if taken.bound < self.floor || !taken.challenges(self.best.as_ref()) {
            self.set_aside.push(taken);
            return BoxFate::Pruned;
        }
        if self.shapes[taken.shape].is_pose() {
            // The previous best may become the runner-up.
            self.set_aside.extend(self.best.replace(taken));
            return BoxFate::Best;
        }
        self.split(&taken)
    }

    fn evaluate_for_runner_up(&mut self, taken: OpenBox) -> BoxFate {
        if !taken.challenges(self.runner_up.as_ref()) || taken.bound < self.runner_up_floor() {
            return BoxFate::Pruned;
        }
        if self
            .best
            .is_some_and(|best| self.is_same_place(&best, &taken))
        {
            return BoxFate::SamePlace;
        }
        if self.shapes[taken.shape].is_pose() {
            self.runner_up = Some(taken);
            return BoxFate::Best;
        }
        self.split(&taken)
    }

    /// Continues with the boxes that were set aside, which are already bounded.
    fn start_runner_up_search(&mut self) {
        self.goal = SearchGoal::RunnerUp;
        let Some(best) = self.best else { return };
        for aside in &self.set_aside {
            if self.shapes[aside.shape].is_pose()
                && aside.bound >= self.runner_up_floor()
                && aside.challenges(self.runner_up.as_ref())
                && !self.is_same_place(&best, aside)
            {
                self.runner_up = Some(*aside);
            }
        }
        let (runner_up, floor) = (self.runner_up, self.runner_up_floor());
        let set_aside = core::mem::take(&mut self.set_aside);
        let worth = set_aside
            .into_iter()
            .filter(|aside| aside.bound >= floor && aside.challenges(runner_up.as_ref()));
        self.open.extend(worth);
        self.open.sort_by(OpenBox::promise);
    }

    /// Smallest score of a runner-up of interest.
    fn runner_up_floor(&self) -> u32 {
        let best = self.best.map_or(0, |best| best.bound);
        best.saturating_sub(self.margin)
    }

    /// Adds the parts of a box to the open ones, the most promising one on top.
    fn split(&mut self, taken: &OpenBox) -> BoxFate {
        self.bound_parts(taken.first, self.last_of(taken), taken.shape + 1);
        self.parts.sort_by(OpenBox::promise);
        let parts = self.parts.len();
        self.open.append(&mut self.parts);
        BoxFate::Split { parts }
    }

    /// Smallest bound of a box that may contain the best pose or the runner-up.
    fn of_interest(&self) -> u32 {
        match self.goal {
            SearchGoal::Best => {
                let to_beat = self.best.map_or(0, |best| best.bound).max(self.floor);
                to_beat.saturating_sub(self.margin)
            }
            SearchGoal::RunnerUp => {
                let to_beat = self.runner_up.map_or(0, |runner_up| runner_up.bound);
                to_beat.max(self.runner_up_floor())
            }
        }
    }

    /// Bounds all boxes of a shape from `first` to `last`, inclusive.
    fn bound_parts(&mut self, first: LatticePose, last: LatticePose, shape: usize) {
        let of_interest = self.of_interest();
        let (cells, headings) = (self.shapes[shape].cells(), self.shapes[shape].headings());
        let is_by_four = cells <= NEAR_SIDE && last.row - first.row >= cells;
        let stride = cells << u32::from(is_by_four);
        self.parts.clear();
        for heading in (first.heading..=last.heading).step_by(headings as usize) {
            for row in (first.row..=last.row).step_by(stride as usize) {
                for column in (first.column..=last.column).step_by(stride as usize) {
                    let at = LatticePose {
                        heading,
                        row,
                        column,
                    };
                    if is_by_four {
                        self.bound_four(at, last, shape, of_interest);
                    } else {
                        self.parts.push(self.bounded(at, shape, of_interest));
                    }
                }
            }
        }
        let made = self.parts.len() as u64;
        if self.shapes[shape].is_pose() {
            self.counts.poses += made;
        } else {
            self.counts.bounds += made;
        }
    }

    /// Bounds the box at `first` and its neighbours right of it, above it and above that to the right, as far as the
    /// window reaches: they are looked up together.
    fn bound_four(
        &mut self,
        first: LatticePose,
        last: LatticePose,
        shape: usize,
        of_interest: u32,
    ) {
        let offset = self.lattice.cells_from_center(first.column, first.row);
        let group = first.heading >> self.shapes[shape].turn;
        let scan = &self.scan;
        let cells = self.shapes[shape].cells();
        let bounds = scan.sums_of_four(&self.map, (shape, cells), group, offset, of_interest);
        let corners = [[0, 0], [0, cells], [cells, 0], [cells, cells]];
        for (bound, [up, right]) in bounds.into_iter().zip(corners) {
            let (row, column) = (first.row + up, first.column + right);
            if row <= last.row && column <= last.column {
                let first = LatticePose {
                    row,
                    column,
                    ..first
                };
                self.parts.push(OpenBox {
                    bound,
                    shape,
                    first,
                });
            }
        }
    }

    /// A box of a shape with its bound, which is exact if it is at least `of_interest`.
    fn bounded(&self, first: LatticePose, shape: usize, of_interest: u32) -> OpenBox {
        let offset = self.lattice.cells_from_center(first.column, first.row);
        let group = first.heading >> self.shapes[shape].turn;
        OpenBox {
            bound: self.scan.sum(&self.map, shape, group, offset, of_interest),
            shape,
            first,
        }
    }

    /// The last pose of a box that is inside the window.
    fn last_of(&self, open: &OpenBox) -> LatticePose {
        let shape = self.shapes[open.shape];
        let last = self.lattice.last();
        LatticePose {
            heading: last.heading.min(open.first.heading + shape.headings() - 1),
            row: last.row.min(open.first.row + shape.cells() - 1),
            column: last.column.min(open.first.column + shape.cells() - 1),
        }
    }

    fn is_same_place(&self, best: &OpenBox, other: &OpenBox) -> bool {
        let last = self.last_of(other);
        self.lattice
            .is_near(best.first, other.first, last, self.nearness)
    }

    fn scored(&self, open: &OpenBox) -> ScoredPose {
        ScoredPose {
            pose: self.lattice.pose(open.first),
            score: self.share(open.bound),
        }
    }

    fn share(&self, score: u32) -> f64 {
        f64::from(score) / f64::from(self.scan.full_score())
    }

    fn pose_box(&self, open: &OpenBox) -> PoseBox {
        let last = self.last_of(open);
        let ends = |first: i32, last: i32, at: &dyn Fn(f64) -> f64| {
            [at(f64::from(first) - 0.5), at(f64::from(last) + 0.5)]
        };
        PoseBox {
            x_m: ends(open.first.column, last.column, &|at| self.lattice.x_m(at)),
            y_m: ends(open.first.row, last.row, &|at| self.lattice.y_m(at)),
            heading_rad: [
                self.lattice.heading_rad(open.first.heading),
                self.lattice.heading_rad(last.heading),
            ],
            bound: self.share(open.bound),
            is_pose: self.shapes[open.shape].is_pose(),
        }
    }
}
