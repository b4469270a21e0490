//! The tables: both errors from this start, and the data of every plot.

use ch16_lab::basin::{BasinOutcome, Minimum};
use ch16_slam2d::icp::IcpVariant;
use widget_kit::model::Table;
use widget_kit::ticks::signed;

use super::BasinExplorer;
use super::basins::{COLUMNS, ROWS};
use super::settings::{other_variant, variant, variant_name};
use super::texts::error_m;

/// The tables beside the picture.
pub fn shown(explorer: &BasinExplorer) -> Vec<Table> {
    vec![variants(explorer)]
}

/// All tables, the shown ones first.
pub fn all(explorer: &BasinExplorer) -> Vec<Table> {
    let mut tables = shown(explorer);
    tables.extend([iterations(explorer), basins(explorer)]);
    tables
}

/// The results of both variants from the same start.
fn variants(explorer: &BasinExplorer) -> Table {
    let chosen = variant(&explorer.values);
    let driver = explorer.driver();
    let row = |variant: IcpVariant, end: &BasinOutcome| {
        let yours = driver.filter(|_| variant == chosen);
        let name = yours.map(|yours| format!("your {}", yours.orders.function.name()));
        vec![
            name.unwrap_or_else(|| variant_name(variant).to_owned()),
            end.ending.name().to_owned(),
            format!("{:.3}", end.error_m),
            signed(end.error_deg, 1),
            format!("{:.3}", end.rmse_m),
            end.iterations.to_string(),
        ]
    };
    let mut rows = vec![
        row(chosen, &explorer.run.outcome),
        row(other_variant(chosen), &explorer.other),
    ];
    if chosen == IcpVariant::PointToPlane {
        rows.swap(0, 1);
    }
    Table::shown(
        "variants",
        "Both errors from this start",
        &[
            "error", "ends in", "off (m)", "off (°)", "rmse (m)", "steps",
        ],
        rows,
    )
}

/// The iterations of the registration.
fn iterations(explorer: &BasinExplorer) -> Table {
    let truth = explorer.scene.truth();
    Table::of_items(
        "iterations",
        "Every iteration",
        explorer.run.trace.iter().enumerate(),
        &[
            ("iteration", &|(k, _)| (*k).into()),
            ("pairs", &|(_, state)| state.pairs.into()),
            ("rmse (m)", &|(_, state)| state.rmse_m.into()),
            ("error (m)", &|(_, state)| {
                error_m(&truth, &state.pose).into()
            }),
            ("x (m)", &|(_, state)| state.pose.x().into()),
            ("y (m)", &|(_, state)| state.pose.y().into()),
            ("theta (rad)", &|(_, state)| state.pose.theta().into()),
        ],
    )
}

/// Both basin maps.
fn basins(explorer: &BasinExplorer) -> Table {
    let head = [
        "heading (°)",
        "Δx (m)",
        "Δy (m)",
        "point-to-point",
        "point-to-plane",
    ];
    Table::exported(
        "basins",
        "The minimum reached from every start",
        &head,
        basin_rows(explorer),
    )
}

/// One row per cell; a cell that is not computed yet is empty.
fn basin_rows(explorer: &BasinExplorer) -> Vec<Vec<String>> {
    let point = explorer.basins.map(IcpVariant::PointToPoint);
    let plane = explorer.basins.map(IcpVariant::PointToPlane);
    let cells = (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| (column, row)));
    cells
        .map(|(column, row)| {
            let start = point.axes().start(column, row);
            let name = |minimum: Option<Minimum>| minimum.map_or("", Minimum::name).to_owned();
            vec![
                start.heading_deg.to_string(),
                start.dx_m.to_string(),
                start.dy_m.to_string(),
                name(point.minimum(column, row)),
                name(plane.minimum(column, row)),
            ]
        })
        .collect()
}
