//! factrs 0.3: Gauss–Newton over a factor graph, faer underneath.

use std::path::{Path, PathBuf};

use factrs::core::GaussNewton;
use factrs::optimizers::BaseOptParams;
use factrs::traits::Optimizer;
use factrs::utils::load_g20;

use crate::clock::timed;
use crate::{Peer, Timing};

/// factrs with the path of a graph: it keeps nothing from one solve to the next.
pub struct Factrs {
    path: PathBuf,
}

impl Factrs {
    /// A peer that reads the file before every solve; reading is not timed.
    #[must_use]
    pub fn new(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
        }
    }
}

impl Peer for Factrs {
    fn name(&self) -> &'static str {
        "factrs"
    }

    fn solve_cold(&mut self) -> Timing {
        let path = self.path.to_str().expect("a path in UTF-8");
        let (graph, start) = load_g20(path);
        let (measured, _) = load_g20(path);
        let params = BaseOptParams {
            error_tol_relative: 1e-7,
            error_tol_absolute: 0.0,
            ..BaseOptParams::default()
        };
        let mut optimizer = GaussNewton::new(params, graph);
        let (result, cpu_ms) = timed(|| optimizer.optimize(start));
        // factrs' error is half of χ².
        let chi2 = result.map_or(f64::NAN, |values| 2.0 * measured.error(&values));
        Timing {
            cpu_ms,
            chi2,
            iterations: 0,
        }
    }

    fn solve_warm(&mut self) -> Option<Timing> {
        None
    }
}
