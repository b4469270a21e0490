//! Plots over the keyframes.

use widget_kit::chart::{Series, TimeChart};
use widget_kit::scene::{Mark, Panel, Tone};

use crate::w16_10_own_robot::model::{OwnRobot, panel};

/// The share of each scan that fits.
pub fn fit(own: &OwnRobot) -> Panel {
    let fits: Vec<f64> = own.robot.keyframes.iter().map(|k| k.fit).collect();
    over_keyframes(own, panel::FIT, "How well each scan fits", "share").panel(&[Series {
        label: "share of the scan that fits",
        values: &fits,
        tone: Tone::Measurement,
        mark: Mark::Cross,
    }])
}

/// The standard deviation of each keyframe, and its error if it is known.
pub fn sure(own: &OwnRobot) -> Panel {
    let sigmas: Vec<f64> = own.robot.keyframes.iter().map(|k| k.sigma_m).collect();
    let chart = over_keyframes(own, panel::SURE, "Uncertainty of each keyframe", "m");
    let sigma = Series {
        label: "σ of the position",
        values: &sigmas,
        tone: Tone::Posterior,
        mark: Mark::Square,
    };
    if own.robot.errors_m().is_empty() {
        return chart.panel(&[sigma]);
    }
    chart.panel(&[
        sigma,
        Series {
            label: "error",
            values: own.robot.errors_m(),
            tone: Tone::Truth,
            mark: Mark::Plus,
        },
    ])
}

fn over_keyframes(
    own: &OwnRobot,
    id: &'static str,
    title: &'static str,
    y_label: &'static str,
) -> TimeChart<'static> {
    TimeChart {
        id,
        title,
        x_label: "keyframe",
        last: own.last(),
        y_label,
        now: own.keyframe(),
    }
}
