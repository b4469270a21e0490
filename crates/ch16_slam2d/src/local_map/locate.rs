//! Where a scan was taken, by one cost: from the prediction, and from other starts if the scan fits poorly there.

use pr_geom::SE2;

use super::{LocalMap, MapRegistration, MapRegistrationConfig, MotionPrior};
use crate::cloud::PointCloud;
use crate::search::SearchWindow;

/// A scan that fits so well needs no other start, 0 to 1.
const GOOD_WITHOUT_WHEELS: f64 = 0.9;
/// Other starts where the prediction is off by more than a registration reaches: along the heading (m) and
/// turned by (rad).
const STARTS: ([f64; 5], [f64; 9]) = (
    [0.0, -0.5, 0.5, -1.0, 1.0],
    [0.0, -0.3, 0.3, -0.6, 0.6, -0.9, 0.9, -1.2, 1.2],
);

impl LocalMap {
    /// The pose of lowest cost among those that registrations end at: from the prediction, from `others`, and
    /// from the best pose of the window around the prediction.
    #[must_use]
    pub fn locate(
        &mut self,
        scan: &PointCloud,
        prior: &MotionPrior,
        others: &[SE2],
        config: &MapRegistrationConfig,
    ) -> MapRegistration {
        let stages = [config.reach_m, config.fit_m];
        let near = &stages[1..];
        let mut best = self.register(scan, prior.pose, &stages, Some(prior), config);
        // A registration from afar slides along a wall where the scan fits better at the prediction.
        if self.fit(scan, &prior.pose, config).score > best.fit.score {
            best = cheaper(
                best,
                self.register(scan, prior.pose, near, Some(prior), config),
            );
        }
        let is_vague = 2.0 * prior.sigma_m > config.reach_m;
        if is_vague && best.fit.score < GOOD_WITHOUT_WHEELS {
            for turn_rad in STARTS.1 {
                for ahead_m in STARTS.0 {
                    let start = prior.pose * SE2::new(ahead_m, 0.0, turn_rad);
                    if prior.cost(&start) < best.cost {
                        best = cheaper(
                            best,
                            self.register(scan, start, &stages, Some(prior), config),
                        );
                    }
                }
            }
        }
        for start in others {
            if best.fit.score < config.good_score {
                best = cheaper(
                    best,
                    self.register(scan, *start, &stages, Some(prior), config),
                );
            }
        }
        if best.fit.score < config.good_score {
            let window = SearchWindow::around(prior.pose, config.search_m, config.search_rad);
            if let Some(found) = self.search(scan, &window, 0.0) {
                best = cheaper(
                    best,
                    self.register(scan, found.best.pose, near, Some(prior), config),
                );
            }
        }
        best
    }
}

fn cheaper(one: MapRegistration, other: MapRegistration) -> MapRegistration {
    if other.cost < one.cost { other } else { one }
}
