//! The scene of w16.1: two sweeps of room A, and where ICP ends from every start.
//!
//! Room A is 4.0 m × 3.8 m, almost a square. A sweep of it turned by a quarter fits nearly as well
//! as the right way round, and ICP has no way to know: it goes down the slope on which it starts.
//! A row of equal posts is the other place with false minima by its shape: one at each spacing.
//! [`BasinScene::register_from`] runs one start, [`BasinMap`] a picture of many, filled bit by bit.

mod edge;
mod fence;
mod map;
mod outcome;
mod scene;

pub use edge::EdgeSearch;
pub use fence::FENCE_SPACING_M;
pub use map::{BasinMap, BasinMapAxes, OffsetAxis};
pub use outcome::{BasinOutcome, HOME_HEADING_DEG, Minimum};
pub use scene::{BasinPlace, BasinScene, BasinStart, SUCCESS_RADIUS_M};
