//! Recordings of ROS: MCAP files of ROS 2 and bags of ROS 1, through one set of messages.
//!
//! A container yields messages with topic, type and bytes: [`mcap_file`] or [`bag_file`]. The
//! [`Collector`] decodes those that it knows, finds where the laser sits and where the wheels were,
//! and puts frames together:
//!
//! | type | what it gives |
//! |---|---|
//! | `sensor_msgs/LaserScan` | scans with their geometry and the time of each beam |
//! | `sensor_msgs/PointCloud2` | scans, where the cloud is one ring |
//! | `nav_msgs/Odometry` | the wheels' pose |
//! | `tf2_msgs/TFMessage` | where the laser sits, and the wheels' pose where no Odometry is recorded |
//!
//! Everything is found by type; [`LogOptions`] chooses where there are several. A scan waits until
//! odometry of its time and the transform to its frame have come, and takes the pose in between.
//!
//! Chunks may be compressed by lz4, zstd (MCAP) and bzip2 (bags). A chunk and the message under way
//! are in memory, and nothing else of the file.
//!
//! [`LogOptions`]: crate::log::LogOptions

mod bag_file;
mod collector;
mod container;
mod decompress;
mod file_bytes;
mod mcap_file;
mod messages;
mod point_cloud;
mod reader;
mod transforms;
mod waiting;
mod wire;

pub use reader::RosReader;

#[cfg(test)]
mod tests;
