//! What a reader asks of a loop of their own, and why it cannot be.

use ch16_slam2d::graph::RobustKernel;
use thiserror::Error;

use super::super::choices::Choice;

/// Where Huber's kernel turns linear, a Mahalanobis norm: 95 % of the efficiency of plain least squares
/// on Gaussian noise (Huber 1964). The lap's own, 12, is too wide to see a wrong loop.
const HUBER_WIDTH: f64 = 1.345;

/// Where dynamic covariance scaling begins, a squared Mahalanobis norm.
const DCS_PHI: f64 = 10.0;

/// What the loop says of its two keyframes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Claim {
    /// What registration finds from where the graph believes the two to be.
    #[default]
    Registered,
    /// Their true relative pose.
    Truth,
    /// That both stand at one place, turned as the graph believes them to be.
    SamePlace,
}

impl Choice for Claim {
    const ALL: &'static [Self] = &[Self::Registered, Self::Truth, Self::SamePlace];

    fn name(self) -> &'static str {
        match self {
            Self::Registered => "registered",
            Self::Truth => "truth",
            Self::SamePlace => "same-place",
        }
    }

    fn label(self) -> &'static str {
        match self {
            Self::Registered => "registered",
            Self::Truth => "the truth",
            Self::SamePlace => "“the same place”",
        }
    }
}

/// Whether the loop has to pass the tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum GateUse {
    /// A registered loop passes the tests of fit, pairs and χ², an asserted one that of χ².
    #[default]
    Asked,
    /// It is added whatever the tests say.
    Bypassed,
}

/// What the graph with the loop is solved under.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum OwnKernel {
    /// None: plain least squares.
    #[default]
    Quadratic,
    /// Huber's: far out the cost grows linearly.
    Huber,
    /// Dynamic covariance scaling.
    Dcs,
}

impl OwnKernel {
    /// It, for the solver.
    pub(super) fn kernel(self) -> RobustKernel {
        match self {
            Self::Quadratic => RobustKernel::None,
            Self::Huber => RobustKernel::Huber { width: HUBER_WIDTH },
            Self::Dcs => RobustKernel::Dcs { phi: DCS_PHI },
        }
    }
}

impl Choice for OwnKernel {
    const ALL: &'static [Self] = &[Self::Quadratic, Self::Huber, Self::Dcs];

    fn name(self) -> &'static str {
        match self {
            Self::Quadratic => "quadratic",
            Self::Huber => "huber",
            Self::Dcs => "dcs",
        }
    }

    fn label(self) -> &'static str {
        match self {
            Self::Quadratic => "quadratic",
            Self::Huber => "Huber",
            Self::Dcs => "DCS",
        }
    }
}

/// A loop that a reader asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnLoopRequest {
    /// The graph at the end of this tick gets it.
    pub tick: usize,
    /// Its two keyframes, in any order.
    pub nodes: [usize; 2],
    /// What it says of them.
    pub claim: Claim,
    /// Whether it has to pass the tests.
    pub gate: GateUse,
    /// What the graph is solved under.
    pub kernel: OwnKernel,
}

/// Why there is no such loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum OwnLoopError {
    /// Both ends are one keyframe.
    #[error("both ends of your loop are keyframe {node}: choose two different ones")]
    OneNode {
        /// Which.
        node: usize,
    },
    /// An end was not yet reached.
    #[error("keyframe {node} is not yet there: keyframe {newest} is the newest so far")]
    NotYet {
        /// The end.
        node: usize,
        /// The newest keyframe at that tick.
        newest: usize,
    },
}
