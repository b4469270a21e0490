//! Recorded logs of real robots: read, run through the estimator, and graded.
//!
//! - [`log`]: what every log yields, frames in the order of the file, and what is told of it.
//! - [`carmen`]: the text format of CARMEN.
//! - [`info`]: what is in a log.
//! - [`run`]: a log through [`Slam`](ch16_slam2d::slam::Slam), frame by frame.
//! - [`quality`]: how far each keyframe and each loop is to be trusted, and what is to be doubted.
//! - [`trajectory`]: stamped poses, and the TUM format in both directions.
//! - [`relations`]: reference relations between two times.
//! - [`evaluate`]: errors against relations or against a true trajectory.
//!
//! Nothing here opens a file or asks a clock: readers take any [`std::io::BufRead`], so all of it
//! works in the browser as well. A file that cannot be used ends in one sentence with its name, the
//! line and what was expected.

pub mod carmen;
pub mod evaluate;
pub mod info;
pub mod log;
pub mod quality;
pub mod relations;
pub mod run;
pub mod trajectory;

mod lines;
