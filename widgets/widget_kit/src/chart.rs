//! Plots of values over a timeline: one sample per step, a mark at the current step.

use crate::model::Handle;
use crate::scene::{Aspect, Axis, Layer, LegendEntry, Mark, Panel, Stroke, Tone, Weight};

/// A line of samples, one per step from 0, with its name in the legend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Series<'a> {
    /// Name in the legend.
    pub label: &'a str,
    /// The samples; a value that is not finite leaves a gap.
    pub values: &'a [f64],
    /// Meaning.
    pub tone: Tone,
    /// Shape of the mark at the current step.
    pub mark: Mark,
}

/// Labels and axes of a plot over a timeline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeChart<'a> {
    /// Name of the panel.
    pub id: &'static str,
    /// Title on screen.
    pub title: &'a str,
    /// Name of the horizontal axis.
    pub x_label: &'a str,
    /// Last step of the timeline.
    pub last: usize,
    /// Name of the vertical axis, with its unit.
    pub y_label: &'a str,
    /// The current step.
    pub now: usize,
}

impl TimeChart<'_> {
    /// Builds the plot: a line through each series, with its mark at the current step.
    #[must_use]
    pub fn panel(&self, series: &[Series]) -> Panel {
        let samples = series.iter().flat_map(|series| series.values);
        let highest = samples
            .copied()
            .filter(|v| v.is_finite())
            .fold(0.0, f64::max);
        let y = axis_from_zero(self.y_label, highest);
        let mut layers = vec![self.now_line(y.max)];
        layers.extend(series.iter().map(|series| Layer::Line {
            points: samples_of(series.values),
            stroke: Stroke::Solid,
            tone: series.tone,
            width_px: 1.75,
        }));
        layers.extend(series.iter().filter_map(|series| {
            let value = *series.values.get(self.now)?;
            let at = vec![[self.now as f64, value]];
            value
                .is_finite()
                .then(|| Layer::points(at, series.mark, series.tone, 4.5))
        }));
        Panel {
            id: self.id,
            title: self.title.to_owned(),
            weight: Weight::Side,
            aspect: Aspect::Free,
            x: self.x_axis(),
            y,
            layers,
            legend: series
                .iter()
                .map(|series| {
                    LegendEntry::marked_line(series.label, series.tone, series.mark, Stroke::Solid)
                })
                .collect(),
            color_bar: None,
        }
    }

    /// The whole timeline.
    #[must_use]
    pub fn x_axis(&self) -> Axis {
        Axis::new(self.x_label, 0.0, self.last.max(1) as f64)
    }

    /// The vertical line at the current step, up to `top`.
    #[must_use]
    pub fn now_line(&self, top: f64) -> Layer {
        let x = self.now as f64;
        Layer::Line {
            points: vec![[x, 0.0], [x, top]],
            stroke: Stroke::Solid,
            tone: Tone::Faint,
            width_px: 2.0,
        }
    }
}

/// Grabs the line at the current step if a press at `at` is within `reach` of it.
#[must_use]
pub fn grab_now(panel: &'static str, now: f64, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
    Handle::within(panel, "now", [now, at[1]], at, reach)
}

/// The step to which the line is dragged, at least 0; the caller limits it to the end of the timeline.
#[must_use]
pub fn dragged_to(handle: Handle, at: [f64; 2]) -> f64 {
    (at[0] - handle.offset[0]).round().max(0.0)
}

/// An axis from 0 to a little above the highest value.
#[must_use]
pub fn axis_from_zero(label: &str, highest: f64) -> Axis {
    let highest = if highest > 0.0 { highest } else { 1.0 };
    Axis::new(label, 0.0, 1.08 * highest)
}

fn samples_of(values: &[f64]) -> Vec<[f64; 2]> {
    let samples = values.iter().enumerate();
    samples.map(|(step, value)| [step as f64, *value]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_do_not_extend_the_axis_and_have_no_mark() {
        let chart = TimeChart {
            id: "errors",
            title: "Errors",
            x_label: "tick",
            last: 3,
            y_label: "error (m)",
            now: 1,
        };
        let values = [0.5, f64::NAN, 2.0];
        let panel = chart.panel(&[Series {
            label: "odometry",
            values: &values,
            tone: Tone::Prediction,
            mark: Mark::Triangle,
        }]);
        assert_eq!((panel.x.max, panel.y.max), (3.0, 2.16));
        let marks = |layer: &&Layer| matches!(layer, Layer::Points { .. });
        assert_eq!(panel.layers.iter().filter(marks).count(), 0);
    }
}
