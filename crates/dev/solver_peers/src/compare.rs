//! One graph, all solvers: interleaved rounds, and the rows of the table.

use std::path::Path;

use pr_geom::SE2;
use pr_optim::g2o::G2oFile;
use pr_optim::{Problem, Start};

use crate::arael_peer::Arael;
use crate::factrs_peer::Factrs;
use crate::ours::{Ours, chi2_below};
use crate::{Peer, Solve};

/// The head of the table in Markdown.
pub const HEAD: &str = "\
| graph | solver | warm | ratio | cold | ratio | iterations | χ² |
|---|---|--:|--:|--:|--:|--:|--:|";

/// Largest relative difference of two values of χ² at one optimum: solves stop at 1e-8.
const SAME_CHI2: f64 = 1e-6;

/// Largest relative excess of χ² over the optimum for a solver with another residual: on eight recorded
/// graphs the residuals of the peers shift it by less than a thousandth.
const SAME_BASIN: f64 = 1e-2;

/// The fastest of one solver's runs on a graph.
struct Row {
    name: &'static str,
    end: End,
    iterations: Option<usize>,
    cold_ms: f64,
    warm_ms: Option<f64>,
}

/// Result of the first run of a solver.
#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    /// χ² at the final poses, and χ² at the minimum that full steps reach from there.
    At { chi2: f64, minimum: f64 },
    /// It failed, or its poses are not finite.
    Failed,
}

/// Solves one file with all solvers in `rounds` interleaved rounds; returns the rows in Markdown.
///
/// # Errors
/// If the file cannot be read, in one line.
pub fn compare(path: &Path, rounds: usize) -> Result<Vec<String>, String> {
    let text = std::fs::read(path).map_err(|error| error.to_string())?;
    let file = G2oFile::parse(&text).map_err(|error| error.to_string())?;
    let problem = &file.problem;
    let ids = (0..problem.node_count()).map(|node| file.id_of(node));
    let mut peers: Vec<Box<dyn Peer>> = vec![
        Box::new(Ours::new(problem.clone(), Start::Auto)),
        Box::new(Ours::new(problem.clone(), Start::Given)),
        Box::new(Arael::new(problem.clone())),
        Box::new(Factrs::new(path, ids)),
    ];
    let mut rows: Vec<Row> = peers
        .iter_mut()
        .map(|peer| Row::first(peer.as_mut(), problem))
        .collect();
    for _ in 1..rounds {
        for (row, peer) in rows.iter_mut().zip(&mut peers) {
            row.keep_faster(peer.as_mut());
        }
    }
    let graph = path.file_stem().unwrap_or_default().to_string_lossy();
    let ours = &rows[0];
    Ok(rows.iter().map(|row| row.markdown(&graph, ours)).collect())
}

impl Row {
    fn first(peer: &mut dyn Peer, problem: &Problem) -> Self {
        let Solve {
            cpu_ms,
            poses,
            iterations,
        } = peer.solve_cold();
        Self {
            name: peer.name(),
            end: poses.map_or(End::Failed, |poses| End::at(problem, &poses)),
            iterations,
            cold_ms: cpu_ms,
            warm_ms: peer.solve_warm().map(|solve| solve.cpu_ms),
        }
    }

    fn keep_faster(&mut self, peer: &mut dyn Peer) {
        self.cold_ms = self.cold_ms.min(peer.solve_cold().cpu_ms);
        if let (Some(best), Some(solve)) = (&mut self.warm_ms, peer.solve_warm()) {
            *best = best.min(solve.cpu_ms);
        }
    }

    /// The row, with ratios of `ours` to it if both ended at the same optimum.
    fn markdown(&self, graph: &str, ours: &Self) -> String {
        let name = self.name;
        let End::At { chi2, .. } = self.end else {
            return format!("| {graph} | {name} | – | – | – | – | – | failed |");
        };
        let shown = |value: Option<f64>, decimals: usize| {
            value.map_or("–".to_owned(), |value| format!("{value:.decimals$}"))
        };
        let comparable = self.end.is_at_the_optimum_of(&ours.end);
        let ratio = |ours: f64, theirs: f64| comparable.then_some(ours / theirs);
        let warm = ours.warm_ms.zip(self.warm_ms);
        format!(
            "| {graph} | {name} | {} | {} | {:.3} | {} | {} | {chi2:.6} |",
            shown(self.warm_ms, 3),
            shown(warm.and_then(|(a, b)| ratio(a, b)), 2),
            self.cold_ms,
            shown(ratio(ours.cold_ms, self.cold_ms), 2),
            self.iterations
                .map_or("–".to_owned(), |count| count.to_string()),
        )
    }
}

