//! Scan registration: ICP and NDT.

use ch16_slam2d::cloud::{DenseMap, PointCloud};
use ch16_slam2d::icp::{Icp, IcpConfig, IcpVariant, IcpWorkspace, StopReason};
use ch16_slam2d::matching::{NdtMatcherConfig, TrustConfig, result_information};
use ch16_slam2d::ndt::{NdtConfig, NdtMap, NdtStop, ndt_align};
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods as _};
use pr_geom::SE2;
use pyo3::prelude::*;

use crate::arrays;
use crate::errors::{ChoiceError, count, no_choice, within};
use crate::interrupts::Listener;
use crate::reduced::{self, Reduced};

/// Width of a map cell as a share of the largest distance: a query then sees a handful of cells.
const CELL_PER_DISTANCE: f64 = 0.5;

/// What `icp` found.
#[pyclass(frozen, module = "rustslam2d")]
pub struct IcpResult {
    /// Pose target_from_source, shape (3,): x and y in m, θ in rad.
    #[pyo3(get)]
    pub pose: Py<PyArray1<f64>>,
    /// Covariance of the pose, shape (3, 3), of perturbations on its right in the order x, y, θ: m², m·rad, rad².
    /// None if the pairs leave a direction free, or if there are too few of them.
    #[pyo3(get)]
    pub covariance: Option<Py<PyArray2<f64>>>,
    /// The inverse of the covariance, shape (3, 3): of the pairs that the last increment used, by their weights; zero if
    /// the pose is no result of them.
    #[pyo3(get)]
    pub information: Py<PyArray2<f64>>,
    /// The initial guess and the pose after each increment, shape (iterations + 1, 3).
    #[pyo3(get)]
    pub trace: Py<PyArray2<f64>>,
    /// Root mean square residual of the pairs at each pose of the trace, m, shape (iterations + 1,).
    #[pyo3(get)]
    pub trace_rmse: Py<PyArray1<f64>>,
    /// The last pairs, shape (n, 2): indices into source and target.
    #[pyo3(get)]
    pub pairs: Py<PyArray2<i64>>,
    /// Root mean square residual of the last pairs, m; infinite without pairs.
    #[pyo3(get)]
    pub rmse: f64,
    /// Number of the last pairs.
    #[pyo3(get)]
    pub inliers: usize,
    /// Increments made.
    #[pyo3(get)]
    pub iterations: usize,
    /// Whether the increments became small, and enough pairs measure every direction.
    #[pyo3(get)]
    pub converged: bool,
    /// Why it ended: small-step, iteration-limit, too-few-pairs, too-few-normals, too-few-inliers (of the kernel),
    /// unobservable-direction or not-finite.
    #[pyo3(get)]
    pub stop: String,
    /// The motion x, y, θ that no pair measures, about the centroid of the pairs, of length 1, shape (3,); None if the
    /// pairs measure all. Along it, the pose is that of the guess.
    #[pyo3(get)]
    pub unobservable: Option<Py<PyArray1<f64>>>,
}

reduced::restorable! {
    IcpResult { pose, covariance, information, trace, trace_rmse, pairs, rmse, inliers, iterations, converged, stop,
        unobservable }
}

#[pymethods]
impl IcpResult {
    /// The pose as a homogeneous matrix, shape (3, 3).
    #[getter]
    fn matrix<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        arrays::matrix_of(self.pose.bind(py).as_any())
    }

    /// The pose as a homogeneous matrix of space, shape (4, 4), as small_gicp, kiss-icp and open3d use them.
    #[getter]
    fn matrix_3d<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        arrays::matrix_3d_of(self.pose.bind(py).as_any())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced::by_attributes(slf)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "IcpResult(pose={}, rmse={:.4}, inliers={}, iterations={}, stop={:?})",
            self.pose.bind(py).repr()?,
            self.rmse,
            self.inliers,
            self.iterations,
            self.stop
        ))
    }
}

/// The variants of ICP by their names.
const VARIANTS: [(&str, IcpVariant); 2] = [
    ("point-to-plane", IcpVariant::PointToPlane),
    ("point-to-point", IcpVariant::PointToPoint),
];

