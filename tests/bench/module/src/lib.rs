//! Links the workloads to one module for browsers. The code is in [`slam2d_bench`].

extern crate slam2d_bench as _;
