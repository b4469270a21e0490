//! The constants of submaps.

use super::GridConfig;
use crate::field::ClimbConfig;
use crate::slam::SlamConfig;

/// What scans are registered on.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum FrontEndKind {
    /// The chapter's: the points of the last few sweeps.
    #[default]
    Window,
    /// Two probability grids that overlap.
    Submaps(SubmapConfig),
}

/// A front end by name, whose lengths follow from the system.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum FrontEndChoice {
    /// The points of the last few sweeps.
    #[default]
    Window,
    /// Two probability grids that overlap.
    Submaps,
}

impl FrontEndChoice {
    /// The system with this front end.
    #[must_use]
    pub fn of(self, slam: SlamConfig) -> SlamConfig {
        match self {
            Self::Window => SlamConfig {
                front_end: FrontEndKind::Window,
                ..slam
            },
            Self::Submaps => slam.with_submaps(),
        }
    }
}

/// Size, registration and loops of submaps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SubmapConfig {
    /// The grids.
    pub grid: GridConfig,
    /// A submap is finished once it holds so many scans; the next one is begun at half of them.
    pub scans: usize,
    /// How a scan climbs on a grid; its weight is that of a point's squared misfit.
    pub climb: ClimbConfig,
    /// Points lie at a wall where their cell or one beside it is at least so probably occupied.
    pub occupied: f64,
    /// Where less of a scan lies at walls, its surroundings are searched before it climbs again.
    pub good_score: f64,
    /// Half the width of what is searched then, m.
    pub search_m: f64,
    /// Half its range of headings, rad.
    pub search_rad: f64,
    /// Half the range of headings in which a finished submap is searched at most, rad.
    pub max_turn_rad: f64,
    /// A loop of which less of the scan lies at walls of the submap is none.
    pub min_score: f64,
    /// So many finished submaps are kept ready to be searched; others are made ready anew.
    pub ready: usize,
}

impl SubmapConfig {
    /// Submaps with the lengths of a system: cells as wide as those of its scans.
    #[must_use]
    pub fn of(slam: &SlamConfig) -> Self {
        let cell_m = slam.scan.cell_m;
        // Of a wall that is a cell and a half wide, so that a point bends the sum as its noise says.
        let widths = 1.5 * cell_m / slam.odometry_trust.sigma_m;
        Self {
            grid: GridConfig {
                cell_m,
                wall_m: slam.scan.cell_m,
                ..GridConfig::default()
            },
            scans: 40,
            climb: ClimbConfig {
                weight: 0.5 * widths * widths,
                max_steps: 30,
                tolerance: 1e-4,
            },
            occupied: 0.5,
            good_score: 0.6,
            search_m: slam.keyframe_distance_m,
            search_rad: 2.0 * slam.keyframe_turn_rad,
            max_turn_rad: 0.5,
            min_score: 0.55,
            ready: 4,
        }
    }
}

impl SlamConfig {
    /// The chapter's system with a front end of submaps, whose lengths are its own.
    #[must_use]
    pub fn with_submaps(mut self) -> Self {
        self.robot = None;
        self.front_end = FrontEndKind::Submaps(SubmapConfig::of(&self));
        self
    }
}
