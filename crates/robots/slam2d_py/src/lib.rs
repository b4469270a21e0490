//! Scan matching and pose-graph SLAM for Python: the package `rustslam2d`.
//!
//! It contains no algorithm: it passes arrays of numpy to the core's functions and returns their results as arrays. The
//! interpreter's lock is released while they compute. Errors of the core become exceptions with the same sentence, and
//! arguments that would make the core panic are checked here. `python/rustslam2d/__init__.pyi` has the signatures for editors.
//!
//! PyO3's macros write the code that the interpreter calls. They need no exception from `unsafe_code = "forbid"`: that
//! lint does not apply to code that a macro of another crate generates.

mod arrays;
mod callables;
mod connection;
mod errors;
mod evaluation;
mod grid_map;
mod interrupts;
mod localizer;
mod log_files;
mod log_options;
mod motions;
mod pictures;
mod pose_graph;
mod reduced;
mod registration;
mod restored;
mod run_log;
mod sensor;
mod sessions;
mod settings;
mod simulation;
mod slam;
mod slam_step;
mod steps;
mod trajectories;

use pyo3::prelude::*;

/// Scan matching and pose-graph SLAM for a planar laser.
///
/// A pose is an array (x, y, θ) of shape (3,), in m, m, rad; poses are of shape (n, 3), points of shape (n, 2), m.
/// Covariances and informations have the order x, y, θ and belong to perturbations on the right of a pose. Every result
/// has the same bits on every machine, and those of the command `slam2d`.
#[pymodule]
mod _rustslam2d {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::connection::{RobotConnection, connect};
    #[pymodule_export]
    use super::errors::{
        ArrayError, ChoiceError, EvaluationError, FrameError, GraphError, LogError, OptimizeError,
        SettingError, SlamError,
    };
    #[pymodule_export]
    use super::evaluation::evaluate;
    #[pymodule_export]
    use super::grid_map::GridMap;
    #[pymodule_export]
    use super::localizer::{Fix, Localizer};
    #[pymodule_export]
    use super::motions::{between, compose, exp, inverse, log, transform};
    #[pymodule_export]
    use super::pose_graph::{OptimizeReport, PoseGraph, chi2_gate};
    #[pymodule_export]
    use super::registration::{IcpResult, Ndt, NdtResult, icp, normals};
    #[pymodule_export]
    use super::restored::_restored;
    #[pymodule_export]
    use super::run_log::{LogResult, Pipeline};
    #[pymodule_export]
    use super::sensor::Sensor;
    #[pymodule_export]
    use super::settings::settings;
    #[pymodule_export]
    use super::simulation::{Drive, simulate};
    #[pymodule_export]
    use super::slam::Slam;
    #[pymodule_export]
    use super::slam_step::SlamStep;
    #[pymodule_export]
    use super::trajectories::save_tum;

    /// Adds the version, and the error that has two bases.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        let number_error = super::errors::number_error(module.py())?;
        module.add("NumberError", number_error)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
