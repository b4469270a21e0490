//! Place recognition over the laps of `ch16 places`: precision and recall.

use ch16_lab::lap::{BuiltInWorld, LapConfig, LapDetector, LapMatcher, NamedChoice};
use ch16_lab::places::{GRADED, PlaceCurve, PlacePair, place_curves, place_pairs};

use super::shared::Shared;

/// Laps of each world, from seed 1 on.
const SEEDS: u32 = 20;

/// Share of the pairs that exercise 7 calls the same.
const CALLED: f64 = 0.3;

/// The grades of all detectors in one world.
pub struct GradedWorld {
    pairs: Vec<PlacePair>,
    curves: Vec<PlaceCurve>,
}

impl GradedWorld {
    /// The world of that name.
    pub fn shared(name: &str) -> Option<&'static Self> {
        static WORLDS: Shared<GradedWorld> = Shared::new();
        WORLDS.get(name, || Self::graded(name))
    }

    /// Runs the laps of the world of that name.
    fn graded(name: &str) -> Option<Self> {
        let world = BuiltInWorld::named(name)?;
        let lap = |seed| LapConfig::in_world(world, seed, 1.0).with_matcher(LapMatcher::Ndt);
        let pairs: Vec<_> = (1..=SEEDS)
            .flat_map(|seed| place_pairs(&lap(seed)))
            .collect();
        Some(Self {
            curves: place_curves(&pairs),
            pairs,
        })
    }

    /// Share of pairs that are the same place: the precision of a detector that guesses.
    fn chance(&self) -> f64 {
        self.same() as f64 / self.pairs.len() as f64
    }

    fn same(&self) -> usize {
        self.pairs.iter().filter(|pair| pair.is_same).count()
    }

    /// Number of pairs that exercise 7 calls the same.
    fn called(&self) -> usize {
        (CALLED * self.pairs.len() as f64) as usize
    }

    /// Precision if the most alike `CALLED` of the pairs are called the same.
    fn precision_called(&self, curve: &PlaceCurve) -> Option<f64> {
        let index = GRADED.iter().position(|graded| *graded == curve.detector)?;
        let mut ranked: Vec<&PlacePair> = self.pairs.iter().collect();
        ranked.sort_by(|a, b| a.distances[index].total_cmp(&b.distances[index]));
        let called = self.called();
        let right = ranked[..called].iter().filter(|pair| pair.is_same).count();
        Some(right as f64 / called as f64)
    }

    /// `context.area`, `nearby.clean_recall`.
    pub fn value(&self, path: &[&str]) -> Option<f64> {
        let detector = |name: &str| {
            let detector = LapDetector::named(name)?;
            self.curves.iter().find(|curve| curve.detector == detector)
        };
        match *path {
            ["chance"] => Some(self.chance()),
            ["chance_percent"] => Some(100.0 * self.chance()),
            ["perfect", "called"] => Some((self.same() as f64 / self.called() as f64).min(1.0)),
            [name, "called"] => self.precision_called(detector(name)?),
            [name, "half"] => detector(name)?.precision_at_fixed_recall(),
            [name, "over_chance"] => Some(detector(name)?.average_precision / self.chance()),
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
        "called_percent" => Some(100.0 * CALLED),
        _ => None,
    }
}
