//! What a widget orders, and its text: `your-code svd_align registration room 457 25 0.55 0.45 …`.

use std::fmt::{self, Display, Formatter};
use std::str::FromStr;
use std::sync::Arc;

use ch16_slam2d::chapter::{ChapterParts, InformationFrame};
use ch16_slam2d::icp::{IcpConfig, IcpVariant, IcpWorkspace, Increment};
use ch16_slam2d::loops::GateModel;
use ch16_slam2d::matching::IcpMatcher;
use pr_sim::{Course, Sketch};

use super::{Callable, Function, Rejection, SEAT};
use crate::basin::{BasinMapAxes, BasinOutcome, BasinPlace, BasinScene, BasinStart, OffsetAxis};
use crate::lap::{BuiltInWorld, LapConfig, LapMatcher, LapSettings, LoopClosure, NamedChoice as _};

/// A computation with a reader's function.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// The function.
    pub function: Function,
    /// What it computes.
    pub task: Task,
}

/// What a function computes.
#[derive(Clone, Debug, PartialEq)]
pub enum Task {
    /// A registration of two sweeps.
    Registration(BasinTask),
    /// Cells of the basin map, by column and row.
    Cells(BasinTask, Vec<[usize; 2]>),
    /// A lap.
    Lap(LapTask),
}

/// A registration of two sweeps of one location.
#[derive(Clone, Debug, PartialEq)]
pub struct BasinTask {
    /// The location.
    pub place: BasinPlace,
    /// Seed of the range noise.
    pub seed: u32,
    /// The initial guess.
    pub start: BasinStart,
    /// The settings, with the variant of the function if it is an increment.
    pub config: IcpConfig,
    /// The axes of the basin map.
    pub axes: BasinMapAxes,
}

impl BasinTask {
    /// Registers from `start` with a function in its seam.
    pub fn register(
        &self,
        scene: &BasinScene,
        start: &BasinStart,
        function: Function,
        callable: &impl Callable,
        workspace: &mut IcpWorkspace,
    ) -> BasinOutcome {
        if function != Function::KeepPairs {
            let rules = (Some(callable as &dyn Increment), None);
            return scene.register_with(start, &self.config, rules, workspace);
        }
        let rule = Rejection {
            function: callable,
            trim: self.config.trim,
        };
        let untrimmed = IcpConfig {
            trim: 0.0,
            ..self.config
        };
        scene.register_with(start, &untrimmed, (None, Some(&rule)), workspace)
    }
}

/// A lap.
#[derive(Clone, Debug, PartialEq)]
pub struct LapTask {
    /// The settings; a function that is an increment decides on the matcher.
    pub settings: LapSettings,
    /// The reader's own course in the form of a link; empty for a built-in world.
    pub course: String,
}

impl LapTask {
    /// The lap with a function in its seam.
    ///
    /// # Errors
    /// If the course cannot be driven; the message is one sentence.
    pub fn lap<F: Callable + 'static>(
        &self,
        function: Function,
        callable: Arc<F>,
    ) -> Result<(LapConfig, ChapterParts), String> {
        let own = if self.course.is_empty() {
            Course::apartment()
        } else {
            let sketch = Sketch::from_text(&self.course).map_err(|problem| problem.to_string())?;
            sketch.course().map_err(|problem| problem.to_string())?
        };
        let config = self.settings.config(Some(&own));
        let mut config = config.ok_or("this course cannot be driven")?;
        if !function.registers() {
            let mut parts = ChapterParts::from_config(&config.slam.chapter);
            parts.gate = Some(callable);
            return Ok((config, parts));
        }
        let is_plane = self.settings.matcher == LapMatcher::PointToPlane;
        let variant = function.variant().unwrap_or(if is_plane {
            IcpVariant::PointToPlane
        } else {
            IcpVariant::PointToPoint
        });
        config = config.with_matcher(match variant {
            IcpVariant::PointToPoint => LapMatcher::PointToPoint,
            IcpVariant::PointToPlane => LapMatcher::PointToPlane,
        });
        let chapter = &config.slam.chapter;
        let mut parts = ChapterParts::from_config(chapter);
        let matcher = |map| {
            let ours = IcpMatcher::with_variant(variant, map);
            Box::new(if function == Function::KeepPairs {
                // The chapter's lap trims nothing.
                ours.with_rejection(Arc::new(Rejection {
                    function: callable.clone(),
                    trim: 0.0,
                }))
            } else {
                ours.with_increment(callable.clone())
            })
        };
        parts.front_end = matcher(&chapter.local_map);
        parts.loops = matcher(&chapter.loops.submap);
        Ok((config, parts))
    }
}

const VARIANTS: [(IcpVariant, &str); 2] = [
    (IcpVariant::PointToPoint, "p2p"),
    (IcpVariant::PointToPlane, "p2l"),
];
const PLACES: [(BasinPlace, &str); 2] = [(BasinPlace::Room, "room"), (BasinPlace::Fence, "fence")];
const AXES: [(OffsetAxis, &str); 2] = [(OffsetAxis::Dx, "dx"), (OffsetAxis::Dy, "dy")];
const LOOPS: [(LoopClosure, &str); 2] = [(LoopClosure::On, "on"), (LoopClosure::Off, "off")];
const GATES: [(GateModel, &str); 2] = [
    (GateModel::PathApproximation, "path"),
    (GateModel::ExactMarginal, "exact"),
];
const FRAMES: [(InformationFrame, &str); 2] = [
    (InformationFrame::Chapter, "chapter"),
    (InformationFrame::Exact, "exact"),
];
/// The world of a custom course.
const OWN: &str = "own";

