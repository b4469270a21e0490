//! Many sweeps registered on one map: the scatter of their results.

use pr_geom::{SE2, Vector2};
use pr_sim::Rng;

use super::scene::Sweeper;
use super::{SceneKind, TerrainScene};
use ch16_slam2d::icp::{Icp, IcpConfig, IcpVariant, IcpWorkspace};

/// Largest initial error of a drop along each axis, m.
pub const DROP_SPREAD_M: f64 = 0.3;

/// Increment between the seeds of drops (the golden ratio of 2³²).
const SEED_STEP: u32 = 0x9E37_79B9;

/// Registers many sweeps on the map of a scene, each with independent range noise.
///
/// Drop k is taken at the pose of the scene's sweep, but its beams point between those of the scene, and its
/// noise is its own. It starts at a shift drawn uniformly from ±[`DROP_SPREAD_M`] or another spread, with the
/// right heading, and is registered point to plane with the chapter's settings. The same scene and the same k give the same
/// bits.
pub struct Drops {
    kind: SceneKind,
    spread_m: f64,
    sweeper: Sweeper,
    workspace: IcpWorkspace,
}

impl Drops {
    /// Prepares drops for a location.
    #[must_use]
    pub fn new(kind: SceneKind) -> Self {
        Self {
            kind,
            spread_m: DROP_SPREAD_M,
            sweeper: Sweeper::new(kind),
            workspace: IcpWorkspace::new(),
        }
    }

    /// Draws the starts from ±`spread_m` instead; 0 starts all of them at the truth.
    #[must_use]
    pub fn with_spread(mut self, spread_m: f64) -> Self {
        self.spread_m = spread_m;
        self
    }

    /// The location.
    #[must_use]
    pub fn kind(&self) -> SceneKind {
        self.kind
    }

    /// Position error of the sensor before the first and after every increment of drop `number`, `(Δx, Δy)`
    /// in m; never empty. The last one is the result.
    ///
    /// # Panics
    /// If the scene is another location.
    pub fn path_m(&mut self, scene: &TerrainScene, number: usize) -> Vec<Vector2<f64>> {
        assert_eq!(scene.kind(), self.kind, "the sweeps are of another place");
        let seed = (number as u32 + 1).wrapping_mul(SEED_STEP) ^ scene.seed();
        let mut rng = Rng::new(seed);
        let sensor = scene.world_from_sensor();
        let sweep = self.sweeper.fresh_sweep(&sensor, &mut rng);
        let mut shift = || rng.uniform(-self.spread_m, self.spread_m);
        let start = SE2::from_xy(shift(), shift());
        let config = IcpConfig {
            variant: IcpVariant::PointToPlane,
            ..IcpConfig::default()
        };
        Icp::new(&sweep, scene.map(), start, &config, &mut self.workspace).run();
        let truth = sensor.position();
        let moved = |pose: SE2| pose.transform(truth) - truth;
        let trace = self.workspace.trace().iter();
        trace.map(|state| moved(state.pose)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pr_geom::math;

    /// Standard deviations of 100 results along x and y, m.
    fn spread_m(kind: SceneKind) -> [f64; 2] {
        let scene = TerrainScene::new(kind, TerrainScene::DEFAULT_NDT_CELL_M);
        let mut drops = Drops::new(kind);
        let rests: Vec<_> = (0..100)
            .map(|k| *drops.path_m(&scene, k).last().unwrap())
            .collect();
        let mean = rests.iter().sum::<Vector2<f64>>() / 100.0;
        [0, 1].map(|axis| {
            let squares = rests.iter().map(|at| (at[axis] - mean[axis]).powi(2));
            math::sqrt(squares.sum::<f64>() / 100.0)
        })
    }

    #[test]
    fn rests_are_round_in_the_room_and_a_streak_in_the_corridor() {
        let [x, y] = spread_m(SceneKind::Room);
        assert!(x < 0.005 && y < 0.005, "room {x} {y}");
        assert!((0.5..2.0).contains(&(x / y)), "room {x} {y}");
        let [x, y] = spread_m(SceneKind::LongCorridor);
        assert!(x > 0.1 && y < 0.01, "corridor {x} {y}");
    }

    #[test]
    fn a_drop_is_a_sweep_of_its_own_and_the_same_each_time() {
        let scene = TerrainScene::new(SceneKind::LongCorridor, 0.55);
        let mut drops = Drops::new(SceneKind::LongCorridor);
        let first = drops.path_m(&scene, 0);
        let second = drops.path_m(&scene, 1);
        assert_ne!(first, second);
        assert_eq!(Drops::new(SceneKind::LongCorridor).path_m(&scene, 0), first);
        let start = first[0];
        assert!(start.x.abs() <= DROP_SPREAD_M && start.y.abs() <= DROP_SPREAD_M);
    }
}
