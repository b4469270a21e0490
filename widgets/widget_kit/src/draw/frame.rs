//! Everything around a panel's layers: background, grid, ticks, names, colour bar, legend.

use super::marks::mark;
use super::plan;
use crate::layout::{PanelLayout, TICK, TITLE_ROW, swatch, wrap, x_ticks, y_ticks};
use crate::palette::{Theme, level_color, mix, tone};
use crate::scene::{Aspect, ColorBar, LegendEntry, Mark, Panel, Stroke, Tone};
use crate::surface::{Align, Pen, Px, PxRect, Surface, TextSize};
use crate::ticks::signed;
use crate::transform::Transform;

/// Width of the colour bar.
const BAR_WIDTH: f32 = 120.0;
/// Radius of a mark in a legend.
const MARK_RADIUS: f32 = 5.0;

/// Rows of a vertical axis that are at least this high have names in the size of the text.
const BODY_ROW_PX: f64 = 16.0;

/// Background and grid.
pub fn back(surface: &mut dyn Surface, panel: &Panel, to: &Transform, theme: Theme) {
    let plot = to.plot();
    let shown = to.shown();
    surface.rect(plot, tone(theme, Tone::Paper));
    let grid = Pen::solid(
        mix(tone(theme, Tone::Paper), tone(theme, Tone::Faint), 0.6),
        1.0,
    );
    for value in x_ticks(&panel.x, shown.min[0], shown.max[0], plot.width, surface).values {
        let x = surface.snap(to.to_px([value, 0.0])[0]);
        surface.line(&[[x, plot.top], [x, plot.bottom()]], grid);
    }
    for value in y_ticks(&panel.y, shown.min[1], shown.max[1], plot.height).values {
        let y = surface.snap(to.to_px([0.0, value])[1]);
        surface.line(&[[plot.left, y], [plot.right(), y]], grid);
    }
}

/// The words of a panel that waits for the run, in the middle of its plot.
pub fn question(surface: &mut dyn Surface, words: &str, plot: &PxRect, theme: Theme) {
    let lines = wrap(words, plot.width, TextSize::Body, surface);
    let [x, middle] = plot.center();
    let top = middle - 0.5 * TITLE_ROW * (lines.len() as f32 - 1.0);
    for (k, line) in (0_u8..).zip(&lines) {
        let at = [x, top + TITLE_ROW * f32::from(k)];
        surface.text(
            at,
            Align::Center,
            line,
            TextSize::Body,
            tone(theme, Tone::Ink),
        );
    }
}

/// Axes, ticks with labels, names, title, colour bar and legend.
pub fn front(
    surface: &mut dyn Surface,
    panel: &Panel,
    layout: &PanelLayout,
    origin: Px,
    to: &Transform,
    theme: Theme,
) {
    let ink = tone(theme, Tone::Ink);
    let quiet = tone(theme, Tone::Truth);
    for (line, y) in &layout.title {
        let at = [origin[0], origin[1] + y];
        surface.text(at, Align::Left, line, TextSize::Body, ink);
    }
    if panel.is_plan() {
        plan::scale_bar(surface, to, theme);
    } else if panel.x.is_drawn() || panel.aspect == Aspect::Free {
        axes(surface, to.plot(), Pen::solid(quiet, 1.0));
    }
    ticks(surface, panel, layout, origin, to, theme);
    if let (Some(bar), Some(y)) = (&panel.color_bar, layout.color_bar_y) {
        color_bar(surface, bar, [origin[0], origin[1] + y], theme);
    }
    for (entry, at) in panel.legend.iter().zip(&layout.legend) {
        legend_entry(
            surface,
            entry,
            [origin[0] + at[0], origin[1] + at[1]],
            theme,
        );
    }
}

/// The left and the lower edge of a plot.
fn axes(surface: &mut dyn Surface, plot: PxRect, pen: Pen) {
    let (left, right) = (surface.snap(plot.left), surface.snap(plot.right()));
    let (top, bottom) = (surface.snap(plot.top), surface.snap(plot.bottom()));
    surface.line(&[[left, top], [left, bottom], [right, bottom]], pen);
}

fn border(surface: &mut dyn Surface, plot: PxRect, pen: Pen) {
    let (left, right) = (surface.snap(plot.left), surface.snap(plot.right()));
    let (top, bottom) = (surface.snap(plot.top), surface.snap(plot.bottom()));
    surface.line(
        &[
            [left, top],
            [right, top],
            [right, bottom],
            [left, bottom],
            [left, top],
        ],
        pen,
    );
}

