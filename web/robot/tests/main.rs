//! Integration tests of the worker, without a browser.

mod engine;
mod input;
mod sessions;
