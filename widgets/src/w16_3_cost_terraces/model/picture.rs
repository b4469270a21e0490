//! The panels: both landscapes, the ground along their balls' paths, the sweep on the map and on the Gaussians, the slices, the results of many
//! sweeps.

mod maps;
mod places;
mod plots;
mod profiles;
mod rows;

use widget_kit::scene::{Axis, Layer, Mark, Scene, Tone};

use super::landscape::Landscape;
use super::rests::Rests;
use super::terrains::Terrains;
use crate::w16_3_cost_terraces::spec::Colors;
use crate::w16_3_cost_terraces::spec::HALF_SPAN_M;
use plots::{Along, Measure};

/// The state that the picture shows besides the landscapes.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// Shift under the cross hair, m.
    pub probe_m: [f64; 2],
    /// The shift at which the sweep is shown.
    pub looked: Looked,
    /// Where ICP's ball is, m.
    pub ball_m: [f64; 2],
    /// Steps of the balls so far.
    pub step: usize,
    /// What determines a cell's colour.
    pub colors: Colors,
}

/// The shift at which the sweep is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Looked {
    /// The cross hair's.
    CrossHair,
    /// That of ICP's ball while it rolls.
    Ball,
    /// That of the pointer over a map, m.
    Pointer([f64; 2]),
}

impl Moment {
    /// The shift, m.
    pub fn looked_m(&self) -> [f64; 2] {
        match self.looked {
            Looked::CrossHair => self.probe_m,
            Looked::Ball => self.ball_m,
            Looked::Pointer(at) => at,
        }
    }

    /// Position of a landscape's ball, m.
    pub fn ball_of(&self, landscape: &Landscape) -> [f64; 2] {
        landscape.ball.at_step(self.step)
    }
}

/// The whole picture.
pub fn scene(terrains: &Terrains, rests: &Rests, moment: Moment) -> Scene {
    Scene {
        panels: vec![
            maps::icp(&terrains.icp, moment, &rests.now_m()),
            places::pairs(terrains, moment),
            profiles::icp(&terrains.icp, moment),
            maps::ndt(&terrains.ndt, moment),
            profiles::ndt(&terrains.ndt, moment),
            places::bells(terrains, moment),
            plots::slice(terrains, moment, Measure::Icp, Along::X),
            plots::slice(terrains, moment, Measure::Icp, Along::Y),
            plots::slice(terrains, moment, Measure::Ndt, Along::X),
            plots::slice(terrains, moment, Measure::Ndt, Along::Y),
            plots::information(terrains, rests),
            rows::panel(terrains),
        ],
    }
}

/// A mark on a slightly larger one of paper.
fn haloed(at: [f64; 2], mark: Mark, tone: Tone, radius_px: f32) -> [Layer; 2] {
    let halo = if mark == Mark::Plus { Mark::Dot } else { mark };
    [
        (Tone::Paper, halo, radius_px + 2.0),
        (tone, mark, radius_px),
    ]
    .map(|(tone, mark, radius_px)| Layer::points(vec![at], mark, tone, radius_px))
}

/// The ball: in its landscape and on its profile.
fn ball(at: [f64; 2]) -> [Layer; 2] {
    haloed(at, Mark::Dot, Tone::Posterior, 7.0)
}

/// An axis of shifts.
fn shift_axis(label: &str) -> Axis {
    Axis::new(label, -HALF_SPAN_M, HALF_SPAN_M)
}
