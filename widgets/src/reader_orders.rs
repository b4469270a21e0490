//! The orders of a widget to a reader's function: at most one is under way, and at most one, the newest, waits for it.

use ch16_lab::reader_code::{Function, Order, Task};

/// Orders of one widget to the function that drives it.
#[derive(Debug)]
pub struct Orders {
    /// The function that drives.
    pub function: Function,
    under_way: Option<Order>,
    waiting: Option<Order>,
    unsent: Vec<String>,
}

impl Orders {
    /// No order yet.
    pub fn new(function: Function) -> Self {
        Self {
            function,
            under_way: None,
            waiting: None,
            unsent: Vec::new(),
        }
    }

    /// Orders a computation; one that still waits is dropped.
    pub fn want(&mut self, task: Task) {
        let function = self.function;
        let order = Order { function, task };
        if self.under_way.is_some() {
            self.waiting = Some(order);
        } else {
            self.send(order);
        }
    }

    fn send(&mut self, order: Order) {
        self.unsent.push(order.to_string());
        self.under_way = Some(order);
    }

    /// Whether nothing is under way.
    pub fn is_idle(&self) -> bool {
        self.under_way.is_none()
    }

    /// Takes note of the answers to an order. Returns its task if they are still wanted: it was under way, and no newer one
    /// waits.
    pub fn answered(&mut self, text: &str) -> Option<Task> {
        let order = (self.under_way).take_if(|order| order.to_string() == text)?;
        match self.waiting.take() {
            Some(newer) => {
                self.send(newer);
                None
            }
            None => Some(order.task),
        }
    }

    /// The orders since the last call.
    pub fn take(&mut self) -> Vec<String> {
        core::mem::take(&mut self.unsent)
    }
}
