//! Iterative closest point: match, move, repeat.

use pr_geom::math;

use crate::{
    Correspondence, PointCloud, SE2, VoxelMap, associate, icp_information, point_to_plane_step,
    svd_align,
};

/// The error that an increment minimizes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum IcpVariant {
    /// The distance between paired points (Besl & McKay 1992).
    #[default]
    PointToPoint,
    /// The distance along the partner's normal (Chen & Medioni 1992).
    PointToPlane,
}

/// The settings of a registration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IcpConfig {
    /// The error that an increment minimizes.
    pub variant: IcpVariant,
    /// Points farther than this from the map have no partner, m.
    pub tau: f64,
    /// Largest number of increments.
    pub max_iters: usize,
    /// With fewer pairs the registration ends.
    pub min_pairs: usize,
    /// An increment smaller than this, m and rad added, ends the registration.
    pub tolerance: f64,
    /// Share of the pairs to drop, the longest first (Chetverikov et al. 2002).
    pub trim: f64,
}

impl Default for IcpConfig {
    fn default() -> Self {
        Self {
            variant: IcpVariant::default(),
            tau: 0.6,
            max_iters: 25,
            min_pairs: 8,
            tolerance: 1e-4,
            trim: 0.0,
        }
    }
}

/// Result of a registration.
#[derive(Clone, Debug, PartialEq)]
pub struct IcpResult {
    /// `map_from_cloud`.
    pub pose: SE2,
    /// Root mean square residual of the last pairs, m; infinite without pairs.
    pub rmse: f64,
    /// Number of the last pairs.
    pub inliers: usize,
    /// The initial guess and the pose after each increment: iterations = length − 1.
    pub trace: Vec<SE2>,
    /// Whether an increment below the tolerance ended it, and the last pairs measure the pose: [`measures_pose`].
    pub converged: bool,
}

/// Registers a cloud on a map from the guess `init`.
#[must_use]
pub fn icp(cloud: &PointCloud, map: &VoxelMap, init: SE2, cfg: &IcpConfig) -> IcpResult {
    let mut pose = init;
    let mut trace = vec![pose];
    let mut converged = false;
    let mut pairs = trimmed(associate(cloud, map, &pose, cfg.tau), cfg.trim);
    while trace.len() <= cfg.max_iters && pairs.len() >= cfg.min_pairs {
        let increment = match cfg.variant {
            IcpVariant::PointToPoint => {
                let (src, dst): (Vec<_>, Vec<_>) = pairs.iter().map(|c| (c.src, c.dst)).unzip();
                svd_align(&src, &dst)
            }
            IcpVariant::PointToPlane => point_to_plane_step(&pairs),
        };
        pose = increment * pose;
        trace.push(pose);
        pairs = trimmed(associate(cloud, map, &pose, cfg.tau), cfg.trim);
        if increment.step_size() < cfg.tolerance {
            converged = measures_pose(&pairs, cfg);
            break;
        }
    }
    IcpResult {
        pose,
        rmse: rmse(&pairs, cfg.variant),
        inliers: pairs.len(),
        trace,
        converged,
    }
}

/// Whether pairs measure a pose: there are enough, and none of its directions is free, as one is along a corridor.
///
/// Point to plane uses those with a normal only, and needs twice as many, because a pair measures one number along its
/// normal, and two without. A direction counts if its information exceeds the ridge of [`point_to_plane_step`], or for
/// point to point what rounding leaves of coincident points.
#[must_use]
pub fn measures_pose(pairs: &[Correspondence], cfg: &IcpConfig) -> bool {
    let is_plane = cfg.variant == IcpVariant::PointToPlane;
    let used = pairs
        .iter()
        .filter(|pair| !is_plane || pair.normal.is_some());
    let used: Vec<Correspondence> = used
        .map(|pair| Correspondence {
            normal: pair.normal.filter(|_| is_plane),
            ..*pair
        })
        .collect();
    let (needed, ridge) = match cfg.variant {
        IcpVariant::PointToPoint => (cfg.min_pairs.max(1), 1e-12),
        IcpVariant::PointToPlane => ((2 * cfg.min_pairs).max(3), 1e-4 / 3.0),
    };
    let information = icp_information(&used, 1.0, 1.0);
    let least = information.symmetric_eigenvalues().min();
    used.len() >= needed && least > ridge * information.trace()
}

/// Drops the longest share of the pairs; keeps at least one.
fn trimmed(mut pairs: Vec<Correspondence>, share: f64) -> Vec<Correspondence> {
    if share <= 0.0 || pairs.is_empty() {
        return pairs;
    }
    let kept = ((1.0 - share) * pairs.len() as f64).ceil().max(1.0) as usize;
    let mut lengths: Vec<f64> = pairs.iter().map(Correspondence::distance_squared).collect();
    lengths.sort_by(f64::total_cmp);
    pairs.retain(|pair| pair.distance_squared() <= lengths[kept - 1]);
    pairs
}

/// Root mean square of the variant's residual; a pair without a normal counts its distance.
fn rmse(pairs: &[Correspondence], variant: IcpVariant) -> f64 {
    if pairs.is_empty() {
        return f64::INFINITY;
    }
    let square = |pair: &Correspondence| match (variant, pair.normal) {
        (IcpVariant::PointToPlane, Some(n)) => {
            let error = n.dot(&(pair.src - pair.dst));
            error * error
        }
        _ => pair.distance_squared(),
    };
    math::sqrt(pairs.iter().map(square).sum::<f64>() / pairs.len() as f64)
}
