//! The constants of localization.

use pr_geom::SE2;

use crate::chi_squared::GATE_999;
use crate::search::{LikelihoodConfig, SearchNeighborhood};

/// Prior knowledge of the first pose.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum StartPose {
    /// Unknown: the robot was carried away, or switched on anywhere.
    #[default]
    Anywhere,
    /// Approximately known, `map_from_body`.
    Near(SE2),
}

/// Thresholds of localization; lengths are those of rooms and corridors.
#[derive(Clone, Debug, PartialEq)]
pub struct LocalizeConfig {
    /// A scan is registered on the keyframes within this distance of the prediction, m.
    pub near_m: f64,
    /// Largest number of these keyframes, the nearest.
    pub near_keyframes: usize,
    /// A scan with at least this score fits, 0 to 1.
    pub good_score: f64,
    /// A registration with a lower score is ignored, 0 to 1.
    pub poor_score: f64,
    /// The robot is lost after this many consecutive scans that do not fit.
    pub lost_after: usize,
    /// A scan whose score is lower than usual by this much makes the pose doubtful. After `lost_after` of them in
    /// a row the whole map is searched, because the scans may fit better elsewhere.
    pub score_drop: f64,
    /// Standard deviation of the position beyond which a pose is doubtful, m.
    pub doubt_m: f64,
    /// Cells and blur of the whole map; the cells are enlarged if the map needs too many.
    pub grid: LikelihoodConfig,
    /// Farther points are not used by the search, m, because they require small steps of the heading. If four of five
    /// points of the map are seen from farther away, this and the cells of the search are enlarged.
    pub search_reach_m: f64,
    /// Cell of the trail's points for the search, m.
    pub search_cell_m: f64,
    /// A search is given up after this many sums over the points.
    pub most_sums: u64,
    /// Sums over the points in one frame, which bound its time: the search goes on in the next one.
    pub frame_sums: u64,
    /// What counts as a distinct pose.
    pub neighborhood: SearchNeighborhood,
    /// Smallest score of a search result, 0 to 1.
    pub min_score: f64,
    /// A best pose with a lower score is reported but not accepted, 0 to 1, because walls have similar distances in
    /// other buildings.
    pub found_score: f64,
    /// Side of the largest room that a building may have several times, m. A trail that shows less may be in one that
    /// is not on the map.
    pub room_m: f64,
    /// If the usual score is lower, the pose is doubtful and the whole map is searched, 0 to 1.
    pub usual_score: f64,
    /// A best pose is accepted if its margin to the runner-up is at least this, and the next search
    /// confirms it.
    pub min_margin: f64,
    /// With this margin it is accepted without confirmation.
    pub unconfirmed_margin: f64,
    /// Largest number of sweeps of the trail.
    pub trail_sweeps: usize,
    /// Distance between two sweeps of the trail, m.
    pub trail_step_m: f64,
    /// Or turn between them, rad.
    pub trail_turn_rad: f64,
    /// Number of similar keyframes that are searched first.
    pub alike: usize,
    /// Uncertainty of a given start: standard deviation, m.
    pub start_sigma_m: f64,
    /// Uncertainty of its heading, rad.
    pub start_sigma_rad: f64,
    /// Largest squared innovation against a given start: the 99.9 % quantile.
    pub gate_chi2: f64,
}

impl Default for LocalizeConfig {
    fn default() -> Self {
        Self {
            near_m: 4.0,
            near_keyframes: 12,
            good_score: 0.7,
            poor_score: 0.6,
            lost_after: 5,
            score_drop: 0.1,
            doubt_m: 0.5,
            grid: LikelihoodConfig {
                cell_m: 0.1,
                sigma_m: 0.12,
            },
            search_reach_m: 10.0,
            search_cell_m: 0.25,
            most_sums: 1_000_000,
            frame_sums: 100_000,
            neighborhood: SearchNeighborhood::default(),
            min_score: 0.55,
            found_score: 0.85,
            room_m: 5.5,
            usual_score: 0.8,
            min_margin: 0.05,
            unconfirmed_margin: 0.15,
            trail_sweeps: 20,
            trail_step_m: 0.4,
            trail_turn_rad: 0.5,
            alike: 5,
            start_sigma_m: 0.5,
            start_sigma_rad: 0.2,
            gate_chi2: GATE_999,
        }
    }
}
