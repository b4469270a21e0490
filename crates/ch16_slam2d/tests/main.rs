//! The system from outside: one binary, one module for each part.

mod alignment;
mod listings;
mod nearest;
