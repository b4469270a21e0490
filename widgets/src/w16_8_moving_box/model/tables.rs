//! The tables: the three registrations beside the picture, the curves for the export.

use ch16_lab::moving_box::BoxMethods;
use widget_kit::model::Table;
use widget_kit::ticks::signed;

use super::MovingBox;
use super::texts::error_m;

/// All tables, the shown one first.
pub fn all(moving: &MovingBox) -> Vec<Table> {
    vec![methods(moving), curves(moving)]
}

fn methods(moving: &MovingBox) -> Table {
    let rows = moving.runs.iter().enumerate().map(|(k, run)| {
        let [x, y] = run.error_m;
        vec![
            BoxMethods::NAMES[k].to_owned(),
            format!("{:.3}", error_m(moving, k)),
            signed(x, 3),
            signed(y, 3),
            format!("{:.3}", run.end.rmse_m),
            run.end.inliers.to_string(),
            run.end.iterations.to_string(),
        ]
    });
    Table::shown(
        "methods",
        "The three registrations",
        &[
            "method", "off (m)", "in x", "in y", "rmse (m)", "pairs", "steps",
        ],
        rows.collect(),
    )
}

fn curves(moving: &MovingBox) -> Table {
    let bias = |method: usize| moving.curves.bias_m(method);
    Table::of_items(
        "bias",
        format!("Bias over {} seeds", moving.curves.seeds()),
        bias(0).zip(bias(1)).zip(bias(2)),
        &[
            ("points on the box (%)", &|((plain, _), _)| plain.0.into()),
            ("plain (m)", &|((plain, _), _)| plain.1.into()),
            ("trimmed (m)", &|((_, trimmed), _)| trimmed.1.into()),
            ("Huber (m)", &|(_, huber)| huber.1.into()),
        ],
    )
}
