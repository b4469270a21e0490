//! Poses and the measurements between them: what is to be solved.

use pr_geom::SE2;

use crate::factor::{Between, PreparedFactor, PreparedPose};
use crate::kernel::RobustKernel;

/// A pose graph as plain arrays.
///
/// The cost is `Σ eᵀΩe` over the factors. Fixed poses hold the gauge: without any, a rigid motion
/// of everything would change nothing, and the normal equations would be singular.
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

    /// Adds a pose that stays where it is; returns its index.
    pub fn add_fixed_pose(&mut self, pose: SE2) -> usize {
        let node = self.add_pose(pose);
        self.fixed[node] = true;
        node
    }

    /// Keeps a pose where it is from now on.
    ///
    /// # Panics
    /// Where the pose does not exist.
    pub fn fix(&mut self, node: usize) {
        self.fixed[node] = true;
    }

    /// Adds a measurement.
    ///
    /// # Panics
    /// Where an end does not exist, or both ends are the same.
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

    /// Takes the newest measurement out again and returns it; none where there is none.
    pub fn pop_factor(&mut self) -> Option<Between> {
        self.prepared.pop();
        let factor = self.factors.pop();
        self.optimized = self.optimized.min(self.factors.len());
        factor
    }

    /// How many measurements there were when a pose was last moved.
    ///
    /// A solver that is asked for covariances adds what was measured since to the factor of what was before.
    #[must_use]
    pub fn optimized_factors(&self) -> usize {
        self.optimized
    }

    /// Says so of a problem that was built anew; more than there are count as all.
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

    /// The poses, to be moved from outside.
    pub fn poses_mut(&mut self) -> &mut [SE2] {
        self.optimized = self.factors.len();
        &mut self.poses
    }

    /// Takes other poses for the same nodes, and leaves the present ones in `poses`.
    pub(crate) fn swap_poses(&mut self, poses: &mut Vec<SE2>) {
        debug_assert_eq!(poses.len(), self.poses.len());
        self.optimized = self.factors.len();
        core::mem::swap(&mut self.poses, poses);
    }

    /// Which poses stay where they are.
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

    /// The first so many poses, and the measurements that were added first, all of them between those.
    pub(crate) fn beginning(&self, nodes: usize, factors: usize) -> Self {
        Self {
            poses: self.poses[..nodes].to_vec(),
            fixed: self.fixed[..nodes].to_vec(),
            factors: self.factors[..factors].to_vec(),
            prepared: self.prepared[..factors].to_vec(),
            optimized: self.optimized.min(factors),
        }
    }

    /// Takes what another problem has beyond this one, which is its [`beginning`](Self::beginning).
    pub(crate) fn follow(&mut self, whole: &Self) {
        let (nodes, factors) = (self.node_count(), self.factors.len());
        self.poses.extend_from_slice(&whole.poses[nodes..]);
        self.fixed.extend_from_slice(&whole.fixed[nodes..]);
        self.factors.extend_from_slice(&whole.factors[factors..]);
        self.prepared.extend_from_slice(&whole.prepared[factors..]);
    }

    /// Whether that is the [`beginning`](Self::beginning) of this problem, at the same poses.
    pub(crate) fn begins_with(&self, beginning: &Self) -> bool {
        self.poses.starts_with(&beginning.poses)
            && self.fixed.starts_with(&beginning.fixed)
            && self.factors.starts_with(&beginning.factors)
    }

    /// The first pose that no chain of measurements ties to a fixed one, `None` where all are tied.
    ///
    /// With a loose pose the normal equations are singular, but for the ridge.
    #[must_use]
    pub fn first_loose_node(&self) -> Option<usize> {
        self.first_loose_of(self.node_count(), self.factors.len())
    }

    /// The same of a [`beginning`](Self::beginning).
    pub(crate) fn first_loose_of(&self, nodes: usize, factors: usize) -> Option<usize> {
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
    /// Where the measurement does not exist.
    #[must_use]
    pub fn factor_chi2(&self, factor: usize) -> f64 {
        self.factor_chi2_at(factor, &self.poses)
    }

    /// The same at other poses, by index.
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

    /// `χ² = Σ eᵀΩe`: no kernel, no factor ½.
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

    /// The same at other poses, by index.
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

/// The representative of a node's component, with the path to it halved on the way.
fn root_of(parent: &mut [usize], mut node: usize) -> usize {
    while parent[node] != node {
        parent[node] = parent[parent[node]];
        node = parent[node];
    }
    node
}
