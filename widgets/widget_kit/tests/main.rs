//! Integration tests of the kit on a widget made for the tests: one binary, one module for each part.

mod draw;
mod fake;
mod palette;
mod shell;
