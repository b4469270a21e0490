#![doc = include_str!("../README.md")]
//!
//! Reads recorded logs of real robots, runs the estimator on them, and evaluates the result.
//!
//! - [`log`]: what every log yields: frames in the order of the file, and notes.
//! - [`log_options`]: the options of a log, which the command, Python and the page read here; [`robots`]: its robots, one after
//!   the other.
//! - [`log_format`]: detects the format of a file and opens its reader.
//! - [`carmen`]: the text format of CARMEN, in both directions.
//! - [`ros`]: recordings of ROS 2 (MCAP) and ROS 1 (bags).
//! - [`course_log`]: the text format of Carnegie Mellon's course on robotics.
//! - [`table_log`]: rows of scans or of beams: CSV, `rostopic echo -p`, RPLidar's SDK, BreezySLAM.
//! - [`json_log`]: JSON lines, in both directions.
//! - [`line_log`]: shared by all text formats.
//! - [`graph_file`]: pose graphs of g2o, TORO and JSON.
//! - [`map_image`]: maps for Nav2's map_server.
//! - [`report`]: a run's report in one HTML file.
//! - [`info`]: summary of a log.
//! - [`run`]: runs [`Slam`](ch16_slam2d::slam::Slam) on a log, frame by frame, and draws its map.
//! - [`session`]: the complete state of a run in one file.
//! - [`settings`]: the parameters of the estimator by name.
//! - [`live`]: a robot that drives, heard over a network.
//! - [`localize`]: localizes a log on the map of a session.
//! - [`evidence`]: evidence of loops and scans that a run keeps.
//! - [`own_body`] and [`near_readings`]: remove readings of the robot's own body, and of the floor before a laser that leans.
//! - [`quality`]: reliability of each keyframe and loop, and what is doubtful.
//! - [`trajectory`]: stamped poses, and the TUM format in both directions.
//! - [`relations`]: reference relative poses between two times.
//! - [`evaluate`]: errors against relations or against a true trajectory.
//!
//! The crate opens no files and reads no clock: readers take any [`std::io::BufRead`], so all of it also runs in the
//! browser. An unusable file gives one sentence with its name, the line and what was expected.

#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]

pub mod carmen;
pub mod course_log;
pub mod doctor;
pub mod evaluate;
pub mod evidence;
pub mod footprint;
pub mod foreign;
pub mod graph_file;
pub mod info;
pub mod json_log;
pub mod laser_mount;
pub mod line_log;
pub mod live;
pub mod localize;
pub mod log;
pub mod log_bytes;
pub mod log_format;
pub mod log_options;
pub mod map_image;
pub mod motion;
pub mod near_readings;
pub mod own_body;
pub mod quality;
pub mod relations;
pub mod remark;
pub mod report;
pub mod robots;
pub mod ros;
pub mod rosbag2;
pub mod run;
pub mod session;
pub mod settings;
pub mod table_layout;
pub mod table_log;
pub mod trajectory;

mod lines;
mod mounted_reader;
mod odometry_file;
mod odometry_poses;
mod odometry_use;
mod open_log;
mod path_lengths;
mod plausible;
mod plural;
mod range_unit;
mod repeats;
mod restamped;
mod stamps;
