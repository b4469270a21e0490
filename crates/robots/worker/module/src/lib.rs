//! The module of the worker that maps logs. The implementation is in [`slam_robot`].

extern crate slam_robot as _;
