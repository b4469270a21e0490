//! The result in words and numbers.

use widget_kit::model::{Assessment, Fact, Outcome};
use widget_kit::ticks::signed;

use super::landscape::{BallPath, End};
use super::rests::{Rests, Scatter};
use super::settings::TerraceSettings;
use super::terrains::Terrains;
use crate::w16_3_cost_terraces::spec::SweepPlace;

/// The results of the balls, with the numbers.
pub fn outcome(terrains: &Terrains, rests: &Rests, settings: &TerraceSettings) -> Outcome {
    let (icp, ndt) = (&terrains.icp.ball, &terrains.ndt.ball);
    let (standing, verdict) = match (icp.is_home(), ndt.is_home()) {
        (true, true) => (Assessment::Good, "both arrive"),
        (false, true) => (Assessment::Bad, "ICP sticks"),
        (true, false) => (Assessment::Bad, "NDT sticks"),
        (false, false) => (Assessment::Bad, "both stick"),
    };
    let mut sentence = format!(
        "Dropped at {}, ICP's ball {}. NDT's ball {}.",
        shift(settings.probe_m),
        rest(icp),
        rest(ndt),
    );
    if terrains.rows_taken() < terrains.rows.rows.len() || settings.odometry_m.is_some() {
        sentence += &format!(" {}.", row_in_words(terrains));
    }
    let scatter = rests.scatter();
    if scatter.count > 1 {
        let [x, y] = scatter.deviation_m.map(|m| 100.0 * m);
        sentence += &format!(
            " {} sweeps scatter by {x:.1} cm along x, {y:.1} cm along y.",
            scatter.count
        );
    }
    Outcome {
        standing,
        verdict: verdict.to_owned(),
        sentence,
        facts: facts(terrains, &scatter, settings),
    }
}

/// The last row, and the constraints of all rows so far.
pub fn row_in_words(terrains: &Terrains) -> String {
    let (taken, constraints) = (terrains.rows_taken(), terrains.row_constraints());
    let row = match taken.checked_sub(1).map(|last| terrains.rows.rows[last]) {
        Some(row) => format!(
            "Row {taken} of {}: ({}, {}, {} m)",
            terrains.rows.rows.len(),
            signed(row.normal.x, 0),
            signed(row.normal.y, 0),
            signed(row.lever_m, 2)
        ),
        None => "No row".to_owned(),
    };
    let held = match constraints.along_m {
        Some(along_m) => format!(", x known to {:.1} cm", 100.0 * along_m),
        None => String::new(),
    };
    format!("{row}; rank {}{held}", constraints.rank)
}

/// A shift as text, with true minus signs.
fn shift([x, y]: [f64; 2]) -> String {
    format!("({}, {}) m", signed(x, 2), signed(y, 2))
}

fn rest(ball: &BallPath) -> String {
    let (steps, distance) = (ball.steps(), ball.rest_distance_m());
    match ball.end {
        End::Rests if ball.is_home() => format!("arrives after {steps} steps"),
        End::Rests => format!("stops {distance:.2} m from the truth after {steps} steps"),
        End::OutOfSteps => {
            format!("is still rolling {distance:.2} m from the truth after {steps} steps")
        }
    }
}

fn facts(terrains: &Terrains, scatter: &Scatter, settings: &TerraceSettings) -> Vec<Fact> {
    let off = |label: &'static str, id, [x, y]: [f64; 2]| {
        Fact::new(id, label, pr_geom::math::norm2(x, y), "m", 3)
    };
    let (icp, ndt, hold) = (&terrains.icp, &terrains.ndt, &terrains.information);
    let [firm, loose] = hold.eigenvalues_per_cm2;
    let constraints = terrains.row_constraints();
    let known = |label, id, value| Fact::new(id, label, value, "1/cm²", 2);
    let mut facts = vec![
        Fact::new(
            "icp_cost_m2",
            "ICP cost at the crosshair",
            icp.at_probe(),
            "m²",
            4,
        ),
        Fact::new(
            "ndt_score",
            "NDT score at the crosshair",
            -ndt.at_probe(),
            "",
            3,
        ),
        off("ICP's ball ends off by", "icp_rest_m", icp.ball.end_m()),
        off("NDT's ball ends off by", "ndt_rest_m", ndt.ball.end_m()),
        off("ICP's lowest cell is off by", "icp_lowest_m", icp.lowest_m),
        off("NDT's lowest cell is off by", "ndt_lowest_m", ndt.lowest_m),
        known(
            "information, firmest direction",
            "information_firm_per_cm2",
            firm,
        ),
        known(
            "information, loosest direction",
            "information_loose_per_cm2",
            loose,
        ),
        Fact::new(
            "loose_direction_deg",
            "loosest direction, from x",
            hold.directions_deg[1],
            "°",
            0,
        ),
        Fact::new(
            "information_rank",
            "rank with the heading",
            hold.rank as f64,
            "",
            0,
        ),
        Fact::count("rows", "rows taken", terrains.rows_taken() as f64),
        Fact::count("rows_rank", "their rank", constraints.rank as f64),
        Fact::count(
            "partners_changing",
            "matches about to change",
            terrains.pairing_at(settings.probe_m).points.len() as f64,
        ),
        Fact::count("bells", "NDT's bells", terrains.bells().len() as f64),
        Fact::count("rests", "sweeps dropped", scatter.count as f64),
    ];
    if let Some(null) = constraints.null {
        facts.extend([
            Fact::new("null_x", "unconstrained: shift along x", null.x, "m", 3),
            Fact::new("null_y", "unconstrained: shift along y", null.y, "m", 3),
            Fact::new("null_turn", "unconstrained: heading", null.z, "rad", 3),
        ]);
    }
    if let Some(along_m) = constraints.along_m {
        facts.push(Fact::metres("rows_along_m", "rows: x known to", along_m));
    }
    if scatter.count > 1 {
        let [x, y] = scatter.deviation_m.map(|m| 100.0 * m);
        facts.extend([
            Fact::new(
                "rests_std_x_cm",
                "final positions scatter along x",
                x,
                "cm",
                2,
            ),
            Fact::new(
                "rests_std_y_cm",
                "final positions scatter along y",
                y,
                "cm",
                2,
            ),
        ]);
    }
    facts
}

/// The picture in words.
pub fn summary(terrains: &Terrains, settings: &TerraceSettings) -> String {
    let place = match settings.place {
        SweepPlace::Room => "a room, over its own points",
        SweepPlace::Corridor => "a corridor without doors, over a map with independent noise",
        SweepPlace::OwnCorridor => "the Apartment's corridor, over its own points",
    };
    let (icp, ndt) = (&terrains.icp, &terrains.ndt);
    format!(
        "Two reliefs over {cells} by {cells} shifts of a sweep in {place}, up to 1.3 metres from the truth: \
         ICP's cost up to {icp_high:.3} square metres, and NDT's score up to {ndt_high:.3}. \
         At the crosshair the cost is {cost:.4} square metres and the score {score:.3}, and {changing} points are about to change their match.",
        cells = settings.cells,
        icp_high = icp.range[1],
        ndt_high = -ndt.range[0],
        cost = icp.at_probe(),
        score = -ndt.at_probe(),
        changing = terrains.pairing_at(settings.probe_m).points.len(),
    )
}
