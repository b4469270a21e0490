//! Printing of the subcommands.

use std::fmt::Arguments;
use std::io::{ErrorKind, Write, stdout};
use std::process::exit;
use std::sync::OnceLock;

use pr_geom::SE2;
use serde::Serialize;

static NAME: OnceLock<&str> = OnceLock::new();

/// Sets the name of the running command, once.
pub fn name_program(program: &'static str) {
    NAME.get_or_init(|| program);
}

/// The name of the running command, which stands before its messages.
#[must_use]
pub fn name() -> &'static str {
    NAME.get().copied().unwrap_or("slam2d")
}

/// Prints one line to standard output like `println!`, but exits silently if the reader of a
/// pipe has closed it, as `head` does.
#[macro_export]
macro_rules! say {
    ($($text:tt)*) => { $crate::output::print_line(format_args!($($text)*)) };
}
pub use say;

/// Implementation of [`say!`].
pub fn print_line(line: Arguments<'_>) {
    match writeln!(stdout().lock(), "{line}") {
        Ok(()) => {}
        Err(error) if error.kind() == ErrorKind::BrokenPipe => exit(0),
        Err(error) => {
            eprintln!("{}: standard output: {error}", name());
            exit(2);
        }
    }
}

/// Prints one JSON value on one line.
pub fn print_json(value: &impl Serialize) {
    let line = serde_json::to_string(value).expect("plain numbers, strings and lists");
    say!("{line}");
}

/// Formats a pose as `x y heading°`.
pub fn pose(pose: &SE2) -> String {
    format!(
        "({:.4} m, {:.4} m, {:.3}°)",
        pose.x(),
        pose.y(),
        pose.theta().to_degrees()
    )
}
