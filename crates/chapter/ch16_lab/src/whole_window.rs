//! Global search on the scene of the basins: every heading and offset of a window, box by box.
//!
//! [`WindowSearch`] runs one step of [`ScanSearch`] at a time and records when each box was open, so that a
//! figure can show any step. ICP refines the result; it fails from the start itself. Separate searches return
//! the scores of the room's other headings.

mod surface;

use std::sync::Arc;

pub use surface::ScoreSurface;

use ch16_slam2d::icp::{Icp, IcpVariant, IcpWorkspace};
use ch16_slam2d::search::{
    BoxFate, LikelihoodConfig, PoseBox, ScanSearch, ScoredPose, SearchCounts, SearchError,
    SearchGoal, SearchMap, SearchNeighborhood, SearchResult, SearchWindow,
};
use pr_geom::SE2;

use crate::basin::{BasinOutcome, BasinScene, BasinStart};

/// The blur of the map in cells: that of [`LikelihoodConfig::default`].
const BLUR_CELLS: f64 = 1.6;

/// Half the range of headings around a quarter or half turn in which that false minimum is searched, degrees.
const TURN_REACH_DEG: f64 = 15.0;

/// The window, and the start of ICP.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowConfig {
    /// The center of the window, and ICP's start.
    pub start: BasinStart,
    /// Half the width of the window along x and y, m.
    pub half_width_m: f64,
    /// Half its range of headings, degrees; 180 is the full circle.
    pub half_turn_deg: f64,
    /// Side of a cell and resolution of the search, m.
    pub cell_m: f64,
}

impl Default for WindowConfig {
    fn default() -> Self {
        Self {
            start: BasinStart {
                heading_deg: 75.0,
                dx_m: 0.0,
                dy_m: 0.0,
            },
            half_width_m: 1.5,
            half_turn_deg: 180.0,
            cell_m: LikelihoodConfig::default().cell_m,
        }
    }
}

impl WindowConfig {
    /// τ of ICP, from the start and from the result of the search; that of the basins, m.
    pub const TAU_M: f64 = 0.7;
    /// The least score of a match, as in the matcher for loops.
    pub const MIN_SCORE: f64 = 0.5;

    /// The map's cells and their blur.
    #[must_use]
    pub fn likelihood(&self) -> LikelihoodConfig {
        LikelihoodConfig {
            cell_m: self.cell_m,
            sigma_m: BLUR_CELLS * self.cell_m,
        }
    }

    fn window(&self, scene: &BasinScene) -> SearchWindow {
        SearchWindow::around(
            scene.guess(&self.start),
            self.half_width_m,
            self.half_turn_deg.to_radians(),
        )
    }
}

/// A box of poses, and the steps during which it was open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenBox {
    /// Its poses and their upper bound.
    pub poses: PoseBox,
    /// The step that created it.
    pub since: usize,
    /// The step that expanded it; `None` while it is open.
    pub until: Option<usize>,
    /// What that step did with it.
    pub fate: Option<BoxFate>,
}

impl SeenBox {
    /// Whether it is open after that many steps.
    #[must_use]
    pub fn waits_after(&self, steps: usize) -> bool {
        self.since <= steps && self.until.is_none_or(|until| until > steps)
    }
}

/// The search after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowMoment {
    /// The index of the box that the step expanded; `None` before the first step.
    pub taken: Option<usize>,
    /// The goal of the search.
    pub goal: SearchGoal,
    /// The largest bound of the open boxes; no other pose scores more.
    pub bound: Option<f64>,
    /// The best pose so far.
    pub best: Option<ScoredPose>,
    /// The best pose so far at another location.
    pub runner_up: Option<ScoredPose>,
    /// The work so far.
    pub counts: SearchCounts,
}

/// A search of the window under way.
#[derive(Clone, Debug)]
pub struct WindowSearch {
    config: WindowConfig,
    map: Arc<SearchMap>,
    search: ScanSearch,
    boxes: Vec<SeenBox>,
    /// Indices of the open boxes, in the order of the search.
    waiting: Vec<usize>,
    moments: Vec<WindowMoment>,
}

impl WindowSearch {
    /// Creates a search before its first step.
    ///
    /// # Errors
    /// If the window or the cells cannot be searched.
    pub fn new(scene: &BasinScene, config: WindowConfig) -> Result<Self, SearchError> {
        let map = Arc::new(SearchMap::build(scene.target(), config.likelihood())?);
        let search = ScanSearch::new(
            Arc::clone(&map),
            scene.source(),
            &config.window(scene),
            &SearchNeighborhood::default(),
        )?
        .with_min_score(WindowConfig::MIN_SCORE);
        let mut window = Self {
            config,
            map,
            search,
            boxes: Vec::new(),
            waiting: Vec::new(),
            moments: Vec::new(),
        };
        window.wait_for_all(0);
        let moment = window.moment(None, SearchGoal::Best);
        window.moments.push(moment);
        Ok(window)
    }

