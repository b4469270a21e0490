//! Recordings of ROS: MCAP and SQLite files of ROS 2 and bags of ROS 1, through one set of messages.
//!
//! A container yields messages with topic, type and bytes: `mcap_file`, `sqlite_file` or `bag_file`. A recording
//! is read twice. A `survey` finds what is in it: topics, transforms, odometry and the times of scans. A
//! `plan` chooses among them, puts all clocks together and says where the laser sits. Then a
//! `cursor` for each laser yields its scans in the order of time.
//!
//! | type | what it gives |
//! |---|---|
//! | `sensor_msgs/LaserScan` | scans with their geometry and the time of each beam |
//! | `sensor_msgs/MultiEchoLaserScan` | the same of the first echo |
//! | `sensor_msgs/PointCloud2` | scans, where the cloud is one ring or heights are given to cut it by |
//! | `nav_msgs/Odometry` | the body's pose by odometry |
//! | `tf2_msgs/TFMessage` | where the laser sits, and odometry where no better one is recorded |
//!
//! Everything is found by type; [`LogOptions`] chooses where there are several.
//!
//! Chunks may be compressed by lz4, zstd (MCAP) and bzip2 (bags). In memory are a chunk and the message under
//! way, the times of all scans and the poses of odometry, up to a bound.
//!
//! [`LogOptions`]: crate::log::LogOptions

mod bag_file;
mod binned;
mod container;
mod cursor;
mod decompress;
mod file;
mod file_bytes;
mod mcap_file;
mod messages;
mod plan;
mod point_cloud;
mod reader;
mod scan_fields;
mod sqlite_file;
mod survey;
mod transforms;
mod wire;

pub use reader::RosReader;

#[cfg(test)]
mod tests;
