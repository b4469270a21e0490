//! The reader's function in place of the increments or of the gate of the lap.

use std::sync::Arc;

use ch16_lab::lap::{LapConfig, LapMatcher, NewestLap};
use ch16_slam2d::chapter::ChapterParts;
use ch16_slam2d::icp::IcpVariant;
use ch16_slam2d::matching::IcpMatcher;
use pr_sim::{Course, Sketch};
use widget_kit::host_messages::Delivery;
use widget_kit::values::Values;

use super::FullLap;
use super::settings::LapSettings;
use crate::your_code::{ANSWERS, Answers, Callable, Function, Orders, SEAT};

/// The lap of these values with a function in its seam, on the course of the values.
///
/// # Errors
/// If the course cannot be driven; the message is one sentence.
pub fn your_lap(
    values: &Values,
    function: Function,
    callable: Arc<impl Callable + 'static>,
) -> Result<(LapConfig, ChapterParts), String> {
    let text = values.to_text("flat");
    let own = if text.is_empty() {
        Ok(Course::apartment())
    } else {
        let sketch = Sketch::from_text(&text).map_err(|problem| problem.to_string())?;
        sketch.course().map_err(|problem| problem.to_string())
    };
    let config = LapSettings::read(values).config(own.as_ref().ok());
    let mut config = config.ok_or("this flat cannot be driven")?;
    if let Some(variant) = function.variant() {
        config = config.with_matcher(match variant {
            IcpVariant::PointToPoint => LapMatcher::PointToPoint,
            IcpVariant::PointToPlane => LapMatcher::PointToPlane,
        });
    }
    let chapter = &config.slam.chapter;
    let mut parts = ChapterParts::from_config(chapter);
    match function.variant() {
        Some(variant) => {
            let matcher = |map| {
                let ours = IcpMatcher::with_variant(variant, map);
                Box::new(ours.with_increment(callable.clone()))
            };
            parts.front_end = matcher(&chapter.local_map);
            parts.loops = matcher(&chapter.loops.submap);
        }
        None => parts.gate = Some(callable),
    }
    Ok((config, parts))
}

impl FullLap {
    /// Seats a function, or takes its answers.
    pub(super) fn take_from_worker(&mut self, delivery: &Delivery<'_>) {
        match delivery.kind {
            SEAT => {
                self.yours = Function::named(delivery.text).map(Orders::new);
                // Laps of one driver only: the one under way is dropped.
                self.laps = NewestLap::new();
                self.recompute();
            }
            ANSWERS => self.take_answers(delivery.text, delivery.numbers),
            _ => {}
        }
    }

    fn take_answers(&mut self, order: &str, numbers: &[f64]) {
        let Some(orders) = self.yours.as_mut() else {
            return;
        };
        if !orders.answered(order) {
            return;
        }
        let answers = Arc::new(Answers::new(numbers));
        if let Ok((config, parts)) = your_lap(&self.values, orders.function, answers) {
            self.laps.ask_with_parts(config, parts);
        }
    }
}
