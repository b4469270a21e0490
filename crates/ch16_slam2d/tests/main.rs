//! The system from outside: one binary, one module for each part.

mod alignment;
mod examples;
mod listings;
mod nearest;
