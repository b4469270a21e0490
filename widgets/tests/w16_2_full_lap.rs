//! The widget through its shell.

mod shell;
