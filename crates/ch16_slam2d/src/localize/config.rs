//! The constants of localization.

use pr_geom::SE2;

use crate::search::{LikelihoodConfig, SearchNeighborhood};

/// What is known of the first pose.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum StartPose {
    /// Nothing: the robot was carried away, or switched on anywhere.
    #[default]
    Anywhere,
    /// About here, `map_from_body`.
    Near(SE2),
}

/// When a place is localized, and for how long; lengths are those of rooms and corridors.
#[derive(Clone, Debug, PartialEq)]
pub struct LocalizeConfig {
    /// Keyframes within this distance of the prediction are what a scan is registered on, m.
    pub near_m: f64,
    /// At most so many of them, the nearest.
    pub near_keyframes: usize,
    /// With this score a scan fits, 0 to 1.
    pub good_score: f64,
    /// With a lower one the registration is not listened to, 0 to 1.
    pub poor_score: f64,
    /// After so many scans in a row that do not fit the robot is lost.
    pub lost_after: usize,
    /// A scan whose score is lower than usual by so much is doubted; after as many of them in a row the
    /// robot is looked for everywhere: elsewhere it may fit better.
    pub score_drop: f64,
    /// Standard deviation of the position beyond which a pose is doubted, m.
    pub doubt_m: f64,
    /// Cells and blur of the whole map; larger cells are taken where it needs them.
    pub grid: LikelihoodConfig,
    /// Points farther from the robot are not searched with, m: they make the steps of the heading
    /// small.
    pub search_reach_m: f64,
    /// The trail is searched with a point a cell of this side, m.
    pub search_cell_m: f64,
    /// A search that is not decided after so many sums over the points is given up: a frame has to end.
    pub most_sums: u64,
    /// What counts as another place.
    pub neighborhood: SearchNeighborhood,
    /// A search whose best score is lower found nothing, 0 to 1.
    pub min_score: f64,
    /// A best place with a lower score is told and not localized, 0 to 1: walls stand as far apart in
    /// other buildings, too.
    pub found_score: f64,
    /// Where scans usually fit worse, the robot is doubted and looked for everywhere, 0 to 1.
    pub usual_score: f64,
    /// A best place is localized if the best other one is behind by so much, and the next search
    /// finds it again.
    pub min_margin: f64,
    /// With this margin it is localized at once.
    pub unconfirmed_margin: f64,
    /// Sweeps of the trail, at most.
    pub trail_sweeps: usize,
    /// Way between two sweeps of the trail, m.
    pub trail_step_m: f64,
    /// Or turn between them, rad.
    pub trail_turn_rad: f64,
    /// Keyframes that look alike and are looked at first.
    pub alike: usize,
    /// How well a given start is known: standard deviations, m.
    pub start_sigma_m: f64,
    /// The same for its heading, rad.
    pub start_sigma_rad: f64,
    /// Largest squared innovation against a given start; 999 of 1,000 lie below.
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
            doubt_m: 1.0,
            grid: LikelihoodConfig {
                cell_m: 0.1,
                sigma_m: 0.12,
            },
            search_reach_m: 10.0,
            search_cell_m: 0.25,
            most_sums: 200_000,
            neighborhood: SearchNeighborhood::default(),
            min_score: 0.55,
            found_score: 0.85,
            usual_score: 0.8,
            min_margin: 0.05,
            unconfirmed_margin: 0.15,
            trail_sweeps: 20,
            trail_step_m: 0.4,
            trail_turn_rad: 0.5,
            alike: 5,
            start_sigma_m: 0.5,
            start_sigma_rad: 0.2,
            gate_chi2: 16.266,
        }
    }
}
