//! The reader's function in place of the increment, beside ours.

use ch16_lab::basin::BasinOutcome;
use ch16_slam2d::icp::{IcpConfig, IcpVariant};
use widget_kit::host_messages::Delivery;
use widget_kit::model::Activity;

use super::settings::{config, start, variant};
use super::{BasinExplorer, Preview, Run};
use crate::w16_1_basin_explorer::spec::VARIANT;
use crate::your_code::{ANSWERS, Answers, Function, Orders, SEAT};

/// Cells of the basin map in one order.
const CELLS_PER_ORDER: usize = 64;

/// The function that drives.
pub struct YourCode {
    pub orders: Orders,
    /// The error that its increment reduces: it drives while this variant is selected.
    variant: IcpVariant,
    /// Our result from the same start.
    pub ours: BasinOutcome,
    /// Whether the run on screen is that of the function.
    is_shown: bool,
    /// How often the maps had been emptied as cells were ordered.
    emptied: usize,
}

impl BasinExplorer {
    /// The function whose run is on screen.
    pub(super) fn driver(&self) -> Option<&YourCode> {
        self.yours.as_ref().filter(|yours| yours.is_shown)
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
        let ours = self.run.outcome;
        let seated = |function: Function| {
            Some(YourCode {
                orders: Orders::new(function),
                variant: function.variant()?,
                ours,
                is_shown: false,
                emptied: 0,
            })
        };
        self.yours = function.and_then(seated);
        let variant = self.yours.as_ref().map(|yours| yours.variant);
        if let Some(variant) = variant {
            self.playback.pause();
            self.values.put(&VARIANT, variant);
            self.preview = Preview::Shown;
        }
        self.register();
        self.follow();
        self.basins.give(variant, &self.values);
    }

    /// Orders the registration from the current start. Until it is here, the source stands at its start.
    pub(super) fn order_registration(&mut self) {
        let Some(yours) = &mut self.yours else {
            return;
        };
        yours.is_shown = false;
        if yours.variant != variant(&self.values) {
            return;
        }
        yours.ours = self.run.outcome;
        yours.orders.want("registration", &self.values);
        let unmoved = IcpConfig {
            max_iterations: 0,
            ..config(&self.values, yours.variant)
        };
        let start = start(&self.values);
        let outcome = (self.scene).register_from(&start, &unmoved, &mut self.workspace);
        self.run = Run {
            trace: self.workspace.trace().to_vec(),
            outcome,
        };
    }

    /// Orders the next cells of the basin map.
    pub(super) fn order_cells(&mut self) -> Activity {
        let Some(yours) = self.yours.as_mut().filter(|yours| yours.orders.is_idle()) else {
            return Activity::Idle;
        };
        let cells = self.basins.ahead(CELLS_PER_ORDER);
        if cells.is_empty() {
            return Activity::Idle;
        }
        let cells: Vec<String> = cells.iter().map(|[c, r]| format!("{c}.{r}")).collect();
        yours.emptied = self.basins.emptied;
        let what = format!("cells={}", cells.join(","));
        yours.orders.want(&what, &self.values);
        Activity::Busy
    }

    fn take_answers(&mut self, order: &str, numbers: &[f64]) {
        let Some(yours) = &mut self.yours else {
            return;
        };
        if !yours.orders.answered(order) {
            return;
        }
        if order.contains(" cells=") {
            if yours.emptied == self.basins.emptied {
                self.basins.put(numbers);
            }
            return;
        }
        if yours.variant != variant(&self.values) {
            return;
        }
        let config = config(&self.values, yours.variant);
        let (start, answers) = (start(&self.values), Answers::new(numbers));
        let workspace = &mut self.workspace;
        let outcome = (self.scene).register_with(&start, &config, &answers, workspace);
        self.run = Run {
            trace: workspace.trace().to_vec(),
            outcome,
        };
        yours.is_shown = true;
    }
}
