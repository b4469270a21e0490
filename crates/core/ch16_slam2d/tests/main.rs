//! Integration tests of the system: one binary, one module for each part.

mod alignment;
mod any_frame;
mod examples;
mod listings;
mod nearest;
mod reasons;
mod support;
