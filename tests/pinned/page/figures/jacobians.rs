//! One pose graph solved in four ways, like w16.12.

use ch16_lab::jacobians::{
    EDGE_STD, RING_POSES, Recipe, RingConfig, WrongJacobian, descend, optimum, ring,
};

/// Largest number of steps of each solver, as in the widget.
const MAX_STEPS: usize = 40;

/// `6.exact.steps`, `3.residual.off_m`: by contradiction in degrees, and by solver.
pub fn value(path: &[&str]) -> Option<f64> {
    match *path {
        ["setup", "poses"] => Some(RING_POSES as f64),
        ["setup", "bias_deg"] => Some(RingConfig::default().turn_bias_rad.to_degrees()),
        ["setup", "edge_cm"] => Some(100.0 * EDGE_STD.0),
        // A ring of n poses has n edges for n − 1 free poses.
        ["setup", "freedom"] => Some(3.0),
        [bias_deg, solver, what] => {
            let recipe = match solver {
                "exact" => Recipe::Exact,
                "approximate" => Recipe::Approximate,
                "twice" => Recipe::WrongJacobian(WrongJacobian::TwiceTooLong),
                "residual" => Recipe::WrongResidual,
                _ => return None,
            };
            let graph = ring(&RingConfig {
                turn_bias_rad: bias_deg.parse::<f64>().ok()?.to_radians(),
                ..RingConfig::default()
            });
            let descent = descend(&graph, recipe, &optimum(&graph).0, MAX_STEPS);
            match what {
                "steps" => Some(descent.steps() as f64),
                "off_m" => Some(descent.end().off_m),
                "off_mm" => Some(1e3 * descent.end().off_m),
                "chi2" => Some(descent.end().chi2),
                _ => None,
            }
        }
        _ => None,
    }
}
