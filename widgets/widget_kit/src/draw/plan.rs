//! A plan drawn as a world: floors, walls with their thickness, robots seen from above, what a sensor sees, threads.

use core::f32::consts::TAU;

use crate::palette::{self, Rgb, Theme, tone};
use crate::scene::{Mark, Tone};
use crate::surface::{Align, Pen, Px, PxRect, Surface, TextSize};
use crate::transform::Transform;

use super::marks::is_finite;

/// Thickness of a wall, m.
const WALL_M: f64 = 0.12;
/// Smallest thickness of a wall, px.
const WALL_PX: f32 = 3.0;
/// Width of the line around all walls, px.
const EDGE_PX: f32 = 1.0;
/// Half the width of a robot, m.
const ROBOT_M: f64 = 0.18;
/// Smallest half width of a robot, as a multiple of the radius of its mark.
const PER_RADIUS: f32 = 1.7;
/// Neighbouring returns of a sweep at a larger angle have nothing between them, rad.
const GAP_RAD: f32 = 0.2;
/// Opacity of what a sensor sees, at the sensor and at the returns.
const SEEN: [f32; 2] = [0.26, 0.12];
/// Opacity of an area of uncertainty, in its middle and at its edge.
const UNSURE: [f32; 2] = [0.34, 0.08];
/// A metre shorter than this is drawn as ten, px.
const LEAST_BAR_PX: f32 = 12.0;
/// Opacity of the body of a robot that is not there.
const GHOST: f32 = 0.2;

/// The floor within the walls, and the walls: first a line around all, then all fills, so that joints vanish.
pub fn walls(surface: &mut dyn Surface, walls: &[[[f64; 2]; 2]], to: &Transform, theme: Theme) {
    let walls = walls.iter().filter(|[a, b]| is_finite(a) && is_finite(b));
    let half = half_wall(to);
    let ends: Vec<[Px; 2]> = walls.map(|wall| wall.map(|end| to.to_px(end))).collect();
    if let Some(floor) = around(ends.as_flattened()) {
        surface.rect(
            within(floor.grown(half), &to.plot().grown(1.0)),
            palette::floor(theme),
        );
    }
    for (more, color) in [
        (EDGE_PX, palette::wall_edge(theme)),
        (0.0, palette::wall(theme)),
    ] {
        for end in &ends {
            surface.polygon(&band(*end, half, more), color);
        }
    }
}

/// Half the thickness of a wall, px.
fn half_wall(to: &Transform) -> f32 {
    (0.5 * WALL_M / to.units_per_px()[0]).max(0.5 * f64::from(WALL_PX)) as f32
}

/// A wall as a rectangle: it is longer by half its thickness at both ends.
fn band([a, b]: [Px; 2], half: f32, more: f32) -> [Px; 4] {
    let [x, y] = [b[0] - a[0], b[1] - a[1]];
    let length = (x * x + y * y).sqrt().max(1e-6);
    let along = [x / length, y / length].map(|part| part * (half + more));
    let across = [-along[1], along[0]];
    let corner = |at: Px, ahead: f32, aside: f32| {
        core::array::from_fn(|i| at[i] + ahead * along[i] + aside * across[i])
    };
    [
        corner(a, -1.0, -1.0),
        corner(b, 1.0, -1.0),
        corner(b, 1.0, 1.0),
        corner(a, -1.0, 1.0),
    ]
}

/// The smallest rectangle with all points.
fn around(points: &[Px]) -> Option<PxRect> {
    let first = *points.first()?;
    let [low, high] = points.iter().fold([first; 2], |[low, high], at| {
        [
            [low[0].min(at[0]), low[1].min(at[1])],
            [high[0].max(at[0]), high[1].max(at[1])],
        ]
    });
    Some(PxRect::new(
        low[0],
        low[1],
        high[0] - low[0],
        high[1] - low[1],
    ))
}

fn within(rect: PxRect, other: &PxRect) -> PxRect {
    let (left, top) = (rect.left.max(other.left), rect.top.max(other.top));
    let (right, bottom) = (
        rect.right().min(other.right()),
        rect.bottom().min(other.bottom()),
    );
    PxRect::new(left, top, (right - left).max(0.0), (bottom - top).max(0.0))
}

/// The area between a sensor and its returns.
pub fn seen(surface: &mut dyn Surface, from: Px, returns: Vec<Px>, color: Rgb) {
    let mut rays: Vec<(f32, Px)> = returns
        .into_iter()
        .map(|at| ((at[1] - from[1]).atan2(at[0] - from[0]), at))
        .collect();
    rays.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some(first) = rays.first().copied() else {
        return;
    };
    rays.push((first.0 + TAU, first.1));
    for run in rays.chunk_by(|a, b| b.0 - a.0 <= GAP_RAD) {
        let rim: Vec<Px> = run.iter().map(|(_, at)| *at).collect();
        if rim.len() > 1 {
            surface.fan(from, &rim, color, SEEN);
        }
    }
}

