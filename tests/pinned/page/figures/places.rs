//! Place recognition over the laps of `slam2d places`: precision and recall.

use ch16_lab::lap::{BuiltInWorld, Choice, LapConfig, LapDetector, LapMatcher};
use ch16_lab::places::{PlaceCurve, place_curves, place_pairs};

/// Laps of each world, from seed 1 on.
const SEEDS: u32 = 20;

/// The grades of all detectors in one world.
pub struct World {
    curves: Vec<PlaceCurve>,
}

impl World {
    /// Runs the laps of the world of that name.
    pub fn graded(name: &str) -> Option<Self> {
        let world = BuiltInWorld::named(name)?;
        let lap = |seed| LapConfig::in_world(world, seed, 1.0).with_matcher(LapMatcher::Ndt);
        let pairs: Vec<_> = (1..=SEEDS)
            .flat_map(|seed| place_pairs(&lap(seed)))
            .collect();
        Some(Self {
            curves: place_curves(&pairs),
        })
    }

    /// `context.area`, `nearby.clean_recall`.
    pub fn value(&self, path: &[&str]) -> Option<f64> {
        let detector = |name: &str| {
            let detector = LapDetector::named(name)?;
            self.curves.iter().find(|curve| curve.detector == detector)
        };
        match *path {
            [name, "area"] => Some(detector(name)?.average_precision),
            [name, "clean_recall"] => Some(detector(name)?.recall_without_errors),
            _ => None,
        }
    }
}

/// Parameters of the comparison.
pub fn setup(what: &str) -> Option<f64> {
    match what {
        "seeds" => Some(f64::from(SEEDS)),
        _ => None,
    }
}
