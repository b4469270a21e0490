//! The window from above: the best score of each position, and the open boxes over it.

use ch16_lab::whole_window::SeenBox;
use ch16_slam2d::search::PoseBox;
use pr_geom::SE2;
use widget_kit::scene::{
    Aspect, Axis, Bounds, Layer, LegendEntry, Mark, Panel, Raster, RasterCell, Stroke, Tone, Weight,
};

use super::super::texts::now;
use super::super::{WholeWindow, panel};
use super::bounds::is_dropped;
use super::{icp_now, icp_path, sensor};

/// Colour of boxes whose best possible score is below one that was found.
pub const THROWN_AWAY: Tone = Tone::Ink;

/// Margin around the window as a share of its width.
const MARGIN: f64 = 0.06;

pub fn panel(window: &WholeWindow) -> Panel {
    let search = &window.search_task.window;
    let moment = &search.moments()[window.step()];
    let [low, high] = search.search().extent_m();
    let margin = MARGIN * (high[0] - low[0]);
    let mut layers = vec![Layer::Raster(raster(window))];
    layers.extend(boxes_now(window));
    layers.extend(looked_at(window));
    layers.push(sensor(window.scene.truth(), Mark::Plus, Tone::Truth));
    layers.push(sensor(window.guess(), Mark::Circle, Tone::Prior));
    if let Some(icp) = icp_now(window) {
        layers.push(icp_path(window));
        layers.push(sensor(icp, Mark::Dot, Tone::Series(2)));
    }
    if let Some(runner_up) = moment.runner_up {
        layers.push(sensor(runner_up.pose, Mark::Triangle, Tone::Series(1)));
    }
    if moment.best.is_some() {
        layers.push(sensor(window.shown_pose(), Mark::Square, Tone::Posterior));
    }
    Panel {
        id: panel::PLACES,
        title: format!("{}; more ink, better fit", now(window)),
        weight: Weight::Half,
        aspect: Aspect::Equal,
        x: Axis::hidden(low[0] - margin, high[0] + margin),
        y: Axis::hidden(low[1] - margin, high[1] + margin),
        layers,
        legend: vec![
            LegendEntry::line("box", Tone::Series(0), Stroke::Solid),
            LegendEntry::line("opened", Tone::Series(3), Stroke::Solid),
            LegendEntry::mark("best", Tone::Posterior, Mark::Square),
            LegendEntry::mark("runner-up", Tone::Series(1), Mark::Triangle),
        ],
        color_bar: None,
    }
}

/// The boxes, those dropped as a trace behind those that are not.
pub fn boxes_now(window: &WholeWindow) -> Vec<Layer> {
    let all = window.search_task.window.boxes();
    let step = window.step();
    let dropped = all.iter().filter(|seen| is_dropped(seen, step));
    let waiting = all.iter().filter(|seen| seen.waits_after(step));
    let mut layers = vec![
        boxes(dropped.clone().map(|seen| &seen.poses), THROWN_AWAY, 0.5),
        boxes(waiting.map(|seen| &seen.poses), Tone::Series(0), 1.8),
    ];
    if step == window.boxes_taken()
        && let Some(best) = window.search_task.window.moments()[step].best
    {
        // One of the best pose's place, with other headings, would look as if that were thrown away.
        let elsewhere = dropped.filter(|seen| !is_over(&seen.poses, best.pose));
        let largest = elsewhere.max_by(|a, b| width_m(a).total_cmp(&width_m(b)));
        layers.extend(largest.into_iter().flat_map(|SeenBox { poses, .. }| {
            let words = format!("scores at most {:.2}, best {:.2}", poses.bound, best.score);
            [
                boxes(core::iter::once(poses), THROWN_AWAY, 2.5),
                Layer::label([poses.x_m[0], poses.y_m[1]], words, 6.0),
            ]
        }));
    }
    layers
}

/// The box looked at.
pub fn looked_at(window: &WholeWindow) -> Option<Layer> {
    let seen = window.looked_at.as_ref()?.seen;
    let poses = &window.search_task.window.boxes()[seen].poses;
    Some(boxes(core::iter::once(poses), Tone::Series(3), 2.5))
}

/// Whether a box, seen from above, contains the place of a pose.
fn is_over(PoseBox { x_m, y_m, .. }: &PoseBox, at: SE2) -> bool {
    (x_m[0]..=x_m[1]).contains(&at.x()) && (y_m[0]..=y_m[1]).contains(&at.y())
}

fn width_m(seen: &SeenBox) -> f64 {
    seen.poses.x_m[1] - seen.poses.x_m[0]
}

/// The outlines of boxes from above.
fn boxes<'a>(boxes: impl Iterator<Item = &'a PoseBox>, tone: Tone, width_px: f32) -> Layer {
    let mut points = Vec::new();
    for PoseBox { x_m, y_m, .. } in boxes {
        points.extend([
            [x_m[0], y_m[0]],
            [x_m[1], y_m[0]],
            [x_m[1], y_m[1]],
            [x_m[0], y_m[1]],
            [x_m[0], y_m[0]],
            [f64::NAN; 2],
        ]);
    }
    Layer::line(points, Stroke::Solid, tone, width_px)
}

/// Paper for no fit, ink for a perfect one.
fn raster(window: &WholeWindow) -> Raster {
    let (surface, search) = (
        &window.search_task.surface,
        window.search_task.window.search(),
    );
    let [rows, columns] = search.places();
    let [min, max] = search.extent_m();
    let cells = surface.by_place().iter();
    Raster {
        bounds: Bounds { min, max },
        columns,
        rows,
        cells: cells
            .map(|score| RasterCell::Occupancy(*score as f32))
            .collect(),
        // Surfaces of two searches may have equally many rows.
        revision: (window.searches << 32) + surface.rows_done() as u64,
    }
}
