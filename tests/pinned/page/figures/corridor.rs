//! A bare corridor over several seeds: how much of its path each matcher believes to have driven.

use ch16_lab::lap::{BuiltInWorld, LapConfig, LapMatcher, LapRunner};
use ch16_lab::results::Percentiles;

use super::lap::driven_percent;

const SEEDS: u32 = 9;

/// Radius of the normals of the canonical run, cells.
fn chapter_normals_cells() -> f64 {
    let scan = LapConfig::default().slam.scan;
    scan.normal_radius_m / scan.cell_m
}

/// `p2l-narrow.driven_percent`: the median of a matcher.
pub fn value(path: &[&str]) -> Option<f64> {
    let [matcher, "driven_percent"] = *path else {
        return (path == ["seeds"]).then(|| f64::from(SEEDS));
    };
    let with_matcher = |config: LapConfig| {
        Some(match matcher {
            "p2p" => config,
            "p2l" => config.with_matcher(LapMatcher::PointToPlane),
            "p2l-narrow" => config
                .with_matcher(LapMatcher::PointToPlane)
                .with_normals(chapter_normals_cells()),
            "ndt" => config.with_matcher(LapMatcher::Ndt),
            _ => return None,
        })
    };
    let mut runner = LapRunner::new();
    let driven: Option<Vec<f64>> = (1..=SEEDS)
        .map(|seed| {
            let config = with_matcher(LapConfig::in_world(BuiltInWorld::Corridor, seed, 1.0))?;
            driven_percent(&runner.run(&config).front_end)
        })
        .collect();
    Some(Percentiles::from_values(driven?)?.median)
}
