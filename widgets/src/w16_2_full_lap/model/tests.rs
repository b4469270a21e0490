//! The widget without its picture, against the laps of the library and the claims of its texts.

mod both_gates;
mod floor_plan;
mod layers;
mod own;
mod parts;
mod playing;
mod reference;
mod settings;
mod worlds;

use widget_kit::model::{Assessment, Fact, text_alternative};
use widget_kit::scene::{Layer, Mark, Stroke, Tone};

use super::*;

fn fact(model: &FullLap, id: &str) -> f64 {
    let facts = model.outcome().facts;
    let find = |fact: &&Fact| fact.id == id;
    facts
        .iter()
        .find(find)
        .unwrap_or_else(|| panic!("no fact `{id}`"))
        .value
}

fn at(settings: &[(&str, f64)]) -> FullLap {
    let mut model = FullLap::default();
    for (id, value) in settings {
        model.set(id, *value).unwrap();
    }
    model.finish_work();
    model
}

fn set(model: &mut FullLap, id: &str, value: f64) {
    model.set(id, value).unwrap();
    model.finish_work();
}

fn press(model: &mut FullLap, id: &str) {
    model.press(id).unwrap();
    model.finish_work();
}

/// The results table at the end of the lap.
fn results(model: &FullLap) -> ResultsTable {
    model.runs.results_at(model.runs.ticks())
}

fn table(model: &FullLap, id: &str) -> Vec<Vec<String>> {
    let tables = model.tables();
    tables
        .into_iter()
        .find(|table| table.id == id)
        .unwrap()
        .rows
}

/// The picture as text, which is equal even if samples are NaN.
fn picture(model: &FullLap) -> String {
    format!("{:?}", model.scene())
}

/// The nodes on the map: the purple squares.
fn shown_nodes(model: &FullLap) -> Vec<[f64; 2]> {
    let scene = model.scene();
    let nodes = scene.panels[0].layers.iter().find_map(|layer| match layer {
        Layer::Points {
            points,
            mark: Mark::Square,
            tone: Tone::Posterior,
            ..
        } => Some(points.clone()),
        _ => None,
    });
    nodes.expect("the map shows the graph's nodes")
}
