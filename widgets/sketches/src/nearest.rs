//! A nearest-neighbour query: the points that a hash grid compares, and those of a tree that grows with its
//! map.

use std::sync::OnceLock;

use ch16_lab::lap::{LapConfig, LapRunner};
use ch16_slam2d::cloud::{PointCloud, VoxelMap};
use ch16_slam2d::prelude::Point2;
use widget_kit::plural::plural;
use widget_kit::scene::{
    Aspect, Axis, Bounds, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::{Shown, SketchSpec, Slider};

/// Width of a cell, and largest distance of a partner, m.
const TAU_M: f64 = 0.5;
/// Largest number of points in a cell.
const MAX_IN_A_CELL: usize = 20;
/// The query point, m, in the world's frame: near a wall that the first sweep sees.
const QUERY: [f64; 2] = [1.3, 3.65];
/// Half the side of the picture of the cells, m.
const NEAR_M: f64 = 1.25;

pub(super) const SKETCH: SketchSpec = SketchSpec {
    name: "nearest",
    title: "One query in a growing map",
    slider: Slider {
        label: "sweeps in the map",
        unit: "",
        min: 1.0,
        max: 41.0,
        step: 1.0,
        default: 8.0,
        decimals: 0,
    },
    at,
    handle,
};

/// The sweeps of the canonical lap's keyframes, at their final poses in the graph.
fn sweeps() -> &'static [PointCloud] {
    &lap().0
}

/// The sweeps, and where they were sensed.
fn lap() -> &'static (Vec<PointCloud>, Vec<[f64; 2]>) {
    static FOUND: OnceLock<(Vec<PointCloud>, Vec<[f64; 2]>)> = OnceLock::new();
    FOUND.get_or_init(|| {
        let record = LapRunner::new().run(&LapConfig::default());
        let poses = &record.lap.epochs.last().expect("a lap has poses").poses;
        let placed = record.lap.keyframes.iter().zip(poses);
        placed
            .map(|(keyframe, pose)| {
                let sweep = record.drive.sweep(keyframe.tick).cloud.transformed(pose);
                (sweep, [pose.x(), pose.y()])
            })
            .unzip()
    })
}

/// Where the newest sweep was sensed.
fn handle(sweeps: f64) -> (&'static str, [f64; 2]) {
    let places = &lap().1;
    ("cuts", places[(sweeps as usize).clamp(1, places.len()) - 1])
}

/// A k-d tree: each inner node splits the plane at its own point, by x and y in turn.
///
/// A new point becomes a leaf (Bentley 1975); the tree is never rebalanced.
#[derive(Default)]
struct Tree {
    points: Vec<[f64; 2]>,
    /// The children of each node, before and beyond its split.
    below: Vec<[Option<usize>; 2]>,
    /// The deepest leaf, and its level.
    deepest: usize,
    levels: usize,
}

impl Tree {
    fn insert(&mut self, point: [f64; 2]) {
        let new = self.points.len();
        self.points.push(point);
        self.below.push([None; 2]);
        let (mut node, mut level) = (0, 1);
        while node != new {
            let side = self.side(node, level % 2, point);
            node = *self.below[node][side].get_or_insert(new);
            level += 1;
        }
        if level > self.levels {
            (self.deepest, self.levels) = (new, level);
        }
    }

    /// The side of a node's split on which a point lies; the root's level, the first, splits x.
    fn side(&self, node: usize, parity: usize, point: [f64; 2]) -> usize {
        let axis = 1 - parity;
        usize::from(point[axis] >= self.points[node][axis])
    }

    /// The splits from the root to the deepest leaf, each as long as the region that it splits.
    fn cuts_to_the_deepest(&self, mut within: Bounds) -> Vec<[[f64; 2]; 2]> {
        let goal = self.points[self.deepest];
        let (mut node, mut axis, mut cuts) = (0, 0, Vec::new());
        while node != self.deepest {
            let at = self.points[node][axis];
            let [mut from, mut to] = [within.min, within.max];
            (from[axis], to[axis]) = (at, at);
            cuts.push([from, to]);
            let side = self.side(node, 1 - axis, goal);
            let end = if side == 0 {
                &mut within.max
            } else {
                &mut within.min
            };
            end[axis] = at;
            node = self.below[node][side].expect("the leaf hangs below");
            axis = 1 - axis;
        }
        cuts
    }

