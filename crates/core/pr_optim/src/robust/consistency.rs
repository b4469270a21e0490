//! Pairwise consistency: the largest set of mutually consistent loops.

use pr_geom::order_by;

use super::path::{Loop, SequentialPath, variance_share};
use super::{LOOP_CHI2, is_sequential};
use crate::problem::Problem;

/// Factor on the gate of a pair: twice the first-order deviations of the path, which are too small for long
/// paths.
const FIRST_ORDER: f64 = 4.0;

/// Settings of [`consistent_set`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConsistencySettings {
    /// Two loops are consistent if the cycle through both closes within this squared Mahalanobis norm, with the
    /// noise level of loops over short paths.
    pub max_chi2: f64,
    /// The greedy search starts from this many loops, those that are consistent with most others.
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

/// A large set of measurements whose loops are pairwise consistent; contains the sequential ones.
///
/// Two loops `a: i → j` and `b: k → l` are consistent if the cycle `Z_a⁻¹ X_ik Z_b X_lj` through the path between
/// them closes: `eᵀ C⁻¹ e ≤ 4 v max_chi2` for its logarithm e. C is the sum of the covariances of both loops and
/// of both path segments, to first order. v, at most 1, is the ratio of actual to stated variance, estimated from
/// loops over short paths (Mangelson, Dominic, Eustice, Vasudevan, "Pairwise consistent measurement set
/// maximization for robust multi-robot map merging", ICRA 2018). The largest set in which all are pairwise
/// consistent is a maximum clique. The search is greedy, from many starts (Pattabiraman et al. 2015), so a larger
/// one may exist.
///
/// The covariance of a long path is so large that even false loops are consistent. All measurements are members if
/// the sequential ones do not connect every pose to the next.
#[must_use]
pub fn consistent_set(problem: &Problem, settings: &ConsistencySettings) -> Vec<bool> {
    let mut member = vec![true; problem.factors().len()];
    let Some(path) = SequentialPath::new(problem) else {
        return member;
    };
    let loops: Vec<(usize, Loop)> = problem
        .factors()
        .iter()
        .enumerate()
        .filter(|(_, factor)| !is_sequential(factor))
        .filter_map(|(index, factor)| Some((index, Loop::new(factor)?)))
        .collect();
    let sequential: Vec<bool> = problem.factors().iter().map(is_sequential).collect();
    let max_chi2 = FIRST_ORDER * settings.max_chi2 * variance_share(problem, &sequential, &path);
    let mut agreeing = Agreement::new(loops.len());
    for (a, (_, first)) in loops.iter().enumerate() {
        for (b, (_, second)) in loops.iter().enumerate().skip(a + 1) {
            if path.closes(first, second, max_chi2) {
                agreeing.add(a, b);
            }
        }
    }
    let set = agreeing.large_clique(settings.beginnings);
    for (k, (index, _)) in loops.iter().enumerate() {
        member[*index] = set[k];
    }
    // A loop without a covariance cannot be compared.
    for (index, factor) in problem.factors().iter().enumerate() {
        if !is_sequential(factor) && !loops.iter().any(|(known, _)| *known == index) {
            member[index] = false;
        }
    }
    member
}

/// The consistency graph: one row of bits for each loop.
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

    /// The largest of the cliques grown from the loops of highest degree; the first of equals.
    fn large_clique(&self, beginnings: usize) -> Vec<bool> {
        let order = order_by(self.count, &|a| -f64::from(self.degree(a)));
        let mut best: Vec<usize> = Vec::new();
        for &first in order.iter().take(beginnings) {
            let clique = self.select_along_path(first, &order);
            if clique.len() > best.len() {
                best = clique;
            }
        }
        let mut member = vec![false; self.count];
        best.iter().for_each(|&a| member[a] = true);
        member
    }

    /// Grows a clique: adds every loop that is consistent with all members, in this order.
    fn select_along_path(&self, first: usize, order: &[usize]) -> Vec<usize> {
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
