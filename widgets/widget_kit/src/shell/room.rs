//! Keeps a widget beside its text in view: everything shown at the start has to fit the height of the screen,
//! so plots shrink; texts do not.

use crate::layout::PlotHeight;
use crate::view::{Column, Placed, Row};

/// Smallest share of a plot's natural height at which it is still readable.
const MIN_SHARE: f32 = 0.3;

/// Height of a long sentence: if more becomes free, buttons have gone, and the panels grow again.
const A_SENTENCE: f32 = 60.0;

/// The available height, and the part for the panels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Room {
    /// Available height for the whole widget, in points.
    height: f32,
    /// Whether the panels of this frame shrink.
    gives_way: bool,
    /// Height of the panels of this frame.
    panels: f32,
    /// Width of the last frame.
    width: f32,
    /// Largest height around the panels at that width, so that the panels do not jump as a sentence comes and
    /// goes.
    around: f32,
}

impl Default for Room {
    fn default() -> Self {
        Self {
            height: f32::INFINITY,
            gives_way: false,
            panels: 0.0,
            width: 0.0,
            around: 0.0,
        }
    }
}

impl Room {
    /// A limit of that many points.
    pub(super) fn from_height(height: f32) -> Self {
        Self {
            height,
            ..Self::default()
        }
    }

    /// Starts a frame: the panels shrink if the widget shows only its opening parts and the height is
    /// limited.
    pub(super) fn begin(&mut self, is_opening: bool) {
        self.gives_way = is_opening && self.height.is_finite();
    }

    /// Reduces the plots of rows by a common share until `place` fits the height.
    ///
    /// The height of a row is that of its highest column, so it is convex in the share: a point on the chord
    /// between two shares is never too high.
    pub(super) fn fit(
        &mut self,
        rows: &mut [Row],
        mut place: impl FnMut(&[Row]) -> (Vec<Placed>, f32),
    ) {
        if !self.gives_way {
            return;
        }
        let room = self.height - self.around;
        let (natural, height) = place(rows);
        self.panels = height;
        if height <= room {
            return;
        }
        let plot = |id: &str| {
            let placed = natural.iter().find(|placed| placed.panel == id);
            placed.map_or(0.0, |placed| placed.layout.plot.height)
        };
        let mut lowered = |share: f32| {
            let columns = rows.iter_mut().flat_map(|row| &mut row.columns);
            for slot in columns.flat_map(|column| &mut column.slots) {
                slot.height = PlotHeight::Fixed(share * plot(slot.panel));
            }
            place(rows)
        };
        let (_, lowest) = lowered(MIN_SHARE);
        let share =
            MIN_SHARE + (1.0 - MIN_SHARE) * (room - lowest).max(0.0) / (height - lowest).max(1.0);
        let (placed, height) = lowered(share);
        self.panels = height;
        // A column beside a higher one grows back as far as possible.
        let bottom = |column: &Column| {
            let panels = column.slots.iter().map(|slot| slot.panel);
            panels
                .filter_map(|id| placed.iter().find(|placed| placed.panel == id))
                .map(|placed| placed.origin[1] + placed.layout.size[1])
                .fold(0.0, f32::max)
        };
        for row in rows {
            let deepest = row.columns.iter().map(bottom).fold(0.0, f32::max);
            for column in &mut row.columns {
                let spare = (deepest - bottom(column)) / column.slots.len().max(1) as f32;
                for slot in &mut column.slots {
                    let suits = plot(slot.panel);
                    slot.height = PlotHeight::Fixed(suits.min(share * suits + spare));
                }
            }
        }
    }

    /// Records the height around the panels of a frame of that width, from the height of the whole column.
    pub(super) fn learn(&mut self, width: f32, column: f32) {
        if !self.gives_way {
            return;
        }
        let around = column - self.panels;
        let is_other = self.width != width || around < self.around - A_SENTENCE;
        self.width = width;
        if is_other || around > self.around {
            self.around = around;
        }
    }
}
