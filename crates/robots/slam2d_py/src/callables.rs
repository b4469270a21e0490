//! A reader's functions at the seams of the chapter's estimator: registration, and the verification of loops.
//!
//! The core's interfaces return no errors. An exception is kept, and the step during which it was raised raises it again.

use std::sync::{Arc, Mutex, PoisonError};

use ch16_slam2d::chapter::ChapterParts;
use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::icp::IcpConfig;
use ch16_slam2d::loops::{LoopCandidate, LoopDetector, LoopQuery};
use ch16_slam2d::matching::{
    IcpMatcher, MapConfig, Match, MatchRequest, MatchStop, MatchSummary, Matcher,
};
use ch16_slam2d::slam::SlamConfig;
use pr_geom::SE2;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::arrays;

/// The first exception of a function.
#[derive(Clone, Default)]
pub struct Raised(Arc<Mutex<Option<PyErr>>>);

impl Raised {
    fn kept(&self) -> std::sync::MutexGuard<'_, Option<PyErr>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Runs a function unless one has raised.
    fn ask<T>(&self, work: impl FnOnce(Python<'_>) -> PyResult<T>) -> Option<T> {
        if self.kept().is_some() {
            return None;
        }
        match Python::attach(work) {
            Ok(answer) => Some(answer),
            Err(error) => {
                *self.kept() = Some(error);
                None
            }
        }
    }

    /// Raises it.
    pub fn raise(&self) -> PyResult<()> {
        self.kept().take().map_or(Ok(()), Err)
    }
}

/// The functions that a reader gives.
#[derive(Clone, Default)]
pub struct Callables {
    icp: Option<Arc<Py<PyAny>>>,
    gate: Option<Arc<Py<PyAny>>>,
    /// What one of them has raised.
    pub raised: Raised,
}

impl Callables {
    /// Checks that both can be called.
    pub fn new(icp: Option<Bound<'_, PyAny>>, gate: Option<Bound<'_, PyAny>>) -> PyResult<Self> {
        let checked = |name: &str, function: Option<Bound<'_, PyAny>>| match function {
            Some(function) if !function.is_callable() => Err(PyTypeError::new_err(format!(
                "{name} has to be a function, not {}",
                function.get_type().name()?
            ))),
            function => Ok(function.map(|function| Arc::new(function.unbind()))),
        };
        Ok(Self {
            icp: checked("icp", icp)?,
            gate: checked("gate", gate)?,
            raised: Raised::default(),
        })
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.icp.is_none() && self.gate.is_none()
    }

    /// The estimator with these functions in place of its parts.
    pub fn slam(&self, mut config: SlamConfig) -> ch16_slam2d::slam::Slam {
        let mut parts = ChapterParts::from_config(&config.chapter);
        if let Some(function) = &self.icp {
            let theirs = |map: &MapConfig| TheirIcp {
                function: Arc::clone(function),
                ours: IcpMatcher::new(IcpConfig::default(), map),
                target: PointCloud::default(),
                raised: self.raised.clone(),
            };
            parts.front_end = Box::new(theirs(&config.chapter.local_map));
            parts.loops = Box::new(theirs(&config.chapter.loops.submap));
        }
        if let Some(function) = &self.gate {
            let loops = &mut config.chapter.loops;
            parts.detector = Box::new(TheirGate {
                function: Arc::clone(function),
                near: parts.detector,
                most: loops.candidates_tried,
                raised: self.raised.clone(),
            });
            // Theirs alone decides.
            loops.max_rmse_m = f64::INFINITY;
            loops.min_inliers = 0;
            loops.gate_chi2 = f64::INFINITY;
        }
        ch16_slam2d::slam::Slam::with_parts(config, parts)
    }
}

/// A registration by a reader's function; our ICP pairs the points at the pose that it returns.
#[derive(Clone)]
struct TheirIcp {
    function: Arc<Py<PyAny>>,
    ours: IcpMatcher,
    target: PointCloud,
    raised: Raised,
}

impl TheirIcp {
    /// Calls `icp(source, target, init, *, normals, max_distance, max_iterations)`.
    fn call(&self, py: Python<'_>, source: &PointCloud, request: &MatchRequest) -> PyResult<SE2> {
        let map = self.ours.map();
        let kept = (0..map.xs().len()).map(|index| map.source_index(index));
        let keywords = PyDict::new(py);
        let normals = kept.clone().map(|index| self.target.normal(index));
        keywords.set_item("normals", arrays::of_normals(py, normals)?)?;
        keywords.set_item("max_distance", request.tau_m)?;
        keywords.set_item("max_iterations", request.max_iterations)?;
        let source = arrays::of_points(py, source.iter())?;
        let target = arrays::of_points(py, kept.map(|index| self.target.point(index)))?;
        let init = arrays::of_pose(py, &request.guess);
        let found = (self.function.bind(py)).call((source, target, init), Some(&keywords))?;
        let pose = found.getattr_opt("pose")?.unwrap_or(found);
        arrays::pose("the pose that icp returned", &pose)
    }
}

impl Matcher for TheirIcp {
    fn set_target(&mut self, target: &PointCloud) {
        self.ours.set_target(target);
        self.target.clone_from(target);
    }

    fn register(&mut self, source: &PointCloud, request: &MatchRequest) -> Match {
        let found = (self.raised).ask(|py| self.call(py, source, request));
        let at = MatchRequest {
            guess: found.unwrap_or(request.guess),
            max_iterations: 0,
            ..*request
        };
        let Match { summary, pairs } = self.ours.register(source, &at);
        Match {
            summary: MatchSummary {
                stop: MatchStop::Other("the function returned"),
                ..summary
            },
            pairs,
        }
    }
}

/// Proposes the candidates that a reader's function accepts.
#[derive(Clone)]
struct TheirGate {
    function: Arc<Py<PyAny>>,
    near: Box<dyn LoopDetector>,
    /// The most candidates that are tried at a node.
    most: usize,
    raised: Raised,
}

impl LoopDetector for TheirGate {
    /// Calls `gate(poses, sweeps, node, candidate)` for each candidate, up to the first that it accepts.
    fn detect(&mut self, query: &mut LoopQuery<'_>) -> Vec<LoopCandidate> {
        let node = query.node();
        let near = self.near.detect(query);
        let near = near.into_iter().filter(|near| near.node < node);
        let near: Vec<LoopCandidate> = near.take(self.most).collect();
        if near.is_empty() {
            return near;
        }
        let accepted = self.raised.ask(|py| {
            let poses = arrays::of_poses(py, query.poses().iter().copied())?;
            let sweeps = (0..=node).map(|k| arrays::of_points(py, query.scan(k).iter()));
            let sweeps = PyList::new(py, sweeps.collect::<PyResult<Vec<_>>>()?)?;
            for candidate in near {
                let asked = (&poses, &sweeps, node, candidate.node);
                let found = self.function.bind(py).call1(asked)?;
                let verdict = found.getattr_opt("accepted")?.unwrap_or(found);
                if verdict.is_truthy()? {
                    return Ok(vec![candidate]);
                }
            }
            Ok(Vec::new())
        });
        accepted.unwrap_or_default()
    }
}
