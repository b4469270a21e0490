//! The request for a custom loop, and its errors.

use ch16_slam2d::graph::RobustKernel;
use thiserror::Error;

use super::super::choices::NamedChoice;

/// Width of Huber's kernel, a Mahalanobis norm: 95 % of the efficiency of plain least squares on Gaussian
/// noise (Huber 1964). The lap's own width, 12, is too large to reduce a false loop.
const HUBER_WIDTH: f64 = 1.345;

/// φ of dynamic covariance scaling, a squared Mahalanobis norm.
const DCS_PHI: f64 = 10.0;

/// The relative pose that the loop asserts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Claim {
    /// The registration from the graph's relative pose.
    #[default]
    Registered,
    /// Their true relative pose.
    Truth,
    /// Both keyframes at one position, with the graph's relative heading.
    SamePlace,
}

impl NamedChoice for Claim {
    const NAMED: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Registered, "registered", "registered"),
        (Self::Truth, "truth", "the truth"),
        (Self::SamePlace, "same-place", "“the same place”"),
    ];
}

/// Whether the loop has to pass the acceptance tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum GateUse {
    /// A registered loop has to pass the tests of fit, pairs and χ², an asserted one that of χ².
    #[default]
    Asked,
    /// It is added regardless of the tests.
    Bypassed,
}

/// The robust kernel of the loop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum OwnKernel {
    /// None: plain least squares.
    #[default]
    Quadratic,
    /// Huber's: the cost grows linearly far out.
    Huber,
    /// Dynamic covariance scaling.
    Dcs,
}

impl OwnKernel {
    /// Converts it for the solver.
    pub(super) fn kernel(self) -> RobustKernel {
        match self {
            Self::Quadratic => RobustKernel::None,
            Self::Huber => RobustKernel::Huber { width: HUBER_WIDTH },
            Self::Dcs => RobustKernel::Dcs { phi: DCS_PHI },
        }
    }
}

impl NamedChoice for OwnKernel {
    const NAMED: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Quadratic, "quadratic", "quadratic"),
        (Self::Huber, "huber", "Huber"),
        (Self::Dcs, "dcs", "DCS"),
    ];
}

/// The request for a custom loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnLoopRequest {
    /// The loop is added to the graph at the end of this tick.
    pub tick: usize,
    /// Its two keyframes, in any order.
    pub nodes: [usize; 2],
    /// The relative pose that it asserts.
    pub claim: Claim,
    /// Whether it has to pass the acceptance tests.
    pub gate: GateUse,
    /// Its robust kernel.
    pub kernel: OwnKernel,
}

/// Why a custom loop is impossible.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum OwnLoopError {
    /// Both ends are one keyframe.
    #[error("both ends of your loop are keyframe {node}: choose two different ones")]
    OneNode {
        /// The keyframe.
        node: usize,
    },
    /// An end does not exist at that tick.
    #[error("keyframe {node} does not exist yet; keyframe {newest} is the newest")]
    NotYet {
        /// The end.
        node: usize,
        /// The newest keyframe at that tick.
        newest: usize,
    },
}
