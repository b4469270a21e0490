//! The flat with both robots: where each of them stood, and what it saw from there.

use widget_kit::scene::{Axis, Layer, Mark, Panel, Stroke, Tone, Weight};

use super::super::texts::pair_title;
use super::super::{PlaceRecognition, panel};
use super::{NOW, OTHER, SAME, THEN, empty};

/// Space around the walls, m.
const MARGIN_M: f64 = 0.15;

pub fn panel(been: &PlaceRecognition) -> Panel {
    let world = &been.config.drive.world;
    let bounds = world.bounds();
    let wall = |wall: &pr_sim::Wall| [[wall.start.x, wall.start.y], [wall.end.x, wall.end.y]];
    let mut panel = Panel {
        weight: Weight::Main,
        x: Axis::hidden(bounds.min.x - MARGIN_M, bounds.max.x + MARGIN_M),
        y: Axis::hidden(bounds.min.y - MARGIN_M, bounds.max.y + MARGIN_M),
        layers: vec![Layer::Walls(world.walls().iter().map(wall).collect())],
        ..empty(panel::FLAT, "A robot drives through the Apartment and back")
    };
    let Some((places, pair)) = been.places.as_ref().zip(been.pair()) else {
        return panel;
    };
    let study = &places.study;
    panel.title = pair_title(been);
    let stood = study
        .places()
        .iter()
        .map(|place| [place.truth.x(), place.truth.y()]);
    panel
        .layers
        .push(Layer::points(stood.collect(), Mark::Dot, Tone::Truth, 2.0));
    let robots = pair.into_iter().zip([(THEN, "then"), (NOW, "now")]);
    let mut ends = [[0.0; 2]; 2];
    let mut on_top = Vec::new();
    for (k, (node, (tone, name))) in robots.enumerate() {
        let place = &study.places()[node];
        let at = [place.truth.x(), place.truth.y()];
        let seen = place.scan.transformed(&place.truth);
        let hits: Vec<_> = seen.iter().map(|hit| [hit.x, hit.y]).collect();
        let mark = [Mark::Cross, Mark::Square][k];
        panel.layers.push(Layer::Seen {
            from: at,
            points: hits.clone(),
            tone,
        });
        on_top.extend([
            Layer::points(hits, mark, tone, 2.4),
            Layer::Handle {
                at,
                tone,
                label: "drag the robot along its path",
            },
            Layer::pose(place.truth.to_array(), mark, tone, 6.0),
            Layer::label(at, name.to_owned(), 12.0),
        ]);
        ends[k] = at;
    }
    if !been.asks
        && study.is_loop(pair)
        && let Some(judged) = study.pair(pair[0], pair[1])
        && judged.distances[been.detector()] <= been.threshold(been.detector())
    {
        // What the detector claims: both stand at one place.
        let tone = if judged.is_same { SAME } else { OTHER };
        panel
            .layers
            .push(Layer::segments(vec![ends], Stroke::Dashed, tone, 3.0));
    }
    panel.layers.extend(on_top);
    panel
}
