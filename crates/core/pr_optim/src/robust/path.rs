//! The path along the trusted measurements, and how well cycles through it close.

use nalgebra::Matrix3;
use pr_geom::{SE2, order_by, sort_numbers};

use super::is_sequential;
use crate::factor::Between;
use crate::problem::Problem;

/// The median of χ² with three degrees of freedom.
const MEDIAN_CHI2: f64 = 2.366;

/// The noise level is estimated from one in this many loops, those over the shortest paths.
const SHORTEST_FRACTION: usize = 4;

/// Smallest number of these loops.
const MIN_LOOPS: usize = 16;

/// Smallest ratio of actual to stated variance.
const MIN_VARIANCE_SHARE: f64 = 0.01;

/// A loop with its covariance.
pub struct Loop {
    from: usize,
    to: usize,
    measurement: SE2,
    covariance: Matrix3<f64>,
}

impl Loop {
    /// `None` if its information has no inverse.
    pub fn new(factor: &Between) -> Option<Self> {
        Some(Self {
            from: factor.from,
            to: factor.to,
            measurement: factor.measurement,
            covariance: factor.information.try_inverse()?,
        })
    }
}

/// The path along the sequential measurements, with its covariance accumulated in the first frame.
pub struct SequentialPath {
    poses: Vec<SE2>,
    /// `Σ Ad Q Adᵀ` of the steps up to each pose: the covariance between two poses is a difference.
    sums: Vec<Matrix3<f64>>,
}

impl SequentialPath {
    /// `None` if the sequential measurements do not connect every pose to the next.
    pub fn new(problem: &Problem) -> Option<Self> {
        let mut steps: Vec<Option<&Between>> = vec![None; problem.node_count().checked_sub(1)?];
        for factor in problem.factors().iter().filter(|f| is_sequential(f)) {
            steps[factor.from.min(factor.to)].get_or_insert(factor);
        }
        let (mut pose, mut sum) = (SE2::identity(), Matrix3::zeros());
        let mut path = Self {
            poses: vec![pose],
            sums: vec![sum],
        };
        for step in steps {
            let step = step?;
            let covariance = step.information.try_inverse()?;
            // The noise is in the frame of the measured pose, which is the start for a backward step.
            if step.from < step.to {
                pose = pose * step.measurement;
                sum += transformed(&pose, &covariance);
            } else {
                sum += transformed(&pose, &covariance);
                pose = pose * step.measurement.inverse();
            }
            path.poses.push(pose);
            path.sums.push(sum);
        }
        Some(path)
    }

    /// The poses along it, in the frame of the first.
    pub fn poses(&self) -> &[SE2] {
        &self.poses
    }

    /// Squared Mahalanobis norm of the closing error of the cycle of a measurement and the path.
    pub fn cycle_chi2(&self, factor: &Between) -> Option<f64> {
        let (from, to) = (&self.poses[factor.from], &self.poses[factor.to]);
        let e = (factor.measurement.inverse() * from.between(to)).log();
        let path = transformed(&to.inverse(), &self.between(factor.from, factor.to));
        let information = (path + factor.information.try_inverse()?).try_inverse()?;
        let chi2 = e.dot(&(information * e));
        chi2.is_finite().then_some(chi2)
    }

    /// Whether the cycle through both loops closes.
    pub fn closes(&self, a: &Loop, b: &Loop, max_chi2: f64) -> bool {
        let (i, j, k, l) = (a.from, a.to, b.from, b.to);
        let to_b = self.poses[i].between(&self.poses[k]);
        let back = self.poses[l].between(&self.poses[j]);
        let at_l = a.measurement.inverse() * to_b * b.measurement;
        let closed = at_l * back;
        let e = closed.log();
        // Every part in the end frame of the cycle, which is the frame of pose j.
        let end = closed.inverse();
        let first = end * a.measurement.inverse();
        let mut covariance = transformed(&end, &a.covariance);
        covariance += transformed(&(first * self.poses[i].inverse()), &self.between(i, k));
        covariance += transformed(&(end * at_l), &b.covariance);
        covariance += transformed(&(end * at_l * self.poses[l].inverse()), &self.between(l, j));
        let Some(information) = covariance.try_inverse() else {
            return false;
        };
        e.dot(&(information * e)) <= max_chi2
    }

    /// Covariance of the steps between two poses, in the path's first frame.
    fn between(&self, a: usize, b: usize) -> Matrix3<f64> {
        self.sums[a.max(b)] - self.sums[a.min(b)]
    }
}

/// `Ad C Adᵀ`: transforms a covariance to another frame.
fn transformed(to_from: &SE2, covariance: &Matrix3<f64>) -> Matrix3<f64> {
    let adjoint = to_from.adjoint();
    adjoint * covariance * adjoint.transpose()
}

/// Ratio of actual to stated variance of loops over short paths.
///
/// Most of these loops are true, because two arbitrary poses are rarely close in time.
pub fn variance_share(problem: &Problem, trusted: &[bool], path: &SequentialPath) -> f64 {
    let factors = problem.factors().iter().zip(trusted);
    let loops: Vec<&Between> = factors
        .filter_map(|(factor, trusted)| (!trusted).then_some(factor))
        .collect();
    let shortest_first = order_by(loops.len(), &|k| loops[k].from.abs_diff(loops[k].to) as f64);
    let shortest =
        (shortest_first.into_iter()).take((loops.len() / SHORTEST_FRACTION).max(MIN_LOOPS));
    let mut squares: Vec<f64> = shortest.filter_map(|k| path.cycle_chi2(loops[k])).collect();
    sort_numbers(&mut squares);
    let median = squares.get(squares.len() / 2);
    median.map_or(1.0, |median| {
        (median / MEDIAN_CHI2).clamp(MIN_VARIANCE_SHARE, 1.0)
    })
}
