//! Exact covariances of the poses.

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
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

    /// Covariance of the position error of every node that is left if all nodes are aligned to their true positions by
    /// a rigid motion, by node, in the frame of its pose, m².
    ///
    /// Errors are judged after such an alignment, but [`pose_covariances`](Self::pose_covariances) are relative to
    /// the fixed nodes: zero there, and large at the far end if the heading at the start is uncertain. With the
    /// positions' covariance Σ and the rigid motions in the columns of G, the covariance is `Q Σ Qᵀ`,
    /// `Q = 1 − G (GᵀG)⁻¹ Gᵀ`, whichever nodes are fixed: that of a free network. Förstner & Wrobel,
    /// "Photogrammetric computer vision", 2016, §4.5.
    ///
    /// # Errors
    /// If the normal equations are not positive definite.
    pub fn aligned_covariances(&mut self) -> Result<Vec<Matrix2<f64>>, OptimizeError> {
        let poses = self.problem.poses();
        let count = poses.len() as f64;
        let sum = poses
            .iter()
            .map(pr_geom::SE2::translation)
            .sum::<Vector2<f64>>();
        let centre = sum / count;
        // G of each node, in the frame of its pose; orthogonal, because the rotation is about the centre.
        let rigid: Vec<Matrix3<f64>> = poses
            .iter()
            .map(|pose| {
                let arm = pose.translation() - centre;
                let motions = [(1.0, 0.0), (0.0, 1.0), (-arm.y, arm.x)];
                Matrix3::from_columns(&motions.map(|(x, y)| {
                    let (x, y) = pose.rotation().unrotate(x, y);
                    Vector3::new(x, y, 0.0)
                }))
            })
            .collect();
        let spread_m2: f64 = rigid
            .iter()
            .map(|rigid| rigid.column(2).norm_squared())
            .sum();
        let turn = if spread_m2 > 0.0 {
            1.0 / spread_m2
        } else {
            0.0
        };
        let weights = Matrix3::from_diagonal(&Vector3::new(1.0 / count, 1.0 / count, turn));
        let covariances = self.optimizer.marginals_with(&self.problem, &rigid)?;
        let nodes = rigid.iter().zip(&covariances);
        let of_motion: Matrix3<f64> = nodes
            .clone()
            .map(|(rigid, [_, with_motion])| rigid.transpose() * with_motion)
            .sum();
        Ok(nodes
            .map(|(rigid, [stated, with_motion])| {
                let aligning = rigid * weights;
                let cross = with_motion * aligning.transpose();
                let aligned = stated - cross - cross.transpose()
                    + aligning * of_motion * aligning.transpose();
                aligned.fixed_view::<2, 2>(0, 0).into_owned()
            })
            .collect())
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
