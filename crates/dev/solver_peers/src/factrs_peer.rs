//! factrs 0.3: Gauss–Newton over a factor graph, faer underneath.

use std::path::{Path, PathBuf};

use bench_support::timed;
use factrs::containers::{DefaultSymbolHandler, Values};
use factrs::core::GaussNewton;
use factrs::optimizers::{BaseOptParams, OptError};
use factrs::traits::Optimizer;
use factrs::utils::load_g20;
use factrs::variables;
use pr_geom::SE2;

use crate::{Peer, Solve};

/// factrs with the path of a graph: it has no state between solves.
pub struct Factrs {
    path: PathBuf,
    /// Ids of the vertices in the order of the file; `None` if one exceeds the range of factrs.
    ids: Option<Vec<u32>>,
}

impl Factrs {
    /// A peer that reads the file before every solve; reading is not timed.
    #[must_use]
    pub fn new(path: &Path, ids: impl Iterator<Item = i64>) -> Self {
        Self {
            path: path.to_owned(),
            ids: ids.map(|id| u32::try_from(id).ok()).collect(),
        }
    }

    fn poses_of(&self, values: &Values) -> Option<Vec<SE2>> {
        let ids = self.ids.as_ref()?.iter();
        ids.map(|&id| {
            let key = DefaultSymbolHandler::sym_to_key('X', id);
            let pose: &variables::SE2 = values.get_unchecked(key)?;
            Some(SE2::new(pose.x(), pose.y(), pose.theta()))
        })
        .collect()
    }
}

impl Peer for Factrs {
    fn name(&self) -> &'static str {
        "factrs"
    }

    fn solve_cold(&mut self) -> Solve {
        let path = self.path.to_str().expect("a path in UTF-8");
        let (graph, start) = load_g20(path);
        let params = BaseOptParams {
            error_tol_relative: 1e-7,
            error_tol_absolute: 0.0,
            ..BaseOptParams::default()
        };
        let mut optimizer = GaussNewton::new(params, graph);
        let (result, cpu_ms) = timed(|| optimizer.optimize(start));
        let poses = match result {
            // At the iteration limit it returns its last poses.
            Ok(values) | Err(OptError::MaxIterations(values)) => self.poses_of(&values),
            Err(_) => None,
        };
        Solve {
            cpu_ms,
            poses,
            iterations: None,
        }
    }

    fn solve_warm(&mut self) -> Option<Solve> {
        None
    }
}