/// A soft area of uncertainty.
pub fn unsure(surface: &mut dyn Surface, center: Px, rim: &[Px], color: Rgb) {
    surface.fan(center, rim, color, UNSURE);
}

/// Correspondences: the longer a thread the wider and the warmer, the longest on top.
pub fn threads(
    surface: &mut dyn Surface,
    threads: &[[[f64; 2]; 2]],
    reach: f64,
    to: &Transform,
    theme: Theme,
) {
    let share = |[a, b]: &[[f64; 2]; 2]| {
        let [x, y] = [b[0] - a[0], b[1] - a[1]];
        ((x * x + y * y).sqrt() / reach.max(1e-9)).min(1.0) as f32
    };
    let finite = threads.iter().filter(|[a, b]| is_finite(a) && is_finite(b));
    let mut sorted: Vec<_> = finite.map(|thread| (share(thread), thread)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (share, thread) in sorted {
        let pen = Pen::solid(palette::thread(theme, share), 1.25 + 2.0 * share);
        surface.line(&thread.map(|end| to.to_px(end)), pen);
    }
}

/// A robot from above: body, wheels, and a lidar whose tip points ahead. All but the estimate are ghosts.
pub fn robot(
    surface: &mut dyn Surface,
    pose: [f64; 3],
    mark: Mark,
    meaning: Tone,
    radius_px: f32,
    to: &Transform,
    theme: Theme,
) {
    let at = to.to_px([pose[0], pose[1]]);
    let true_size = ROBOT_M / to.units_per_px()[0];
    let half = (true_size as f32).clamp(PER_RADIUS * radius_px, 5.0 * radius_px);
    let (sin, cos) = pose[2].sin_cos();
    let ahead = [cos as f32, -sin as f32];
    let spot = |forward: f32, left: f32| {
        [
            at[0] + half * (forward * ahead[0] + left * ahead[1]),
            at[1] + half * (forward * ahead[1] - left * ahead[0]),
        ]
    };
    let color = tone(theme, meaning);
    let paper = tone(theme, Tone::Paper);
    let is_there = mark == Mark::Square;
    let wheels = if is_there {
        tone(theme, Tone::Ink)
    } else {
        color
    };
    let body = circle(at, 0.86 * half);
    if is_there {
        surface.circle(at, half + 2.0, Some(paper), None);
    }
    for side in [-0.92, 0.92] {
        let wheel = [(-0.42, -0.14), (0.42, -0.14), (0.42, 0.14), (-0.42, 0.14)];
        let wheel = wheel.map(|(forward, left)| spot(forward, side + left));
        surface.polygon(&wheel, wheels);
    }
    let lidar = if is_there {
        surface.polygon(&body, color);
        paper
    } else {
        surface.fan(at, &body, paper, [0.7; 2]);
        surface.fan(at, &body, color, [GHOST; 2]);
        surface.line(&body, Pen::solid(color, 1.5));
        color
    };
    surface.polygon(&[spot(0.66, 0.0), spot(0.0, 0.34), spot(0.0, -0.34)], lidar);
    surface.circle(spot(-0.08, 0.0), 0.34 * half, Some(lidar), None);
}

/// A closed line around a circle.
fn circle(center: Px, radius: f32) -> Vec<Px> {
    let turns = (0..=32_u8).map(|k| (f32::from(k) / 32.0 * TAU).sin_cos());
    turns
        .map(|(sin, cos)| [center[0] + radius * cos, center[1] + radius * sin])
        .collect()
}

/// A bar at the lower left with its length: 1 m, or 10 m in a large place.
pub fn scale_bar(surface: &mut dyn Surface, to: &Transform, theme: Theme) {
    let plot = to.plot();
    let px_per_m = (1.0 / to.units_per_px()[0]) as f32;
    let metres = if px_per_m < LEAST_BAR_PX { 10 } else { 1 };
    let length = px_per_m * metres as f32;
    let words = &format!("{metres} m");
    let width = surface.text_width(words, TextSize::Small);
    if length + width + 24.0 > plot.width {
        return;
    }
    let color = tone(theme, Tone::Ink);
    let at = [plot.left + 8.0, plot.bottom() - 12.0];
    let end = [at[0] + length, at[1]];
    let back = PxRect::new(at[0] - 5.0, at[1] - 10.0, length + width + 18.0, 20.0);
    surface.rect(back, tone(theme, Tone::Paper));
    surface.line(&[at, end], Pen::solid(color, 3.0));
    surface.text(
        [end[0] + 8.0, at[1]],
        Align::Left,
        words,
        TextSize::Small,
        color,
    );
}
