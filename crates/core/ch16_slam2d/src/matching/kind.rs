//! The matchers of this crate by name.

use super::{
    IcpMatcher, MapConfig, Matcher, NdtMatcher, NdtMatcherConfig, SearchMatcher,
    SearchMatcherConfig,
};
use crate::icp::{IcpConfig, IcpVariant};

/// The matcher of a front end or of loop verification.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum MatcherKind {
    /// Point-to-point ICP, the chapter's.
    #[default]
    PointToPoint,
    /// Point-to-plane ICP.
    PointToPlane,
    /// ICP with custom trimming, kernel or tolerance.
    Icp(IcpConfig),
    /// The normal distributions transform.
    Ndt(NdtMatcherConfig),
    /// Branch and bound over a window around the guess, then ICP.
    Search(SearchMatcherConfig),
}

impl MatcherKind {
    /// The settings of its ICP, except τ and the number of iterations; `None` if it is not ICP.
    #[must_use]
    pub fn icp(&self) -> Option<IcpConfig> {
        let of = |variant| IcpConfig {
            variant,
            ..IcpConfig::default()
        };
        match *self {
            Self::PointToPoint => Some(of(IcpVariant::PointToPoint)),
            Self::PointToPlane => Some(of(IcpVariant::PointToPlane)),
            Self::Icp(config) => Some(config),
            Self::Ndt(_) | Self::Search(_) => None,
        }
    }

    /// Builds the matcher, with targets built by `map`.
    #[must_use]
    pub fn build(&self, map: &MapConfig) -> Box<dyn Matcher> {
        match *self {
            Self::PointToPoint => Box::new(IcpMatcher::with_variant(IcpVariant::PointToPoint, map)),
            Self::PointToPlane => Box::new(IcpMatcher::with_variant(IcpVariant::PointToPlane, map)),
            Self::Icp(config) => Box::new(IcpMatcher::new(config, map)),
            Self::Ndt(config) => Box::new(NdtMatcher::new(config, map)),
            Self::Search(config) => Box::new(SearchMatcher::new(config, map)),
        }
    }
}