    /// The point nearest to `query` if one is closer than τ, and the number of compared points.
    fn nearest(&self, query: [f64; 2]) -> (Option<usize>, usize) {
        let (mut best, mut compared) = ((TAU_M * TAU_M, None), 0);
        // Nodes to visit: a node, the axis that it splits, and a lower bound of the distance to its side.
        let mut open = vec![(0, 0, 0.0)];
        while let Some((node, axis, least_m2)) = open.pop() {
            if least_m2 >= best.0 {
                continue;
            }
            compared += 1;
            let point = self.points[node];
            let (dx, dy) = (point[0] - query[0], point[1] - query[1]);
            if dx * dx + dy * dy < best.0 {
                best = (dx * dx + dy * dy, Some(node));
            }
            let near = self.side(node, 1 - axis, query);
            let beyond_m = query[axis] - point[axis];
            for (side, least_m2) in [(1 - near, beyond_m * beyond_m), (near, 0.0)] {
                if let Some(next) = self.below[node][side] {
                    open.push((next, 1 - axis, least_m2));
                }
            }
        }
        (best.1, compared)
    }
}

/// The map after a number of sweeps, in both forms.
struct Grown {
    map: VoxelMap,
    tree: Tree,
}

impl Grown {
    fn with_count(count: usize) -> Self {
        let mut map = VoxelMap::new(TAU_M, MAX_IN_A_CELL);
        sweeps()
            .iter()
            .take(count)
            .for_each(|sweep| map.insert_cloud(sweep));
        let mut tree = Tree::default();
        map.points()
            .iter()
            .for_each(|point| tree.insert([point.x, point.y]));
        Self { map, tree }
    }

    /// The points of the nine cells around the query.
    fn compared(&self) -> Vec<[f64; 2]> {
        let block = block();
        let is_inside = |point: &Point2<f64>| {
            (block.min[0]..block.max[0]).contains(&point.x)
                && (block.min[1]..block.max[1]).contains(&point.y)
        };
        let points = self.map.points().iter().filter(is_inside);
        points.map(|point| [point.x, point.y]).collect()
    }

    /// Levels of a balanced tree over these points.
    fn fewest_levels(&self) -> u32 {
        usize::BITS - self.tree.points.len().leading_zeros()
    }
}

/// The area of all sweeps of the lap, with a margin of half a metre.
fn bounds() -> Bounds {
    let mut bounds = Bounds {
        min: QUERY,
        max: QUERY,
    };
    for point in sweeps().iter().flat_map(PointCloud::iter) {
        for (axis, at) in [point.x, point.y].into_iter().enumerate() {
            bounds.min[axis] = bounds.min[axis].min(at - 0.5);
            bounds.max[axis] = bounds.max[axis].max(at + 0.5);
        }
    }
    bounds
}

/// The cell of the query and those around it.
fn block() -> Bounds {
    let first = QUERY.map(|at| TAU_M * ((at / TAU_M).floor() - 1.0));
    Bounds {
        min: first,
        max: first.map(|at| at + 3.0 * TAU_M),
    }
}

fn at(sweeps: f64) -> Shown {
    let count = sweeps as usize;
    let grown = Grown::with_count(count);
    let compared = grown.compared();
    let (_, asked) = grown.tree.nearest(QUERY);
    Shown {
        sentence: format!(
            "{sweeps}, {points} points. The query compares {compared} points, from nine cells. The tree compares {asked}, but one leaf is {levels} levels down, where {fewest} would do.",
            sweeps = plural(count, "sweep"),
            points = grown.tree.points.len(),
            compared = compared.len(),
            levels = grown.tree.levels,
            fewest = grown.fewest_levels(),
        ),
        scene: Scene {
            panels: vec![cells(&grown, compared), cuts(&grown)],
        },
    }
}

fn dots(grown: &Grown) -> Layer {
    Layer::points(grown.tree.points.clone(), Mark::Dot, Tone::Ink, 1.5)
}

fn query() -> Layer {
    Layer::points(vec![QUERY], Mark::Circle, Tone::Prior, 6.0)
}

fn segments(segments: Vec<[[f64; 2]; 2]>, stroke: Stroke, tone: Tone) -> Layer {
    Layer::segments(segments, stroke, tone, 1.5)
}