fn ticks(
    surface: &mut dyn Surface,
    panel: &Panel,
    layout: &PanelLayout,
    origin: Px,
    to: &Transform,
    theme: Theme,
) {
    let plot = to.plot();
    let shown = to.shown();
    let ink = tone(theme, Tone::Ink);
    let pen = Pen::solid(tone(theme, Tone::Truth), 1.0);

    let x_axis = x_ticks(&panel.x, shown.min[0], shown.max[0], plot.width, surface);
    for value in &x_axis.values {
        let x = surface.snap(to.to_px([*value, 0.0])[0]);
        surface.line(&[[x, plot.bottom()], [x, plot.bottom() + 4.0]], pen);
        let at = [x, origin[1] + layout.x_ticks_y];
        surface.text(
            at,
            Align::Center,
            &x_axis.label(*value),
            TextSize::Small,
            ink,
        );
    }
    let row_px = f64::from(plot.height) / (shown.max[1] - shown.min[1]);
    let size = if panel.y.names.is_empty() || row_px < BODY_ROW_PX {
        TextSize::Small
    } else {
        TextSize::Body
    };
    let y_axis = y_ticks(&panel.y, shown.min[1], shown.max[1], plot.height);
    for value in &y_axis.values {
        let y = surface.snap(to.to_px([0.0, *value])[1]);
        surface.line(&[[plot.left - 4.0, y], [plot.left, y]], pen);
        let at = [plot.left - TICK + 1.0, y];
        surface.text(at, Align::Right, &y_axis.label(*value), size, ink);
    }

    let at = [plot.center()[0], origin[1] + layout.x_name_y];
    surface.text(at, Align::Center, &panel.x.label, TextSize::Small, ink);
    let at = [origin[0], origin[1] + layout.y_name_y];
    surface.text(at, Align::Left, &panel.y.label, TextSize::Small, ink);
}

fn color_bar(surface: &mut dyn Surface, bar: &ColorBar, at: Px, theme: Theme) {
    let ink = tone(theme, Tone::Ink);
    let decimals = match (bar.max - bar.min).abs() {
        span if span < 0.1 => 4,
        span if span < 10.0 => 2,
        _ => 0,
    };
    let low = signed(bar.min, decimals);
    let high = format!("{} {}", signed(bar.max, decimals), bar.label);
    surface.text(at, Align::Left, &low, TextSize::Small, ink);
    let left = at[0] + surface.text_width(&low, TextSize::Small) + 6.0;
    const STRIPS: u16 = 60;
    let strip = BAR_WIDTH / f32::from(STRIPS);
    for k in 0..STRIPS {
        let x = left + strip * f32::from(k);
        // Strips overlap by a pixel to avoid a visible seam.
        let rest = (left + BAR_WIDTH - x).min(strip + 1.0);
        let color = level_color(f32::from(k) / f32::from(STRIPS - 1));
        surface.rect(PxRect::new(x, at[1] - 6.0, rest, 12.0), color);
    }
    let right = [left + BAR_WIDTH + 6.0, at[1]];
    surface.text(right, Align::Left, &high, TextSize::Small, ink);
}

fn legend_entry(surface: &mut dyn Surface, entry: &LegendEntry, at: Px, theme: Theme) {
    let color = tone(theme, entry.tone);
    let [x, y] = at;
    let swatch = swatch(entry);
    let (left, right) = (x + 1.0, x + swatch - 8.0);
    let middle = [0.5 * (left + right), y];
    if let Some(stroke) = entry.stroke {
        let pen = Pen {
            color,
            width: 2.0,
            stroke,
        };
        match (entry.mark, stroke) {
            // The dashes start at both ends, because the mark would hide those that meet in the middle.
            (Some(_), Stroke::Dashed | Stroke::Dotted) => {
                let beside = MARK_RADIUS + 1.0;
                surface.line(&[[left, y], [middle[0] - beside, y]], pen);
                surface.line(&[[right, y], [middle[0] + beside, y]], pen);
            }
            _ => surface.line(&[[left, y], [right, y]], pen),
        }
    }
    match entry.mark {
        Some(Mark::Dot) => mark(surface, middle, Mark::Dot, 3.0, color),
        Some(shape) => mark(surface, middle, shape, MARK_RADIUS, color),
        // An area without mark and line, such as the class of a raster's cells.
        None if entry.stroke.is_none() => {
            let area = PxRect::new(x + 3.0, y - 6.0, 15.0, 12.0);
            surface.rect(area, color);
            // An area in the colour of the paper is invisible without an outline.
            if matches!(entry.tone, Tone::Paper | Tone::Unseen) {
                border(surface, area, Pen::solid(tone(theme, Tone::Truth), 1.0));
            }
        }
        None => {}
    }
    let ink = tone(theme, Tone::Ink);
    surface.text(
        [x + swatch - 4.0, y],
        Align::Left,
        &entry.label,
        TextSize::Small,
        ink,
    );
}
