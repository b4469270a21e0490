//! The drawing of a flat during editing: its walls with their ends, the start and the path.

use pr_geom::math;
use pr_sim::sketch::to_m;
use widget_kit::scene::{Layer, LegendEntry, Mark, Stroke, Tone};

use crate::w16_2_full_lap::model::moment::Drawn;
use crate::w16_2_full_lap::model::plan_element::PlanElement;
use crate::w16_2_full_lap::spec::Tool;

/// Distance of text from its waypoint, in pixels.
const CLEAR_PX: f32 = 12.0;

/// Stops nearer to each other than this share a name, m.
const ONE_RING_M: f64 = 0.3;

/// The walls of the drawing.
pub fn walls(drawn: &Drawn) -> Vec<[[f64; 2]; 2]> {
    let walls = drawn.sketch.walls_cm.iter();
    walls.map(|wall| wall.map(|end| end.map(to_m))).collect()
}

/// The planned path, the ends of the walls, and the selection.
pub fn layers(drawn: &Drawn) -> Vec<Layer> {
    let Drawn { sketch, tool, .. } = drawn;
    let places: Vec<_> = core::iter::once(sketch.start_cm)
        .chain(sketch.way_points_cm.iter().copied())
        .map(|at| at.map(to_m))
        .collect();
    let [x, y] = places[0];
    let heading = PlanElement::Heading.place(sketch);
    let mut layers = vec![
        Layer::line(places.clone(), Stroke::Dotted, Tone::Ink, 1.5),
        Layer::segments(vec![[places[0], heading]], Stroke::Solid, Tone::Ink, 2.5),
    ];
    let handle = |at, label| Layer::Handle {
        at,
        tone: Tone::Ink,
        label,
    };
    if tool.is_some() {
        let ends = walls(drawn).into_iter().flatten().collect();
        layers.push(Layer::points(ends, Mark::Square, Tone::Ink, 2.5));
        layers.push(handle(heading, "turn the start"));
        layers.push(handle([x, y], "move the start"));
        for at in &places[1..] {
            layers.push(handle(*at, "move the waypoint"));
        }
        layers.extend(chosen(drawn));
    } else {
        layers.push(Layer::points(places.clone(), Mark::Circle, Tone::Ink, 4.0));
    }
    let mut named = vec![(places[0], "start".to_owned())];
    for (number, at) in places.iter().enumerate().skip(1) {
        match named.iter_mut().find(|(ring, _)| is_there(ring, at)) {
            Some((_, names)) => *names += &format!(", {number}"),
            None => named.push((*at, number.to_string())),
        }
    }
    layers.extend(
        named
            .into_iter()
            .map(|(at, names)| Layer::label(at, names, CLEAR_PX)),
    );
    layers
}

/// Whether two rings are one to the eye, and share a name.
fn is_there(one: &[f64; 2], other: &[f64; 2]) -> bool {
    math::norm2(other[0] - one[0], other[1] - one[1]) < ONE_RING_M
}

/// The selection: a wide wall with a handle at each end, or a ring around a point.
fn chosen(drawn: &Drawn) -> Vec<Layer> {
    let Some(piece) = drawn.piece else {
        return Vec::new();
    };
    match piece {
        PlanElement::Wall(index) | PlanElement::FirstEnd(index) | PlanElement::SecondEnd(index) => {
            let wall = walls(drawn)[index];
            let mut layers = vec![Layer::segments(vec![wall], Stroke::Solid, Tone::Ink, 5.0)];
            let ends = [PlanElement::FirstEnd(index), PlanElement::SecondEnd(index)];
            for (end, at) in ends.into_iter().zip(wall) {
                if piece == end || matches!(piece, PlanElement::Wall(_)) {
                    layers.push(Layer::Handle {
                        at,
                        tone: Tone::Ink,
                        label: "move the end",
                    });
                }
            }
            layers
        }
        PlanElement::WayPoint(_) | PlanElement::Start | PlanElement::Heading => {
            let at = piece.place(drawn.sketch);
            vec![Layer::points(vec![at], Mark::Circle, Tone::Ink, 12.0)]
        }
    }
}

/// The legend entry of the plan.
pub fn legend() -> LegendEntry {
    LegendEntry::marked_line("the planned path", Tone::Ink, Mark::Circle, Stroke::Dotted)
}

/// `Your own flat: 18 walls, 3 waypoints`.
pub fn title(drawn: &Drawn) -> String {
    let hand = match drawn.tool {
        None => "",
        Some(Tool::Move) => ", moving",
        Some(Tool::Wall) => ", drawing walls",
        Some(Tool::Way) => ", placing waypoints",
        Some(Tool::Remove) => ", removing",
        Some(Tool::Robot) => ", setting the robot down",
    };
    format!(
        "The flat: {}{hand}",
        super::super::texts::floor_plan::counts(drawn.sketch)
    )
}
