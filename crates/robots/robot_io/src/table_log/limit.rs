//! The longest reading of a sensor whose table does not state it.
//!
//! Many drivers write it for a beam without a return. Taken as a wall, it is an arc that moves with the robot.

use ch16_slam2d::scan::LaserScan;

/// So many equal readings, the longest of their scan, are no wall.
const FEWEST: usize = 5;

/// The limit, once a scan has shown it.
#[derive(Clone, Copy, Debug, Default)]
pub struct UnstatedLimit(Option<f64>);

impl UnstatedLimit {
    /// Sets the limit of a scan without one; returns a sentence when it is found. A longer reading refutes it.
    pub fn apply(&mut self, scan: &mut LaserScan) -> Option<String> {
        if scan.range_max_m.is_finite() {
            return None;
        }
        let returns = || {
            let ranges = scan.ranges_m.iter().copied();
            ranges.filter(|&range_m| scan.is_return(range_m))
        };
        let longest_m = returns().fold(0.0, f64::max);
        let equal = returns().filter(|&range_m| range_m == longest_m).count();
        // In a scan of equal readings nothing tells.
        let is_limit = equal >= FEWEST && equal < returns().count();
        let known_m = self.0.filter(|&limit_m| longest_m <= limit_m);
        self.0 = known_m.or_else(|| is_limit.then_some(longest_m));
        scan.range_max_m = self.0?;
        known_m.is_none().then(|| {
            format!(
                "its longest reading, {longest_m} m, comes {equal} times in one scan; it is taken as no return. State it in a column range_max"
            )
        })
    }
}
