//! Files that are no log: what they are, and how to get a log from them.

use crate::graph_file::GraphFile;
use crate::log_bytes::packs;
use crate::session::Session;
use crate::table_layout::TableLayout;

/// A kind of file that is no log.
#[derive(Debug)]
pub struct Foreign {
    /// What it is.
    pub found: &'static str,
    /// What to do.
    pub advice: &'static str,
    /// First bytes; one of them is enough.
    starts: &'static [&'static [u8]],
    /// A condition on the start of the file, if first bytes do not suffice.
    is: fn(&[u8]) -> bool,
    /// File name extensions, for files whose content is not recognized.
    extensions: &'static [&'static str],
}

impl PartialEq for Foreign {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}

impl Eq for Foreign {}

impl Foreign {
    /// The kind of a file with this start.
    #[must_use]
    pub fn of(start: &[u8]) -> Option<&'static Self> {
        KINDS.iter().find(|kind| {
            kind.starts.iter().any(|magic| start.starts_with(magic)) || (kind.is)(start)
        })
    }

    /// Whether it is a trajectory.
    #[must_use]
    pub(crate) fn is_trajectory(&self) -> bool {
        self.extensions == ["tum"]
    }

    /// The kind of a file with this name, whose content is not recognized.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        let (_, extension) = name.rsplit_once('.')?;
        let extension = extension.to_ascii_lowercase();
        KINDS
            .iter()
            .find(|kind| kind.extensions.contains(&extension.as_str()))
    }
}

fn never(_: &[u8]) -> bool {
    false
}

const fn kind(
    found: &'static str,
    advice: &'static str,
    starts: &'static [&'static [u8]],
    extensions: &'static [&'static str],
) -> Foreign {
    Foreign {
        found,
        advice,
        starts,
        is: never,
        extensions,
    }
}

const FROM_ITS_RECORDING: &str = "pass the recording that it was made from";

