//! The reader's function in place of the increment, beside ours.

use ch16_lab::basin::BasinOutcome;
use ch16_lab::reader_code::{ANSWERS, Answers, BasinTask, Function, SEAT, Task};
use ch16_slam2d::icp::{IcpConfig, IcpVariant};
use widget_kit::host_messages::Delivery;
use widget_kit::model::Activity;

use super::basins::map_axes;
use super::settings::{config, start, variant};
use super::{BasinExplorer, Preview, Run};
use crate::reader_orders::Orders;
use crate::w16_1_basin_explorer::spec::{SCENE, SEED, TRIM, VARIANT};

/// Cells of the basin map in one order.
const CELLS_PER_ORDER: usize = 128;

/// The share of pairs to drop as a rejection takes its seat.
const SHARE_TO_DROP: f64 = 0.25;

/// The function that drives.
pub struct YourCode {
    pub orders: Orders,
    /// An increment drives while the variant of its error is selected, a rejection of pairs any.
    variant: IcpVariant,
    /// The pairs that it drops at each iteration, if it rejects pairs.
    dropped: Vec<Vec<usize>>,
    /// Our result from the same start.
    pub ours: BasinOutcome,
    /// Whether the run on screen is that of the function.
    is_shown: bool,
}

impl BasinExplorer {
    /// The function whose run is on screen.
    pub(super) fn driver(&self) -> Option<&YourCode> {
        self.yours.as_ref().filter(|yours| yours.is_shown)
    }

    /// The pairs that the function drops at an iteration, if it rejects pairs.
    pub(super) fn dropped_at(&self, iteration: usize) -> Option<&[usize]> {
        let dropped = self.driver()?.dropped.get(iteration)?;
        Some(dropped)
    }

    /// The name of the function whose basin map a variant has.
    pub(super) fn mapped_by(&self, of: IcpVariant) -> Option<&'static str> {
        let yours = self.yours.as_ref().filter(|yours| yours.variant == of)?;
        Some(yours.orders.function.name())
    }

    /// Seats a function, or takes its answers.
    pub(super) fn take_delivery(&mut self, delivery: &Delivery<'_>) {
        match delivery.kind {
            SEAT => self.seat(Function::named(delivery.text)),
            ANSWERS => self.take_answers(delivery.text, delivery.numbers),
            _ => {}
        }
    }

    fn seat(&mut self, function: Option<Function>) {
        let (ours, selected) = (self.run.outcome, variant(&self.values));
        let function = function.filter(|function| function.registers());
        self.yours = function.map(|function| YourCode {
            orders: Orders::new(function),
            variant: function.variant().unwrap_or(selected),
            dropped: Vec::new(),
            ours,
            is_shown: false,
        });
        let variant = self.yours.as_ref().map(|yours| yours.variant);
        if let Some(variant) = variant {
            self.playback.pause();
            self.values.put(&VARIANT, variant);
            self.preview = Preview::Shown;
        }
        if function == Some(Function::KeepPairs) && self.values.get(&TRIM) == 0.0 {
            // With nothing to drop, the right function keeps all pairs.
            self.values.put(&TRIM, SHARE_TO_DROP);
        }
        self.register();
        self.follow();
        self.basins.give(variant, &self.values);
    }

    fn task(&self, variant: IcpVariant) -> BasinTask {
        let values = &self.values;
        BasinTask {
            place: values.get(&SCENE),
            seed: values.get(&SEED),
            start: start(values),
            config: config(values, variant),
            axes: map_axes(values),
        }
    }

    /// Orders the registration from the current start. Until it is here, the source stands at its start.
    pub(super) fn order_registration(&mut self) {
        let selected = variant(&self.values);
        let Some(yours) = &mut self.yours else {
            return;
        };
        if yours.variant != selected && yours.orders.function.fits(selected) {
            yours.variant = selected;
            self.basins.give(Some(selected), &self.values);
        }
        let variant_of_yours = yours.variant;
        let task = self.task(variant_of_yours);
        let ours = self.run.outcome;
        if let Some(yours) = &mut self.yours {
            yours.is_shown = false;
            if yours.variant != selected {
                return;
            }
            yours.ours = ours;
            yours.orders.want(Task::Registration(task.clone()));
        }
        let unmoved = IcpConfig {
            max_iterations: 0,
            ..task.config
        };
        let outcome = (self.scene).register_from(&task.start, &unmoved, &mut self.workspace);
        self.run = Run {
            trace: self.workspace.trace().to_vec(),
            outcome,
        };
    }

    /// Orders the next cells of the basin map.
    pub(super) fn order_cells(&mut self) -> Activity {
        let idle = self.yours.as_ref().filter(|yours| yours.orders.is_idle());
        let Some(variant) = idle.map(|yours| yours.variant) else {
            return Activity::Idle;
        };
        let cells = self.basins.ahead(CELLS_PER_ORDER);
        if cells.is_empty() {
            return Activity::Idle;
        }
        let task = self.task(variant);
        if let Some(yours) = &mut self.yours {
            yours.orders.want(Task::Cells(task, cells));
        }
        Activity::Busy
    }

    fn take_answers(&mut self, order: &str, numbers: &[f64]) {
        let Some(yours) = &mut self.yours else {
            return;
        };
        match yours.orders.answered(order) {
            Some(Task::Cells(task, _)) if self.basins.is_of(&task.axes, &task.config) => {
                self.basins.put(numbers);
            }
            Some(Task::Registration(task)) if yours.variant == variant(&self.values) => {
                let (function, answers) = (yours.orders.function, Answers::new(numbers));
                let workspace = &mut self.workspace;
                let outcome =
                    task.register(&self.scene, &task.start, function, &answers, workspace);
                if function == Function::KeepPairs {
                    yours.dropped = Answers::each_dropped(numbers);
                }
                self.run = Run {
                    trace: workspace.trace().to_vec(),
                    outcome,
                };
                yours.is_shown = true;
            }
            _ => {}
        }
    }
}