/// Registers `source` on `target` by iterative closest point.
///
/// It finds the minimum of the basin in which `init` lies. A small rmse means that pairs agree, not that they are the
/// right ones.
///
/// source: points, shape (n, 2), m.
/// target: points of the map, shape (m, 2), m.
/// init: initial guess of target_from_source, shape (3,): x and y in m, θ in rad; or a homogeneous matrix, shape (3, 3) or
///     (4, 4); the identity without it.
/// variant: "point-to-plane" (Chen & Medioni 1992) or "point-to-point" (Besl & McKay 1992).
/// max_distance: points farther from the map have no pair, m.
/// max_iterations: the most increments.
/// tolerance: an increment smaller than this ends it, m and rad added.
/// min_pairs: with fewer pairs it ends, and point-to-plane with fewer than twice as many that have a normal.
/// trim: share of the pairs to drop, the longest first.
/// huber_width: residual beyond which a pair weighs less, m.
/// normal_radius: radius within which target points give each other normals, m.
/// sigma: standard deviation of a point, m, for the covariance.
/// covariance_scale: factor of the covariance, because neighbouring points are not independent.
///
/// Raises ArrayError for a wrong shape or a number that is not finite, ChoiceError for an argument out of its range.
#[pyfunction]
#[pyo3(signature = (source, target, *, init=None, variant="point-to-plane", max_distance=0.5, max_iterations=25.0,
    tolerance=1e-4, min_pairs=8.0, trim=0.0, huber_width=f64::INFINITY, normal_radius=0.3, sigma=0.05, covariance_scale=12.0),
    text_signature = "(source, target, *, init=None, variant='point-to-plane', max_distance=0.5, max_iterations=25, \
        tolerance=1e-4, min_pairs=8, trim=0.0, huber_width=1e999, normal_radius=0.3, sigma=0.05, covariance_scale=12.0)")]
// Keyword arguments of Python.
#[expect(clippy::too_many_arguments)]
pub fn icp(
    py: Python<'_>,
    source: &Bound<'_, PyAny>,
    target: &Bound<'_, PyAny>,
    init: Option<&Bound<'_, PyAny>>,
    variant: &str,
    max_distance: f64,
    max_iterations: f64,
    tolerance: f64,
    min_pairs: f64,
    trim: f64,
    huber_width: f64,
    normal_radius: f64,
    sigma: f64,
    covariance_scale: f64,
) -> PyResult<IcpResult> {
    let source = arrays::cloud("source", source)?;
    let mut target = arrays::cloud("target", target)?;
    let init = arrays::pose_or("init", init, SE2::identity())?;
    let found = VARIANTS.iter().find(|(name, _)| *name == variant);
    let variant = found.ok_or_else(|| no_choice("variant", variant, &VARIANTS.map(|v| v.0)))?;
    let config = IcpConfig {
        variant: variant.1,
        max_iterations: count("max_iterations", max_iterations)?,
        tau_m: within("max_distance", max_distance, 1e-6, 1e6, " m")?,
        tolerance: within("tolerance", tolerance, 0.0, 1e6, "")?,
        min_pairs: count("min_pairs", min_pairs)?,
        trim: within("trim", trim, 0.0, 1.0, "")?,
        huber_width_m: within("huber_width", huber_width, 1e-9, f64::INFINITY, " m")?,
    };
    let normal_radius = within("normal_radius", normal_radius, 1e-6, 1e6, " m")?;
    let trust = TrustConfig {
        sigma_m: within("sigma", sigma, 1e-6, 1e6, " m")?,
        covariance_scale: within("covariance_scale", covariance_scale, 1e-6, 1e6, "")?,
        information_cap: f64::INFINITY,
    };
    let (found, map) = py.detach(|| {
        if config.variant == IcpVariant::PointToPlane {
            target.estimate_normals(normal_radius);
        }
        let map = DenseMap::from_cloud(&target, CELL_PER_DISTANCE * config.tau_m, usize::MAX);
        let found = interruptible(&source, &map, init, &config)?;
        Ok::<_, PyErr>((found, map))
    })?;
    let information = result_information(&found, &config, &trust);
    let unobservable = match found.stop {
        StopReason::Unobservable { direction } => Some(direction),
        _ => None,
    };
    let covariance = information.try_inverse().filter(|_| unobservable.is_none());
    let pairs = found.pairs.iter().flat_map(|pair| {
        let target = map.source_index(pair.target_index);
        [pair.source_index as i64, target as i64]
    });
    let pairs = PyArray1::from_vec(py, pairs.collect());
    let rmse = found.trace.iter().map(|at| at.rmse_m).collect();
    Ok(IcpResult {
        pose: arrays::of_pose(py, &found.pose).unbind(),
        covariance: covariance
            .map(|covariance| Ok::<_, PyErr>(arrays::of_matrix(py, &covariance)?.unbind()))
            .transpose()?,
        information: arrays::of_matrix(py, &information)?.unbind(),
        trace: arrays::of_poses(py, found.trace.iter().map(|at| at.pose))?.unbind(),
        trace_rmse: PyArray1::from_vec(py, rmse).unbind(),
        pairs: pairs.reshape([found.pairs.len(), 2])?.unbind(),
        rmse: found.rmse_m,
        inliers: found.inliers,
        iterations: found.trace.len() - 1,
        converged: found.stop.converged(),
        stop: match found.stop {
            StopReason::SmallStep { .. } => "small-step",
            StopReason::IterationLimit { .. } => "iteration-limit",
            StopReason::TooFewPairs { .. } => "too-few-pairs",
            StopReason::TooFewNormals { .. } => "too-few-normals",
            StopReason::TooFewInliers { .. } => "too-few-inliers",
            StopReason::Unobservable { .. } => "unobservable-direction",
            StopReason::NotFinite => "not-finite",
        }
        .to_owned(),
        unobservable: unobservable
            .map(|direction| PyArray1::from_vec(py, direction.to_vec()).unbind()),
    })
}

