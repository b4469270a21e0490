//! The panels: the map, the loop from near, the plots over time.

mod closeup;
mod map;
mod plots;

use kit::scene::Scene;

use super::moment::Moment;

pub use plots::OVER_TIME;

/// The whole picture.
pub fn scene(moment: &Moment) -> Scene {
    let (runs, tick) = (moment.runs, moment.tick);
    Scene {
        panels: vec![
            map::map(moment),
            closeup::closeup(runs, tick),
            plots::errors(runs, tick),
            plots::disagreement(runs, tick),
            plots::gate(runs, tick),
        ],
    }
}
