//! Which loops are believed at once, and which wait for others that say the same.

use nalgebra::{Matrix3, Vector3};
use pr_geom::{SE2, math};

use super::LoopVerification;
use crate::graph::{LoopBeliefs, PoseGraph};

/// A guard against places that look alike.
///
/// The exact covariance of the relative pose in the graph, with the drift since the last loop, says how
/// far off the graph may be. Where that is little, what the registration found is the only place that
/// it can have found. Where it is more, the best place of the whole window has to be ahead of the best
/// other one, and several loops along the way have to agree before the first is closed: Olson,
/// "Recognizing places using spectrally clustered local matches", 2009; Mangelson et al., "Pairwise
/// consistent measurement set maximization", 2018.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopGuard {
    /// The graph is off by so much more than its covariance and drift say, a standard deviation, m.
    pub floor_m: f64,
    /// The same for the heading, rad.
    pub floor_rad: f64,
    /// The largest squared innovation that is expected, of three degrees of freedom.
    pub gate_chi2: f64,
    /// Where the gate reaches no farther than this, a loop within it is believed at once, m.
    pub sure_m: f64,
    /// Else the best place of the window has to be ahead of the best other one by so much.
    pub min_margin: f64,
    /// And so many loops have to agree, itself among them.
    pub agreeing: usize,
    /// So many have to where they contradict the gate.
    pub agreeing_outside: usize,
    /// Loops that agree lie so far apart on the way, m.
    pub apart_m: f64,
    /// Loops wait for others on so much of the way, m.
    pub patience_m: f64,
    /// Who says which loops to believe once the graph contradicts itself.
    pub referee: Referee,
}

/// Says which edges of a graph are believed where each loop may be false; by default nobody does.
///
/// A function, so that a program that asks nobody does not carry it. It is no value of the guard: guards with
/// the same values are equal.
#[derive(Clone, Copy, Default)]
pub struct Referee(Option<fn(&PoseGraph) -> LoopBeliefs>);

impl Referee {
    /// By the truncated cost: [`PoseGraph::believed`].
    #[must_use]
    pub fn by_truncated_cost() -> Self {
        Self(Some(PoseGraph::believed))
    }

    /// What is believed; none where nobody is asked.
    #[must_use]
    pub fn judge(&self, graph: &PoseGraph) -> Option<LoopBeliefs> {
        self.0.map(|judge| judge(graph))
    }
}

impl PartialEq for Referee {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl core::fmt::Debug for Referee {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("Referee")
    }
}

impl Default for LoopGuard {
    fn default() -> Self {
        Self {
            floor_m: 0.15,
            floor_rad: 0.05,
            gate_chi2: 11.345,
            sure_m: 1.2,
            min_margin: 0.05,
            agreeing: 2,
            agreeing_outside: 3,
            apart_m: 1.0,
            patience_m: 12.0,
            referee: Referee::default(),
        }
    }
}

/// A loop that waits for others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldLoop {
    /// What is known of it.
    pub verification: LoopVerification,
    /// Way of the keyframes from the first to its new node, m.
    pub way_m: f64,
    /// Whether it lies within the gate.
    pub is_expected: bool,
}

impl HeldLoop {
    /// How many loops have to agree before it is closed, itself among them.
    #[must_use]
    pub fn needed(&self, guard: &LoopGuard) -> usize {
        if self.is_expected {
            guard.agreeing
        } else {
            guard.agreeing_outside
        }
    }

    /// Whether two loops lie so far apart on the way that they count as two.
    #[must_use]
    pub fn is_apart(&self, other: &Self, guard: &LoopGuard) -> bool {
        (self.way_m - other.way_m).abs() >= guard.apart_m
    }
}

/// Variance of the position along its widest direction, m².
pub(crate) fn widest_variance(covariance: &Matrix3<f64>) -> f64 {
    let (xx, xy, yy) = (covariance[(0, 0)], covariance[(0, 1)], covariance[(1, 1)]);
    math::max(0.5 * (xx + yy) + math::norm2(0.5 * (xx - yy), xy), 0.0)
}