    /// Expands one box; false once the search is finished.
    pub fn step(&mut self) -> bool {
        let Some(report) = self.search.step() else {
            return false;
        };
        let step = self.moments.len();
        let goal_before = self.moments[step - 1].goal;
        let taken = if report.goal == goal_before {
            self.waiting.pop().expect("what was taken up has waited")
        } else {
            // Boxes that were set aside are open again.
            self.waiting.clear();
            self.boxes.push(SeenBox {
                poses: report.taken,
                since: step,
                until: None,
                fate: None,
            });
            self.boxes.len() - 1
        };
        let seen = &mut self.boxes[taken];
        debug_assert_eq!(seen.poses, report.taken);
        (seen.until, seen.fate) = (Some(step), Some(report.fate));
        self.wait_for_all(step);
        let moment = self.moment(Some(taken), report.goal);
        self.moments.push(moment);
        true
    }

    /// Searches to the end.
    #[must_use]
    pub fn run(mut self) -> Self {
        while self.step() {}
        self
    }

    /// The window.
    #[must_use]
    pub fn config(&self) -> &WindowConfig {
        &self.config
    }

    /// The search itself.
    #[must_use]
    pub fn search(&self) -> &ScanSearch {
        &self.search
    }

    /// Every box that has been open, in order of creation.
    #[must_use]
    pub fn boxes(&self) -> &[SeenBox] {
        &self.boxes
    }

    /// The search before its first step and after each one.
    #[must_use]
    pub fn moments(&self) -> &[WindowMoment] {
        &self.moments
    }

    /// The result so far; `None` before a pose was found.
    #[must_use]
    pub fn result(&self) -> Option<SearchResult> {
        self.search.result()
    }

    /// The best score at each heading of a box, `[heading in rad, score]`: the box's bound is never below.
    #[must_use]
    pub fn best_by_heading(&self, poses: &PoseBox) -> Vec<[f64; 2]> {
        let search = &self.search;
        let ([rows, columns], [low, high]) = (search.places(), search.extent_m());
        let cells = |axis: usize, count: usize, [from, to]: [f64; 2]| {
            let side = (high[axis] - low[axis]) / count as f64;
            let first = ((from - low[axis]) / side).round() as usize;
            first..(((to - low[axis]) / side).round() as usize).min(count)
        };
        let (xs, ys) = (cells(0, columns, poses.x_m), cells(1, rows, poses.y_m));
        let [from, to] = poses.heading_rad;
        // Headings are equal to the last bit or a step apart.
        let headings = (0..search.headings()).map(|k| (k, search.heading_rad(k)));
        let inside = headings.filter(|(_, heading)| (from..=to).contains(heading));
        let best = inside.map(|(k, heading)| {
            let scores = ys.clone().flat_map(|row| {
                let row = search.row_scores(k, row);
                row.skip(xs.start).take(xs.len())
            });
            [heading, scores.fold(0.0, f64::max)]
        });
        best.collect()
    }

    /// Searches for the best pose of the window whose heading differs from `best` by about that angle,
    /// degrees; `None` if the window holds no such heading.
    #[must_use]
    pub fn rival(&self, scene: &BasinScene, best: &SE2, turn_deg: f64) -> Option<ScanSearch> {
        let window = self.config.window(scene);
        let heading = best.theta() + turn_deg.to_radians();
        let off_center = SE2::new(0.0, 0.0, heading - window.center.theta()).theta();
        if off_center.abs() > window.half_turn_rad {
            return None;
        }
        let around = SearchWindow {
            center: SE2::new(window.center.x(), window.center.y(), heading),
            half_turn_rad: TURN_REACH_DEG.to_radians(),
            ..window
        };
        let neighborhood = SearchNeighborhood::default();
        ScanSearch::new(
            Arc::clone(&self.map),
            scene.source(),
            &around,
            &neighborhood,
        )
        .ok()
    }

    /// Records the search's new boxes as open since `step`.
    fn wait_for_all(&mut self, step: usize) {
        let new = self.search.open_boxes().skip(self.waiting.len());
        for poses in new {
            self.waiting.push(self.boxes.len());
            self.boxes.push(SeenBox {
                poses,
                since: step,
                until: None,
                fate: None,
            });
        }
    }

    fn moment(&self, taken: Option<usize>, goal: SearchGoal) -> WindowMoment {
        let bounds = self.waiting.iter().map(|&k| self.boxes[k].poses.bound);
        let result = self.search.result();
        WindowMoment {
            taken,
            goal,
            bound: bounds.max_by(f64::total_cmp),
            best: result.map(|result| result.best),
            runner_up: result.and_then(|result| result.runner_up),
            counts: self.search.counts(),
        }
    }
}

