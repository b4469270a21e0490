//! Native tests of the worker, without a browser.

mod engine;
mod given;
mod sessions;
