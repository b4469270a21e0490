//! The worker's half: executes an order with a function.

use std::rc::Rc;
use std::sync::Arc;

use ch16_slam2d::icp::IcpWorkspace;

use super::{BasinTask, Callable, Function, Order, Recorder, Task};
use crate::basin::{BasinPlace, BasinScene, BasinStart};
use crate::lap::{LapRun, LapRunner};

/// Executes orders, and keeps what takes long to compute between them.
#[derive(Default)]
pub struct Executor {
    scene: Option<(BasinPlace, u32, Rc<BasinScene>)>,
    runner: LapRunner,
}

/// An order under way.
pub struct Job {
    named: Function,
    function: Arc<Recorder>,
    work: Work,
}

enum Work {
    Basin {
        scene: Rc<BasinScene>,
        task: BasinTask,
        /// Starts of the cells, the next one last; `None` for a single registration.
        left: Option<Vec<BasinStart>>,
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
        let Order {
            function: named,
            task,
        } = order.parse()?;
        let function = Arc::new(Recorder {
            function: Arc::clone(function),
            numbers: Default::default(),
        });
        let work = match task {
            Task::Registration(task) => self.basin(task, None),
            Task::Cells(task, cells) => {
                let starts = cells.iter().rev();
                let starts = starts.map(|&[column, row]| task.axes.start(column, row));
                let starts = starts.collect();
                self.basin(task, Some(starts))
            }
            Task::Lap(task) => {
                let (config, parts) = task.lap(named, Arc::clone(&function))?;
                Work::Lap(Box::new(self.runner.start_with_parts(config, parts)))
            }
        };
        Ok(Job {
            named,
            function,
            work,
        })
    }

    fn basin(&mut self, task: BasinTask, left: Option<Vec<BasinStart>>) -> Work {
        let wanted = (task.place, task.seed);
        let kept = self
            .scene
            .take()
            .filter(|(place, seed, _)| (*place, *seed) == wanted);
        let (.., scene) = kept.unwrap_or_else(|| {
            let scene = BasinScene::at(task.place, task.seed);
            (task.place, task.seed, Rc::new(scene))
        });
        self.scene = Some((task.place, task.seed, Rc::clone(&scene)));
        Work::Basin {
            scene,
            task,
            letters: Vec::new(),
            left,
        }
    }
}

impl Job {
    /// Does a piece of the work. Returns the result at the end: what the function answered, or, for cells of a basin
    /// map, the letter of the minimum of each.
    pub fn step(&mut self) -> Option<Vec<f64>> {
        match &mut self.work {
            Work::Basin {
                scene,
                task,
                left,
                letters,
            } => {
                let next = left.as_mut().map_or(Some(task.start), Vec::pop);
                let workspace = &mut IcpWorkspace::new();
                let (named, function) = (self.named, &*self.function);
                let end =
                    next.map(|start| task.register(scene, &start, named, function, workspace));
                let Some(left) = left else {
                    return Some(self.function.take());
                };
                letters.extend(end.map(|end| f64::from(u32::from(end.ending.letter()))));
                left.is_empty().then(|| core::mem::take(letters))
            }
            Work::Lap(run) => run.step().map(|_| self.function.take()),
        }
    }
}
