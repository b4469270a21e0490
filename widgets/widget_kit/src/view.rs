//! Layout of a widget's panels: rows of columns of panels.

use crate::disclosure::Disclosure;
use crate::layout::{PanelLayout, PlotHeight};
use crate::scene::{Aspect, Panel, Scene, Weight};
use crate::surface::{Measure, Px};

/// Space around the picture.
pub const MARGIN: f32 = 12.0;
/// Space between panels.
pub const PANEL_GAP: f32 = 16.0;

/// Width from which panels are side by side.
pub const SIDE_BY_SIDE: f32 = 520.0;

/// Arranges the panels of a scene at a width; [`Arrangement::by_weight`] suits most.
pub type View = fn(&Scene, f32) -> Arrangement;

/// One panel in a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slot {
    /// The panel's name; a panel that the scene lacks leaves no gap.
    pub panel: &'static str,
    /// Height of its plot.
    pub height: PlotHeight,
}

impl Slot {
    /// A plot of that height in pixels.
    #[must_use]
    pub const fn fixed(panel: &'static str, px: f32) -> Self {
        Self {
            panel,
            height: PlotHeight::Fixed(px),
        }
    }

    /// A plot as high as its axes require, and at most that many pixels.
    #[must_use]
    pub const fn natural(panel: &'static str, most: f32) -> Self {
        Self {
            panel,
            height: PlotHeight::Natural { most },
        }
    }
}

/// Panels above each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Share of the row's width, relative to the other columns.
    pub share: f32,
    /// The panels from the top.
    pub slots: Vec<Slot>,
}

/// Columns side by side.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Row {
    /// The columns from the left.
    pub columns: Vec<Column>,
}

impl Row {
    /// Columns side by side, each with its share of the width and its panels from the top.
    #[must_use]
    pub fn of_columns(columns: &[(f32, &[Slot])]) -> Self {
        let columns = columns.iter().map(|(share, slots)| Column {
            share: *share,
            slots: slots.to_vec(),
        });
        Self {
            columns: columns.collect(),
        }
    }

    /// Panels of equal width side by side.
    #[must_use]
    pub fn new(slots: &[Slot]) -> Self {
        let columns: Vec<_> = slots.chunks(1).map(|slot| (1.0, slot)).collect();
        Self::of_columns(&columns)
    }

    /// A row for each panel.
    #[must_use]
    pub fn each(slots: &[Slot]) -> Vec<Self> {
        slots.chunks(1).map(Self::new).collect()
    }
}

/// The rows of the picture.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Arrangement {
    /// The pictures that the widget is about; they shrink to the height that the host leaves for them.
    pub stage: Vec<Row>,
    /// The plots below them.
    pub below: Vec<Row>,
}

impl Arrangement {
    /// The visible part for a disclosure: no plots below the stage unless everything is shown.
    #[must_use]
    pub fn of_disclosure(mut self, disclosure: &Disclosure) -> Self {
        if !disclosure.is_all() {
            self.below.clear();
        }
        self
    }

    /// Lays out all panels at that width. Returns them with their total height.
    #[must_use]
    pub fn place(
        &self,
        scene: &Scene,
        width: f32,
        measure: &mut dyn Measure,
    ) -> (Vec<Placed>, f32) {
        place(scene, self.stage.iter().chain(&self.below), width, measure)
    }

    /// Default arrangement: main panels over the whole width, halves in pairs, side plots in pairs below.
    #[must_use]
    pub fn by_weight(scene: &Scene, width: f32) -> Self {
        let slots = |weight: Weight, columns: usize| {
            let column_width = width / columns as f32 - PANEL_GAP;
            let slots: Vec<Slot> = scene
                .panels
                .iter()
                .filter(|panel| panel.weight == weight)
                .map(|panel| default_slot(panel, column_width))
                .collect();
            slots.chunks(columns).map(Row::new).collect::<Vec<_>>()
        };
        let pair = if width >= SIDE_BY_SIDE { 2 } else { 1 };
        let mut stage = slots(Weight::Main, 1);
        stage.extend(slots(Weight::Half, pair));
        Self {
            stage,
            below: slots(Weight::Side, pair),
        }
    }
}

fn default_slot(panel: &Panel, width: f32) -> Slot {
    match (panel.aspect, panel.weight) {
        (Aspect::Equal, Weight::Side) => Slot::natural(panel.id, 260.0),
        (Aspect::Equal, _) => Slot::natural(panel.id, 560.0),
        (Aspect::Free, Weight::Side) => Slot::fixed(panel.id, 130.0),
        (Aspect::Free, _) => Slot::fixed(panel.id, (0.6 * width).clamp(180.0, 420.0)),
    }
}

/// A panel with its position, relative to the top left corner of its rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    /// The panel's name.
    pub panel: &'static str,
    /// Top left corner.
    pub origin: Px,
    /// Its parts.
    pub layout: PanelLayout,
}

/// Lays out the panels of rows at that width. Returns them with their total height.
#[must_use]
pub fn place<'a>(
    scene: &Scene,
    rows: impl IntoIterator<Item = &'a Row>,
    width: f32,
    measure: &mut dyn Measure,
) -> (Vec<Placed>, f32) {
    let mut placed = Vec::with_capacity(scene.panels.len());
    let mut top = 0.0;
    let panel_of = |slot: &Slot| scene.panels.iter().find(|panel| panel.id == slot.panel);
    for row in rows {
        let columns = row.columns.iter();
        let columns =
            columns.filter(|column| column.slots.iter().any(|slot| panel_of(slot).is_some()));
        let columns: Vec<_> = columns.collect();
        let shares: f32 = columns.iter().map(|column| column.share).sum();
        let gaps = PANEL_GAP * (columns.len().max(1) - 1) as f32;
        let mut left = 0.0;
        let mut bottom: f32 = top;
        for column in columns {
            let column_width = (width - gaps) * column.share / shares;
            let mut y = top;
            for slot in &column.slots {
                let Some(panel) = panel_of(slot) else {
                    continue;
                };
                let layout = PanelLayout::new(panel, column_width, slot.height, measure);
                let height = layout.size[1];
                placed.push(Placed {
                    panel: panel.id,
                    origin: [left, y],
                    layout,
                });
                y += height + PANEL_GAP;
            }
            bottom = bottom.max(y);
            left += column_width + PANEL_GAP;
        }
        top = bottom;
    }
    (placed, (top - PANEL_GAP).max(0.0))
}
