//! The small figures beside the text: one slider, one picture and one sentence each.
//!
//! Each shows one idea in a section without a widget. The core computes it for every value of its slider, and
//! the kit draws it like the widgets.

mod agree;
mod ate;
mod attempts;
mod bells;
mod ellipse;
mod fill;
mod gate;
mod incremental;
mod kappa;
mod nearest;
mod newton;
mod pull;
mod push;
mod rule;
mod slide;
mod start;
mod steps;

use serde_json::{Value, json};
use widget_kit::palette::Theme;
use widget_kit::scene::Scene;
use widget_kit::svg::{scene_places, scene_svg};

/// The slider of a figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slider {
    /// Its name on the page.
    pub label: &'static str,
    /// Unit of its values, with a leading space.
    pub unit: &'static str,
    /// Smallest value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
    /// Step between values.
    pub step: f64,
    /// Initial value.
    pub default: f64,
    /// Decimals of a value in the text.
    pub decimals: usize,
}

/// A figure at one value of its slider.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// The picture.
    pub scene: Scene,
    /// The result in words and numbers.
    pub sentence: String,
}

/// A figure with its slider.
#[derive(Clone, Copy, Debug)]
pub struct SketchSpec {
    /// Its name in the page: `slide`.
    pub name: &'static str,
    /// Its topic.
    pub title: &'static str,
    /// Its slider.
    pub slider: Slider,
    at: fn(f64) -> Shown,
    /// The panel with the thing that the reader drags, and its place there.
    handle: fn(f64) -> (&'static str, [f64; 2]),
}

/// Largest number of places on the way of a handle.
const PLACES: f64 = 120.0;

/// All figures, in the order of the page.
pub const SKETCHES: [SketchSpec; 17] = [
    pull::SKETCH,
    slide::SKETCH,
    bells::SKETCH,
    newton::SKETCH,
    ellipse::SKETCH,
    kappa::SKETCH,
    gate::SKETCH,
    attempts::SKETCH,
    agree::SKETCH,
    push::SKETCH,
    steps::SKETCH,
    rule::SKETCH,
    nearest::SKETCH,
    fill::SKETCH,
    start::SKETCH,
    ate::SKETCH,
    incremental::SKETCH,
];

/// The outline of a histogram with `bins` bins to either side of zero; what lies beyond is counted in the last ones.
fn histogram(values: impl Iterator<Item = f64>, width: f64, bins: i32) -> Vec<[f64; 2]> {
    let mut counts = vec![0.0; 2 * bins as usize + 1];
    for value in values {
        let bin = (value / width).round() as i32;
        counts[(bin.clamp(-bins, bins) + bins) as usize] += 1.0;
    }
    let outline = counts.iter().enumerate().flat_map(|(bin, count)| {
        let left = width * (bin as f64 - f64::from(bins) - 0.5);
        [[left, *count], [left + width, *count]]
    });
    outline.collect()
}

/// Looks up a figure by name.
#[must_use]
pub fn find(name: &str) -> Option<&'static SketchSpec> {
    SKETCHES.iter().find(|sketch| sketch.name == name)
}

impl SketchSpec {
    /// The figure with its slider at `value`, rounded to the nearest valid value.
    #[must_use]
    pub fn at(&self, value: f64) -> Shown {
        let Slider {
            min, max, default, ..
        } = self.slider;
        let value = if value.is_finite() { value } else { default };
        (self.at)(value.clamp(min, max))
    }

    /// Title and slider, for the page.
    #[must_use]
    pub fn schema(&self) -> Value {
        let Slider {
            label,
            unit,
            min,
            max,
            step,
            default,
            decimals,
        } = self.slider;
        json!({
            "name": self.name, "title": self.title, "label": label, "unit": unit, "min": min,
            "max": max, "step": step, "default": default, "decimals": decimals,
        })
    }

    /// The way of the handle on the picture, `[[value, x px, y px], …]`: a drag sets the value of the nearest place.
    #[must_use]
    pub fn way(&self, width_px: f32) -> Value {
        let Slider { min, max, step, .. } = self.slider;
        let count = ((max - min) / step).round().min(PLACES);
        let values: Vec<f64> = (0..=count as usize)
            .map(|k| min + (max - min) * k as f64 / count)
            .map(|value| (min + step * ((value - min) / step).round()).min(max))
            .collect();
        let places: Vec<_> = values.iter().map(|&value| (self.handle)(value)).collect();
        let scene = self.at(self.slider.default).scene;
        let on_picture = scene_places(&scene, width_px, &places);
        let way = values.iter().zip(on_picture);
        way.map(|(value, [x, y])| json!([value, x, y])).collect()
    }