impl LoopGuard {
    /// The covariance of an innovation: what the graph says, the drift, and the floor.
    #[must_use]
    pub fn expected(&self, marginal: &Matrix3<f64>, drift_m: f64) -> Matrix3<f64> {
        let xy = self.floor_m * self.floor_m + drift_m * drift_m;
        let theta = self.floor_rad * self.floor_rad;
        marginal + Matrix3::from_diagonal(&Vector3::new(xy, xy, theta))
    }

    /// How far a gate of that covariance reaches along its widest direction, m.
    #[must_use]
    pub fn reach_m(&self, covariance: &Matrix3<f64>) -> f64 {
        math::sqrt(self.gate_chi2 * widest_variance(covariance))
    }

    /// Whether two loops say the same of where the robot is, by the way between their new nodes.
    ///
    /// `e = log((Tᵢ Z)⁻¹ C T)` with the pose T of the second one's new node, its own claim `Tᵢ Z`, and
    /// the correction `C` of the first one; `eᵀ S⁻¹ e` within the gate. S is the covariance of the way
    /// between both.
    #[must_use]
    pub fn agree(
        &self,
        poses: &[SE2],
        first: &LoopVerification,
        second: &LoopVerification,
        way: &Matrix3<f64>,
    ) -> bool {
        let claim = |found: &LoopVerification| poses[found.candidate.node] * found.registered;
        let correction = claim(first) * poses[first.from_node].inverse();
        let expected = correction * poses[second.from_node];
        let e = claim(second).between(&expected).log();
        way.try_inverse()
            .is_some_and(|information| e.dot(&(information * e)) <= self.gate_chi2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loops::{GateTest, LoopCandidate};

    #[test]
    fn a_gate_reaches_along_its_widest_direction() {
        let guard = LoopGuard {
            floor_m: 0.0,
            floor_rad: 0.0,
            ..LoopGuard::default()
        };
        // Standard deviations of 0.4 m at 45° and 0.1 m across.
        let (long, short) = (0.16, 0.01);
        let (mean, half) = (0.5 * (long + short), 0.5 * (long - short));
        let marginal = Matrix3::new(mean, half, 0.0, half, mean, 0.0, 0.0, 0.0, 1e-4);
        let reach_m = guard.reach_m(&guard.expected(&marginal, 0.0));
        // 1e-12: a dozen roundings of numbers about 1.
        assert!((reach_m - 0.4 * math::sqrt(11.345)).abs() < 1e-12);
        let drifted = guard.reach_m(&guard.expected(&marginal, 0.3));
        assert!((drifted - 0.5 * math::sqrt(11.345)).abs() < 1e-12);
    }

    #[test]
    fn loops_agree_where_they_correct_the_way_alike() {
        // The graph says that the robot drives along x, 4 m apart from its first way; it is 1 m off.
        let poses: Vec<SE2> = (0..8)
            .map(|k| SE2::translation(f64::from(k), 0.0))
            .collect();
        let off = SE2::new(0.7, -0.7, 0.2);
        let found = |from_node: usize, error: SE2| {
            let node = from_node - 4;
            let registered = poses[node].between(&(off * poses[from_node] * error));
            LoopVerification {
                from_node,
                candidate: LoopCandidate {
                    node,
                    distance_m: 4.0,
                    proposal: None,
                },
                belief: poses[node].between(&poses[from_node]),
                initial: SE2::identity(),
                registered,
                rmse_m: 0.02,
                inliers: 90,
                iterations: 5,
                score: Some(0.9),
                margin: Some(0.2),
                innovation: Vector3::zeros(),
                gate_information: Matrix3::identity(),
                gate: GateTest {
                    chi2: 1.0,
                    gate_chi2: 7.8,
                },
                information: Matrix3::identity(),
                rejection: None,
            }
        };
        let guard = LoopGuard::default();
        let way = guard.expected(&Matrix3::zeros(), 0.05);
        let first = found(4, SE2::identity());
        let alike = found(7, SE2::new(0.1, 0.05, 0.01));
        let other = found(7, SE2::new(0.0, 4.0, 0.0));
        assert!(guard.agree(&poses, &first, &alike, &way));
        assert!(!guard.agree(&poses, &first, &other, &way));
    }
}
