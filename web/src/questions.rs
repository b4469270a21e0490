//! Functions of the module for the page besides the widgets: schemas, parsing, laps, small figures.

use ch16_lab::lap::{LapConfig, LapFrontEnd, LapRunner};
use pr_geom::SE2;
use serde_json::{Value, json};
use wasm_bindgen::prelude::*;
use widget_kit::param::ParamKind;

use crate::app::theme_of;
use crate::matcher;
use crate::outcomes::Outcomes;
use widgets::registry;

use crate::{candidates, schema, state, story};

/// The schema of every widget, a JSON array.
#[wasm_bindgen(js_name = widgetSchemas)]
pub fn widget_schemas() -> String {
    let widgets = registry::MODELS.map(|model| schema::widget(model().as_ref()));
    Value::from(widgets.to_vec()).to_string()
}

/// State and results of a widget after each of its presets, a line of JSON each.
///
/// # Errors
/// If there is no such widget.
#[wasm_bindgen(js_name = afterEachPreset)]
pub fn after_each_preset(name: &str) -> Result<String, JsError> {
    let maker = registry::find(name).map_err(|problem| JsError::new(&problem))?;
    Ok(state::after_each_preset(maker))
}

/// The digest of a lap's poses and metrics, 16 hexadecimal digits like the output of `ch16 lap`; with
/// `on_local_map` that of the estimator for recorded logs.
#[wasm_bindgen(js_name = lapDigest)]
pub fn lap_digest(seed: u32, noise_factor: f64, on_local_map: Option<bool>) -> String {
    let digest = if on_local_map.unwrap_or_default() {
        let lap = LapConfig::with_seed_and_noise(seed, noise_factor);
        let lap = lap.with_front_end(LapFrontEnd::LocalMap);
        LapRunner::new().run(&lap).digest()
    } else {
        ch16_lab::lap::lap_digest(seed, noise_factor)
    };
    format!("{digest:016x}")
}

/// A whole lap as JSON, for drawing; see [`story::story`].
#[wasm_bindgen(js_name = lapStory)]
pub fn lap_story(seed: u32, noise_factor: f64) -> String {
    story::story(seed, noise_factor).to_string()
}

/// Title and slider of each small figure of the page, a JSON array; see [`sketches`].
#[wasm_bindgen(js_name = sketchSchemas)]
pub fn sketch_schemas() -> String {
    let figures = sketches::SKETCHES.iter().map(sketches::SketchSpec::schema);
    Value::from(figures.collect::<Vec<_>>()).to_string()
}

/// A small figure of the page with its slider at `value`: `{"svg", "sentence"}`.
///
/// # Errors
/// If there is no such figure.
#[wasm_bindgen(js_name = drawSketch)]
pub fn draw_sketch(name: &str, value: f64, width_px: f32, theme: &str) -> Result<String, JsError> {
    let sketch = sketches::find(name)
        .ok_or_else(|| JsError::new(&format!("there is no figure `{name}`")))?;
    Ok(sketch.drawn(value, width_px, theme_of(theme)).to_string())
}

/// The way of the handle of a small figure on its picture, `[[value, x px, y px], …]`.
///
/// # Errors
/// If there is no such figure.
#[wasm_bindgen(js_name = sketchWay)]
pub fn sketch_way(name: &str, width_px: f32) -> Result<String, JsError> {
    let sketch = sketches::find(name)
        .ok_or_else(|| JsError::new(&format!("there is no figure `{name}`")))?;
    Ok(sketch.way(width_px).to_string())
}

/// Ten loop candidates for the reader to judge, a JSON array of `{"svg", "says"}`; see [`candidates`].
#[wasm_bindgen(js_name = loopCandidates)]
pub fn loop_candidates(width_px: f32, theme: &str) -> String {
    candidates::shown(width_px, theme_of(theme)).to_string()
}

/// Evaluates the reader's answers, a letter for each candidate, `1` if it was accepted.
#[wasm_bindgen(js_name = judgeCandidates)]
pub fn judge_candidates(answers: &str, width_px: f32, theme: &str) -> String {
    let answers: Vec<bool> = answers.chars().map(|letter| letter == '1').collect();
    candidates::judged(&answers, width_px, theme_of(theme)).to_string()
}

/// Two sweeps of a room of the page's matcher, and ICP on them.
#[wasm_bindgen]
pub struct PageMatcher {
    matcher: matcher::RoomMatcher,
}

#[wasm_bindgen]
impl PageMatcher {
    /// The matcher of a room before its first run.
    #[wasm_bindgen(constructor)]
    #[must_use]
    pub fn new(room: &str) -> Self {
        Self {
            matcher: matcher::RoomMatcher::new(room),
        }
    }

    /// The sweeps as JSON; see [`matcher::RoomMatcher::scene`].
    #[must_use]
    pub fn scene(&self) -> String {
        self.matcher.scene().to_string()
    }

    /// A run from that `world_from_source` as JSON; see [`matcher::RoomMatcher::run`].
    pub fn run(&mut self, x: f64, y: f64, theta: f64) -> String {
        self.matcher.run(&SE2::new(x, y, theta)).to_string()
    }
}

/// Runs one lap after the other.
#[wasm_bindgen]
#[derive(Default)]
pub struct LapOutcomes {
    outcomes: Outcomes,
}

#[wasm_bindgen]
impl LapOutcomes {
    /// Creates it before its first lap.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// The numbers of a lap with the settings of a link to w16.2; see [`Outcomes::of`].
    ///
    /// # Errors
    /// If the link is invalid.
    pub fn drive(&mut self, seed: u32, link: &str) -> Result<Vec<f64>, JsError> {
        let numbers = self.outcomes.of(seed, link);
        numbers
            .map(|numbers| numbers.to_vec())
            .map_err(|problem| JsError::new(&problem))
    }
}

/// Parses a text like the core: `[true, value as text]` or `[false, error]`.
///
/// # Errors
/// If there is no such widget or parameter.
#[wasm_bindgen(js_name = parseParam)]
pub fn parse_param(name: &str, id: &str, text: &str) -> Result<String, JsError> {
    let widget = registry::spec(name).ok_or_else(|| JsError::new(&registry::unknown(name)))?;
    let spec = widget
        .params
        .iter()
        .find(|param| param.id == id)
        .ok_or_else(|| JsError::new("no such parameter"))?;
    let answer = match spec.parse(text) {
        Ok(_) if matches!(spec.kind, ParamKind::Text { .. }) => json!([true, text.trim()]),
        Ok(value) => json!([true, spec.to_text(value)]),
        Err(problem) => json!([false, problem.to_string()]),
    };
    Ok(answer.to_string())
}
