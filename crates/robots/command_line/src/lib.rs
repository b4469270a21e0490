//! What the commands of this workspace share: their frame, output, numbers, files, and how they open a recorded log.

pub mod choice;
pub mod in_file;
pub mod interrupt;
pub mod log_args;
pub mod log_file;
pub mod numbers;
pub mod output;
pub mod program;
pub mod progress;
pub mod setting;
pub mod whole_file;
