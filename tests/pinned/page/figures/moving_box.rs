//! The moving box of w16.8: the bias of the mean over many seeds.

use ch16_lab::moving_box::{BoxConfig, BoxErrors, BoxMethods, BoxScene};
use ch16_slam2d::icp::IcpWorkspace;

/// Seeds of the widget's curves, from 1 on.
const SEEDS: u32 = 100;

/// `20.plain.bias_mm`: by share in percent and by method; `setup.seeds`.
pub fn value(path: &[&str]) -> Option<f64> {
    let methods = BoxMethods::default();
    match *path {
        ["setup", "dropped_percent"] => Some(100.0 * methods.dropped),
        ["setup", "seeds"] => Some(f64::from(SEEDS)),
        [share, method, "bias_mm"] => {
            let method = BoxMethods::NAMES
                .iter()
                .position(|name| name.to_lowercase() == method)?;
            let share = share.parse::<f64>().ok()? / 100.0;
            let mut errors = BoxErrors::default();
            let mut workspace = IcpWorkspace::new();
            for seed in 1..=SEEDS {
                let scene = BoxScene::new(&BoxConfig {
                    seed,
                    share,
                    ..BoxConfig::default()
                });
                errors.add(&scene, &methods, &mut workspace);
            }
            Some(1e3 * errors.bias_m(method)?)
        }
        _ => None,
    }
}
