//! Keeps a widget beside its text in view: the picture has to fit the height that the host leaves for it, so plots
//! shrink; texts do not.

use crate::layout::PlotHeight;
use crate::view::{Column, Placed, Row};

/// Smallest share of a plot's natural height at which it is still readable.
const MIN_SHARE: f32 = 0.3;

/// Reduces the plots of rows by a common share until `place` fits the height.
///
/// The height of a row is that of its highest column, so it is convex in the share: a point on the chord between two
/// shares is never too high.
pub(super) fn fit(
    rows: &mut [Row],
    room: f32,
    mut place: impl FnMut(&[Row]) -> (Vec<Placed>, f32),
) {
    if !room.is_finite() {
        return;
    }
    let (natural, height) = place(rows);
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
    let (placed, _) = lowered(share);
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
