//! Exact covariances of the poses.

use nalgebra::Matrix3;
use pr_optim::OptimizeError;

use super::{NodeId, PoseGraph};

impl PoseGraph {
    /// Exact covariance of the relative pose `T_i⁻¹ T_j`, given all edges.
    ///
    /// Computed from the factor of the whole graph, at the present poses: 3×3, in the tangent space of right
    /// perturbations of the relative pose, order x, y, θ, m² and rad². Other paths between the two nodes, such as
    /// closed loops, make it smaller than the sum along the path. Kaess & Dellaert, "Covariance recovery from a
    /// square root information matrix for data association", 2009.
    ///
    /// # Errors
    /// If the normal equations are not positive definite.
    ///
    /// # Panics
    /// If a node does not exist.
    pub fn relative_covariance(
        &mut self,
        i: impl Into<NodeId>,
        j: impl Into<NodeId>,
    ) -> Result<Matrix3<f64>, OptimizeError> {
        let (i, j) = (i.into(), j.into());
        let joint = self
            .optimizer
            .joint_covariance(&self.problem, i.index(), j.index())?;
        Ok(joint.relative(&self.pose(i), &self.pose(j)))
    }

    /// Largest move of any node, m and rad added, if the graph was optimized: to first order, by the edges since the
    /// last optimization. Infinite if those are too many.
    ///
    /// # Errors
    /// If the normal equations are not positive definite.
    pub fn largest_move_since(&mut self) -> Result<f64, OptimizeError> {
        self.optimizer.largest_move_since(&self.problem)
    }

    /// Exact covariance of every pose relative to the fixed ones, by node; zero for fixed nodes.
    ///
    /// # Errors
    /// If the normal equations are not positive definite.
    pub fn pose_covariances(&mut self) -> Result<Vec<Matrix3<f64>>, OptimizeError> {
        self.optimizer.marginals(&self.problem)
    }

    /// Exact covariance of the relative pose at every edge, in the order in which they were added.
    ///
    /// Computes [`relative_covariance`](Self::relative_covariance) for all edges from one selected
    /// inverse of the factor.
    ///
    /// # Errors
    /// If the normal equations are not positive definite.
    pub fn edge_covariances(&mut self) -> Result<Vec<Matrix3<f64>>, OptimizeError> {
        let measured = self.optimizer.measured_covariances(&self.problem)?;
        let poses = self.problem.poses();
        let ends = self.problem.factors().iter();
        Ok(measured
            .iter()
            .zip(ends)
            .map(|(joint, factor)| joint.relative(&poses[factor.from], &poses[factor.to]))
            .collect())
    }
}
