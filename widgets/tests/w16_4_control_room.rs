//! The widget from outside: its model, its words, its view. One binary, one module for each.

mod control_room;
mod view;
mod words;
