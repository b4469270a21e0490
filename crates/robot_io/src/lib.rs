#![doc = include_str!("../README.md")]
//!
//! Recorded logs of real robots: read, run through the estimator, and graded.
//!
//! - [`log`]: what every log yields, frames in the order of the file, and what is told of it.
//! - [`log_format`]: which format a file has, and its reader.
//! - [`carmen`]: the text format of CARMEN, in both directions.
//! - [`ros`]: recordings of ROS 2 (MCAP) and ROS 1 (bags).
//! - [`json_log`]: a log as lines of JSON, in both directions.
//! - [`line_log`]: what all formats of text share.
//! - [`graph_file`]: pose graphs of g2o, TORO and JSON.
//! - [`map_image`]: maps for Nav2's map_server.
//! - [`recorder`] and [`report`]: what a run leaves for a map, and one HTML file with pictures.
//! - [`info`]: what is in a log.
//! - [`run`]: a log through [`Slam`](ch16_slam2d::slam::Slam), frame by frame.
//! - [`session`]: all that a run is, in one file.
//! - [`settings`]: the numbers of the estimator by name.
//! - [`localize`]: a log on the map of a session.
//! - [`evidence`]: what a run keeps of its loops and scans.
//! - [`quality`]: how far each keyframe and each loop is to be trusted, and what is to be doubted.
//! - [`trajectory`]: stamped poses, and the TUM format in both directions.
//! - [`relations`]: reference relations between two times.
//! - [`evaluate`]: errors against relations or against a true trajectory.
//!
//! Nothing here opens a file or asks a clock: readers take any [`std::io::BufRead`], so all of it
//! works in the browser as well. A file that cannot be used ends in one sentence with its name, the
//! line and what was expected.

#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]

pub mod carmen;
pub mod doctor;
pub mod evaluate;
pub mod evidence;
pub mod graph_file;
pub mod info;
pub mod json_log;
pub mod laser_mount;
pub mod line_log;
pub mod localize;
pub mod log;
pub mod log_bytes;
pub mod log_format;
pub mod map_image;
pub mod motion;
pub mod quality;
pub mod recorder;
pub mod relations;
pub mod remark;
pub mod report;
pub mod ros;
pub mod rosbag2;
pub mod run;
pub mod session;
pub mod settings;
pub mod trajectory;

mod counted;
mod lines;
mod place;
mod restamped;
mod stamps;
mod wheel_poses;
