//! The whole window of w16.6: how many poses it holds, how sure the best is, and how much work it was.

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
