//! The worker that maps logs, linked to one module. All of it is in [`slam_robot`].

extern crate slam_robot as _;
