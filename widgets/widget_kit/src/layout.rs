//! Positions of a panel's parts: title, axis names, plot, tick labels, colour bar, legend.
//!
//! ```text
//! title
//! y name
//! 2 ┌────────────┐
//! 1 │    plot    │
//! 0 └────────────┘
//!   0     1     2     x name is centred below
//! colour bar
//! legend, in as many rows as it needs
//! ```
//!
//! Names are above and below the plot and never rotated, for readability.

use crate::scene::{Axis, LegendEntry, Panel, Stroke};
use crate::surface::{Measure, PxRect, TextSize};
use crate::ticks::{Scale, Ticks};

/// Height of a row of small text.
pub const ROW: f32 = 19.0;
/// Smallest height of a name of a vertical axis.
const NAME_ROW: f32 = 14.0;
/// Height of a row of the title.
pub const TITLE_ROW: f32 = 22.0;
/// Length of a tick plus its distance to the label.
pub const TICK: f32 = 8.0;
/// Space between legend entries.
const LEGEND_GAP: f32 = 14.0;
/// Width of a legend's swatch with its margin.
const SWATCH: f32 = 28.0;
/// Width for a dashed line with a mark: two dashes fit on either side of the mark.
const BROKEN_SWATCH: f32 = 54.0;
/// Space between blocks.
const GAP: f32 = 4.0;

/// The height of a plot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlotHeight {
    /// The height that follows from the scale of the axes, within a limit.
    Natural {
        /// Upper limit in pixels.
        most: f32,
    },
    /// A fixed height.
    Fixed(f32),
}

/// The positions of a panel's parts, relative to its top left corner.
#[derive(Clone, Debug, PartialEq)]
pub struct PanelLayout {
    /// Whole width and height.
    pub size: [f32; 2],
    /// The requested height of the plot.
    pub asked: PlotHeight,
    /// The title's lines, each with the middle of its row.
    pub title: Vec<(String, f32)>,
    /// Middle of the row with the name of the vertical axis.
    pub y_name_y: f32,
    /// The plot itself.
    pub plot: PxRect,
    /// Middle of the row with the labels of the horizontal ticks.
    pub x_ticks_y: f32,
    /// Middle of the row with the name of the horizontal axis.
    pub x_name_y: f32,
    /// Middle of the colour bar's row.
    pub color_bar_y: Option<f32>,
    /// Left edge and middle of every legend entry.
    pub legend: Vec<[f32; 2]>,
}

impl PanelLayout {
    /// Lays out a panel at that width.
    #[must_use]
    pub fn new(panel: &Panel, width: f32, height: PlotHeight, measure: &mut dyn Measure) -> Self {
        let left = if panel.y.is_drawn() {
            tick_label_width(&panel.y, measure) + TICK + 2.0
        } else {
            1.0
        };
        // Half of the last label of the horizontal axis extends beyond the plot's edge.
        let right = if panel.x.is_drawn() {
            0.5 * measure.text_width(&format!("{:.0}", panel.x.max), TextSize::Small) + 4.0
        } else {
            1.0
        };
        let plot_width = (width - left - right).max(40.0);
        let plot_height = match height {
            PlotHeight::Fixed(height) => height,
            PlotHeight::Natural { most } => {
                let size = panel.bounds().size();
                (plot_width * (size[1] / size[0]) as f32).min(most)
            }
        };
        let plot_height = plot_height.max(least_height(&panel.y));

        let mut y = 0.0;
        let mut row = |height: f32| {
            y += height;
            y - 0.5 * height
        };
        let title = wrap(&panel.title, width, TextSize::Body, measure)
            .into_iter()
            .map(|line| (line, row(TITLE_ROW)))
            .collect();
        let y_name_y = row(if panel.y.label.is_empty() { 0.0 } else { ROW });
        row(GAP);
        let plot_middle = row(plot_height);
        let plot = PxRect::new(
            left,
            plot_middle - 0.5 * plot_height,
            plot_width,
            plot_height,
        );
        let below = if panel.x.is_drawn() { ROW } else { 0.0 };
        row(TICK - 4.0);
        let x_ticks_y = row(below);
        let x_name_y = row(below);
        let color_bar_y = panel.color_bar.is_some().then(|| {
            row(GAP);
            row(ROW)
        });
        let mut legend = Vec::with_capacity(panel.legend.len());
        if !panel.legend.is_empty() {
            row(GAP);
            let mut x = 0.0;
            let mut middle = row(ROW + 2.0);
            for entry in &panel.legend {
                let entry_width = legend_width(entry, measure);
                if x > 0.0 && x + entry_width > width {
                    x = 0.0;
                    middle = row(ROW + 2.0);
                }
                legend.push([x, middle]);
                x += entry_width + LEGEND_GAP;
            }
        }
        row(GAP);
        Self {
            size: [width, y],
            asked: height,
            title,
            y_name_y,
            plot,
            x_ticks_y,
            x_name_y,
            color_bar_y,
            legend,
        }
    }
}