/// Runs ICP, and hears Ctrl-C meanwhile.
fn interruptible(
    source: &PointCloud,
    map: &DenseMap,
    init: SE2,
    config: &IcpConfig,
) -> PyResult<ch16_slam2d::icp::IcpResult> {
    let mut workspace = IcpWorkspace::new();
    let mut icp = Icp::new(source, map, init, config, &mut workspace);
    let mut listener = Listener::default();
    let (last, stop) = loop {
        let step = icp.step();
        if let Some(stop) = step.stop {
            break (step.trace, stop);
        }
        listener.listen()?;
    };
    Ok(ch16_slam2d::icp::IcpResult {
        pose: last.pose,
        rmse_m: last.rmse_m,
        inliers: last.pairs,
        trace: workspace.trace().to_vec(),
        pairs: workspace.pairs(map).collect(),
        stop,
    })
}

/// A unit normal for each point: the direction in which its neighbours scatter least; NaN at corners and where there are
/// few.
///
/// points: shape (n, 2), m.
/// radius: neighbours lie within it, m.
///
/// Returns shape (n, 2). The sign of a normal is arbitrary.
#[pyfunction]
#[pyo3(signature = (points, *, radius=0.3))]
pub fn normals<'py>(
    py: Python<'py>,
    points: &Bound<'_, PyAny>,
    radius: f64,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let mut cloud = arrays::cloud("points", points)?;
    let radius = within("radius", radius, 1e-6, 1e6, " m")?;
    py.detach(|| cloud.estimate_normals(radius));
    arrays::of_normals(py, (0..cloud.len()).map(|index| cloud.normal(index)))
}

/// Normal distributions transform: a map of Gaussians on a grid of cells (Biber & Straßer 2003).
///
/// points: points of the map, shape (n, 2), m.
/// cell: width of a cell, m; the basin is about as wide.
/// min_points: points that a cell needs, at least 2.
///
/// Raises ArrayError for a wrong shape or a number that is not finite, ChoiceError for an argument out of its range.
#[pyclass(frozen, module = "rustslam2d")]
pub struct Ndt {
    map: NdtMap,
}

/// Result of `Ndt.align`.
#[pyclass(frozen, module = "rustslam2d")]
pub struct NdtResult {
    /// Pose map_from_source, shape (3,): x and y in m, θ in rad.
    #[pyo3(get)]
    pub pose: Py<PyArray1<f64>>,
    /// The initial guess and the pose after each step, shape (k, 3).
    #[pyo3(get)]
    pub trace: Py<PyArray2<f64>>,
    /// Sum of the scores of all points, each 0 to a little more than 1.
    #[pyo3(get)]
    pub score: f64,
    /// Number of iterations.
    #[pyo3(get)]
    pub iterations: usize,
    /// Whether it is at a maximum that points in cells measure in every direction.
    #[pyo3(get)]
    pub converged: bool,
    /// Why it ended: small-gradient, no-better-step (a maximum, or the border of a cell), iteration-limit,
    /// too-few-points (in cells) or unobservable-direction.
    #[pyo3(get)]
    pub stop: String,
}

reduced::restorable! {
    NdtResult { pose, trace, score, iterations, converged, stop }
}

