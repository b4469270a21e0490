//! Two errors of a trajectory, with loops and without: absolute after alignment, and relative over a distance.

use std::sync::OnceLock;

use ch16_lab::lap::{LapConfig, LapRecord, LapRunner, LapTrace};
use ch16_slam2d::icp::svd_align;
use ch16_slam2d::metrics::{position_error_m, rms};
use pr_geom::{Point2, SE2, math};
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::{Shown, SketchSpec, Slider};

/// Largest distance of the relative error, and its step, m.
const FARTHEST_M: f64 = 15.0;
const STEP_M: f64 = 0.5;

pub(super) const SKETCH: SketchSpec = SketchSpec {
    name: "ate",
    title: "Absolute and relative errors of a trajectory",
    slider: Slider {
        label: "relative error over",
        unit: " m",
        min: STEP_M,
        max: FARTHEST_M,
        step: STEP_M,
        default: 2.0,
        decimals: 1,
    },
    at,
    handle,
};

/// The errors of one estimator on the canonical lap.
struct Errors {
    /// Absolute trajectory error: root mean square after the best rigid alignment, m.
    ate_m: f64,
    /// The relative error over each multiple of [`STEP_M`], m.
    rpe_m: Vec<f64>,
}

impl Errors {
    fn of(record: &LapRecord, trace: &LapTrace) -> Self {
        let poses = trace.poses(record.ticks());
        let truths: Vec<SE2> = trace
            .keyframes
            .iter()
            .map(|keyframe| keyframe.truth)
            .collect();
        let places =
            |poses: &[SE2]| -> Vec<Point2<f64>> { poses.iter().map(SE2::position).collect() };
        let aligned = svd_align(&places(poses), &places(&truths));
        let absolute = poses.iter().zip(&truths);
        let steps = truths
            .windows(2)
            .map(|pair| position_error_m(&pair[0], &pair[1]));
        let mut driven_m = vec![0.0];
        for step in steps {
            driven_m.push(driven_m[driven_m.len() - 1] + step);
        }
        let relative = |from: usize, to: usize| {
            let [estimate, truth] = [poses, &truths].map(|of| of[from].between(&of[to]));
            let off = truth.between(&estimate);
            math::norm2(off.x(), off.y())
        };
        let over = |distance_m: f64| {
            let pairs = (0..poses.len()).filter_map(|from| {
                let to = driven_m.partition_point(|at| *at < driven_m[from] + distance_m);
                (to < poses.len()).then(|| relative(from, to))
            });
            rms(pairs)
        };
        let distances = (1..=(FARTHEST_M / STEP_M) as usize).map(|k| STEP_M * k as f64);
        Self {
            ate_m: rms(absolute.map(|(pose, truth)| position_error_m(&(aligned * *pose), truth))),
            rpe_m: distances.map(over).collect(),
        }
    }

    fn rpe_at(&self, distance_m: f64) -> f64 {
        let index = (distance_m / STEP_M).round() as usize;
        self.rpe_m[index.clamp(1, self.rpe_m.len()) - 1]
    }
}

/// The front end alone, and the lap with loops.
fn errors() -> &'static [Errors; 2] {
    static ERRORS: OnceLock<[Errors; 2]> = OnceLock::new();
    ERRORS.get_or_init(|| {
        let record = LapRunner::new().run(&LapConfig::default());
        [&record.front_end, &record.lap].map(|trace| Errors::of(&record, trace))
    })
}

/// The relative error with loops.
fn handle(distance_m: f64) -> (&'static str, [f64; 2]) {
    ("ate", [distance_m, errors()[1].rpe_at(distance_m)])
}

fn at(distance_m: f64) -> Shown {
    let [alone, loops] = errors();
    Shown {
        sentence: format!(
            "Loops take the absolute error from {:.2} to {:.2} m. Over {distance_m:.1} m, the relative error goes from {:.3} to \
             {:.3} m.",
            alone.ate_m,
            loops.ate_m,
            alone.rpe_at(distance_m),
            loops.rpe_at(distance_m)
        ),
        scene: Scene {
            panels: vec![picture(distance_m)],
        },
    }
}

fn picture(distance_m: f64) -> Panel {
    let [alone, loops] = errors();
    let curve = |errors: &Errors, stroke, tone| {
        let points = errors.rpe_m.iter().enumerate();
        let points = points.map(|(k, error)| [STEP_M * (k + 1) as f64, *error]);
        Layer::line(points.collect(), stroke, tone, 2.0)
    };
    let level = |errors: &Errors, tone| {
        let ends = [[0.0, errors.ate_m], [FARTHEST_M, errors.ate_m]];
        Layer::segments(vec![ends], Stroke::Dotted, tone, 1.5)
    };
    let most = [alone, loops].map(|errors| {
        errors
            .rpe_m
            .iter()
            .fold(errors.ate_m, |a, b| math::max(a, *b))
    });
    let now = |errors: &Errors| vec![[distance_m, errors.rpe_at(distance_m)]];
    Panel {
        id: "ate",
        title: "The canonical run".to_owned(),
        weight: Weight::Main,
        aspect: Aspect::Free,
        x: Axis::new("distance driven (m)", 0.0, FARTHEST_M),
        y: Axis::new("error (m)", 0.0, 1.1 * math::max(most[0], most[1])),
        layers: vec![
            level(alone, Tone::Prior),
            level(loops, Tone::Posterior),
            curve(alone, Stroke::Dashed, Tone::Prior),
            curve(loops, Stroke::Solid, Tone::Posterior),
            Layer::points(now(alone), Mark::Circle, Tone::Prior, 5.0),
            Layer::points(now(loops), Mark::Square, Tone::Posterior, 5.0),
        ],
        legend: vec![
            LegendEntry::marked_line(
                "relative, front end",
                Tone::Prior,
                Mark::Circle,
                Stroke::Dashed,
            ),
            LegendEntry::marked_line(
                "relative, with loops",
                Tone::Posterior,
                Mark::Square,
                Stroke::Solid,
            ),
            LegendEntry::line("absolute, front end", Tone::Prior, Stroke::Dotted),
            LegendEntry::line("absolute, with loops", Tone::Posterior, Stroke::Dotted),
        ],
        color_bar: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loop_reduces_the_absolute_error_by_more_than_the_relative_one_over_a_short_distance() {
        let [alone, loops] = errors();
        let fall = |before: f64, after: f64| 1.0 - after / before;
        let absolute = fall(alone.ate_m, loops.ate_m);
        let relative = fall(alone.rpe_at(2.0), loops.rpe_at(2.0));
        assert!(absolute > relative + 0.1, "{absolute} {relative}");
    }

    #[test]
    fn a_rigid_motion_of_the_whole_path_changes_neither_error() {
        let record = LapRunner::new().run(&LapConfig::default());
        let mut moved = record.clone();
        let motion = SE2::new(3.0, -1.0, 0.7);
        for epoch in &mut moved.lap.epochs {
            for pose in &mut epoch.poses {
                *pose = motion * *pose;
            }
        }
        let [before, after] = [&record.lap, &moved.lap].map(|trace| Errors::of(&record, trace));
        // 1e-9: rounding of a rotation about a far origin.
        assert!((before.ate_m - after.ate_m).abs() < 1e-9);
        for (a, b) in before.rpe_m.iter().zip(&after.rpe_m) {
            assert!((a - b).abs() < 1e-9);
        }
    }
}
