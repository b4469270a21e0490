//! The panels: the map, the close-up of the loop, the plots over time, the strain of each edge.

mod bounds;
mod closeup;
mod floor_plan;
mod loop_style;
mod map;
mod parts;
mod plots;
mod shapes;
mod strain;
mod wipe;

use widget_kit::scene::Scene;

use super::moment::LapState;

pub use bounds::shown_bounds as map_bounds;
pub use plots::{OVER_TIME, gate_mark};
pub use shapes::loop_mark;
pub use strain::{part_of, strain_mark};
pub use wipe::{divider, shown_nodes};

/// The whole picture.
pub fn scene(moment: &LapState) -> Scene {
    Scene {
        panels: vec![
            map::map(moment),
            closeup::closeup(moment),
            plots::errors(moment),
            plots::disagreement(moment),
            plots::gate(moment),
            strain::strain(moment),
        ],
    }
}
