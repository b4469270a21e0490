//! Pairs of points to align: what a robot sees twice, including degenerate cases.

use nalgebra::Point2;
use pr_geom::SE2;
use pr_sim::Rng;

/// The true `target_from_source`: x and y in m, heading in degrees.
const TRUTH: (f64, f64, f64) = (0.3, 0.2, 40.0);
/// Range noise of both sweeps, m.
const SIGMA_M: f64 = 0.012;
/// Corners without mirror symmetry, m.
const CORNERS: [[f64; 2]; 4] = [[-1.2, -0.6], [1.0, -0.9], [1.3, 0.5], [-0.5, 1.1]];
/// Number of points of the wall, and their spacing, m.
const WALL_POINTS: usize = 5;
const WALL_STEP_M: f64 = 0.7;

/// The observed shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Four corners of a room.
    Corners,
    /// Two points.
    Two,
    /// A straight wall: the offsets from the line are noise.
    Wall,
    /// The corners, seen the second time by a sensor that hangs upside down, which swaps left and right.
    UpsideDown,
}

/// Points of the source and their partners in the target, m, each in its sensor's frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Pairs {
    /// Points to transform.
    pub source: Vec<Point2<f64>>,
    /// Their partners, in the same order.
    pub target: Vec<Point2<f64>>,
}

impl Pairs {
    /// Observes the shape twice, with the noise of that seed in both sweeps.
    #[must_use]
    pub fn seen(shape: Shape, seed: u32) -> Self {
        let mut rng = Rng::new(seed);
        let mut noisy = |p: Point2<f64>| {
            Point2::new(
                p.x + rng.normal(0.0, SIGMA_M),
                p.y + rng.normal(0.0, SIGMA_M),
            )
        };
        let (x, y, heading_deg) = TRUTH;
        let target_from_source = SE2::new(x, y, heading_deg.to_radians());
        let places = shape.places();
        let second = |p: &Point2<f64>| match shape {
            Shape::UpsideDown => Point2::new(p.x, -p.y),
            Shape::Corners | Shape::Two | Shape::Wall => *p,
        };
        Self {
            source: places.iter().map(|p| noisy(*p)).collect(),
            target: places
                .iter()
                .map(|p| noisy(target_from_source.transform(second(p))))
                .collect(),
        }
    }

    /// Number of pairs.
    #[must_use]
    pub fn len(&self) -> usize {
        self.source.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.source.is_empty()
    }
}

impl Shape {
    /// Points in the frame of the source, without noise.
    fn places(self) -> Vec<Point2<f64>> {
        let corners = || CORNERS.map(Point2::from).to_vec();
        match self {
            Self::Corners | Self::UpsideDown => corners(),
            Self::Two => corners()[..2].to_vec(),
            Self::Wall => {
                let middle = 0.5 * (WALL_POINTS - 1) as f64;
                let along = |k: usize| WALL_STEP_M * (k as f64 - middle);
                (0..WALL_POINTS)
                    .map(|k| Point2::new(along(k), 0.0))
                    .collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::procrustes::{Handedness, Procrustes, Winner};

    fn seen(shape: Shape, seed: u32) -> Procrustes {
        let pairs = Pairs::seen(shape, seed);
        assert!(!pairs.is_empty() && pairs.len() == pairs.target.len());
        Procrustes::new(&pairs.source, &pairs.target)
    }

    #[test]
    fn corners_are_turned_and_those_seen_upside_down_are_mirrored() {
        for seed in 1..=50 {
            let corners = seen(Shape::Corners, seed);
            assert_eq!(corners.winner(), Winner::Turn);
            // 2°: five deviations of the noise over a metre.
            assert!((corners.aligned.theta().to_degrees() - TRUTH.2).abs() < 2.0);
            assert_eq!(seen(Shape::UpsideDown, seed).winner(), Winner::Mirror);
            assert_eq!(seen(Shape::Two, seed).winner(), Winner::Tie);
        }
    }

    #[test]
    fn along_a_bare_wall_noise_decides_and_the_alignment_of_the_core_does_not_care() {
        let laps = 1000;
        let mut mirrored = 0;
        for seed in 1..=laps {
            let wall = seen(Shape::Wall, seed);
            mirrored += usize::from(wall.winner() == Winner::Mirror);
            assert!((wall.aligned.theta().to_degrees() - TRUTH.2).abs() < 2.0);
            let cost = Handedness::ALL.map(|kind| wall.cost_m2(kind, wall.best(kind).theta_rad));
            // Both fit up to the noise: ten coordinates of both sweeps.
            assert!(
                cost.iter()
                    .all(|cost| *cost < 10.0 * 8.0 * SIGMA_M * SIGMA_M)
            );
        }
        // Half of them, within five standard deviations of a thousand coin tosses.
        assert!((420..=580).contains(&mirrored), "{mirrored}");
    }
}
