//! Finds overlapping and clipped texts in a picture, for the tests of every widget.

use crate::model::Model;
use crate::palette::{Rgb, Theme};
use crate::picture::{picture, scene_picture};
use crate::scene::{Raster, Scene};
use crate::surface::{Align, Haloed, Measure, Pen, Px, PxRect, Surface, TextSize};
use crate::svg::SvgSurface;
use crate::view::View;

/// Height of letters and figures as a share of the font's size.
const LETTER_HEIGHT: f32 = 0.75;
/// Overlap that is too small to see, in pixels.
const SLACK: f32 = 1.0;

/// Reports every text outside of the panels' layers that leaves the picture or overlaps another one, at that
/// width.
///
/// Text widths are rounded up from the page's own font.
#[must_use]
pub fn text_faults(model: &dyn Model, view: View, width_px: f32) -> Vec<String> {
    let mut recorder = Recorder::new();
    let height = picture(&mut recorder, model, view, width_px, Theme::Light);
    recorder.faults(width_px, height)
}

/// [`text_faults`] of the panels of a scene alone.
#[must_use]
pub fn scene_text_faults(scene: &Scene, width_px: f32) -> Vec<String> {
    let mut recorder = Recorder::new();
    let height = scene_picture(&mut recorder, scene, width_px, Theme::Light);
    recorder.faults(width_px, height)
}

/// Reports every pair of overlapping texts over the data of one panel, at that width.
#[must_use]
pub fn label_faults(model: &dyn Model, view: View, width_px: f32) -> Vec<String> {
    let mut recorder = Recorder::new();
    picture(&mut recorder, model, view, width_px, Theme::Light);
    let mut faults = Vec::new();
    for (index, (text, rect)) in recorder.labels.iter().enumerate() {
        let others = recorder.labels[index + 1..].iter();
        faults.extend(
            others
                .filter(|(_, place)| overlap(rect, place))
                .map(|(other, _)| format!("`{text}` lies on `{other}` at a width of {width_px}")),
        );
    }
    faults
}

fn overlap(a: &PxRect, b: &PxRect) -> bool {
    a.left + SLACK < b.right()
        && b.left + SLACK < a.right()
        && a.top + SLACK < b.bottom()
        && b.top + SLACK < a.bottom()
}

/// A surface that records the positions of texts and draws nothing.
struct Recorder {
    measure: SvgSurface,
    texts: Vec<(String, PxRect)>,
    /// Text over data.
    labels: Vec<(String, PxRect)>,
    in_layers: bool,
}

impl Recorder {
    fn new() -> Self {
        Self {
            measure: SvgSurface::new(Theme::Light),
            texts: Vec::new(),
            labels: Vec::new(),
            in_layers: false,
        }
    }

    fn faults(&self, width_px: f32, height: f32) -> Vec<String> {
        let mut faults = Vec::new();
        for (index, (text, rect)) in self.texts.iter().enumerate() {
            let inside = rect.left >= -SLACK
                && rect.right() <= width_px + SLACK
                && rect.top >= 0.0
                && rect.bottom() <= height;
            if !inside {
                faults.push(format!(
                    "`{text}` leaves the picture of {width_px} × {height}: {rect:?}"
                ));
            }
            for (other, place) in &self.texts[index + 1..] {
                if overlap(rect, place) {
                    faults.push(format!(
                        "`{text}` lies on `{other}` at a width of {width_px}"
                    ));
                }
            }
        }
        faults
    }
}

impl Measure for Recorder {
    fn text_width(&mut self, text: &str, size: TextSize) -> f32 {
        self.measure.text_width(text, size)
    }
}

impl Surface for Recorder {
    fn clip(&mut self, rect: Option<PxRect>) {
        // Layers are clipped to their plot; the data determine the position of their text.
        self.in_layers = rect.is_some();
    }

    fn line(&mut self, _points: &[Px], _pen: Pen) {}

    fn polygon(&mut self, _points: &[Px], _fill: Rgb) {}

    fn fan(&mut self, _from: Px, _rim: &[Px], _fill: Rgb, _opacity: [f32; 2]) {}

    fn circle(&mut self, _center: Px, _radius: f32, _fill: Option<Rgb>, _ring: Option<Pen>) {}

    fn rect(&mut self, _rect: PxRect, _fill: Rgb) {}

    fn raster(&mut self, _rect: PxRect, _raster: &Raster, _key: &str) {}

    fn text(&mut self, at: Px, align: Align, text: &str, size: TextSize, _color: Rgb) {
        let width = self.text_width(text, size);
        let left = match align {
            Align::Left => at[0],
            Align::Center => at[0] - 0.5 * width,
            Align::Right => at[0] - width,
        };
        let height = LETTER_HEIGHT * size.px();
        let rect = PxRect::new(left, at[1] - 0.5 * height, width, height);
        let kept = if self.in_layers {
            &mut self.labels
        } else {
            &mut self.texts
        };
        kept.push((text.to_owned(), rect));
    }

    fn haloed_text(&mut self, at: Px, align: Align, text: &str, size: TextSize, colors: Haloed) {
        self.text(at, align, text, size, colors.ink);
    }

    fn snap(&self, coordinate: f32) -> f32 {
        coordinate
    }
}
