//! The whole window of w16.6: what is found, how sure it is, and how much work it was.

use ch16_lab::basin::BasinScene;
use ch16_lab::whole_window::{WindowConfig, WindowSearch, refine};
use ch16_slam2d::icp::IcpWorkspace;

/// `home.margin`, `wide.fewer`: by window.
pub fn value(scene: &BasinScene, case: &str, what: &str) -> Option<f64> {
    let config = config(case)?;
    let searched = WindowSearch::new(scene, config).ok()?.run();
    let result = searched.result()?;
    let behind = |turns_deg: &[f64]| {
        let rivals = turns_deg.iter().filter_map(|turn_deg| {
            let rival = searched.rival(scene, &result.best.pose, *turn_deg)?;
            Some(rival.run()?.best.score)
        });
        Some(result.best.score - rivals.reduce(f64::max)?)
    };
    Some(match what {
        "half_width_m" => config.half_width_m,
        "cell_m" => config.cell_m,
        "min_score" => WindowConfig::MIN_SCORE,
        "window" => result.counts.window as f64,
        "scored" => result.counts.scored() as f64,
        "fewer" => result.counts.window as f64 / result.counts.scored() as f64,
        "score" => result.best.score,
        "margin" => result.margin()?,
        "half_behind" => behind(&[180.0])?,
        "quarter_behind" => behind(&[90.0, -90.0])?,
        "error_m" => refine(scene, result.best.pose, &mut IcpWorkspace::new()).error_m,
        _ => return None,
    })
}

fn config(case: &str) -> Option<WindowConfig> {
    let home = WindowConfig::default();
    Some(match case {
        "home" => home,
        "wide" => WindowConfig {
            half_width_m: 3.0,
            ..home
        },
        "coarse" => WindowConfig {
            cell_m: 0.2,
            ..home
        },
        _ => return None,
    })
}
