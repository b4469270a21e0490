//! What the worker promises, without any browser.

mod engine;
mod given;
mod sessions;