fn word<T: PartialEq>(words: &[(T, &'static str)], of: &T) -> &'static str {
    let found = words.iter().find(|(value, _)| value == of);
    found.map_or("", |(_, word)| word)
}

impl Display for Order {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let name = self.function.name();
        match &self.task {
            Task::Registration(task) => write!(f, "{SEAT} {name} registration {task}"),
            Task::Cells(task, cells) => {
                write!(f, "{SEAT} {name} cells {task}")?;
                let mut cells = cells.iter();
                cells.try_for_each(|[column, row]| write!(f, " {column} {row}"))
            }
            Task::Lap(task) => write!(f, "{SEAT} {name} lap {task}"),
        }
    }
}

impl Display for BasinTask {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self {
            place,
            seed,
            start,
            config,
            axes,
        } = self;
        write!(
            f,
            "{} {} {seed} {} {} {} {} {} {} {} {} {} {} {} {}",
            word(&VARIANTS, &config.variant),
            word(&PLACES, place),
            start.heading_deg,
            start.dx_m,
            start.dy_m,
            config.tau_m,
            config.trim,
            config.huber_width_m,
            config.max_iterations,
            axes.columns,
            axes.rows,
            axes.offset_span_m,
            word(&AXES, &axes.axis),
            axes.other_offset_m,
        )
    }
}

impl Display for LapTask {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { settings, course } = self;
        write!(
            f,
            "{} {} {} {} {} {} {} {} {} {} {} {course}",
            settings.world.map_or(OWN, |world| world.name()),
            settings.seed,
            settings.noise_factor,
            word(&LOOPS, &settings.loop_closure),
            settings.gate_chi2,
            word(&GATES, &settings.gate_model),
            settings.matcher.name(),
            word(&FRAMES, &settings.information_frame),
            settings.normals_cells.unwrap_or(0.0),
            settings.is_capped,
            settings.keeps_misses,
        )
    }
}

impl FromStr for Order {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut words = Words(text.split(' '));
        words.order().ok_or_else(|| format!("`{text}` is no order"))
    }
}

/// The words of an order that are still unread.
struct Words<'a>(std::str::Split<'a, char>);

impl Words<'_> {
    fn next<T: FromStr>(&mut self) -> Option<T> {
        self.0.next()?.parse().ok()
    }

    fn one_of<T: Copy>(&mut self, words: &[(T, &str)]) -> Option<T> {
        let given = self.0.next()?;
        let found = words.iter().find(|(_, word)| *word == given);
        found.map(|(value, _)| *value)
    }

    fn order(&mut self) -> Option<Order> {
        if self.0.next()? != SEAT {
            return None;
        }
        let function = Function::named(self.0.next()?)?;
        let what = self.0.next()?;
        let task = match what {
            "registration" => Task::Registration(self.basin(function)?),
            "cells" => {
                let task = self.basin(function)?;
                let cells = self.cells(&task.axes)?;
                Task::Cells(task, cells)
            }
            "lap" => Task::Lap(self.lap()?),
            _ => return None,
        };
        Some(Order { function, task })
    }

    fn basin(&mut self, function: Function) -> Option<BasinTask> {
        let variant = self.one_of(&VARIANTS)?;
        function.fits(variant).then_some(())?;
        Some(BasinTask {
            place: self.one_of(&PLACES)?,
            seed: self.next()?,
            start: BasinStart {
                heading_deg: self.next()?,
                dx_m: self.next()?,
                dy_m: self.next()?,
            },
            config: IcpConfig {
                tau_m: self.next()?,
                trim: self.next()?,
                huber_width_m: self.next()?,
                max_iterations: self.next()?,
                ..BasinScene::config(variant, 0.0)
            },
            axes: BasinMapAxes {
                columns: self.next()?,
                rows: self.next()?,
                offset_span_m: self.next()?,
                axis: self.one_of(&AXES)?,
                other_offset_m: self.next()?,
            },
        })
    }

    fn cells(&mut self, axes: &BasinMapAxes) -> Option<Vec<[usize; 2]>> {
        let mut cells = Vec::new();
        while let Some(column) = self.0.next() {
            let cell = [column.parse().ok()?, self.next()?];
            (cell[0] < axes.columns && cell[1] < axes.rows).then(|| cells.push(cell))?;
        }
        Some(cells)
    }

    fn lap(&mut self) -> Option<LapTask> {
        let world = self.0.next()?;
        let built_in = BuiltInWorld::named(world);
        if built_in.is_none() && world != OWN {
            return None;
        }
        Some(LapTask {
            settings: LapSettings {
                world: built_in,
                seed: self.next()?,
                noise_factor: self.next()?,
                loop_closure: self.one_of(&LOOPS)?,
                gate_chi2: self.next()?,
                gate_model: self.one_of(&GATES)?,
                matcher: LapMatcher::named(self.0.next()?)?,
                information_frame: self.one_of(&FRAMES)?,
                normals_cells: self.next().map(|cells| (cells > 0.0).then_some(cells))?,
                is_capped: self.next()?,
                keeps_misses: self.next()?,
            },
            course: self.next()?,
        })
    }
}
