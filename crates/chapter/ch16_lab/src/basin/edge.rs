//! The edge of the basin of convergence along pure rotations: the largest heading error of a guess.

use super::{BasinScene, BasinStart, Minimum};
use ch16_slam2d::icp::{IcpConfig, IcpWorkspace};

/// Largest heading error: half a turn.
const HALF_TURN_DEG: u32 = 180;

/// Searches for the edge from the truth outwards, in steps of one degree.
///
/// The edge is the largest heading error for which registration converges to the truth from it and from all
/// smaller errors, on both sides. The position of the guess is the true one. Starts beyond the first failure
/// belong to another basin and do not count.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeSearch {
    config: IcpConfig,
    next_deg: u32,
    is_done: bool,
}

impl EdgeSearch {
    /// Creates a search with these registration settings.
    #[must_use]
    pub fn new(config: IcpConfig) -> Self {
        Self {
            config,
            next_deg: 0,
            is_done: false,
        }
    }

    /// The registration settings.
    #[must_use]
    pub fn config(&self) -> &IcpConfig {
        &self.config
    }

    /// Registers from the next heading, on both sides. Returns whether the edge is found.
    pub fn step(&mut self, scene: &BasinScene, workspace: &mut IcpWorkspace) -> bool {
        if self.is_done {
            return true;
        }
        let mut comes_home = |side: f64| {
            let start = BasinStart {
                heading_deg: side * f64::from(self.next_deg),
                dx_m: 0.0,
                dy_m: 0.0,
            };
            scene.register_from(&start, &self.config, workspace).ending == Minimum::Right
        };
        if comes_home(1.0) && comes_home(-1.0) {
            self.next_deg += 1;
            self.is_done = self.next_deg > HALF_TURN_DEG;
        } else {
            self.is_done = true;
        }
        self.is_done
    }

    /// Whether the edge is found.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.is_done
    }

    /// The largest heading error so far that converged to the truth, °; `None` before the first registration,
    /// or if not even the truth converges.
    #[must_use]
    pub fn reached_deg(&self) -> Option<f64> {
        self.next_deg.checked_sub(1).map(f64::from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ch16_slam2d::icp::IcpVariant;

    fn edge(variant: IcpVariant, tau_m: f64) -> Option<f64> {
        let (scene, mut workspace) = (BasinScene::new(), IcpWorkspace::new());
        let mut search = EdgeSearch::new(BasinScene::config(variant, tau_m));
        let mut steps = 0;
        while !search.step(&scene, &mut workspace) {
            steps += 1;
            assert!(steps <= HALF_TURN_DEG, "the search never ends");
        }
        assert!(search.step(&scene, &mut workspace) && search.is_done());
        search.reached_deg()
    }

    #[test]
    fn inside_the_edge_all_starts_come_home_and_one_degree_beyond_one_does_not() {
        let (scene, mut workspace) = (BasinScene::new(), IcpWorkspace::new());
        for variant in [IcpVariant::PointToPoint, IcpVariant::PointToPlane] {
            let config = BasinScene::config(variant, 0.7);
            let edge = edge(variant, 0.7).unwrap();
            let mut home = |heading_deg: f64| {
                let start = BasinStart {
                    heading_deg,
                    dx_m: 0.0,
                    dy_m: 0.0,
                };
                scene.register_from(&start, &config, &mut workspace).ending == Minimum::Right
            };
            for degrees in 0..=edge as i32 {
                assert!(home(f64::from(degrees)) && home(f64::from(-degrees)));
            }
            assert!(!home(edge + 1.0) || !home(-edge - 1.0));
        }
    }

    #[test]
    fn point_to_plane_reaches_farther_and_a_double_tau_hardly_helps_point_to_point() {
        let [point, plane] =
            [IcpVariant::PointToPoint, IcpVariant::PointToPlane].map(|of| edge(of, 0.7).unwrap());
        assert!(plane > point, "{plane} and {point}");
        let wide = edge(IcpVariant::PointToPoint, 1.4).unwrap();
        // Degrees: far less than the double.
        assert!((wide - point).abs() < 10.0, "{wide} and {point}");
    }

    #[test]
    fn a_tau_without_pairs_has_its_edge_at_the_truth() {
        assert!(edge(IcpVariant::PointToPoint, 1e-9).unwrap_or(0.0) <= 3.0);
    }
}
