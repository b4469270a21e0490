//! The search of one window and everything that follows from it, in pieces between frames.

use ch16_lab::basin::{BasinOutcome, BasinScene};
use ch16_lab::whole_window::{ScoreSurface, WindowConfig, WindowSearch, refine};
use ch16_slam2d::icp::IcpWorkspace;
use ch16_slam2d::search::{ScanSearch, ScoredPose, SearchGoal};
use pr_geom::SE2;
use widget_kit::model::Activity;

/// Boxes in one piece of work: some tenths of a millisecond.
const BOXES_PER_PIECE: usize = 30;
/// Rows of the surface in one piece.
const ROWS_PER_PIECE: usize = 4;

/// The other headings at which the room fits, degrees from the best pose.
pub const TURNS: [(&str, f64); 3] = [
    ("quarter turn to the left", 90.0),
    ("quarter turn to the right", -90.0),
    ("half turn", 180.0),
];

/// A registration by ICP.
pub struct Refined {
    /// Its result.
    pub outcome: BasinOutcome,
    /// Its poses, from the start on.
    pub path: Vec<SE2>,
}

/// The results of a search.
pub struct SearchResults {
    /// The best pose, and ICP from there.
    pub home: Option<(ScoredPose, Refined)>,
    /// The best pose at each of [`TURNS`]; `None` if the window lacks that heading.
    pub rivals: [Option<ScoredPose>; 3],
    /// Searches for those poses under way.
    pending: Vec<(usize, ScanSearch)>,
}

/// One window.
pub struct SearchTask {
    /// The search with its history.
    pub window: WindowSearch,
    /// The scores that it avoids to compute.
    pub surface: ScoreSurface,
    /// ICP from the start alone.
    pub alone: Refined,
    /// The results; `None` during the search.
    pub found: Option<SearchResults>,
}

impl SearchTask {
    /// A search before its first step.
    pub fn new(scene: &BasinScene, config: WindowConfig, workspace: &mut IcpWorkspace) -> Self {
        let window = match WindowSearch::new(scene, config) {
            Ok(window) => window,
            Err(error) => panic!("the parameters yield an invalid window: {error}"),
        };
        Self {
            surface: ScoreSurface::new(window.search()),
            alone: icp(scene, scene.guess(&config.start), workspace),
            window,
            found: None,
        }
    }

    /// One piece of the search, or of those at the other headings; idle once all of them are finished.
    pub fn search(&mut self, scene: &BasinScene, workspace: &mut IcpWorkspace) -> Activity {
        let Some(found) = &mut self.found else {
            let is_busy = (0..BOXES_PER_PIECE).all(|_| self.window.step());
            if !is_busy {
                self.found = Some(self.finish(scene, workspace));
            }
            return Activity::Busy;
        };
        let Some((turn, search)) = found.pending.last_mut() else {
            return Activity::Idle;
        };
        for _ in 0..BOXES_PER_PIECE {
            let is_over = search
                .step()
                .is_none_or(|report| report.goal == SearchGoal::RunnerUp);
            if is_over {
                found.rivals[*turn] = search.result().map(|result| result.best);
                found.pending.pop();
                break;
            }
        }
        Activity::Busy
    }

    /// One piece of the surface.
    pub fn fill(&mut self) -> Activity {
        let search = self.window.search();
        if (0..ROWS_PER_PIECE).all(|_| self.surface.advance(search)) {
            Activity::Busy
        } else {
            Activity::Idle
        }
    }

    fn finish(&self, scene: &BasinScene, workspace: &mut IcpWorkspace) -> SearchResults {
        let best = self.window.result().map(|result| result.best);
        let rival = |(k, (_, turn_deg)): (usize, &(&str, f64))| {
            let search = self.window.rival(scene, &best?.pose, *turn_deg)?;
            Some((k, search))
        };
        SearchResults {
            pending: TURNS.iter().enumerate().filter_map(rival).collect(),
            rivals: [None; 3],
            home: best.map(|best| (best, icp(scene, best.pose, workspace))),
        }
    }
}

fn icp(scene: &BasinScene, from: SE2, workspace: &mut IcpWorkspace) -> Refined {
    let outcome = refine(scene, from, workspace);
    let path = workspace.trace().iter().map(|state| state.pose);
    Refined {
        outcome,
        path: path.collect(),
    }
}
