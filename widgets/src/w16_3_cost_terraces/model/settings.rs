//! Converts the values of the parameters to the types of the core.

use widget_kit::values::Values;

use crate::w16_3_cost_terraces::spec::{
    CELLS, COLOURS, Colors, HEADING, MAX_ROWS, NDT_CELL, ODOMETRY, PROBE_X, PROBE_Y, ROWS, SCENE,
    SEED, SweepPlace, TAU,
};

/// The parameters in the form of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TerraceSettings {
    /// Location of the sweep.
    pub place: SweepPlace,
    /// Largest distance of a pair, m.
    pub tau_m: f64,
    /// Seed of the range noise of the sweep.
    pub seed: u32,
    /// Width of an NDT cell, m.
    pub ndt_cell_m: f64,
    /// Rotation of the sweep, degrees.
    pub heading_deg: f64,
    /// Samples along each axis, odd.
    pub cells: usize,
    /// What determines a cell's colour.
    pub colors: Colors,
    /// Shift under the crosshair, m.
    pub probe_m: [f64; 2],
    /// Number of rows of the point-to-plane step.
    pub rows: usize,
    /// Standard deviation of a row of odometry, m; `None` without this row.
    pub odometry_m: Option<f64>,
}

impl TerraceSettings {
    /// Reads the values.
    pub fn read(values: &Values) -> Self {
        Self {
            place: values.get(&SCENE),
            tau_m: values.get(&TAU),
            seed: values.get(&SEED),
            ndt_cell_m: values.get(&NDT_CELL),
            heading_deg: values.get(&HEADING),
            cells: odd(values.get(&CELLS)),
            colors: values.get(&COLOURS),
            probe_m: [values.get(&PROBE_X), values.get(&PROBE_Y)],
            rows: match values.get(&ROWS) {
                MAX_ROWS => usize::MAX,
                rows => rows as usize,
            },
            odometry_m: Some(values.get(&ODOMETRY)).filter(|&sigma_m| sigma_m > 0.0),
        }
    }
}

/// The nearest odd number, so that a cell is at the truth.
fn odd(value: f64) -> usize {
    let half = ((value - 1.0) / 2.0).round();
    2 * half as usize + 1
}