/// All kinds; the first one that fits is taken.
static KINDS: [Foreign; 35] = [
    kind(
        "a Git LFS pointer, not the file itself",
        "fetch the file with git lfs pull",
        &[b"version https://git-lfs"],
        &[],
    ),
    Foreign {
        is: |start| start.len() > 64 && start.iter().all(|&byte| byte == 0),
        ..kind(
            "zeros only, as after a power cut or an unfinished copy",
            "copy it again, or record it again",
            &[],
            &[],
        )
    },
    Foreign {
        is: is_page,
        ..kind(
            "a web page, not the file itself",
            "download the file again: the page may ask for a login or a confirmation",
            &[],
            &["html", "htm"],
        )
    },
    kind(
        "a ROS 1 recording older than version 2.0",
        "convert it with rosbag fix first",
        &[b"#ROSRECORD", b"#ROSBAG V1"],
        &[],
    ),
    kind(
        "the description of a ROS 2 recording, not the recording itself",
        "pass its folder, or the files that it lists",
        &[b"rosbag2_bagfile_information"],
        &[],
    ),
    Foreign {
        is: |start| start.get(257..262) == Some(b"ustar"),
        ..kind(
            "an archive",
            "extract it and pass the recording in it",
            &[b"PK\x03\x04", b"7z\xbc\xaf\x27\x1c", b"Rar!"],
            &["tar", "zip", "7z", "rar"],
        )
    },
    kind(
        "compressed by bzip2, xz or lz4",
        "decompress it with bunzip2, xz -d or lz4 -d first",
        &[b"BZh", b"\xfd7zXZ", b"\x04\x22\x4d\x18"],
        &["bz2", "xz", "lz4"],
    ),
    Foreign {
        is: packs,
        ..kind(
            "compressed more than twice",
            "decompress it with zstd -d or gunzip first",
            &[],
            &[],
        )
    },
    Foreign {
        is: is_gfs,
        ..kind(
            "the output of GMapping, not a log of scans",
            "pass the log that GMapping was run on",
            &[],
            &["gfs"],
        )
    },
    Foreign {
        is: |start| {
            let keys = [&b"\"nrays\""[..], b"\"readings\""];
            start.starts_with(b"{") && keys.iter().all(|key| contains(start, key))
        },
        ..kind(
            "a log of CSM, the canonical scan matcher",
            "convert it to CARMEN with CSM's json2carmen first",
            &[],
            &[],
        )
    },
    Foreign {
        // A graph that carries its scans is a log.
        is: |start| GraphFile::begins(start) && !contains(start, b"\nROBOTLASER1 "),
        ..kind(
            "a pose graph, not a log of scans",
            "optimize it with slam2d optimize",
            &[],
            &["g2o", "toro"],
        )
    },
    Foreign {
        is: Session::begins,
        ..kind(
            "a saved session, not a log of scans",
            "pass a log; slam2d run LOG --continue continues a session",
            &[],
            &["slam2d"],
        )
    },
    kind(
        "text in UTF-16",
        "save it as UTF-8 first",
        &[b"\xff\xfe", b"\xfe\xff"],
        &[],
    ),
    kind(
        "a point cloud in a file, not a log of scans",
        "publish it as sensor_msgs/PointCloud2, record that topic, and pass --heights LOW,HIGH for a 3-D sensor",
        &[
            b"# .PCD",
            b"VERSION 0.7",
            b"VERSION .7",
            b"ply\n",
            b"ply\r\n",
            b"LASF",
        ],
        &["pcd", "ply", "las", "laz", "xyz"],
    ),
    kind(
        "a map or a picture, not a log of scans",
        FROM_ITS_RECORDING,
        &[
            b"P5\n",
            b"P2\n",
            b"P5 ",
            b"image:",
            b"\x89PNG",
            b"octomap",
            b"# Octomap",
        ],
        &["pgm", "png", "bt"],
    ),
    kind(
        "a pose graph of slam_toolbox, not a log of scans",
        FROM_ITS_RECORDING,
        &[b"\x16\0\0\0\0\0\0\0serialization::archive"],
        &["posegraph"],
    ),
    Foreign {
        is: |start| contains(&start[..start.len().min(64)], b"pbstream"),
        ..kind(
            "a state of Cartographer, not a log of scans",
            "pass the recording that Cartographer was run on",
            &[b"\xdb\x01\xf5\x5b\x7b\x1f\x1d\x7b"],
            &["pbstream"],
        )
    },
    Foreign {
        is: |start| {
            let names = [&b"CActionCollection"[..], b"CSensoryFrame", b"CObservation"];
            let head = &start[..start.len().min(64)];
            names.iter().any(|name| contains(head, name))
        },
        ..kind(
            "a rawlog of MRPT",
            "convert it with rawlog-edit --externalize and MRPT's carmen or rosbag tools first",
            &[],
            &["rawlog"],
        )
    },
    kind(
        "a capture of network packets",
        "replay it to the sensor's driver, record the topic of its scans, and pass that recording",
        &[
            b"\xd4\xc3\xb2\xa1",
            b"\xa1\xb2\xc3\xd4",
            b"\x0a\x0d\x0d\x0a",
        ],
        &["pcap", "pcapng"],
    ),
    Foreign {
        is: is_rplidar,
        ..kind(
            "what an RPLidar sends on its serial port",
            "record the topic of its driver, or save the output of the SDK's ultra_simple, lines of theta: … Dist: … Q: …",
            &[b"\xa5\x5a"],
            &[],
        )
    },
    Foreign {
        is: is_player,
        ..kind(
            "a log of Player",
            "write its laser lines as CSV with a header such as time,x,y,heading,angle_min,angle_increment,ranges",
            &[b"## Player version"],
            &[],
        )
    },
    Foreign {
        is: |start| {
            contains(
                &start[..start.len().min(4096)],
                b"sensor_msgs.msg.LaserScan(",
            )
        },
        ..kind(
            "messages as rclpy prints them",
            "record the topic with ros2 bag record, or print it with ros2 topic echo --csv --full-length",
            &[],
            &[],
        )
    },
    Foreign {
        is: |start| {
            let start = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start);
            let inner = start.trim_ascii_start().strip_prefix(b"[");
            inner.is_some_and(|inner| inner.trim_ascii_start().starts_with(b"{"))
        },
        ..kind(
            "a list in JSON, not an object a line",
            "write an object a line: jq -c '.[]' FILE; each needs a time, angle_min, angle_increment and ranges, which jq -c '.[] + {angle_min: -3.14159, angle_increment: 0.0174533}' FILE adds",
            &[],
            &[],
        )
    },
    kind(
        "an array of NumPy",
        "write it as CSV with a header such as time,x,y,heading,angle_min,angle_increment,ranges",
        &[b"\x93NUMPY"],
        &["npy", "npz"],
    ),
    kind(
        "a file of MATLAB",
        "write it as CSV with a header such as time,x,y,heading,angle_min,angle_increment,ranges",
        &[b"MATLAB"],
        &["mat"],
    ),
    kind(
        "an HDF5 file",
        "write its scans as CSV with a header such as time,x,y,heading,angle_min,angle_increment,ranges",
        &[b"\x89HDF"],
        &["h5", "hdf5"],
    ),
    kind(
        "a log of LCM",
        "write its scans as JSON lines or CSV; docs/recordings.md describes both",
        &[b"\xed\xa1\xda\x01"],
        &["lcm", "lcmlog"],
    ),
    kind(
        "a flight log of PX4, which has no scans",
        "record the topic of the laser",
        &[b"ULog\x01\x12\x35"],
        &["ulg"],
    ),
    kind(
        "a topic as ros2 topic echo prints it",
        "record it with ros2 bag record, or print it with ros2 topic echo --csv --full-length or rostopic echo -p",
        &[b"header:", b"---\nheader:"],
        &[],
    ),
    kind(
        "an XML file",
        "pass a recorded log",
        &[b"<?xml"],
        &["xml", "launch", "world", "sdf", "urdf"],
    ),
    kind(
        "a picture",
        "pass a recorded log",
        &[b"\xff\xd8\xff", b"GIF8"],
        &["jpg", "jpeg", "gif", "bmp"],
    ),
    kind("a PDF", "pass a recorded log", &[b"%PDF"], &["pdf"]),
    kind(
        "a video",
        "pass a recorded log",
        &[b"\0\0\0\x18ftyp", b"\0\0\0\x20ftyp", b"\x1a\x45\xdf\xa3"],
        &["mp4", "mkv", "avi"],
    ),
    Foreign {
        is: is_trajectory,
        ..kind(
            "a trajectory, not a log of scans",
            "pass a log; slam2d evaluate evaluates a trajectory",
            &[],
            &["tum"],
        )
    },
    Foreign {
        is: TableLayout::names_poses,
        ..kind(
            "odometry without scans",
            "pass the log of the scans with it: slam2d run SCANS ODOMETRY",
            &[],
            &[],
        )
    },
];

