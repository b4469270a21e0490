//! Place recognition by appearance: descriptors of a scan, and detectors that compare them.
//!
//! A search around the estimated pose depends on the pose that may be wrong. A descriptor does not: it
//! measures the similarity of two scans, wherever they were taken.
//!
//! - [`RangeHistogram`]: the distribution of the ranges. It is invariant to rotation, so it gives no
//!   heading, and it cannot distinguish two positions along a corridor.
//! - [`ScanContext`]: which directions are occupied at which distance. Comparing at every rotation
//!   also finds the heading, which becomes the start of the registration.
//!
//! Both only propose: a candidate is registered and gated like any other. Both see one scan from one
//! position, so a location that is entered with an offset of a metre looks a little different.

mod detector;
mod range_histogram;
mod scan_context;

pub use detector::{PlaceDescriptor, PlaceDetector, PlaceDetectorConfig};
pub use range_histogram::{HistogramConfig, RangeHistogram};
pub use scan_context::{ContextConfig, ContextMatch, ScanContext};
