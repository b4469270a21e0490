//! The outcome in words and numbers, and the tables beside the picture.

use egui::{Align, Color32, FontId, Layout, RichText, Sense, Stroke, Ui, pos2, vec2};

use crate::egui_surface::{color, font};
use crate::model::{Assessment, Fact, Outcome, Table};
use crate::palette::{self, Rgb, Theme};
use crate::surface::TextSize;
use crate::ticks::signed;

/// Size of a verdict, px.
const VERDICT_PX: f32 = 16.0;
/// Space between the columns of a table.
const COLUMN_GAP: f32 = 12.0;
/// Height of the row of a fact.
const FACT_ROW: f32 = 18.0;
/// Width from which facts are in two columns.
const TWO_COLUMNS: f32 = 460.0;

/// The verdict and its sentence.
pub fn verdict(ui: &mut Ui, outcome: &Outcome, theme: Theme) {
    let ink = palette::standing(theme, outcome.standing);
    ui.horizontal(|ui| {
        sign(ui, outcome.standing, ink);
        ui.label(
            RichText::new(&outcome.verdict)
                .color(color(ink))
                .strong()
                .size(VERDICT_PX),
        );
    });
    ui.label(outcome.in_full());
}

/// The question that stands in place of a verdict, as high as that, so that the first act moves nothing.
pub fn question(ui: &mut Ui, question: &str, outcome: &Outcome) {
    let sentence = egui::WidgetText::from(outcome.in_full());
    let width = ui.available_width();
    let sentence = sentence.into_galley(ui, None, width, egui::TextStyle::Body);
    let row = ui.spacing().interact_size.y;
    ui.set_min_height(row + ui.spacing().item_spacing.y + sentence.size().y);
    ui.label(RichText::new(question).strong().size(VERDICT_PX));
}

/// The numbers of an outcome.
pub fn facts(ui: &mut Ui, outcome: &Outcome) {
    ui.add_space(4.0);
    // Rows without controls may be closer together.
    ui.spacing_mut().interact_size.y = FACT_ROW;
    ui.spacing_mut().item_spacing.y = 3.0;
    if ui.available_width() < TWO_COLUMNS {
        for fact in &outcome.facts {
            fact_row(ui, fact);
        }
        return;
    }
    let half = outcome.facts.len().div_ceil(2).max(1);
    ui.spacing_mut().item_spacing.x = 28.0;
    ui.columns(2, |columns| {
        for (index, fact) in outcome.facts.iter().enumerate() {
            fact_row(&mut columns[index / half], fact);
        }
    });
}

/// A shape for the standing, in addition to its colour.
fn sign(ui: &mut Ui, standing: Assessment, ink: Rgb) {
    let (rect, _) = ui.allocate_exact_size(vec2(16.0, 16.0), Sense::hover());
    let painter = ui.painter();
    let stroke = Stroke::new(2.2, color(ink));
    let at = |x: f32, y: f32| rect.min + vec2(16.0 * x, 16.0 * y);
    match standing {
        Assessment::Good => {
            painter.line(vec![at(0.1, 0.55), at(0.4, 0.85), at(0.95, 0.15)], stroke);
        }
        Assessment::Bad => {
            painter.line_segment([at(0.15, 0.15), at(0.85, 0.85)], stroke);
            painter.line_segment([at(0.15, 0.85), at(0.85, 0.15)], stroke);
        }
        Assessment::Doubtful => {
            let corners = vec![at(0.5, 0.0), at(1.0, 0.95), at(0.0, 0.95)];
            painter.add(egui::Shape::closed_line(corners, stroke));
            painter.line_segment([at(0.5, 0.35), at(0.5, 0.62)], stroke);
            painter.circle_filled(at(0.5, 0.77), 1.2, color(ink));
        }
        Assessment::Neutral => {
            painter.circle_stroke(rect.center(), 5.5, stroke);
        }
    }
}

fn fact_row(ui: &mut Ui, fact: &Fact) {
    ui.horizontal(|ui| {
        ui.label(RichText::new(fact.label).weak());
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.label(fact_text(fact));
        });
    });
}

