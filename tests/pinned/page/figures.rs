//! Names of printed numbers, and their computation by the core.
//!
//! A name is a path: `basin.p2l.180.rmse` registers from 180° with point to plane and reads the RMSE. Two
//! names with a slash between them are a quotient. So a new sentence needs a new name, seldom new code here.

mod alignment;
pub mod attempts;
mod ball;
pub mod basin;
mod consistency;
mod corridor;
mod drift;
mod drops;
mod graph;
mod jacobians;
mod lap;
mod loops;
mod moving_box;
mod ndt;
mod places;
mod procrustes;
pub mod recorded;
mod robots;
mod rows;
mod rule;
mod search;
mod setup;
mod shared;
mod sweep;
mod terrain;

use std::sync::OnceLock;

use ch16_lab::basin::BasinScene;
use ch16_lab::lap::{LapRecord, LapRunner};

use shared::Shared;

/// The value of the core of that name; `None` if it is unknown.
pub fn value(name: &str) -> Option<f64> {
    if let Some((above, below)) = name.split_once('/') {
        return Some(value(above)? / value(below)?);
    }
    let path: Vec<&str> = name.split('.').collect();
    match path.as_slice() {
        ["world", what] => setup::world(what),
        ["setup", what @ ..] => setup::value(what),
        ["gate", what] => setup::gate(what),
        ["example", "points", what] => alignment::value(what),
        ["example", "poses", what] => graph::value(what),
        ["basin", what @ ..] => basin::value(basin(), what),
        ["attempts", what @ ..] => attempts::value(what),
        ["corridor", what @ ..] => corridor::value(what),
        ["consistency", "seeds"] => Some(f64::from(consistency::SEEDS)),
        ["rule", what] => rule::value(what),
        ["drift", path, edges] => drift::rejected_percent(path, edges),
        ["ndt", "hessian", what] => ndt::hessian(what),
        ["ndt", start, what] => ndt::value(start, what),
        ["procrustes", what @ ..] => procrustes::value(what),
        ["jacobians", what @ ..] => jacobians::value(what),
        ["box", what @ ..] => moving_box::value(what),
        ["places", "setup", what] => places::setup(what),
        ["places", world, what @ ..] => places::GradedWorld::shared(world)?.value(what),
        ["search", case, what] => search::value(basin(), case, what),
        ["terrain", what @ ..] => terrain::value(what),
        ["rows", what @ ..] => rows::value(what),
        ["drops", what @ ..] => drops::value(what),
        ["ball", place, objective, reach_cm, dx_cm, dy_cm, "rest_m"] => {
            ball::rest_m(place, objective, [reach_cm, dx_cm, dy_cm])
        }
        ["grid", run, what] => lap::grid(lap_named(run)?, what),
        ["lap", run, what @ ..] => lap::value(lap_named(run)?, what),
        ["robots", row, column] => robots::value(row, column),
        ["worlds", what @ ..] => crate::worlds::value(what),
        ["sweep", "seeds"] => Some(sweep::SEEDS.count() as f64),
        ["consistency" | "sweep", ..] => recorded::value(name),
        _ => None,
    }
}

fn basin() -> &'static BasinScene {
    static BASIN: OnceLock<BasinScene> = OnceLock::new();
    BASIN.get_or_init(BasinScene::new)
}

fn lap_named(name: &str) -> Option<&'static LapRecord> {
    static LAPS: Shared<LapRecord> = Shared::new();
    LAPS.get(name, || Some(LapRunner::new().run(&lap::config(name)?)))
}
