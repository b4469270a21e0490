//! The cheapest poses on the way of a solve, remembered only where the cost rises.
//!
//! A step that lowers the cost leaves nothing worth keeping behind, so that a solve that only
//! descends copies nothing.

use pr_geom::SE2;

/// The cheapest poses that steps climbed away from.
#[derive(Clone, Debug, Default)]
pub(crate) struct BestPoses {
    /// Steps so far.
    steps: usize,
    /// Where the last step came from; its poses are still in the solver's second buffer.
    previous: Option<Place>,
    /// The cheapest place before a rise.
    lowest: Option<Place>,
    /// The poses of `lowest`.
    poses: Vec<SE2>,
}

#[derive(Clone, Copy, Debug)]
struct Place {
    cost: f64,
    /// Number of the step that was computed here.
    step: usize,
}

impl BestPoses {
    /// Another solve begins.
    pub fn forget(&mut self) {
        self.steps = 0;
        self.previous = None;
        self.lowest = None;
    }

    /// The last step led to poses of this cost, from `previous`. A cost that is no number is a rise.
    pub fn arrived(&mut self, cost: f64, previous: &[SE2]) {
        let Some(place) = self.previous.take() else {
            return;
        };
        let rose = !matches!(
            cost.partial_cmp(&place.cost),
            Some(core::cmp::Ordering::Less | core::cmp::Ordering::Equal)
        );
        if rose && self.lowest.is_none_or(|lowest| place.cost < lowest.cost) {
            self.lowest = Some(place);
            self.poses.clear();
            self.poses.extend_from_slice(previous);
        }
    }

    /// A step was computed at poses of this cost, and taken or refused.
    pub fn left(&mut self, cost: f64, accepted: bool) {
        let step = self.steps;
        self.previous = accepted.then_some(Place { cost, step });
        self.steps += 1;
    }

    /// The cheapest poses before a rise, with the step that was computed there, where they cost
    /// less than `cost`.
    pub fn cheaper_than(&self, cost: f64) -> Option<(usize, &[SE2])> {
        let lowest = self.lowest?;
        // Also where `cost` is no number.
        let is_cheaper = cost.is_nan() || lowest.cost < cost;
        is_cheaper.then_some((lowest.step, self.poses.as_slice()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A walk over places of these costs, as a solve that takes every step sees it.
    fn walk(costs: &[f64]) -> BestPoses {
        let mut best = BestPoses::default();
        let pose = |k: usize| [SE2::translation(k as f64, 0.0)];
        for (k, &cost) in costs.iter().enumerate() {
            best.arrived(cost, &pose(k.saturating_sub(1)));
            best.left(cost, true);
        }
        best
    }

    #[test]
    fn the_cheapest_place_before_a_rise_is_kept() {
        let best = walk(&[9.0, 4.0, 7.0, 2.0, 3.0, 8.0]);
        let (step, poses) = best.cheaper_than(8.0).unwrap();
        assert_eq!((step, poses[0].x()), (3, 3.0));
        assert!(best.cheaper_than(2.0).is_none());
    }

    #[test]
    fn a_descent_keeps_nothing() {
        assert!(walk(&[9.0, 4.0, 4.0, 2.0]).cheaper_than(1e9).is_none());
    }

    #[test]
    fn a_cost_that_is_no_number_is_a_rise() {
        for lost in [f64::NAN, f64::INFINITY] {
            let best = walk(&[9.0, 4.0, lost]);
            assert_eq!(best.cheaper_than(lost).map(|(step, _)| step), Some(1));
        }
    }

    #[test]
    fn a_refused_step_leads_nowhere() {
        let mut best = BestPoses::default();
        best.left(4.0, false);
        best.arrived(9.0, &[SE2::identity()]);
        assert!(best.cheaper_than(9.0).is_none());
    }
}
