//! The panels: the relief, the ground along the ball's path, the sweep on the map or on the Gaussians, the slices, the
//! results of many sweeps.

mod places;
mod plots;
mod profile;
mod relief;
mod rows;

use widget_kit::scene::{Axis, Layer, Mark, Scene, Tone};

use super::morph::Morph;
use super::rests::Rests;
use super::terrains::Terrains;
use crate::w16_3_cost_terraces::spec::{Colors, HALF_SPAN_M, ReliefMeasure};
use plots::Along;

/// Name of the panel with the relief.
pub const RELIEF: &str = "relief";

/// The state that the picture shows besides the landscapes.
#[derive(Clone, Copy, Debug)]
pub struct PictureState {
    /// The measure that the relief shows.
    pub measure: ReliefMeasure,
    /// Shift under the crosshair, m.
    pub probe_m: [f64; 2],
    /// The shift at which the sweep is shown.
    pub looked: Looked,
    /// Steps of the ball so far.
    pub step: usize,
    /// What determines a cell's colour.
    pub colors: Colors,
}

/// The shift at which the sweep is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Looked {
    /// The crosshair's.
    CrossHair,
    /// That of the ball while it rolls.
    Ball,
    /// That of the pointer over a map, m.
    Pointer([f64; 2]),
}

impl PictureState {
    /// The shift at which the sweep is shown, m.
    pub fn looked_m(&self, terrains: &Terrains) -> [f64; 2] {
        match self.looked {
            Looked::CrossHair => self.probe_m,
            Looked::Ball => self.ball_m(terrains),
            Looked::Pointer(at) => at,
        }
    }

    /// Where the ball is, m.
    pub fn ball_m(&self, terrains: &Terrains) -> [f64; 2] {
        terrains.of(self.measure).ball.at_step(self.step)
    }
}

/// The whole picture.
pub fn scene(terrains: &Terrains, rests: &Rests, morph: &Morph, moment: PictureState) -> Scene {
    Scene {
        panels: vec![
            relief::panel(terrains, &rests.now_m(), morph, moment),
            profile::panel(terrains.of(moment.measure), moment),
            match moment.measure {
                ReliefMeasure::Icp => places::pairs(terrains, moment),
                ReliefMeasure::Ndt => places::bells(terrains, moment),
            },
            plots::slice(terrains, moment, Along::X),
            plots::slice(terrains, moment, Along::Y),
            plots::information(terrains, rests),
            rows::panel(terrains),
        ],
    }
}

/// The name of a measure.
fn name(measure: ReliefMeasure) -> &'static str {
    match measure {
        ReliefMeasure::Icp => "ICP",
        ReliefMeasure::Ndt => "NDT",
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
