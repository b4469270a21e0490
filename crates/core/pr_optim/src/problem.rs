//! Poses and the measurements between them.

use pr_geom::SE2;

use crate::factor::{Between, PreparedFactor, PreparedPose};
use crate::kernel::RobustKernel;

/// A pose graph as plain arrays.
///
/// The cost is `Σ eᵀΩe` over the factors. Fixed poses fix the gauge: without any, the cost is invariant under a
/// rigid motion of the whole graph, and the normal equations are singular.
#[derive(Clone, Debug, Default)]
pub struct Problem {
    poses: Vec<SE2>,
    fixed: Vec<bool>,
    factors: Vec<Between>,
    prepared: Vec<PreparedFactor>,
    optimized: usize,
}

impl Problem {
    /// An empty problem.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a pose that the solver may move; returns its index.
    pub fn add_pose(&mut self, pose: SE2) -> usize {
        self.poses.push(pose);
        self.fixed.push(false);
        self.poses.len() - 1
    }

    /// Adds a fixed pose; returns its index.
    pub fn add_fixed_pose(&mut self, pose: SE2) -> usize {
        let node = self.add_pose(pose);
        self.fixed[node] = true;
        node
    }

    /// Fixes a pose from now on.
    ///
    /// # Panics
    /// If the pose does not exist.
    pub fn fix(&mut self, node: usize) {
        self.fixed[node] = true;
    }

    /// Adds a measurement.
    ///
    /// # Panics
    /// If an end does not exist, or both ends are the same.
    pub fn add_factor(&mut self, factor: Between) {
        assert!(
            factor.from < self.poses.len() && factor.to < self.poses.len(),
            "factor {} -> {} in a problem of {} poses",
            factor.from,
            factor.to,
            self.poses.len()
        );
        assert_ne!(factor.from, factor.to, "a factor needs two poses");
        self.prepared.push(PreparedFactor::new(&factor));
        self.factors.push(factor);
    }

    /// Removes the newest measurement and returns it, or `None` if there is none.
    pub fn pop_factor(&mut self) -> Option<Between> {
        self.prepared.pop();
        let factor = self.factors.pop();
        self.optimized = self.optimized.min(self.factors.len());
        factor
    }

    /// Number of measurements when a pose was last moved.
    ///
    /// Covariance queries update the factor of these measurements with those added since.
    #[must_use]
    pub fn optimized_factors(&self) -> usize {
        self.optimized
    }

    /// Sets [`optimized_factors`](Self::optimized_factors) of a rebuilt problem, at most the number of
    /// factors.
    pub fn mark_optimized(&mut self, factors: usize) {
        self.optimized = factors.min(self.factors.len());
    }

    /// Number of poses.
    #[must_use]
    pub fn node_count(&self) -> usize {
        self.poses.len()
    }

    /// The poses, by index.
    #[must_use]
    pub fn poses(&self) -> &[SE2] {
        &self.poses
    }

    /// The poses, mutable.
    pub fn poses_mut(&mut self) -> &mut [SE2] {
        self.optimized = self.factors.len();
        &mut self.poses
    }

    /// Replaces the poses by others of the same nodes, and leaves the present ones in `poses`.
    pub(crate) fn swap_poses(&mut self, poses: &mut Vec<SE2>) {
        debug_assert_eq!(poses.len(), self.poses.len());
        self.optimized = self.factors.len();
        core::mem::swap(&mut self.poses, poses);
    }

    /// Which poses are fixed.
    #[must_use]
    pub fn fixed(&self) -> &[bool] {
        &self.fixed
    }

    /// The measurements, in the order in which they were added.
    #[must_use]
    pub fn factors(&self) -> &[Between] {
        &self.factors
    }

    /// The measurements in the solver's form.
    #[must_use]
    pub(crate) fn prepared(&self) -> &[PreparedFactor] {
        &self.prepared
    }

    /// The first `nodes` poses and the first `factors` measurements, all of them between those poses.
    pub(crate) fn prefix(&self, nodes: usize, factors: usize) -> Self {
        Self {
            poses: self.poses[..nodes].to_vec(),
            fixed: self.fixed[..nodes].to_vec(),
            factors: self.factors[..factors].to_vec(),
            prepared: self.prepared[..factors].to_vec(),
            optimized: self.optimized.min(factors),
        }
    }

