//! Outlier rejection of pairs before each increment.

use pr_geom::sort_numbers;

/// A rule that rejects pairs by their distance.
pub trait PairRejection: Send + Sync {
    /// The accepted pairs; `squared_m2` holds the squared distances of all pairs, m², at least one, and may be reordered.
    fn accepted(&self, squared_m2: &mut [f64]) -> Accepted;
}

/// The pairs that a rule accepts.
#[derive(Clone, Debug, PartialEq)]
pub enum Accepted {
    /// Those up to this squared distance, m².
    UpTo(f64),
    /// All but those at these indices, which ascend.
    AllBut(Vec<usize>),
}

/// Accepts pairs up to a distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaxDistance {
    /// The distance, m.
    pub tau_m: f64,
}

impl PairRejection for MaxDistance {
    fn accepted(&self, _: &mut [f64]) -> Accepted {
        Accepted::UpTo(self.tau_m * self.tau_m)
    }
}

/// Accepts all but the longest pairs (Chetverikov et al. 2002); ties with the longest accepted pair are accepted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trimmed {
    /// Share of the pairs to drop, 0 to 1.
    pub share: f64,
}

impl PairRejection for Trimmed {
    fn accepted(&self, squared_m2: &mut [f64]) -> Accepted {
        let kept = ((1.0 - self.share) * squared_m2.len() as f64).ceil();
        let last = (kept as usize).clamp(1, squared_m2.len()) - 1;
        sort_numbers(squared_m2);
        Accepted::UpTo(squared_m2[last])
    }
}

#[cfg(test)]
mod tests {
    use pr_geom::{Point2, SE2};

    use super::*;
    use crate::cloud::{PointCloud, VoxelMap};
    use crate::icp::{Icp, IcpConfig, IcpWorkspace};

    /// Three times the median distance: a custom rule.
    struct TimesMedian(f64);

    impl PairRejection for TimesMedian {
        fn accepted(&self, squared_m2: &mut [f64]) -> Accepted {
            let middle = squared_m2.len() / 2;
            let median_m2 = *squared_m2.select_nth_unstable_by(middle, f64::total_cmp).1;
            Accepted::UpTo(self.0 * self.0 * median_m2)
        }
    }

    /// The same rule, which names the pairs.
    struct ByIndex(f64);

    impl PairRejection for ByIndex {
        fn accepted(&self, squared_m2: &mut [f64]) -> Accepted {
            let Accepted::UpTo(limit_m2) = TimesMedian(self.0).accepted(&mut squared_m2.to_vec())
            else {
                unreachable!("the rule has a limit")
            };
            let far = squared_m2.iter().enumerate();
            let far = far.filter(|(_, squared_m2)| **squared_m2 > limit_m2);
            Accepted::AllBut(far.map(|(index, _)| index).collect())
        }
    }

    #[test]
    fn a_custom_rule_rejects_the_pairs_of_a_moved_box() {
        let wall = |k: i32| Point2::new(0.05 * f64::from(k), 0.0);
        let side = |k: i32| Point2::new(0.0, 0.05 * f64::from(k));
        let room: PointCloud = (0..80).flat_map(|k| [wall(k), side(k)]).collect();
        let crate_at = |x: f64| (0..20).map(move |k| Point2::new(x, 1.0 + 0.05 * f64::from(k)));
        let before: PointCloud = room.iter().chain(crate_at(2.0)).collect();
        let after: PointCloud = room.iter().chain(crate_at(2.3)).collect();
        let map = VoxelMap::from_cloud(&before, 0.25, 8);
        let config = IcpConfig::default();
        let off = |rule: Option<&dyn PairRejection>| {
            let mut workspace = IcpWorkspace::new();
            let mut icp = Icp::new(&after, &map, SE2::identity(), &config, &mut workspace);
            if let Some(rule) = rule {
                icp = icp.with_rejection(rule);
            }
            icp.run().pose.step_size()
        };
        let (pulled, held) = (off(None), off(Some(&TimesMedian(3.0))));
        assert!(pulled > 0.01, "{pulled}");
        assert!(held < 1e-6, "{held}");
        assert_eq!(off(Some(&ByIndex(3.0))).to_bits(), held.to_bits());
        assert!(off(Some(&Trimmed { share: 0.2 })) < 1e-6);
        // The box's points at 0.3 m, and walls within a tenth of a metre of each other.
        assert!(off(Some(&MaxDistance { tau_m: 0.1 })) < 0.5 * pulled);
    }
}
