//! The whole window of w16.6: the number of its poses, the margin of the best one, and the work.

use ch16_lab::basin::BasinScene;
use ch16_lab::whole_window::{WindowConfig, WindowSearch};

/// `home.margin`, `home.scored`.
pub fn value(scene: &BasinScene, case: &str, what: &str) -> Option<f64> {
    if case != "home" {
        return None;
    }
    let searched = WindowSearch::new(scene, WindowConfig::default())
        .ok()?
        .run();
    let result = searched.result()?;
    Some(match what {
        "window" => result.counts.window as f64,
        "scored" => result.counts.scored() as f64,
        "margin" => result.margin()?,
        _ => return None,
    })
}
