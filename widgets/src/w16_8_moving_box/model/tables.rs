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
    let of = |method: usize| moving.curves.bias_m(method);
    let rows = of(0)
        .zip(of(1))
        .zip(of(2))
        .map(|((plain, trimmed), huber)| {
            let as_text =
                |bias: Option<f64>| bias.map_or_else(String::new, |bias| bias.to_string());
            vec![
                plain.0.to_string(),
                as_text(plain.1),
                as_text(trimmed.1),
                as_text(huber.1),
            ]
        });
    Table::exported(
        "bias",
        format!("Bias over {} seeds", moving.curves.seeds()),
        &[
            "points on the box (%)",
            "plain (m)",
            "trimmed (m)",
            "Huber (m)",
        ],
        rows.collect(),
    )
}
