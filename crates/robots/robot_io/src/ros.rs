//! ROS recordings: MCAP and SQLite files of ROS 2 and bags of ROS 1, with one set of messages.
//!
//! A container yields messages with topic, type and bytes: `mcap_file`, `sqlite_file` or `bag_file`. A recording
//! is read twice. A `survey` collects topics, transforms, odometry and the stamps of scans. A
//! `plan` selects among them, aligns the clocks and determines the mounting. Then a
//! `cursor` for each laser yields its scans in the order of time. A recording that is still being made is read once:
//! `live`.
//!
//! | type | use |
//! |---|---|
//! | `sensor_msgs/LaserScan` | scans with their geometry and the time of each beam |
//! | `sensor_msgs/MultiEchoLaserScan` | scans of the first echo |
//! | `sensor_msgs/PointCloud2` | scans, if the cloud is one ring or a height band is given |
//! | `nav_msgs/Odometry` | the body's pose by odometry |
//! | `tf2_msgs/TFMessage` | mounting of the laser, and odometry if there is no better source |
//!
//! Topics are found by type; [`LogOptions`] chooses if there are several.
//!
//! Chunks may be compressed by lz4, zstd (MCAP) and bzip2 (bags). Memory holds one chunk and one message, the stamps of
//! all scans and the poses of odometry, up to a bound.
//!
//! [`LogOptions`]: crate::log::LogOptions

mod bag_file;
mod binned;
mod container;
mod cursor;
mod decompress;
mod file;
mod file_bytes;
mod live;
mod mcap_file;
mod mcap_writer;
mod messages;
mod plan;
mod point_cloud;
mod reader;
mod scan_decoder;
mod scan_fields;
mod sqlite_file;
mod survey;
mod transforms;
mod wire;

pub(crate) use container::kind_of;
pub use live::{LiveReader, MessageUse};
pub use mcap_writer::{McapWriter, Topic};
pub(crate) use plan::unread_cloud;
pub use reader::RosReader;
pub(crate) use scan_fields::SWEEP_SLACK;
pub(crate) use scan_fields::ScanFields;

#[cfg(test)]
mod tests;
