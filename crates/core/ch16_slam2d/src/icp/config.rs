//! The settings of a registration.

use super::Pair;
use super::align::MIN_NORMALS;

/// The error that increments minimize.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum IcpVariant {
    /// The distance between paired points (Besl & McKay 1992).
    #[default]
    PointToPoint,
    /// The distance along the target's normal (Chen & Medioni 1992).
    PointToPlane,
}

/// The settings of a registration; the defaults are the chapter's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IcpConfig {
    /// The error that increments minimize.
    pub variant: IcpVariant,
    /// Largest number of increments.
    pub max_iterations: usize,
    /// Points farther than this from the map have no pair, m.
    pub tau_m: f64,
    /// An increment smaller than this, `‖(v_x, v_y)‖ + |ω|` of its log, ends the run.
    pub tolerance: f64,
    /// With fewer pairs than this the run ends, at least 1. Point to plane has not converged with fewer than
    /// [`IcpConfig::min_normals`] that have a normal.
    pub min_pairs: usize,
    /// Share of the pairs to drop, the longest first; 0 keeps all (Chetverikov et al. 2002).
    pub trim: f64,
    /// Residual beyond which a pair's weight falls as width/residual, m; an infinite width weights all pairs equally
    /// (Huber 1964).
    pub huber_width_m: f64,
}

impl IcpConfig {
    /// Pairs with a normal that a result of point to plane needs: twice `min_pairs`, because a pair measures one number
    /// along its normal, and two without; at least one for every degree of freedom.
    #[must_use]
    pub fn min_normals(&self) -> usize {
        self.min_pairs.saturating_mul(2).max(MIN_NORMALS)
    }

    /// The weight of a pair in an increment: 0 if point to plane lacks its normal, else that of the kernel.
    #[must_use]
    pub fn weight(&self, pair: &Pair) -> f64 {
        match (self.variant, pair.normal) {
            (IcpVariant::PointToPoint, _) => huber_weight(pair.distance_m(), self.huber_width_m),
            (IcpVariant::PointToPlane, None) => 0.0,
            (IcpVariant::PointToPlane, Some(_)) => {
                huber_weight(pair.plane_distance_m().abs(), self.huber_width_m)
            }
        }
    }
}

/// The weight of a pair by the size of its residual, m: 1 up to the width, then width/residual (Huber 1964).
#[inline]
#[must_use]
pub fn huber_weight(residual_m: f64, width_m: f64) -> f64 {
    if residual_m > width_m {
        width_m / residual_m
    } else {
        1.0
    }
}

impl Default for IcpConfig {
    fn default() -> Self {
        Self {
            variant: IcpVariant::default(),
            max_iterations: 25,
            tau_m: 0.6,
            tolerance: 1e-4,
            min_pairs: 8,
            trim: 0.0,
            huber_width_m: f64::INFINITY,
        }
    }
}
