//! The workloads, linked to one module for browsers. All of it is in [`slam2d_bench`].

extern crate slam2d_bench as _;
