//! Converts the values of the parameters to the types of the core.

use ch16_lab::lap::BuiltInWorld;
use ch16_lab::laps::LapsConfig;
use pr_geom::SE2;
use widget_kit::values::Values;

use crate::w16_9_relocalization::spec::{HEADING, LAPS, SEED, START_X, START_Y, WORLD};

/// The lap before which the wardrobe is moved: the map of the day before has one lap.
const MOVED_BEFORE: usize = 2;

/// The laps of the map.
pub fn laps_config(values: &Values) -> LapsConfig {
    let world = values.get(&WORLD);
    let wardrobe = (world == BuiltInWorld::Apartment).then_some(MOVED_BEFORE);
    LapsConfig {
        wardrobe,
        ..LapsConfig::new(&world.course(), values.get(&SEED), 1.0)
    }
}

/// Number of laps of the map.
pub fn laps(values: &Values) -> usize {
    MOVED_BEFORE - 1 + values.get(&LAPS)
}

/// The robot's start.
pub fn start(values: &Values) -> SE2 {
    let heading_rad = values.get(&HEADING).to_radians();
    SE2::new(values.get(&START_X), values.get(&START_Y), heading_rad)
}
