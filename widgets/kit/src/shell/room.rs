//! A widget beside its text stays in sight, so all that it opens with has to fit into the height of the
//! screen: its plots give way, its words do not.

use crate::layout::PlotHeight;
use crate::view::{Column, Placed, Row};

/// Plots that are lower than this share of what suits them show nothing any more.
const LEAST_SHARE: f32 = 0.3;

/// The room of a long sentence: where more becomes free, buttons have gone, and the panels take it back.
const A_SENTENCE: f32 = 60.0;

/// What the host has for a widget, and what of it the panels may take.
#[derive(Clone, Copy, Debug)]
pub(super) struct Room {
    /// For the whole widget, in points.
    height: f32,
    /// Whether the panels of this frame give way.
    gives_way: bool,
    /// Height of the panels of this frame.
    panels: f32,
    /// Width of the last frame.
    width: f32,
    /// The most that stood around the panels at that width: they do not jump as a sentence comes and goes.
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
    /// Of so many points.
    pub(super) fn from_height(height: f32) -> Self {
        Self {
            height,
            ..Self::default()
        }
    }

    /// Begins a frame: the panels of what the widget opens with give way where there is an end to the room.
    pub(super) fn begin(&mut self, is_opening: bool) {
        self.gives_way = is_opening && self.height.is_finite();
    }

    /// Lowers the plots of rows, each by the same share, until `place` needs no more than there is.
    ///
    /// The height of a row is that of its highest column, so it is convex in the share: what lies on the chord
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
        let (_, lowest) = lowered(LEAST_SHARE);
        let share = LEAST_SHARE
            + (1.0 - LEAST_SHARE) * (room - lowest).max(0.0) / (height - lowest).max(1.0);
        let (placed, height) = lowered(share);
        self.panels = height;
        // What stands beside a higher column takes back what it can.
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

    /// Remembers what stood around the panels of a frame of that width, whose column was so high.
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