fn cells(grown: &Grown, compared: Vec<[f64; 2]>) -> Panel {
    let block = block();
    let lines = (0..=3).flat_map(|k| {
        let along = |axis: usize| block.min[axis] + f64::from(k) * TAU_M;
        let (x, y) = (along(0), along(1));
        [
            [[x, block.min[1]], [x, block.max[1]]],
            [[block.min[0], y], [block.max[0], y]],
        ]
    });
    let middle = block.middle();
    Panel {
        id: "cells",
        title: format!("The hash: {} compared", compared.len()),
        weight: Weight::Half,
        aspect: Aspect::Equal,
        x: Axis::new("x (m)", middle[0] - NEAR_M, middle[0] + NEAR_M),
        y: Axis::new("y (m)", middle[1] - NEAR_M, middle[1] + NEAR_M),
        layers: vec![
            segments(lines.collect(), Stroke::Solid, Tone::Prediction),
            dots(grown),
            Layer::points(compared, Mark::Square, Tone::Posterior, 3.0),
            query(),
        ],
        legend: vec![
            LegendEntry::mark("query", Tone::Prior, Mark::Circle),
            LegendEntry::mark("map", Tone::Ink, Mark::Dot),
            LegendEntry::mark("compared", Tone::Posterior, Mark::Square),
            LegendEntry::line("nine cells", Tone::Prediction, Stroke::Solid),
        ],
        color_bar: None,
    }
}

fn cuts(grown: &Grown) -> Panel {
    let Bounds { min, max } = bounds();
    let leaf = grown.tree.points[grown.tree.deepest];
    let cuts = grown.tree.cuts_to_the_deepest(bounds());
    Panel {
        id: "cuts",
        title: format!("The tree: {} levels", grown.tree.levels),
        weight: Weight::Half,
        aspect: Aspect::Equal,
        x: Axis::new("x (m)", min[0], max[0]),
        y: Axis::new("y (m)", min[1], max[1]),
        layers: vec![
            dots(grown),
            segments(cuts, Stroke::Solid, Tone::Prediction),
            Layer::points(vec![leaf], Mark::Square, Tone::Posterior, 5.0),
            query(),
        ],
        legend: vec![
            LegendEntry::mark("deepest leaf", Tone::Posterior, Mark::Square),
            LegendEntry::line("cuts on the way to it", Tone::Prediction, Stroke::Solid),
        ],
        color_bar: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tree_and_the_map_find_the_same_neighbour() {
        let grown = Grown::with_count(20);
        let mut answers = 0;
        for k in 0..400 {
            let query = Point2::new(0.37 * f64::from(k % 20), 0.29 * f64::from(k / 20));
            let (found, _) = grown.tree.nearest([query.x, query.y]);
            let off_m = |index: usize| (grown.map.points().point(index) - query).norm();
            let by_map = grown.map.nearest(&query, TAU_M);
            assert_eq!(found.map(off_m), by_map.map(|index| off_m(index as usize)));
            answers += usize::from(found.is_some());
        }
        assert!(answers > 50, "{answers}");
    }

    /// The claims of the section: a query of nine cells costs the same in a large map, and a tree that only
    /// gets leaves is unbalanced.
    #[test]
    fn the_map_grows_and_the_nine_cells_do_not_while_the_tree_gets_lopsided() {
        let (few, all) = (Grown::with_count(8), Grown::with_count(41));
        let points = |grown: &Grown| grown.tree.points.len();
        assert!(
            points(&all) > 2 * points(&few),
            "{} {}",
            points(&few),
            points(&all)
        );
        assert!(all.compared().len() <= 9 * MAX_IN_A_CELL);
        assert!(all.compared().len() < 2 * few.compared().len());
        assert_eq!(
            all.tree.cuts_to_the_deepest(bounds()).len(),
            all.tree.levels - 1
        );
        assert!(all.tree.levels > few.tree.levels);
        let fewest = all.fewest_levels() as usize;
        assert!(all.tree.levels > 2 * fewest, "{} {fewest}", all.tree.levels);
    }

    #[test]
    fn the_partner_lies_in_the_nine_cells() {
        for count in [1, 8, 41] {
            let grown = Grown::with_count(count);
            let (found, _) = grown.tree.nearest(QUERY);
            let partner = grown.tree.points[found.expect("a wall is near")];
            assert!(grown.compared().contains(&partner), "{count}");
        }
    }
}
