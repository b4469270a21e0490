//! Native tests of the worker, without a browser.

mod driving;
mod engine;
mod given;
mod sessions;
