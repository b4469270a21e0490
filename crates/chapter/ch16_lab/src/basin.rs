//! The scene of w16.1: two sweeps of room A, and where ICP ends from every start.
//!
//! Room A is 4.0 m × 3.8 m, almost a square. A sweep of it turned by a quarter fits nearly as well as the
//! right heading, so ICP converges to the minimum in whose basin it starts. A row of equal posts has false
//! minima, too: one at each spacing. [`BasinScene::register_from`] runs one start; [`BasinMap`] evaluates a
//! grid of starts step by step.

mod edge;
mod fence;
mod map;
mod outcome;
mod place;
mod scene;

pub use edge::EdgeSearch;
pub use fence::FENCE_SPACING_M;
pub use map::{BasinMap, BasinMapAxes, OffsetAxis};
pub use outcome::{BasinOutcome, HOME_HEADING_DEG, Minimum, SUCCESS_RADIUS_M};
pub use place::BasinPlace;
pub use scene::{BasinScene, BasinStart};
