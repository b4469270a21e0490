//! The panels: both landscapes, the sweep on the map, the information ellipse, the slices.

mod maps;
mod plots;
mod sweep;

use kit::scene::{Axis, Scene};

use super::settings::Colors;
use super::terrains::Terrains;
use crate::spec::HALF_SPAN_M;
use plots::{Along, Measure};

/// What the picture shows besides the landscapes.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// Shift under the cross hair, m.
    pub probe_m: [f64; 2],
    /// Shift under the pointer, where it hovers over a map, m.
    pub hover_m: Option<[f64; 2]>,
    /// Steps that the balls have taken.
    pub step: usize,
    /// What decides a cell's colour.
    pub colors: Colors,
}

/// The whole picture.
pub fn scene(terrains: &Terrains, moment: Moment) -> Scene {
    Scene {
        panels: vec![
            maps::icp(&terrains.icp, moment),
            maps::ndt(&terrains.ndt, moment),
            plots::slice(terrains, moment, Measure::Icp, Along::X),
            plots::slice(terrains, moment, Measure::Icp, Along::Y),
            plots::slice(terrains, moment, Measure::Ndt, Along::X),
            plots::slice(terrains, moment, Measure::Ndt, Along::Y),
            sweep::panel(terrains, moment),
            plots::information(terrains),
        ],
    }
}

/// An axis of shifts.
fn shift_axis(label: &str) -> Axis {
    Axis::new(label, -HALF_SPAN_M, HALF_SPAN_M)
}
