//! Lowest-cost poses of a solve, copied only if a step raises the cost.
//!
//! A solve that only descends copies nothing: its current poses are the best ones.

use pr_geom::SE2;

/// The lowest-cost poses before the cost rose.
#[derive(Clone, Debug, Default)]
pub(crate) struct BestPoses {
    /// Number of steps so far.
    steps: usize,
    /// Start of the last step; its poses are still in the solver's second buffer.
    previous: Option<Visit>,
    /// The lowest-cost point before a rise.
    lowest: Option<Visit>,
    /// The poses of `lowest`.
    poses: Vec<SE2>,
}

#[derive(Clone, Copy, Debug)]
struct Visit {
    cost: f64,
    /// Number of the step that was computed here.
    step: usize,
}

impl BestPoses {
    /// Resets the record for a new solve.
    pub fn reset(&mut self) {
        self.steps = 0;
        self.previous = None;
        self.lowest = None;
    }

    /// Records that the last step went from `previous` to poses of this cost. A NaN cost counts as a rise.
    pub fn record_arrival(&mut self, cost: f64, previous: &[SE2]) {
        let Some(visit) = self.previous.take() else {
            return;
        };
        let rose = !matches!(
            cost.partial_cmp(&visit.cost),
            Some(core::cmp::Ordering::Less | core::cmp::Ordering::Equal)
        );
        if rose && self.lowest.is_none_or(|lowest| visit.cost < lowest.cost) {
            self.lowest = Some(visit);
            self.poses.clear();
            self.poses.extend_from_slice(previous);
        }
    }

    /// Records a step, accepted or rejected, that was computed at poses of this cost.
    pub fn record_step(&mut self, cost: f64, accepted: bool) {
        let step = self.steps;
        self.previous = accepted.then_some(Visit { cost, step });
        self.steps += 1;
    }

    /// Returns the lowest-cost poses before a rise and the step computed there, if they cost less than
    /// `cost`.
    pub fn cheaper_than(&self, cost: f64) -> Option<(usize, &[SE2])> {
        let lowest = self.lowest?;
        // True as well if `cost` is NaN.
        let is_cheaper = cost.is_nan() || lowest.cost < cost;
        is_cheaper.then_some((lowest.step, self.poses.as_slice()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Simulates a solve that accepts every step and visits these costs.
    fn walk(costs: &[f64]) -> BestPoses {
        let mut best = BestPoses::default();
        let pose = |k: usize| [SE2::from_xy(k as f64, 0.0)];
        for (k, &cost) in costs.iter().enumerate() {
            best.record_arrival(cost, &pose(k.saturating_sub(1)));
            best.record_step(cost, true);
        }
        best
    }

    #[test]
    fn the_cheapest_poses_before_a_rise_is_kept() {
        let best = walk(&[9.0, 4.0, 7.0, 2.0, 3.0, 8.0]);
        let (step, poses) = best.cheaper_than(8.0).unwrap();
        assert_eq!((step, poses[0].x()), (3, 3.0));
        assert!(best.cheaper_than(2.0).is_none());
    }

    #[test]
    fn a_descent_copies_no_poses() {
        assert!(walk(&[9.0, 4.0, 4.0, 2.0]).cheaper_than(1e9).is_none());
    }

    #[test]
    fn a_nan_or_infinite_cost_is_a_rise() {
        for lost in [f64::NAN, f64::INFINITY] {
            let best = walk(&[9.0, 4.0, lost]);
            assert_eq!(best.cheaper_than(lost).map(|(step, _)| step), Some(1));
        }
    }

    #[test]
    fn a_rejected_step_is_not_recorded() {
        let mut best = BestPoses::default();
        best.record_step(4.0, false);
        best.record_arrival(9.0, &[SE2::identity()]);
        assert!(best.cheaper_than(9.0).is_none());
    }
}