/// A fact's value with its unit; a dash if there is none.
#[must_use]
pub fn fact_text(fact: &Fact) -> String {
    if !fact.value.is_finite() {
        return "–".to_owned();
    }
    let number = signed(fact.value, fact.decimals);
    match fact.unit {
        Fact::YES_OR_NO if fact.value == 0.0 => "no".to_owned(),
        Fact::YES_OR_NO => "yes".to_owned(),
        "" | "°" | "%" => format!("{number}{}", fact.unit),
        unit => format!("{number}\u{202f}{unit}"),
    }
}

/// A table as wide as its text needs; the first column wraps if there is not enough space.
pub fn table(ui: &mut Ui, table: &Table, theme: Theme) {
    ui.label(RichText::new(&table.title).strong());
    let font = font(TextSize::Small);
    let room = ui.available_width();
    let widths = column_widths(ui, table, &font, room);
    let ink = color(palette::tone(theme, crate::scene::Tone::Ink));
    let rule = ui.visuals().widgets.noninteractive.bg_stroke;
    // Numbers are right-aligned with their heads, text is left-aligned.
    let numeric: Vec<bool> = (0..widths.len())
        .map(|column| {
            let cells = table.rows.iter().filter_map(|row| row.get(column));
            cells.clone().count() > 0 && cells.into_iter().all(|cell| is_number(cell))
        })
        .collect();
    let rows = core::iter::once(&table.columns).chain(&table.rows);
    for (index, row) in rows.enumerate() {
        let galleys: Vec<_> = row
            .iter()
            .zip(&widths)
            .map(|(text, width)| ui.painter().layout(text.clone(), font.clone(), ink, *width))
            .collect();
        let height = galleys
            .iter()
            .map(|galley| galley.size().y)
            .fold(0.0, f32::max)
            + 6.0;
        let (rect, response) = ui.allocate_exact_size(vec2(room, height), Sense::hover());
        let spoken = row.join(", ");
        response
            .widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::Label, true, &spoken));
        let mut left = rect.left();
        for (column, (galley, width)) in galleys.into_iter().zip(&widths).enumerate() {
            let x = if numeric[column] {
                left + width - galley.size().x
            } else {
                left
            };
            ui.painter()
                .galley(pos2(x, rect.top() + 3.0), galley, Color32::PLACEHOLDER);
            left += width + COLUMN_GAP;
        }
        if index == 0 {
            ui.painter().hline(rect.x_range(), rect.bottom(), rule);
        }
    }
}

/// Whether a cell is a number, a range of numbers, or empty.
fn is_number(cell: &str) -> bool {
    cell.chars()
        .all(|c| c.is_ascii_digit() || "+-−–.×% \u{202f}".contains(c))
}

/// Every column gets the width of its longest word, and a share of the rest up to its full width.
fn column_widths(ui: &Ui, table: &Table, font: &FontId, room: f32) -> Vec<f32> {
    let columns = table.columns.len();
    let mut wanted = vec![0.0_f32; columns];
    let mut needed = vec![0.0_f32; columns];
    let width = |text: &str| {
        let galley = ui
            .painter()
            .layout_no_wrap(text.to_owned(), font.clone(), Color32::WHITE);
        // Half a pixel more, because rounding would wrap text of exactly that width.
        galley.size().x + 0.5
    };
    for row in core::iter::once(&table.columns).chain(&table.rows) {
        for (column, text) in row.iter().enumerate().take(columns) {
            wanted[column] = wanted[column].max(width(text));
            let longest = text.split(' ').map(width).fold(0.0, f32::max);
            needed[column] = needed[column].max(longest);
        }
    }
    let gaps = COLUMN_GAP * columns.saturating_sub(1) as f32;
    let least: f32 = needed.iter().sum();
    let slack = wanted.iter().sum::<f32>() - least;
    let spare = (room - gaps - least).max(0.0);
    let share = if slack > spare { spare / slack } else { 1.0 };
    let pairs = needed.iter().zip(&wanted);
    pairs
        .map(|(least, most)| least + share * (most - least))
        .collect()
}