/// However little room there is, names do not lie on each other.
fn least_height(axis: &Axis) -> f32 {
    if axis.names.is_empty() {
        return 0.0;
    }
    NAME_ROW * (axis.max - axis.min) as f32
}

/// Breaks a text at its spaces into lines of that width; a longer word gets its own line.
#[must_use]
pub fn wrap(text: &str, width: f32, size: TextSize, measure: &mut dyn Measure) -> Vec<String> {
    let mut lines = Vec::new();
    let mut line = String::new();
    for word in text.split_whitespace() {
        let longer = if line.is_empty() {
            word.to_owned()
        } else {
            format!("{line} {word}")
        };
        if !line.is_empty() && measure.text_width(&longer, size) > width {
            lines.push(core::mem::replace(&mut line, word.to_owned()));
        } else {
            line = longer;
        }
    }
    if !line.is_empty() {
        lines.push(line);
    }
    lines
}

/// Ticks of the shown part of a vertical axis of that height in pixels.
#[must_use]
pub fn y_ticks(axis: &Axis, min: f64, max: f64, height: f32) -> Ticks {
    if !axis.is_drawn() {
        return Ticks::from_names(&[], min, max);
    }
    if !axis.names.is_empty() {
        return Ticks::from_names(&axis.names, min, max);
    }
    let most = (height / 34.0).clamp(2.0, 10.0) as usize;
    Ticks::new(min, max, most, Scale::from_label(&axis.label))
}

/// Ticks of the shown part of a horizontal axis of that width, as many as fit beside each other.
#[must_use]
pub fn x_ticks(axis: &Axis, min: f64, max: f64, width: f32, measure: &mut dyn Measure) -> Ticks {
    if !axis.is_drawn() {
        return Ticks::from_names(&[], min, max);
    }
    if !axis.names.is_empty() {
        return Ticks::from_names(&axis.names, min, max);
    }
    let scale = Scale::from_label(&axis.label);
    let mut most = 12;
    loop {
        let ticks = Ticks::new(min, max, most, scale);
        let widest = ticks
            .values
            .iter()
            .map(|value| measure.text_width(&ticks.label(*value), TextSize::Small))
            .fold(0.0, f32::max);
        let spacing = (ticks.step / (max - min)) as f32 * width;
        if most <= 2 || widest + 14.0 <= spacing {
            return ticks;
        }
        most -= 1;
    }
}

fn tick_label_width(axis: &Axis, measure: &mut dyn Measure) -> f32 {
    if !axis.names.is_empty() {
        let widths = axis
            .names
            .iter()
            .map(|name| measure.text_width(name, TextSize::Body));
        return widths.fold(0.0, f32::max);
    }
    // The step depends on the height, which depends on this width; so take the widest of several steps.
    [3, 5, 8]
        .into_iter()
        .flat_map(|most| {
            let ticks = Ticks::new(axis.min, axis.max, most, Scale::from_label(&axis.label));
            let labels: Vec<_> = ticks.values.iter().map(|v| ticks.label(*v)).collect();
            labels
        })
        .map(|label| measure.text_width(&label, TextSize::Small))
        .fold(0.0, f32::max)
}

fn legend_width(entry: &LegendEntry, measure: &mut dyn Measure) -> f32 {
    swatch(entry) + measure.text_width(&entry.label, TextSize::Small)
}

/// Width of an entry's swatch with its margin.
#[must_use]
pub fn swatch(entry: &LegendEntry) -> f32 {
    match (entry.mark, entry.stroke) {
        (Some(_), Some(Stroke::Dashed | Stroke::Dotted)) => BROKEN_SWATCH,
        _ => SWATCH,
    }
}