/// Whether the bytes contain `key`.
fn contains(bytes: &[u8], key: &[u8]) -> bool {
    bytes.windows(key.len()).any(|window| window == key)
}

fn is_page(start: &[u8]) -> bool {
    let start = start.trim_ascii_start();
    [&b"<!doctype html"[..], b"<html", b"<head"]
        .iter()
        .any(|tag| {
            start
                .get(..tag.len())
                .is_some_and(|head| head.eq_ignore_ascii_case(tag))
        })
}

/// Whether the first line that is neither a comment nor the names of a quaternion's parts has the eight numbers of a stamped
/// pose, or up to twice as many more as EuRoC's.
fn is_trajectory(start: &[u8]) -> bool {
    let mut lines = start.split(|&byte| byte == b'\n');
    let is_names = |line: &[u8]| contains(line, b"qw") && contains(line, b"qx");
    let line = lines
        .find(|line| !line.trim_ascii().is_empty() && !line.starts_with(b"#") && !is_names(line));
    let Some(Ok(line)) = line.map(std::str::from_utf8) else {
        return false;
    };
    let separates = |c: char| c.is_ascii_whitespace() || c == ',';
    let words: Vec<&str> = line
        .split(separates)
        .filter(|word| !word.is_empty())
        .collect();
    (8..=24).contains(&words.len()) && words.iter().all(|word| word.parse::<f64>().is_ok())
}

/// Whether the bytes are measurements of an RPLidar, five each, without the answer that announces them: the first two bits
/// differ, and a bit of the angle is set.
fn is_rplidar(start: &[u8]) -> bool {
    let is_measured = |frame: &[u8]| (frame[0] ^ (frame[0] >> 1)) & 1 == 1 && frame[1] & 1 == 1;
    let start = &start[..start.len().min(500)];
    start.len() >= 100 && start.contains(&0) && start.chunks_exact(5).all(is_measured)
}

/// Whether the first line is one of Player: time, host, robot, interface.
fn is_player(start: &[u8]) -> bool {
    let line = start.split(|&byte| byte == b'\n').next().unwrap_or(start);
    let mut words = line.split(|&byte| byte == b' ');
    let names: [&[u8]; 4] = [b"laser", b"ranger", b"position2d", b"sync"];
    words.nth(3).is_some_and(|word| names.contains(&word))
}

/// Whether a line starts with a keyword of GMapping.
fn is_gfs(start: &[u8]) -> bool {
    let words: [&[u8]; 5] = [
        b"LASER_READING ",
        b"ODO_UPDATE ",
        b"SM_UPDATE ",
        b"GFS ",
        b"NEFF ",
    ];
    let mut lines = start.split(|&byte| byte == b'\n').take(20);
    lines.any(|line| words.iter().any(|word| line.starts_with(word)))
}
