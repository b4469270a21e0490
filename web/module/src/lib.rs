//! Links the widgets to one module for the page. The code is in [`slam_web`].

extern crate slam_web as _;
