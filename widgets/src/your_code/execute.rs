//! The worker's half: executes an order with a function.

use std::rc::Rc;
use std::sync::Arc;

use ch16_lab::basin::{BasinMapAxes, BasinScene, BasinStart};
use ch16_lab::lap::{LapRun, LapRunner};
use ch16_slam2d::icp::{IcpConfig, IcpWorkspace};
use widget_kit::values::Values;

use super::{Callable, Function, Recorder, values_of};
use crate::{w16_1_basin_explorer as basin, w16_2_full_lap as lap};

/// Executes orders, and keeps between them what takes long to compute.
#[derive(Default)]
pub struct Executor {
    scene: Option<Rc<BasinScene>>,
    /// The place and the seed of that scene.
    scene_of: String,
    runner: LapRunner,
}

/// An order under way.
pub struct Job {
    function: Arc<Recorder>,
    task: Task,
}

enum Task {
    Registration {
        scene: Rc<BasinScene>,
        start: BasinStart,
        config: IcpConfig,
    },
    Cells {
        scene: Rc<BasinScene>,
        axes: BasinMapAxes,
        config: IcpConfig,
        /// Columns and rows, the next one last.
        left: Vec<[usize; 2]>,
        letters: Vec<f64>,
    },
    Lap(Box<LapRun>),
}

impl Executor {
    /// Starts an order.
    ///
    /// # Errors
    /// If it is none; the message is one sentence.
    pub fn begin(&mut self, order: &str, function: &Arc<dyn Callable>) -> Result<Job, String> {
        let mut words = order.split(' ');
        let none = || format!("`{order}` is no order");
        if words.next() != Some(super::SEAT) {
            return Err(none());
        }
        let named = words.next().and_then(Function::named).ok_or_else(none)?;
        let what = words.next().unwrap_or_default();
        let function = Arc::new(Recorder {
            function: Arc::clone(function),
            numbers: Default::default(),
        });
        let mut query = || words.next().unwrap_or_default();
        let task = match what {
            "registration" => {
                let values = values_of(&basin::spec::SPEC, query())?;
                Task::Registration {
                    scene: self.scene(&values),
                    start: basin::model::start(&values),
                    config: basin::model::config(&values, named.variant().ok_or_else(none)?),
                }
            }
            "lap" => {
                let values = values_of(&lap::spec::SPEC, query())?;
                let (config, parts) = lap::model::your_lap(&values, named, function.clone())?;
                Task::Lap(Box::new(self.runner.start_with_parts(config, parts)))
            }
            cells if cells.starts_with("cells=") => {
                let values = values_of(&basin::spec::SPEC, query())?;
                let variant = named.variant().ok_or_else(none)?;
                let mut left = cells_of(cells).ok_or_else(none)?;
                left.reverse();
                Task::Cells {
                    scene: self.scene(&values),
                    axes: basin::model::map_axes(&values),
                    config: basin::model::config(&values, variant),
                    letters: Vec::with_capacity(left.len()),
                    left,
                }
            }
            _ => return Err(none()),
        };
        Ok(Job { function, task })
    }

    fn scene(&mut self, values: &Values) -> Rc<BasinScene> {
        let wanted = [values.to_text("scene"), values.to_text("seed")].join(" ");
        if self.scene_of != wanted {
            self.scene = None;
            self.scene_of = wanted;
        }
        let scene = self
            .scene
            .get_or_insert_with(|| Rc::new(basin::model::scene_of(values)));
        Rc::clone(scene)
    }
}

impl Job {
    /// Does a piece of the work. Returns the result at the end: what the function answered, or, for cells of a basin
    /// map, the letter of the minimum of each.
    pub fn step(&mut self) -> Option<Vec<f64>> {
        let workspace = &mut IcpWorkspace::new();
        match &mut self.task {
            Task::Registration {
                scene,
                start,
                config,
            } => {
                scene.register_with(start, config, &*self.function, workspace);
            }
            Task::Cells {
                scene,
                axes,
                config,
                left,
                letters,
            } => {
                if let Some([column, row]) = left.pop() {
                    let start = axes.start(column, row);
                    let found = scene.register_with(&start, config, &*self.function, workspace);
                    letters.push(f64::from(u32::from(found.ending.letter())));
                }
                return left.is_empty().then(|| core::mem::take(letters));
            }
            Task::Lap(run) => {
                run.step()?;
            }
        }
        Some(self.function.take())
    }
}

/// `cells=0.0,8.0` as columns and rows; `None` if a cell is none of the map.
fn cells_of(text: &str) -> Option<Vec<[usize; 2]>> {
    let cells = text.strip_prefix("cells=")?.split(',').map(|cell| {
        let (column, row) = cell.split_once('.')?;
        let cell: [usize; 2] = [column.parse().ok()?, row.parse().ok()?];
        let is_in = cell[0] < basin::model::COLUMNS && cell[1] < basin::model::ROWS;
        is_in.then_some(cell)
    });
    cells.collect()
}
