//! The widget from outside: its model, its texts, its view. One binary, one module for each.

mod control_room;
mod texts;
