//! The widgets, linked to one module for the page. All of it is in [`slam_web`].

extern crate slam_web as _;
