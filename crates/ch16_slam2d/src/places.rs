//! Places by what they look like: descriptors of a scan, and detectors that compare them.
//!
//! A search around the estimated pose needs the very pose that is wrong. A descriptor needs none: it
//! says how much two scans look alike, wherever they were taken.
//!
//! - [`RangeHistogram`]: how many returns came from how far. It does not change when the robot turns,
//!   and so says nothing about the heading. It cannot tell a corridor from itself, three metres on.
//! - [`ScanContext`]: which directions are occupied at which distance. Comparing it at every turn
//!   finds the heading as well, which becomes the start of the registration.
//!
//! Neither decides: a candidate is registered and gated like any other. Both see one scan from one
//! spot, so a place that is entered from a metre aside looks a little different.

mod detector;
mod range_histogram;
mod scan_context;

pub use detector::{PlaceDescriptor, PlaceDetector, PlaceDetectorConfig};
pub use range_histogram::{HistogramConfig, RangeHistogram};
pub use scan_context::{ContextConfig, ContextMatch, ScanContext};
