//! Pairwise consistency: the largest set of loops that agree with each other.

use super::path::{Loop, Path, variance_share};
use super::{LOOP_CHI2, is_sequential};
use crate::problem::Problem;

/// Pairs may contradict by twice the deviations that the path has to first order: over long ways those are
/// too small.
const FIRST_ORDER: f64 = 4.0;

/// What [`consistent_set`] calls consistent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConsistencySettings {
    /// Two loops agree where the cycle through both closes within this squared Mahalanobis norm, of noise
    /// as large as that of loops over short ways.
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
/// between them closes: `eᵀ C⁻¹ e ≤ 4 v max_chi2` for its logarithm e, with C the sum of the
/// covariances of both loops and of both ways along the path, to first order, and v the share of its
/// stated variance that the noise of loops over short ways has, at most 1 (Mangelson, Dominic,
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
    // A loop without a covariance can be compared with none.
    for (index, factor) in problem.factors().iter().enumerate() {
        if !is_sequential(factor) && !loops.iter().any(|(known, _)| *known == index) {
            member[index] = false;
        }
    }
    member
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
            let clique = self.select_along_path(first, &order);
            if clique.len() > best.len() {
                best = clique;
            }
        }
        let mut member = vec![false; self.count];
        best.iter().for_each(|&a| member[a] = true);
        member
    }

    /// Adds what agrees with all so far, in that order.
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
