//! What the values of the parameter list mean to the core.

use kit::values::Values;

use crate::w16_3_cost_terraces::spec::MOST_ROWS;

/// Where the sweep was taken, and what it is matched with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Room A: walls in both directions. The sweep is its own map.
    Room,
    /// A corridor without doors: walls along x alone. Map and sweep were measured apart.
    Corridor,
    /// The Apartment's corridor, doors and all. The sweep is its own map.
    OwnCorridor,
}

/// What decides a cell's colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colors {
    /// Its height, evenly from dark to bright.
    ByHeight,
    /// The share of cells that lie lower.
    ByRank,
}

/// The parameters as the model uses them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Where the sweep was taken.
    pub place: Place,
    /// Largest distance of a pair, m.
    pub tau_m: f64,
    /// Where the range noise of the sweep starts.
    pub seed: u32,
    /// Width of an NDT cell, m.
    pub ndt_cell_m: f64,
    /// Turn of the sweep, degrees.
    pub heading_deg: f64,
    /// Samples along each axis, odd.
    pub cells: usize,
    /// What decides a cell's colour.
    pub colors: Colors,
    /// Shift under the cross hair, m.
    pub probe_m: [f64; 2],
    /// So many rows of the point-to-plane step are taken.
    pub rows: usize,
    /// Standard deviation of a row of odometry, m, where there is one.
    pub odometry_m: Option<f64>,
}

impl Settings {
    /// Reads the list.
    pub fn read(values: &Values) -> Self {
        Self {
            place: match values.get("scene") as u32 {
                0 => Place::Room,
                1 => Place::Corridor,
                _ => Place::OwnCorridor,
            },
            tau_m: values.get("tau"),
            seed: values.get("seed") as u32,
            ndt_cell_m: values.get("ndt-cell"),
            heading_deg: values.get("heading"),
            cells: odd(values.get("cells")),
            colors: if values.get("colours") == 0.0 {
                Colors::ByHeight
            } else {
                Colors::ByRank
            },
            probe_m: [values.get("probe-x"), values.get("probe-y")],
            rows: match values.get("rows") {
                MOST_ROWS => usize::MAX,
                rows => rows as usize,
            },
            odometry_m: Some(values.get("odometry")).filter(|&sigma_m| sigma_m > 0.0),
        }
    }
}

/// The nearest odd number, so that the grid has a cell on the truth.
fn odd(value: f64) -> usize {
    let half = ((value - 1.0) / 2.0).round();
    2 * half as usize + 1
}