/// Point-to-point ICP from a pose; its trace stays in the workspace.
#[must_use]
pub fn refine(scene: &BasinScene, from: SE2, workspace: &mut IcpWorkspace) -> BasinOutcome {
    let config = BasinScene::config(IcpVariant::PointToPoint, WindowConfig::TAU_M);
    let found = Icp::new(scene.source(), scene.map(), from, &config, workspace).run();
    BasinOutcome::judge(&scene.truth(), &found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::basin::Minimum;

    fn searched(config: WindowConfig) -> WindowSearch {
        WindowSearch::new(&BasinScene::new(), config).unwrap().run()
    }

    #[test]
    fn from_where_icp_ends_in_the_quarter_turn_the_search_finds_home() {
        let scene = BasinScene::new();
        let window = searched(WindowConfig::default());
        let best = window.result().unwrap().best.pose;
        let mut workspace = IcpWorkspace::new();
        let start = scene.guess(&window.config().start);
        let alone = refine(&scene, start, &mut workspace);
        assert_eq!(alone.ending, Minimum::QuarterTurn);
        assert_eq!(refine(&scene, best, &mut workspace).ending, Minimum::Right);
    }

    #[test]
    fn a_box_waits_until_it_is_taken_up_and_all_that_waits_is_remembered() {
        let window = searched(WindowConfig {
            cell_m: 0.15,
            ..WindowConfig::default()
        });
        let (boxes, moments) = (window.boxes(), window.moments());
        assert!(boxes.iter().all(|seen| seen.until.is_some()));
        let mut again = WindowSearch::new(&BasinScene::new(), *window.config()).unwrap();
        for (step, moment) in moments.iter().enumerate() {
            let waiting = boxes.iter().filter(|seen| seen.waits_after(step)).count();
            assert_eq!(waiting, again.search().open_boxes().len(), "step {step}");
            assert_eq!(moment.taken.is_some(), step > 0);
            again.step();
        }
        let end = moments.last().unwrap();
        assert_eq!(
            (end.bound, end.counts),
            (None, window.result().unwrap().counts)
        );
    }

    #[test]
    fn no_dropped_box_holds_a_better_pose() {
        let window = searched(WindowConfig::default());
        let best = window.result().unwrap().best.score;
        for seen in window.boxes() {
            if seen.fate == Some(BoxFate::Pruned) {
                assert!(seen.poses.bound <= best);
            }
        }
    }

    #[test]
    fn no_score_of_a_box_is_above_its_bound_and_that_of_the_best_pose_is_its_bound() {
        let window = searched(WindowConfig {
            cell_m: 0.15,
            ..WindowConfig::default()
        });
        let mut poses = 0;
        for seen in window.boxes() {
            let scores = window.best_by_heading(&seen.poses);
            assert!(!scores.is_empty(), "{:?}", seen.poses);
            let best = scores.iter().map(|[_, score]| *score).fold(0.0, f64::max);
            assert!(
                best > 0.0 && best <= seen.poses.bound,
                "{best} in {:?}",
                seen.poses
            );
            // The bound of a pose that cannot win need not be its score.
            if seen.fate == Some(BoxFate::Best) {
                assert_eq!((scores.len(), best), (1, seen.poses.bound));
                poses += 1;
            }
        }
        assert!(poses > 0, "the best pose is one");
    }

    #[test]
    fn a_rival_is_the_best_pose_at_its_turn_and_no_better_than_the_best() {
        let scene = BasinScene::new();
        let window = searched(WindowConfig::default());
        let best = window.result().unwrap().best;
        for turn_deg in [90.0, -90.0, 180.0] {
            let rival = window.rival(&scene, &best.pose, turn_deg).unwrap();
            let rival = rival.run().unwrap().best;
            let turned = best.pose.between(&rival.pose).theta().to_degrees();
            let off = SE2::new(0.0, 0.0, (turned - turn_deg).to_radians()).theta();
            assert!(off.to_degrees().abs() <= TURN_REACH_DEG + 1.0);
            assert!(rival.score < best.score);
        }
        let narrow = searched(WindowConfig {
            half_turn_deg: 90.0,
            ..WindowConfig::default()
        });
        assert!(narrow.rival(&scene, &best.pose, -90.0).is_none());
    }

    #[test]
    fn a_window_without_home_holds_no_place_that_fits() {
        let narrow = searched(WindowConfig {
            half_turn_deg: 60.0,
            ..WindowConfig::default()
        });
        assert_eq!(narrow.result(), None);
    }
}
