//! The result in words and numbers.

use ch16_lab::moving_box::BoxMethods;
use pr_geom::math;
use widget_kit::model::{Assessment, Fact, Outcome};

use super::MovingBox;
use super::curves::SEEDS;

use crate::w16_8_moving_box::spec::SHARE;

/// Largest error of a successful registration, m: half the step between neighbouring points of a wall.
const HOME_M: f64 = 0.02;

/// Final translation error of a method, m.
pub fn error_m(moving: &MovingBox, method: usize) -> f64 {
    let [x, y] = moving.runs[method].error_m;
    math::norm2(x, y)
}

fn home(moving: &MovingBox) -> [bool; 3] {
    [0, 1, 2].map(|method| error_m(moving, method) < HOME_M)
}

/// Good if all three succeed.
pub fn standing(moving: &MovingBox) -> Assessment {
    if home(moving).iter().all(|home| *home) {
        Assessment::Good
    } else {
        Assessment::Bad
    }
}

/// Which methods succeed.
pub fn verdict(moving: &MovingBox) -> &'static str {
    match home(moving) {
        [true, true, true] => "all three are home",
        [false, true, true] => "plain is pulled away",
        [false, true, false] => "only trimmed is home",
        [false, false, true] => "only Huber is home",
        [false, false, false] => "all three are pulled away",
        [true, true, false] => "Huber is pulled away",
        [true, false, true] => "trimmed is pulled away",
        [true, false, false] => "only plain is home",
    }
}

pub fn outcome(moving: &MovingBox) -> Outcome {
    let share = moving.values.get(&SHARE);
    let parts = BoxMethods::NAMES
        .iter()
        .enumerate()
        .map(|(k, name)| format!("{name} {:.0} mm", 1e3 * error_m(moving, k)));
    let parts: Vec<_> = parts.collect();
    let rmse = moving.runs[0].end.rmse_m;
    Outcome {
        standing: standing(moving),
        verdict: verdict(moving).to_owned(),
        sentence: format!(
            "With {share:.0}% of the points on the box, the errors are {}. Plain ICP has an rmse of {rmse:.3} m.",
            parts.join(", ")
        ),
        facts: facts(moving),
    }
}

fn facts(moving: &MovingBox) -> Vec<Fact> {
    let ids = [
        ("plain_error_m", "plain_bias_m", "plain_rmse_m"),
        ("trimmed_error_m", "trimmed_bias_m", "trimmed_rmse_m"),
        ("huber_error_m", "huber_bias_m", "huber_rmse_m"),
    ];
    let labels = [
        ("plain: off by", "plain: bias, all seeds", "plain: rmse"),
        (
            "trimmed: off by",
            "trimmed: bias, all seeds",
            "trimmed: rmse",
        ),
        ("Huber: off by", "Huber: bias, all seeds", "Huber: rmse"),
    ];
    let mut facts = Vec::new();
    for (k, (id, label)) in ids.into_iter().zip(labels).enumerate() {
        facts.extend([
            Fact::metres(id.0, label.0, error_m(moving, k)),
            Fact::metres(id.1, label.1, bias_m(moving, k)),
            Fact::metres(id.2, label.2, moving.runs[k].end.rmse_m),
        ]);
    }
    facts
}

/// The bias at the current share; NaN unless the curves have all seeds there.
fn bias_m(moving: &MovingBox, method: usize) -> f64 {
    let share = moving.values.get(&SHARE);
    let mut points = moving.curves.bias_m(method);
    let at = points.find(|(at, _)| *at == share);
    let is_whole = moving.curves.seeds() == SEEDS;
    at.and_then(|(_, bias)| bias.filter(|_| is_whole))
        .unwrap_or(f64::NAN)
}

pub fn summary(moving: &MovingBox) -> String {
    format!(
        "Two sweeps of one room with a box that moved between them, registered in three ways, iteration {} of {}. The picture shows the pull of each pair of {}, enlarged.",
        moving.iteration(),
        moving.last(),
        BoxMethods::NAMES[moving.method()],
    )
}
