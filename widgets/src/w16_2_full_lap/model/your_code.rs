//! The reader's function in place of the increments or of the gate of the lap.

use std::sync::Arc;

use ch16_lab::lap::NewestLap;
use ch16_lab::reader_code::{ANSWERS, Answers, Function, LapTask, SEAT, Task};
use widget_kit::host_messages::Delivery;

use super::FullLap;
use super::settings;
use crate::reader_orders::Orders;

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

    /// The task of the settings.
    pub(super) fn task(&self) -> Task {
        Task::Lap(LapTask {
            settings: settings::read(&self.values),
            course: self.values.to_text("flat"),
        })
    }

    fn take_answers(&mut self, order: &str, numbers: &[f64]) {
        let Some(orders) = self.yours.as_mut() else {
            return;
        };
        let Some(Task::Lap(task)) = orders.answered(order) else {
            return;
        };
        let answers = Arc::new(Answers::new(numbers));
        if let Ok((config, parts)) = task.lap(orders.function, answers) {
            self.laps.ask_with_parts(config, parts);
        }
    }
}
