//! One frame of each widget: scene, layout and tessellation, everything except the graphics card.

use std::hint::black_box;

use ch16_slam2d::digest::Digest;
use egui::{Context, Pos2, RawInput, Rect, vec2};
use widget_kit::palette::Theme;
use widget_kit::shell::Shell;
use widgets::w16_12_jacobians::spec::MAX_STEPS;

use crate::{Limit, Run, Workload, prepared};

/// The size of a widget in a chapter, in points.
const SIZE: [f32; 2] = [1000.0, 1400.0];

const LIMIT: Option<Limit> = Some(Limit {
    native_ms: 2.0,
    wasm_ms: 4.0,
});

/// A frame of a widget that recomputes after a slider moved: a sixtieth of a second in the browser.
const DRAG_LIMIT: Option<Limit> = Some(Limit {
    native_ms: 8.0,
    wasm_ms: 16.0,
});

/// The tick before the canonical lap's 38th keyframe, and its own.
const KEYFRAME_TICKS: [f64; 2] = [118.0, 119.0];

/// The frames of the widgets, with a change of the picture before each.
///
/// Two widgets are missing: w16.8 computes the curves of a hundred seeds between frames, which takes minutes
/// under the counter, and w16.10 shows results of its worker.
#[must_use]
pub fn workloads() -> Vec<Workload> {
    let frame = |id, what, prepare| Workload {
        id,
        what,
        repetitions: 1,
        limit: LIMIT,
        most_of_native: None,
        prepare,
    };
    let drag = |id, what, prepare| Workload {
        limit: DRAG_LIMIT,
        ..frame(id, what, prepare)
    };
    vec![
        frame(
            "frame-w16.1",
            "a frame of w16.1 while its iterations play",
            || Frames::boxed(widget("w16.1"), "iteration", [3.0, 4.0]),
        ),
        frame(
            "frame-w16.2",
            "a frame of w16.2 while its timeline is dragged",
            || Frames::boxed(widget("w16.2"), "t", [100.0, 101.0]),
        ),
        frame(
            "frame-w16.3",
            "a frame of w16.3 while its crosshair is dragged",
            || Frames::boxed(widget("w16.3"), "probe-x", [0.3, 0.31]),
        ),
        frame(
            "frame-w16.4",
            "a frame of w16.4 while its timeline is dragged between two keyframes",
            || Frames::boxed(widget("w16.4"), "t", [100.0, 101.0]),
        ),
        frame(
            "frame-w16.4-grid",
            "a frame of w16.4 that takes a keyframe in or out, and so draws its grid again",
            || Frames::boxed(widget("w16.4"), "t", KEYFRAME_TICKS),
        ),
        drag(
            "frame-w16.5",
            "a frame of w16.5 while a spring is made stiffer, and the graph solved",
            || Frames::boxed(widget("w16.5"), "stiffness", [1.0, 2.0]),
        ),
        drag(
            "frame-w16.6",
            "a frame of w16.6 while its search is scrubbed",
            // The whole window in cells of 10 cm: its searches end soon under the counter, and its picture has the
            // same structure.
            || Frames::boxed(widget_at("w16.6", "cell", 0.1), "progress", [200.0, 201.0]),
        ),
        drag(
            "frame-w16.7",
            "a frame of w16.7 while its threshold is dragged",
            || Frames::boxed(widget("w16.7"), "called", [4.0, 5.0]),
        ),
        drag(
            "frame-w16.9",
            "a frame of w16.9 while its morning is scrubbed",
            || Frames::boxed(widget("w16.9"), "moment", [20.0, 21.0]),
        ),
        drag(
            "frame-w16.11",
            "a frame of w16.11 while its matrix turns",
            || Frames::boxed(widget("w16.11"), "turn", [40.0, 41.0]),
        ),
        drag(
            "frame-w16.12",
            "a frame of w16.12 while its Jacobian is made worse: four solvers to their ends",
            || {
                Frames::boxed(
                    widget_at("w16.12", "steps", MAX_STEPS as f64),
                    "bias",
                    [5.0, 6.0],
                )
            },
        ),
    ]
}

/// A widget whose reader has acted, so that its picture holds nothing back.
fn widget(name: &str) -> Shell {
    let mut shell = widgets::registry::find(name).expect("a widget of the chapter")();
    shell.act();
    shell
}

/// The same with one parameter set.
fn widget_at(name: &str, param: &str, value: f64) -> Shell {
    let mut shell = widget(name);
    let model = shell.model_mut();
    model.set(param, value).expect("the value is in range");
    shell
}

thread_local! {
    /// The context shared by all widgets: it lays the fonts out once.
    static CONTEXT: Context = Context::default();
}

/// A widget drawn without a screen.
struct Frames {
    shell: Shell,
    param: &'static str,
    values: [f64; 2],
    context: Context,
    input: RawInput,
    frames: u32,
}

impl Frames {
    fn boxed(mut shell: Shell, param: &'static str, values: [f64; 2]) -> Box<dyn Run> {
        while shell.model_mut().work().is_busy() {}
        let mut frames = Self {
            shell,
            param,
            values,
            context: CONTEXT.with(Clone::clone),
            input: RawInput {
                screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(SIZE[0], SIZE[1]))),
                ..RawInput::default()
            },
            frames: 0,
        };
        // The first frames lay the fonts out and measure the text.
        for _ in 0..4 {
            frames.draw();
        }
        prepared(frames, Self::draw, Self::add_to)
    }

    fn draw(&mut self) {
        let value = self.values[self.frames as usize % 2];
        self.frames += 1;
        let model = self.shell.model_mut();
        model.set(self.param, value).expect("the value is in range");
        self.input.time = Some(self.context.cumulative_frame_nr() as f64 / 60.0);
        let mut output = self
            .context
            .run_ui(self.input.clone(), |ui| self.shell.ui(ui));
        // There is no graphics card for the upload.
        output.textures_delta.clear();
        let triangles = self
            .context
            .tessellate(output.shapes, output.pixels_per_point);
        black_box(triangles);
    }

    /// Adds the picture of the last frame as SVG, because egui's triangles differ between builds.
    fn add_to(&self, digest: &mut Digest) {
        let picture = self.shell.picture_svg(SIZE[0], Theme::Light);
        picture
            .bytes()
            .for_each(|byte| digest.add_bits(u64::from(byte)));
    }
}

#[cfg(test)]
mod tests {
    use ch16_lab::lap::{LapConfig, LapRunner};

    use super::*;

    #[test]
    fn one_frame_of_the_control_room_redraws_its_grid_and_one_does_not() {
        let record = LapRunner::new().run(&LapConfig::default());
        let keyframes = |tick: f64| record.lap.node_count(tick as usize);
        assert_eq!(keyframes(101.0), keyframes(100.0));
        let [before, at] = KEYFRAME_TICKS;
        assert_eq!(keyframes(at), keyframes(before) + 1);
        assert_eq!(keyframes(at), 38);
    }
}