    /// Appends what `whole` has in addition to this problem, which is a [`prefix`](Self::prefix) of it.
    pub(crate) fn append_from(&mut self, whole: &Self) {
        let (nodes, factors) = (self.node_count(), self.factors.len());
        self.poses.extend_from_slice(&whole.poses[nodes..]);
        self.fixed.extend_from_slice(&whole.fixed[nodes..]);
        self.factors.extend_from_slice(&whole.factors[factors..]);
        self.prepared.extend_from_slice(&whole.prepared[factors..]);
    }

    /// Whether `prefix` is a [`prefix`](Self::prefix) of this problem, at the same poses.
    pub(crate) fn has_prefix(&self, prefix: &Self) -> bool {
        self.poses.starts_with(&prefix.poses)
            && self.fixed.starts_with(&prefix.fixed)
            && self.factors.starts_with(&prefix.factors)
    }

    /// The first pose that is not connected to a fixed one, `None` if all are connected.
    ///
    /// An unconnected pose makes the normal equations singular, apart from the ridge.
    #[must_use]
    pub fn first_loose_node(&self) -> Option<usize> {
        self.first_loose_in_prefix(self.node_count(), self.factors.len())
    }

    /// [`first_loose_node`](Self::first_loose_node) of a [`prefix`](Self::prefix).
    pub(crate) fn first_loose_in_prefix(&self, nodes: usize, factors: usize) -> Option<usize> {
        let mut parent: Vec<usize> = (0..nodes).collect();
        for factor in &self.factors[..factors] {
            let (a, b) = (
                root_of(&mut parent, factor.from),
                root_of(&mut parent, factor.to),
            );
            parent[a.max(b)] = a.min(b);
        }
        let mut held = vec![false; nodes];
        for node in (0..nodes).filter(|&node| self.fixed[node]) {
            held[root_of(&mut parent, node)] = true;
        }
        (0..nodes).find(|&node| !held[root_of(&mut parent, node)])
    }

    /// `eᵀΩe` of one measurement at the present poses, by its index among [`factors`](Self::factors).
    ///
    /// # Panics
    /// If the measurement does not exist.
    #[must_use]
    pub fn factor_chi2(&self, factor: usize) -> f64 {
        self.factor_chi2_at(factor, &self.poses)
    }

    /// [`factor_chi2`](Self::factor_chi2) at other poses, by index.
    pub(crate) fn factor_chi2_at(&self, factor: usize, poses: &[SE2]) -> f64 {
        let Between { from, to, .. } = self.factors[factor];
        self.prepared[factor].squared_norm(
            &PreparedPose::new(&poses[from]),
            &PreparedPose::new(&poses[to]),
        )
    }

    /// `eᵀΩe` of every measurement at other poses, by index.
    pub(crate) fn squared_norms_at(&self, poses: &[SE2]) -> Vec<f64> {
        let poses: Vec<_> = poses.iter().map(PreparedPose::new).collect();
        let factors = self.factors.iter().zip(&self.prepared);
        factors
            .map(|(factor, prepared)| prepared.squared_norm(&poses[factor.from], &poses[factor.to]))
            .collect()
    }

    /// `χ² = Σ eᵀΩe`, without kernel and factor ½.
    #[must_use]
    pub fn chi2(&self) -> f64 {
        self.cost_and_chi2(RobustKernel::None).1
    }

    /// `Σ ρ(eᵀΩe)` with a kernel, and `χ² = Σ eᵀΩe` without.
    #[must_use]
    pub fn cost_and_chi2(&self, kernel: RobustKernel) -> (f64, f64) {
        let poses: Vec<_> = self.poses.iter().map(PreparedPose::new).collect();
        self.cost_and_chi2_at(&poses, kernel)
    }

    /// [`cost_and_chi2`](Self::cost_and_chi2) at other poses, by index.
    pub(crate) fn cost_and_chi2_at(
        &self,
        poses: &[PreparedPose],
        kernel: RobustKernel,
    ) -> (f64, f64) {
        let (mut cost, mut chi2) = (0.0, 0.0);
        for (factor, prepared) in self.factors.iter().zip(&self.prepared) {
            let squared_norm = prepared.squared_norm(&poses[factor.from], &poses[factor.to]);
            chi2 += squared_norm;
            cost += kernel.cost(squared_norm);
        }
        (cost, chi2)
    }
}

/// The representative of a node's component; halves the path to it.
fn root_of(parent: &mut [usize], mut node: usize) -> usize {
    while parent[node] != node {
        parent[node] = parent[parent[node]];
        node = parent[node];
    }
    node
}
