//! Links the worker that maps logs to one module. The code is in [`slam_robot`].

extern crate slam_robot as _;
