//! Sweeps dropped on the map, each with independent noise, and the animation of points to their results.

use ch16_lab::terrain::Drops;
use pr_geom::math;
use widget_kit::model::{Activity, Motion};

use super::terrains::Terrains;

/// Registration increments that an animated point makes per second.
const INCREMENTS_PER_S: f64 = 10.0;
/// Delay between the starts of two points, s.
const STAGGER_S: f64 = 0.01;

/// The computed drops, out of the requested number.
pub struct Rests {
    drops: Drops,
    seed: u32,
    wanted: usize,
    landing: Motion,
    flights: Vec<Flight>,
}

/// One drop: its path, and the time of its animation.
struct Flight {
    path_m: Vec<[f64; 2]>,
    /// Negative before its start; infinite after its end.
    age_s: f64,
}

/// Statistics of the results of many drops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scatter {
    /// Number of drops.
    pub count: usize,
    /// Standard deviations along x and y, m; not finite for fewer than two.
    pub deviation_m: [f64; 2],
}

impl Flight {
    fn start_m(&self) -> [f64; 2] {
        self.path_m[0]
    }

    fn rest_m(&self) -> [f64; 2] {
        self.path_m[self.path_m.len() - 1]
    }

    fn rests(&self) -> bool {
        self.age_s * INCREMENTS_PER_S >= (self.path_m.len() - 1) as f64
    }

    /// The current position.
    fn now_m(&self) -> [f64; 2] {
        if self.rests() {
            return self.rest_m();
        }
        let place = (self.age_s * INCREMENTS_PER_S).max(0.0);
        let before = place as usize;
        let part = place - before as f64;
        let (from, to) = (self.path_m[before], self.path_m[before + 1]);
        [0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis]))
    }
}

impl Rests {
    /// Creates it without drops.
    pub fn new(terrains: &Terrains) -> Self {
        Self {
            drops: Drops::new(terrains.scene().kind()),
            seed: terrains.scene().seed(),
            wanted: 0,
            landing: Motion::Reduced,
            flights: Vec::new(),
        }
    }

    /// Requests drops for the current scene; those of another scene are removed.
    pub fn follow(&mut self, terrains: &Terrains, wanted: usize) {
        let scene = terrains.scene();
        if scene.kind() != self.drops.kind() || scene.seed() != self.seed {
            *self = Self::new(terrains);
        }
        self.wanted = wanted;
        self.flights.truncate(wanted);
    }

    /// Restarts all drops: with full motion the points are animated, otherwise they are at their results.
    pub fn fly(&mut self, wanted: usize, motion: Motion) {
        self.flights.clear();
        self.wanted = wanted;
        self.landing = motion;
    }

    /// Ends all animations.
    pub fn land(&mut self) {
        self.landing = Motion::Reduced;
        for flight in &mut self.flights {
            flight.age_s = f64::INFINITY;
        }
    }

    /// Registers one more sweep.
    pub fn work(&mut self, terrains: &Terrains) -> Activity {
        let number = self.flights.len();
        if number >= self.wanted {
            return Activity::Idle;
        }
        let path = self.drops.path_m(terrains.scene(), number);
        self.flights.push(Flight {
            path_m: path.into_iter().map(Into::into).collect(),
            age_s: match self.landing {
                Motion::Full => -STAGGER_S * number as f64,
                Motion::Reduced => f64::INFINITY,
            },
        });
        Activity::Busy
    }

    /// Advances the animations.
    pub fn advance(&mut self, elapsed_s: f64) -> Activity {
        let mut activity = Activity::Idle;
        for flight in self.flights.iter_mut().filter(|flight| !flight.rests()) {
            flight.age_s += elapsed_s;
            activity = Activity::Busy;
        }
        activity
    }

    /// Current positions of the points, m.
    pub fn now_m(&self) -> Vec<[f64; 2]> {
        self.flights.iter().map(Flight::now_m).collect()
    }

    /// Start and result of each, m.
    pub fn ends_m(&self) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
        let flights = self.flights.iter();
        flights.map(|flight| [flight.start_m(), flight.rest_m()])
    }

    /// The scatter of the results.
    pub fn scatter(&self) -> Scatter {
        let count = self.flights.len();
        let deviation = |axis: usize| {
            if count < 2 {
                return f64::NAN;
            }
            let values = || self.flights.iter().map(|flight| flight.rest_m()[axis]);
            let mean = values().sum::<f64>() / count as f64;
            let squares = values().map(|value| (value - mean) * (value - mean));
            math::sqrt(squares.sum::<f64>() / (count - 1) as f64)
        };
        Scatter {
            count,
            deviation_m: [deviation(0), deviation(1)],
        }
    }
}
