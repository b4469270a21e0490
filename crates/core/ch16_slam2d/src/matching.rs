//! One interface for scan registration, for the front end and for loop closure.
//!
//! A [`Matcher`] takes a target cloud once and registers any number of scans on it. It returns one value, a
//! [`Match`]: the pose, its fit, the stop reason, the pairs and their information, and, after a search, the margin
//! to the runner-up. [`MatcherKind`] selects a matcher of this crate; a custom matcher implements the trait and is
//! passed to [`Slam::with_parts`](crate::slam::Slam::with_parts).

mod icp_matcher;
mod information;
mod information_frame;
mod kind;
mod matcher;
mod ndt_matcher;
mod search_matcher;

pub use icp_matcher::IcpMatcher;
pub use information::{TrustConfig, match_information, result_information};
pub use information_frame::{InformationFrame, chapter_information};
pub use kind::MatcherKind;
pub use matcher::{
    CloneMatcher, MapConfig, Match, MatchRequest, MatchStop, MatchSummary, Matcher, RunnerUp,
};
pub use ndt_matcher::{NdtMatcher, NdtMatcherConfig};
pub use search_matcher::{SearchMatcher, SearchMatcherConfig};