impl End {
    /// Evaluates a solver's poses: our χ² there, and at the minimum that our steps reach from there.
    fn at(problem: &Problem, poses: &[SE2]) -> Self {
        let mut problem = problem.clone();
        problem.poses_mut().copy_from_slice(poses);
        let chi2 = problem.chi2();
        if !chi2.is_finite() {
            return Self::Failed;
        }
        let minimum = chi2_below(problem);
        Self::At { chi2, minimum }
    }

    /// Whether this end is close above the minimum of the other one.
    fn is_at_the_optimum_of(&self, other: &Self) -> bool {
        let near = |a: f64, b: f64, share: f64| (a - b).abs() <= share * b.abs().max(1e-9);
        match (self, other) {
            (Self::At { chi2, minimum }, Self::At { minimum: best, .. }) => {
                near(*minimum, *best, SAME_CHI2) && near(*chi2, *best, SAME_BASIN)
            }
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = "\
VERTEX_SE2 0 5 5 1
VERTEX_SE2 1 1.1 0.1 1.5
VERTEX_SE2 2 1 1.1 3.1
VERTEX_SE2 3 0 1 -1.5
FIX 2
EDGE_SE2 0 1 1 0 1.5707963 50 0 0 50 0 100
EDGE_SE2 1 2 1 0 1.5707963 50 0 0 50 0 100
EDGE_SE2 2 3 1 0 1.5707963 50 0 0 50 0 100
EDGE_SE2 3 0 1 0 1.6 50 0 0 50 0 100
";

    #[test]
    fn arael_holds_the_pose_that_the_file_fixes() {
        let problem = G2oFile::parse(SQUARE).unwrap().problem;
        let fixed = problem.poses()[2];
        let ours = Ours::new(problem.clone(), Start::Auto).solve_cold();
        let theirs = Arael::new(problem.clone()).solve_cold();
        let (ours, theirs) = (ours.poses.unwrap(), theirs.poses.unwrap());
        assert_eq!(theirs[2], fixed);
        for (ours, theirs) in ours.iter().zip(&theirs) {
            // 1e-4: the optima of the two residuals differ by less here.
            assert!(ours.boxminus(theirs).norm() < 1e-4, "{ours:?} {theirs:?}");
        }
    }

    #[test]
    fn every_solver_is_judged_by_the_same_chi2() {
        let file = tempfile::Builder::new().suffix(".g2o").tempfile().unwrap();
        std::fs::write(file.path(), SQUARE).unwrap();
        let rows = compare(file.path(), 1).unwrap();
        let chi2 = |row: &String| -> f64 {
            let cells: Vec<&str> = row.split('|').map(str::trim).collect();
            cells[8].parse().unwrap()
        };
        let best = chi2(&rows[0]);
        for row in &rows {
            // One χ² has one minimum: 1e-6 is the last digit printed.
            assert!(chi2(row) >= best - 1e-6, "{row}");
            assert!(chi2(row) < 1.001 * best, "{row}");
        }
    }

    fn row(end: End) -> Row {
        Row {
            name: "peer",
            end,
            iterations: Some(3),
            cold_ms: 2.0,
            warm_ms: None,
        }
    }

    #[test]
    fn only_solvers_at_the_same_optimum_have_a_ratio() {
        let at = |chi2, minimum| row(End::At { chi2, minimum });
        let ours = at(1.0, 1.0);
        assert_eq!(
            at(1.001, 1.0).markdown("graph", &ours),
            "| graph | peer | – | – | 2.000 | 1.00 | 3 | 1.001000 |"
        );
        // Another minimum, and a stop high above the same one.
        for other in [at(1.001, 1.001), at(1.5, 1.0)] {
            let line = other.markdown("graph", &ours);
            assert!(line.contains("| 2.000 | – | 3 |"), "{line}");
        }
    }

    #[test]
    fn a_failure_has_neither_times_nor_ratios() {
        let ours = row(End::At {
            chi2: 1.0,
            minimum: 1.0,
        });
        let failed = row(End::Failed).markdown("graph", &ours);
        assert_eq!(failed, "| graph | peer | – | – | – | – | – | failed |");
    }
}
