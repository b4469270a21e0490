//! Classifies the result of a registration by the minimum that it reached.

use pr_geom::{SE2, math};
use serde::Serialize;

use super::{BasinPlace, FENCE_SPACING_M};
use ch16_slam2d::icp::{IcpSummary, StopReason};

/// A registration counts as right if it is closer to the truth than this, m.
pub const SUCCESS_RADIUS_M: f64 = 0.12;

/// Largest heading error of a registration that counts as right, degrees.
pub const HOME_HEADING_DEG: f64 = 3.0;

/// A heading error this close to a quarter or half turn belongs to that minimum, degrees.
const TURN_TOLERANCE_DEG: f64 = 10.0;

/// The minimum in which a registration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Minimum {
    /// The right one: within 0.12 m of the truth and within 3°.
    Right,
    /// The room turned by a quarter, to either side.
    QuarterTurn,
    /// The room turned by a half.
    HalfTurn,
    /// At the fence, one post off the right pose, on either side.
    OnePost,
    /// At the fence, two posts or more off the right pose.
    MorePosts,
    /// The right position, but the heading is off by more than 3°.
    WrongHeading,
    /// Another false minimum.
    Other,
    /// No minimum: the iterations were used up elsewhere, or the pairs were too few to go on.
    NotConverged,
}

impl Minimum {
    /// One letter, for figures without colour.
    #[must_use]
    pub fn letter(self) -> char {
        match self {
            Self::Right => 'R',
            Self::QuarterTurn => 'Q',
            Self::HalfTurn => 'H',
            Self::OnePost => '1',
            Self::MorePosts => '2',
            Self::WrongHeading => 'W',
            Self::Other => 'F',
            Self::NotConverged => 'S',
        }
    }

    /// The minimum of that letter.
    #[must_use]
    pub fn from_letter(letter: char) -> Option<Self> {
        let mut all = [BasinPlace::Room, BasinPlace::Fence]
            .into_iter()
            .flat_map(Self::at_place);
        all.find(|minimum| minimum.letter() == letter)
    }

    /// The label for readers.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Right => "right minimum",
            Self::QuarterTurn => "quarter turn",
            Self::HalfTurn => "half turn",
            Self::OnePost => "one post off",
            Self::MorePosts => "two posts off or more",
            Self::WrongHeading => "right place, wrong heading",
            Self::Other => "another false minimum",
            Self::NotConverged => "stopped before it converged",
        }
    }

    /// The minima that exist at a location, and `NotConverged`, for legends.
    #[must_use]
    pub fn at_place(place: BasinPlace) -> [Self; 6] {
        let [next, farther] = match place {
            BasinPlace::Room => [Self::QuarterTurn, Self::HalfTurn],
            BasinPlace::Fence => [Self::OnePost, Self::MorePosts],
        };
        [
            Self::Right,
            next,
            farther,
            Self::WrongHeading,
            Self::Other,
            Self::NotConverged,
        ]
    }

    /// A pose away from every known minimum is one only if the registration converged there.
    fn if_converged(self, stop: &StopReason) -> Self {
        match self {
            Self::WrongHeading | Self::Other if !stop.converged() => Self::NotConverged,
            reached => reached,
        }
    }
}

/// The result of one start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BasinOutcome {
    /// `target_from_source` as registered.
    pub pose: SE2,
    /// The minimum that it reached; a pose outside of the known ones is one only if it converged there.
    pub ending: Minimum,
    /// Length of the translation part of `log(truth⁻¹ ∘ pose)`, m.
    pub error_m: f64,
    /// Its rotation, degrees, with sign.
    pub error_deg: f64,
    /// Root mean square residual of the pairs, m. It is small at false minima, too.
    pub rmse_m: f64,
    /// Number of pairs.
    pub inliers: usize,
    /// Increments made.
    pub iterations: usize,
    /// Why the registration ended.
    pub stop: StopReason,
}

impl BasinOutcome {
    /// Compares a registration with the true `target_from_source`.
    #[must_use]
    pub fn judge(truth: &SE2, found: &IcpSummary) -> Self {
        let error = truth.between(&found.pose).log();
        let error_m = math::norm2(error.x, error.y);
        let error_deg = error.z.to_degrees();
        Self {
            pose: found.pose,
            ending: classify(error_m, error_deg).if_converged(&found.stop),
            error_m,
            error_deg,
            rmse_m: found.rmse_m,
            inliers: found.inliers,
            iterations: found.iterations,
            stop: found.stop,
        }
    }

    /// Like [`judge`](Self::judge), at the fence, which runs along x of the target: minima are told apart by the
    /// number of posts between the result and the truth.
    #[must_use]
    pub fn judge_at_fence(truth: &SE2, found: &IcpSummary) -> Self {
        let outcome = Self::judge(truth, found);
        let off_m = found.pose.position() - truth.position();
        let posts = (off_m.x / FENCE_SPACING_M).round();
        let beside_m = math::norm2(off_m.x - posts * FENCE_SPACING_M, off_m.y);
        let is_turned = outcome.error_deg.abs() > HOME_HEADING_DEG;
        let minimum = if beside_m >= SUCCESS_RADIUS_M || (is_turned && posts != 0.0) {
            Minimum::Other
        } else {
            match posts.abs() {
                0.0 if is_turned => Minimum::WrongHeading,
                0.0 => Minimum::Right,
                1.0 => Minimum::OnePost,
                _ => Minimum::MorePosts,
            }
        };
        Self {
            ending: minimum.if_converged(&found.stop),
            ..outcome
        }
    }
}

fn classify(error_m: f64, error_deg: f64) -> Minimum {
    let turned_by = |turn_deg: f64| (error_deg.abs() - turn_deg).abs() <= TURN_TOLERANCE_DEG;
    if error_m < SUCCESS_RADIUS_M && error_deg.abs() <= HOME_HEADING_DEG {
        Minimum::Right
    } else if turned_by(90.0) {
        Minimum::QuarterTurn
    } else if turned_by(180.0) {
        Minimum::HalfTurn
    } else if error_m < SUCCESS_RADIUS_M {
        Minimum::WrongHeading
    } else {
        Minimum::Other
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn home_is_the_position_and_the_heading() {
        assert_eq!(classify(0.119, 3.0), Minimum::Right);
        assert_eq!(classify(0.0, -3.1), Minimum::WrongHeading);
        assert_eq!(classify(0.11, 25.0), Minimum::WrongHeading);
        assert_eq!(classify(0.121, 2.0), Minimum::Other);
        assert_eq!(classify(0.0, 90.0), Minimum::QuarterTurn);
        assert_eq!(classify(0.943, 89.5), Minimum::QuarterTurn);
        assert_eq!(classify(0.981, -90.5), Minimum::QuarterTurn);
        assert_eq!(classify(1.921, -179.9), Minimum::HalfTurn);
        assert_eq!(classify(0.498, 48.1), Minimum::Other);
    }

    #[test]
    fn a_pose_outside_of_the_known_minima_is_one_only_if_it_converged_there() {
        let limit = StopReason::IterationLimit { max_iterations: 30 };
        let small = StopReason::SmallStep {
            step: 1e-5,
            tolerance: 1e-4,
        };
        for lost in [Minimum::Other, Minimum::WrongHeading] {
            assert_eq!(lost.if_converged(&limit), Minimum::NotConverged);
            assert_eq!(lost.if_converged(&small), lost);
        }
        assert_eq!(Minimum::Right.if_converged(&limit), Minimum::Right);
        assert_eq!(
            Minimum::QuarterTurn.if_converged(&limit),
            Minimum::QuarterTurn
        );
    }
}
