//! The pattern of a pose graph's matrix, and what one step of the elimination order adds to its factor.

use nalgebra::Matrix3;
use pr_geom::SE2;
use pr_optim::ordering::minimum_degree;
use pr_optim::{Between, Problem};
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::{Shown, SketchSpec, Slider};

/// Keyframes of the chain.
const NODES: usize = 12;
/// The keyframe that all loops tie, and the others' ends.
const HUB: usize = 1;
const TIED: [usize; 4] = [5, 7, 9, 11];

pub(super) const SKETCH: SketchSpec = SketchSpec {
    name: "fill",
    title: "The order of elimination",
    slider: Slider {
        label: "position of the loops’ keyframe in the elimination order",
        unit: "",
        min: 1.0,
        max: NODES as f64,
        step: 1.0,
        default: 2.0,
        decimals: 0,
    },
    at,
    handle,
};

/// Its block on the diagonal.
fn handle(place: f64) -> (&'static str, [f64; 2]) {
    ("fill", entry(place as usize - 1, place as usize - 1))
}

/// The place of a block in the picture: columns to the right, rows downwards.
fn entry(row: usize, column: usize) -> [f64; 2] {
    [column as f64 + 1.0, -(row as f64) - 1.0]
}

/// The pairs of keyframes that an edge connects.
fn edges() -> Vec<[usize; 2]> {
    let chain = (1..NODES).map(|node| [node - 1, node]);
    chain.chain(TIED.map(|node| [HUB, node])).collect()
}

/// In the order of the drive, but for the hub.
fn order(place: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..NODES).filter(|node| *node != HUB).collect();
    order.insert(place - 1, HUB);
    order
}

/// The blocks below the diagonal that the factor has and the matrix has not, as rows and columns: a node that is
/// eliminated makes neighbours of its neighbours.
fn filled(order: &[usize]) -> Vec<[usize; 2]> {
    let place = |node: usize| order.iter().position(|at| *at == node).unwrap_or_default();
    let mut factor = [[false; NODES]; NODES];
    for [a, b] in edges() {
        let (a, b) = (place(a), place(b));
        factor[a.max(b)][a.min(b)] = true;
    }
    let mut filled = Vec::new();
    for column in 0..NODES {
        for row in column + 1..NODES {
            for earlier in column + 1..row {
                let meets = factor[row][column] && factor[earlier][column];
                if meets && !factor[row][earlier] {
                    factor[row][earlier] = true;
                    filled.push([row, earlier]);
                }
            }
        }
    }
    filled
}

/// The order that the solver chooses.
fn solvers_order() -> Vec<usize> {
    let mut problem = Problem::new();
    for _ in 0..NODES {
        problem.add_pose(SE2::identity());
    }
    for [from, to] in edges() {
        problem.add_factor(Between {
            from,
            to,
            measurement: SE2::identity(),
            information: Matrix3::identity(),
        });
    }
    let order = minimum_degree(&problem);
    order.into_iter().map(|node| node as usize).collect()
}

fn at(place: f64) -> Shown {
    let place = (place as usize).clamp(1, NODES);
    let order = order(place);
    let filled = filled(&order);
    Shown {
        sentence: format!(
            "At position {place}, the keyframe fills in {} blocks. The solver’s own order, approximate minimum degree, fills in {}.",
            filled.len(),
            self::filled(&solvers_order()).len()
        ),
        scene: Scene {
            panels: vec![picture(place, &order, &filled)],
        },
    }
}

fn picture(place: usize, order: &[usize], filled: &[[usize; 2]]) -> Panel {
    let at = |node: usize| {
        order
            .iter()
            .position(|one| *one == node)
            .unwrap_or_default()
    };
    let both = |row: usize, column: usize| [entry(row, column), entry(column, row)];
    let (chain, loops): (Vec<_>, Vec<_>) = edges().into_iter().partition(|[a, b]| a + 1 == *b);
    let blocks = |edges: Vec<[usize; 2]>| -> Vec<[f64; 2]> {
        edges
            .into_iter()
            .flat_map(|[a, b]| both(at(a), at(b)))
            .collect()
    };
    let diagonal = (0..NODES).map(|k| entry(k, k));
    let size = NODES as f64;
    Panel {
        id: "fill",
        title: format!("The matrix, and {} more blocks in its factor", filled.len()),
        weight: Weight::Main,
        aspect: Aspect::Equal,
        x: Axis::hidden(-5.0, size + 6.0),
        y: Axis::hidden(-size - 0.6, -0.4),
        layers: vec![
            Layer::points(diagonal.collect(), Mark::Square, Tone::Truth, 5.0),
            Layer::points(blocks(chain), Mark::Square, Tone::Posterior, 5.0),
            Layer::points(blocks(loops), Mark::Cross, Tone::Measurement, 5.0),
            Layer::points(
                filled
                    .iter()
                    .map(|[row, column]| entry(*row, *column))
                    .collect(),
                Mark::Triangle,
                Tone::Prediction,
                5.0,
            ),
            Layer::segments(
                vec![[[0.4, -(place as f64)], [size + 0.6, -(place as f64)]]],
                Stroke::Dotted,
                Tone::Ink,
                1.0,
            ),
        ],
        legend: vec![
            LegendEntry::mark("itself", Tone::Truth, Mark::Square),
            LegendEntry::mark("next keyframe", Tone::Posterior, Mark::Square),
            LegendEntry::mark("loop", Tone::Measurement, Mark::Cross),
            LegendEntry::mark("fill-in of the factor", Tone::Prediction, Mark::Triangle),
        ],
        color_bar: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_keyframe_of_all_loops_fills_most_if_it_is_eliminated_first_and_least_if_last() {
        let counts: Vec<usize> = (1..=NODES)
            .map(|place| filled(&order(place)).len())
            .collect();
        let (first, last) = (counts[0], counts[NODES - 1]);
        assert!(first >= 2 * last.max(1), "{counts:?}");
        assert!(
            counts.iter().all(|count| (last..=first).contains(count)),
            "{counts:?}"
        );
        assert!(filled(&solvers_order()).len() <= last, "{counts:?}");
    }

    /// The pattern of a dense elimination with numbers: an entry is filled if it is not zero any more.
    #[test]
    fn the_filled_blocks_are_those_of_a_factorization() {
        for place in [1, 4, NODES] {
            let order = order(place);
            let at = |node: usize| order.iter().position(|one| *one == node).unwrap();
            let mut matrix = nalgebra::DMatrix::<f64>::identity(NODES, NODES) * 20.0;
            for [a, b] in edges() {
                matrix[(at(a), at(b))] = -1.0;
                matrix[(at(b), at(a))] = -1.0;
            }
            let factor = matrix.clone().cholesky().unwrap().l();
            let expected: Vec<[usize; 2]> = (0..NODES)
                .flat_map(|row| (0..row).map(move |column| [row, column]))
                .filter(|[row, column]| factor[(*row, *column)] != 0.0)
                .filter(|[row, column]| matrix[(*row, *column)] == 0.0)
                .collect();
            let mut found = filled(&order);
            found.sort_unstable();
            assert_eq!(found, expected);
        }
    }
}
