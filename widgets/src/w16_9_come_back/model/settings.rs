//! What the values of the parameter list mean to the core.

use ch16_lab::lap::{BuiltInWorld, Choice};
use ch16_lab::laps::LapsConfig;
use kit::values::Values;
use pr_geom::SE2;

/// The lap before which the wardrobe is moved: the map of yesterday is of one lap.
const MOVED_BEFORE: usize = 2;

/// The laps that make the map.
pub fn laps_config(values: &Values) -> LapsConfig {
    let world = BuiltInWorld::ALL[values.get("world") as usize];
    let wardrobe = (world == BuiltInWorld::Apartment).then_some(MOVED_BEFORE);
    LapsConfig {
        wardrobe,
        ..LapsConfig::new(&world.course(), values.get("seed") as u32, 1.0)
    }
}

/// How many laps the map is of.
pub fn laps(values: &Values) -> usize {
    MOVED_BEFORE - 1 + values.get("laps") as usize
}

/// Where the robot is switched on.
pub fn start(values: &Values) -> SE2 {
    let heading_rad = values.get("heading").to_radians();
    SE2::new(values.get("x"), values.get("y"), heading_rad)
}
