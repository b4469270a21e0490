//! The settings of a registration.

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
    /// With fewer pairs than this the run ends.
    pub min_pairs: usize,
    /// Share of the pairs to drop, the longest first; 0 keeps all (Chetverikov et al. 2002).
    pub trim: f64,
    /// Residual beyond which a pair's weight falls as width/residual, m; an infinite width weights all pairs equally
    /// (Huber 1964).
    pub huber_width_m: f64,
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
