//! Slow results, computed once for all tests.

use std::collections::BTreeMap;
use std::sync::{Mutex, OnceLock, PoisonError};

/// Results by name. Tests that ask for one at the same time wait for the same computation.
pub struct Shared<T: 'static>(Mutex<BTreeMap<String, &'static OnceLock<Option<T>>>>);

impl<T> Shared<T> {
    /// No results.
    pub const fn new() -> Self {
        Self(Mutex::new(BTreeMap::new()))
    }

    /// The result of that name, computed on first use; `None` if the computation yields none.
    pub fn get(&self, name: &str, compute: impl FnOnce() -> Option<T>) -> Option<&'static T> {
        let result = {
            // A map of cells is whole after every panic.
            let mut results = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            *results
                .entry(name.to_owned())
                .or_insert_with(|| Box::leak(Box::default()))
        };
        result.get_or_init(compute).as_ref()
    }
}