#[pymethods]
impl NdtResult {
    /// The pose as a homogeneous matrix, shape (3, 3).
    #[getter]
    fn matrix<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        arrays::matrix_of(self.pose.bind(py).as_any())
    }

    /// The pose as a homogeneous matrix of space, shape (4, 4), as small_gicp, kiss-icp and open3d use them.
    #[getter]
    fn matrix_3d<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        arrays::matrix_3d_of(self.pose.bind(py).as_any())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced::by_attributes(slf)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "NdtResult(pose={}, score={:.3}, iterations={}, stop={:?})",
            self.pose.bind(py).repr()?,
            self.score,
            self.iterations,
            self.stop
        ))
    }
}

#[pymethods]
impl Ndt {
    #[new]
    #[pyo3(signature = (points, *, cell=NdtMatcherConfig::default().cell_m,
        min_points=NdtMatcherConfig::default().min_points as f64),
        text_signature = "(points, *, cell=0.6, min_points=4)")]
    fn new(
        py: Python<'_>,
        points: &Bound<'_, PyAny>,
        cell: f64,
        min_points: f64,
    ) -> PyResult<Self> {
        let min_points = count("min_points", min_points)?;
        let points = arrays::cloud("points", points)?;
        let cell_m = within("cell", cell, 1e-6, 1e6, " m")?;
        if min_points < 2 {
            return Err(ChoiceError::new_err(format!(
                "min_points has to be at least 2, because one point has no covariance, not {min_points}"
            )));
        }
        Ok(Self {
            map: py.detach(|| NdtMap::build(&points, cell_m, min_points)),
        })
    }

    /// Registers `source` on the map by damped Gauss–Newton; the score never falls.
    ///
    /// source: points, shape (n, 2), m.
    /// init: initial guess of map_from_source, shape (3,), or a homogeneous matrix, shape (3, 3) or (4, 4); the identity
    ///     without it.
    #[pyo3(signature = (source, *, init=None, max_iterations=NdtConfig::default().max_iterations as f64),
        text_signature = "($self, source, *, init=None, max_iterations=25)")]
    fn align(
        &self,
        py: Python<'_>,
        source: &Bound<'_, PyAny>,
        init: Option<&Bound<'_, PyAny>>,
        max_iterations: f64,
    ) -> PyResult<NdtResult> {
        let source = arrays::cloud("source", source)?;
        let init = arrays::pose_or("init", init, SE2::identity())?;
        let config = NdtConfig {
            max_iterations: count("max_iterations", max_iterations)?,
            ..NdtConfig::default()
        };
        let found = py.detach(|| ndt_align(&source, &self.map, init, &config));
        Ok(NdtResult {
            pose: arrays::of_pose(py, &found.pose).unbind(),
            trace: arrays::of_poses(py, found.trace)?.unbind(),
            score: found.score,
            iterations: found.iterations,
            converged: found.stop.converged(),
            stop: match found.stop {
                NdtStop::SmallGradient { .. } => "small-gradient",
                NdtStop::NoBetterStep { .. } => "no-better-step",
                NdtStop::IterationLimit { .. } => "iteration-limit",
                NdtStop::TooFewPoints { .. } => "too-few-points",
                NdtStop::Unobservable => "unobservable-direction",
            }
            .to_owned(),
        })
    }

    /// The sum of the scores of all points of `source` at a pose map_from_source of shape (3,).
    #[pyo3(signature = (source, pose=None))]
    fn score(
        &self,
        py: Python<'_>,
        source: &Bound<'_, PyAny>,
        pose: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<f64> {
        let source: PointCloud = arrays::cloud("source", source)?;
        let pose = arrays::pose_or("pose", pose, SE2::identity())?;
        Ok(py.detach(|| self.map.score(&source, &pose)))
    }

    /// The means of the cells, shape (k, 2), m.
    #[getter]
    fn means<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        arrays::of_points(py, self.map.cells().iter().map(|cell| cell.mean))
    }

    /// The covariances of the cells, shape (k, 2, 2), m².
    #[getter]
    fn covariances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let cells = self.map.cells();
        let numbers = cells
            .iter()
            .flat_map(|cell| cell.covariance.iter().copied());
        PyArray1::from_vec(py, numbers.collect()).reshape([cells.len(), 2, 2])
    }

    fn __repr__(&self) -> String {
        format!(
            "Ndt({} cells of {} m)",
            self.map.cells().len(),
            self.map.cell_m()
        )
    }
}
