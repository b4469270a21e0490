//! The orders of a widget: at most one is under way, and at most one, the newest, waits for it.

use widget_kit::values::Values;

use super::{Function, query};

/// Orders of one widget to the function that drives it.
#[derive(Debug)]
pub struct Orders {
    /// The function that drives.
    pub function: Function,
    under_way: Option<String>,
    waiting: Option<String>,
    unsent: Vec<String>,
}

impl Orders {
    /// No order yet.
    #[must_use]
    pub fn new(function: Function) -> Self {
        Self {
            function,
            under_way: None,
            waiting: None,
            unsent: Vec::new(),
        }
    }

    /// Orders a computation with these values; one that still waits is dropped.
    pub fn want(&mut self, what: &str, values: &Values) {
        let name = self.function.name();
        let order = format!("{} {name} {what} {}", super::SEAT, query(values));
        if self.under_way.is_some() {
            self.waiting = Some(order);
        } else {
            self.send(order);
        }
    }

    fn send(&mut self, order: String) {
        self.under_way = Some(order.clone());
        self.unsent.push(order);
    }

    /// Whether nothing is under way.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        self.under_way.is_none()
    }

    /// Records the answers to an order. Returns whether they are still wanted: it is under way, and no newer one waits.
    pub fn answered(&mut self, order: &str) -> bool {
        if self.under_way.as_deref() != Some(order) {
            return false;
        }
        self.under_way = None;
        match self.waiting.take() {
            Some(newer) => {
                self.send(newer);
                false
            }
            None => true,
        }
    }

    /// The orders since the last call.
    pub fn take(&mut self) -> Vec<String> {
        core::mem::take(&mut self.unsent)
    }
}
