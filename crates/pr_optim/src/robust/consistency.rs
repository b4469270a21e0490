//! Pairwise consistency: the largest set of loops that agree with each other.

use nalgebra::Matrix3;
use pr_geom::SE2;

use super::{LOOP_CHI2, is_sequential};
use crate::factor::Between;
use crate::problem::Problem;

/// What [`consistent_set`] calls consistent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConsistencySettings {
    /// Two loops agree where the cycle through both closes within this squared Mahalanobis norm.
    pub max_chi2: f64,
    /// The search for a large set begins at so many loops, those that agree with most others.
    pub beginnings: usize,
}

impl Default for ConsistencySettings {
    fn default() -> Self {
        Self {
            max_chi2: LOOP_CHI2,
            beginnings: 32,
        }
    }
}

/// Which measurements belong to a large set of loops that agree in pairs; the sequential ones do.
///
/// Two loops `a: i → j` and `b: k → l` agree where the cycle `Z_a⁻¹ X_ik Z_b X_lj` through the path
/// between them closes: `eᵀ C⁻¹ e ≤ max_chi2` for its logarithm e, with C the sum of the
/// covariances of both loops and of both ways along the path, to first order (Mangelson, Dominic,
/// Eustice, Vasudevan, "Pairwise consistent measurement set maximization for robust multi-robot map
/// merging", ICRA 2018). The largest set in which all agree is a largest clique. It is looked for
/// greedily, from many beginnings (Pattabiraman et al. 2015), so a larger one may exist.
///
/// Over a long way the path's covariance hides everything: then even false loops agree. All
/// measurements count as members where the sequential ones do not tie every pose to the next.
#[must_use]
pub fn consistent_set(problem: &Problem, settings: &ConsistencySettings) -> Vec<bool> {
    let mut member = vec![true; problem.factors().len()];
    let Some(path) = Path::new(problem) else {
        return member;
    };
    let loops: Vec<(usize, Loop)> = problem
        .factors()
        .iter()
        .enumerate()
        .filter(|(_, factor)| !is_sequential(factor))
        .filter_map(|(index, factor)| Some((index, Loop::new(factor)?)))
        .collect();
    let mut agreeing = Agreement::new(loops.len());
    for (a, (_, first)) in loops.iter().enumerate() {
        for (b, (_, second)) in loops.iter().enumerate().skip(a + 1) {
            if path.closes(first, second, settings.max_chi2) {
                agreeing.add(a, b);
            }
        }
    }
    let set = agreeing.large_clique(settings.beginnings);
    for (k, (index, _)) in loops.iter().enumerate() {
        member[*index] = set[k];
    }
    // A loop without a covariance can be compared with none.
    for (index, factor) in problem.factors().iter().enumerate() {
        if !is_sequential(factor) && !loops.iter().any(|(known, _)| *known == index) {
            member[index] = false;
        }
    }
    member
}

/// A loop with its covariance.
struct Loop {
    from: usize,
    to: usize,
    measurement: SE2,
    covariance: Matrix3<f64>,
}

impl Loop {
    fn new(factor: &Between) -> Option<Self> {
        Some(Self {
            from: factor.from,
            to: factor.to,
            measurement: factor.measurement,
            covariance: factor.information.try_inverse()?,
        })
    }
}

/// The path along the sequential measurements, with the covariance summed up in its first frame.
pub(super) struct Path {
    poses: Vec<SE2>,
    /// `Σ Ad Q Adᵀ` of the steps up to each pose: that between two is a difference.
    sums: Vec<Matrix3<f64>>,
}

impl Path {
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
            // The noise is at the end of the measurement; backwards that is where it starts.
            if step.from < step.to {
                pose = pose * step.measurement;
                sum += carried(&pose, &covariance);
            } else {
                sum += carried(&pose, &covariance);
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

    /// The squared Mahalanobis norm by which the cycle of a measurement and the path fails to close.
    pub fn cycle_chi2(&self, factor: &Between) -> Option<f64> {
        let (from, to) = (&self.poses[factor.from], &self.poses[factor.to]);
        let e = (factor.measurement.inverse() * from.between(to)).log();
        let way = carried(&to.inverse(), &self.between(factor.from, factor.to));
        let information = (way + factor.information.try_inverse()?).try_inverse()?;
        let chi2 = e.dot(&(information * e));
        chi2.is_finite().then_some(chi2)
    }

    /// Whether the cycle through both loops closes.
    fn closes(&self, a: &Loop, b: &Loop, max_chi2: f64) -> bool {
        let (i, j, k, l) = (a.from, a.to, b.from, b.to);
        let to_b = self.poses[i].between(&self.poses[k]);
        let back = self.poses[l].between(&self.poses[j]);
        let at_l = a.measurement.inverse() * to_b * b.measurement;
        let closed = at_l * back;
        let e = closed.log();
        // Every part in the frame where the cycle ends, which is the frame of pose j.
        let end = closed.inverse();
        let first = end * a.measurement.inverse();
        let mut covariance = carried(&end, &a.covariance);
        covariance += carried(&(first * self.poses[i].inverse()), &self.between(i, k));
        covariance += carried(&(end * at_l), &b.covariance);
        covariance += carried(&(end * at_l * self.poses[l].inverse()), &self.between(l, j));
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

/// `Ad C Adᵀ`: a covariance in the frame that `to_from` leads to.
fn carried(to_from: &SE2, covariance: &Matrix3<f64>) -> Matrix3<f64> {
    let adjoint = to_from.adjoint();
    adjoint * covariance * adjoint.transpose()
}

/// Which loops agree: one row of bits each.
struct Agreement {
    count: usize,
    words: usize,
    bits: Vec<u64>,
}

impl Agreement {
    fn new(count: usize) -> Self {
        let words = count.div_ceil(64);
        Self {
            count,
            words,
            bits: vec![0; words * count],
        }
    }

    fn add(&mut self, a: usize, b: usize) {
        self.bits[a * self.words + b / 64] |= 1 << (b % 64);
        self.bits[b * self.words + a / 64] |= 1 << (a % 64);
    }

    fn row(&self, a: usize) -> &[u64] {
        &self.bits[a * self.words..][..self.words]
    }

    fn degree(&self, a: usize) -> u32 {
        self.row(a).iter().map(|word| word.count_ones()).sum()
    }

    /// The largest of the cliques that grow from the loops with most agreement; of equals the first.
    fn large_clique(&self, beginnings: usize) -> Vec<bool> {
        let mut by_degree: Vec<(u32, usize)> =
            (0..self.count).map(|a| (self.degree(a), a)).collect();
        by_degree.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
        let order: Vec<usize> = by_degree.iter().map(|(_, a)| *a).collect();
        let mut best: Vec<usize> = Vec::new();
        for &first in order.iter().take(beginnings) {
            let clique = self.grown(first, &order);
            if clique.len() > best.len() {
                best = clique;
            }
        }
        let mut member = vec![false; self.count];
        best.iter().for_each(|&a| member[a] = true);
        member
    }

    /// Adds what agrees with all so far, in that order.
    fn grown(&self, first: usize, order: &[usize]) -> Vec<usize> {
        let mut clique = vec![first];
        let mut common = self.row(first).to_vec();
        for &next in order {
            if common[next / 64] >> (next % 64) & 1 == 1 {
                clique.push(next);
                for (word, row) in common.iter_mut().zip(self.row(next)) {
                    *word &= row;
                }
            }
        }
        clique
    }
}