    /// The picture as SVG, and the sentence.
    #[must_use]
    pub fn drawn(&self, value: f64, width_px: f32, theme: Theme) -> Value {
        let Shown { scene, sentence } = self.at(value);
        let svg = scene_svg(&scene, self.title, self.name, width_px, theme);
        json!({ "svg": svg, "sentence": sentence })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use widget_kit::audit::scene_text_faults;

    fn places(slider: &Slider) -> Vec<f64> {
        let count = 8;
        (0..=count)
            .map(|k| slider.min + (slider.max - slider.min) * f64::from(k) / f64::from(count))
            .collect()
    }

    #[test]
    fn no_text_of_a_figure_overlaps_or_is_cut_off() {
        for sketch in &SKETCHES {
            for place in places(&sketch.slider) {
                for width in [320.0, 360.0, 600.0] {
                    let faults = scene_text_faults(&sketch.at(place).scene, width);
                    assert!(faults.is_empty(), "{} at {place}: {faults:#?}", sketch.name);
                }
            }
        }
    }

    /// All of them are in one page.
    #[test]
    fn no_two_figures_share_a_name_within_their_pictures() {
        let mut seen = std::collections::BTreeSet::new();
        for sketch in &SKETCHES {
            let drawn = sketch.drawn(sketch.slider.default, 600.0, Theme::Light);
            let svg = drawn["svg"].as_str().unwrap();
            let ids: Vec<_> = svg
                .split(" id=\"")
                .skip(1)
                .map(|rest| rest.split('"').next().unwrap())
                .collect();
            assert!(!ids.is_empty(), "{}", sketch.name);
            for id in ids {
                assert!(seen.insert(id.to_owned()), "{id} of {}", sketch.name);
            }
        }
    }

    #[test]
    fn every_value_of_a_slider_has_its_own_picture_and_sentence() {
        for sketch in &SKETCHES {
            let shown: Vec<_> = places(&sketch.slider)
                .iter()
                .map(|&place| sketch.at(place))
                .collect();
            for pair in shown.windows(2) {
                assert_ne!(pair[0].scene, pair[1].scene, "{}", sketch.name);
                assert_ne!(pair[0].sentence, pair[1].sentence, "{}", sketch.name);
            }
        }
    }

    #[test]
    fn every_value_has_its_own_place_on_the_picture() {
        for sketch in &SKETCHES {
            for width in [360.0, 600.0] {
                let way = sketch.way(width);
                let way = way.as_array().unwrap();
                assert!(way.len() > 10, "{}: {}", sketch.name, way.len());
                assert_eq!(way[0][0], sketch.slider.min);
                assert_eq!(way[way.len() - 1][0], sketch.slider.max);
                for pair in way.windows(2) {
                    assert_ne!(pair[0], pair[1]);
                    let at = |k: usize| [1, 2].map(|axis| pair[k][axis].as_f64().unwrap());
                    assert_ne!(at(0), at(1), "{}", sketch.name);
                    let [x, y] = at(0);
                    let is_inside = (0.0..=f64::from(width)).contains(&x) && y >= 0.0;
                    assert!(is_inside, "{}: {x} {y}", sketch.name);
                }
            }
        }
    }

    #[test]
    fn an_invalid_slider_value_is_drawn_as_the_nearest_valid_one() {
        for sketch in &SKETCHES {
            let Slider {
                min, max, default, ..
            } = sketch.slider;
            assert_eq!(sketch.at(f64::NAN), sketch.at(default));
            assert_eq!(sketch.at(-1e9), sketch.at(min));
            assert_eq!(sketch.at(1e9), sketch.at(max));
        }
    }

    #[test]
    fn pictures_keep_their_height_while_a_slider_moves() {
        for sketch in &SKETCHES {
            let height = |place: f64| {
                let drawn = sketch.drawn(place, 390.0, Theme::Light);
                let svg = drawn["svg"].as_str().unwrap();
                let from = svg.find("viewBox").unwrap();
                svg[from..].split('"').nth(1).unwrap().to_owned()
            };
            let heights: Vec<_> = places(&sketch.slider).into_iter().map(height).collect();
            assert!(
                heights.windows(2).all(|pair| pair[0] == pair[1]),
                "{heights:?}"
            );
        }
    }
}
