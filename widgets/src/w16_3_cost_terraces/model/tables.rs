//! The data of every panel: shown beside the picture, or exported as CSV.

use widget_kit::model::Table;
use widget_kit::ticks::signed;

use super::landscape::{BallPath, Landscape, shift_m};
use super::rests::Rests;
use super::settings::TerraceSettings;
use super::terrains::Terrains;

/// The tables beside the picture.
pub fn shown(terrains: &Terrains) -> Vec<Table> {
    vec![results(terrains)]
}

/// All tables, the shown ones first.
pub fn all(terrains: &Terrains, rests: &Rests, settings: &TerraceSettings) -> Vec<Table> {
    let mut tables = shown(terrains);
    tables.extend([
        information(terrains),
        rows(terrains),
        dropped(rests),
        partners(terrains, settings),
        bells(terrains),
        slice(
            "slice-x",
            "Slice along x",
            "Δx (m)",
            terrains,
            |landscape| landscape.row(settings.probe_m[1]),
        ),
        slice(
            "slice-y",
            "Slice along y",
            "Δy (m)",
            terrains,
            |landscape| landscape.column(settings.probe_m[0]),
        ),
        way(
            "icp-ball",
            "Path of ICP's ball",
            "cost (m²)",
            &terrains.icp.ball,
        ),
        way(
            "ndt-ball",
            "Path of NDT's ball",
            "−score",
            &terrains.ndt.ball,
        ),
        maps(terrains),
    ]);
    tables
}

/// The minimum of each measure, and the final shift of its ball.
fn results(terrains: &Terrains) -> Table {
    let row = |name: &str, landscape: &Landscape| {
        vec![
            name.to_owned(),
            point(landscape.lowest_m),
            point(landscape.ball.end_m()),
        ]
    };
    Table::shown(
        "balls",
        "Lowest cells and balls, Δx and Δy",
        &["measure", "lowest cell (m)", "ball ends at (m)"],
        vec![row("ICP", &terrains.icp), row("NDT", &terrains.ndt)],
    )
}

fn point([x, y]: [f64; 2]) -> String {
    format!("{}, {}", signed(x, 2), signed(y, 2))
}

/// Eigenvalues and directions of the information of a shift at the truth.
fn information(terrains: &Terrains) -> Table {
    let information = &terrains.information;
    let row = |name: &str, k: usize| {
        let eigenvalue = information.eigenvalues_per_cm2[k];
        vec![
            name.to_owned(),
            signed(information.directions_deg[k], 0),
            format!("{eigenvalue:.2}"),
        ]
    };
    Table::exported(
        "information",
        "Information at the truth",
        &["direction", "angle from x (°)", "eigenvalue (1/cm²)"],
        vec![row("firmest", 0), row("loosest", 1)],
    )
}

/// The rows of the point-to-plane step, and the rank of each with those before it.
fn rows(terrains: &Terrains) -> Table {
    let each = terrains.rows.rows.iter().enumerate().map(|(index, row)| {
        vec![
            (index + 1).to_string(),
            signed(row.normal.x, 0),
            signed(row.normal.y, 0),
            format!("{:.4}", row.lever_m),
            terrains.rows.constraints(index + 1, None).rank.to_string(),
        ]
    });
    Table::exported(
        "rows",
        "Rows of H",
        &["row", "n_x", "n_y", "p × n (m)", "rank so far"],
        each.collect(),
    )
}

/// Start and result of each dropped sweep.
fn dropped(rests: &Rests) -> Table {
    let rows = rests.ends_m().enumerate().map(|(number, [start, rest])| {
        let numbers = [start, rest].concat();
        let shown = numbers.iter().map(|m| format!("{m:.4}"));
        core::iter::once(number.to_string()).chain(shown).collect()
    });
    Table::exported(
        "rests",
        "Where the dropped sweeps settle",
        &[
            "sweep",
            "dropped Δx (m)",
            "dropped Δy (m)",
            "rests Δx (m)",
            "rests Δy (m)",
        ],
        rows.collect(),
    )
}

/// The pairs at the crosshair, and those that are about to change.
fn partners(terrains: &Terrains, settings: &TerraceSettings) -> Table {
    let pairing = terrains.pairing_at(settings.probe_m);
    let groups = [
        ("stays", pairing.pairs),
        ("about to change", pairing.changing),
        ("next", pairing.next),
    ];
    let rows = groups.into_iter().flat_map(|(what, pairs)| {
        pairs.into_iter().map(move |[from, to]| {
            let numbers = [from, to].concat();
            let shown = numbers.iter().map(|m| format!("{m:.4}"));
            core::iter::once(what.to_owned()).chain(shown).collect()
        })
    });
    Table::exported(
        "partners",
        "Matches at the crosshair",
        &[
            "pair",
            "point x (m)",
            "point y (m)",
            "map x (m)",
            "map y (m)",
        ],
        rows.collect(),
    )
}

/// Center and axes of every Gaussian.
fn bells(terrains: &Terrains) -> Table {
    let rows = terrains.bells().into_iter().map(|bell| {
        let [long, short] = bell.half_axes_m;
        let numbers = [bell.mean_m, long, short].concat();
        numbers.iter().map(|m| format!("{m:.4}")).collect()
    });
    Table::exported(
        "bells",
        "Bells of NDT's map",
        &[
            "middle x (m)",
            "middle y (m)",
            "long axis x (m)",
            "long axis y (m)",
            "short axis x (m)",
            "short axis y (m)",
        ],
        rows.collect(),
    )
}

fn slice(
    id: &'static str,
    title: &str,
    head: &str,
    terrains: &Terrains,
    heights: impl Fn(&Landscape) -> Vec<[f64; 2]>,
) -> Table {
    let (icp, ndt) = (heights(&terrains.icp), heights(&terrains.ndt));
    let rows = icp
        .iter()
        .zip(&ndt)
        .map(|([at, cost], [_, negative_score])| {
            vec![
                format!("{at:.4}"),
                cost.to_string(),
                (-negative_score).to_string(),
            ]
        });
    Table::exported(
        id,
        title,
        &[head, "ICP cost (m²)", "NDT score"],
        rows.collect(),
    )
}

fn way(id: &'static str, title: &str, height: &str, ball: &BallPath) -> Table {
    let rows = ball
        .path_m
        .iter()
        .zip(&ball.heights)
        .enumerate()
        .map(|(step, ([x, y], h))| {
            vec![
                step.to_string(),
                x.to_string(),
                y.to_string(),
                h.to_string(),
            ]
        });
    Table::exported(
        id,
        title,
        &["step", "Δx (m)", "Δy (m)", height],
        rows.collect(),
    )
}

fn maps(terrains: &Terrains) -> Table {
    let cells = terrains.icp.cells();
    let heights = terrains.icp.heights().iter().zip(terrains.ndt.heights());
    let rows = heights.enumerate().map(|(index, (cost, negative_score))| {
        vec![
            format!("{:.4}", shift_m(cells, index % cells)),
            format!("{:.4}", shift_m(cells, index / cells)),
            cost.to_string(),
            (-negative_score).to_string(),
        ]
    });
    let columns = ["Δx (m)", "Δy (m)", "ICP cost (m²)", "NDT score"];
    Table::exported("maps", "Both maps", &columns, rows.collect())
}
