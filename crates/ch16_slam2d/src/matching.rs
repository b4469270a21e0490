//! One door to all ways of registering a scan, for the front end and for loops alike.
//!
//! A [`Matcher`] takes a target cloud once and registers any number of scans on it. It answers with
//! one value, a [`Match`]: the pose, how well it fits, why it stopped, the pairs and their information,
//! and, if it searched, how far the runner-up was behind. [`MatcherKind`] names the matchers of this crate; a matcher of your own
//! implements the trait and goes to [`Slam::with_parts`](crate::slam::Slam::with_parts).

mod icp_matcher;
mod information;
mod kind;
mod matcher;
mod ndt_matcher;
mod search_matcher;

pub use icp_matcher::IcpMatcher;
pub use information::{TrustConfig, match_information};
pub use kind::MatcherKind;
pub use matcher::{
    CloneMatcher, MapConfig, Match, MatchRequest, MatchStop, MatchSummary, Matcher, RunnerUp,
};
pub use ndt_matcher::{NdtMatcher, NdtMatcherConfig};
pub use search_matcher::{SearchMatcher, SearchMatcherConfig};
