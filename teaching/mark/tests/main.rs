//! Tests of the command line.

mod mark;
mod support;
