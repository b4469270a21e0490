//! Sentences on what a network does.

use thiserror::Error;

use super::MAX_MESSAGE;
use super::drive::{DriveEnd, Heard};
use crate::ros::{kind_of, unread_cloud};

/// Most topics that a sentence lists.
const LISTED: usize = 20;

/// Why there is no connection.
#[derive(Debug, Error)]
pub enum ConnectError {
    /// Not an address.
    #[error("{0} is not the address of a robot; pass one such as ws://robot:8765")]
    Address(String),
    /// TLS is asked for.
    #[error(
        "{0} asks for an encrypted connection, which only a browser makes; forward the port with ssh -L 8765:localhost:8765 robot, and pass ws://localhost:8765"
    )]
    Encrypted(String),
    /// The name is unknown.
    #[error("{url}: there is no computer {host}: {why}; check the name, or pass its IP address")]
    Name {
        /// The address.
        url: String,
        /// Its host.
        host: String,
        /// What the system says.
        why: String,
    },
    /// Nobody listens there.
    #[error(
        "{url}: no connection: {why}; start foxglove_bridge on the robot, and check address and port"
    )]
    Refused {
        /// The address.
        url: String,
        /// What the system says.
        why: String,
    },
    /// Somebody else listens there.
    #[error(
        "{url} is not a server of Foxglove's WebSocket protocol: {found}; start foxglove_bridge on the robot and pass its port, 8765 unless it was set"
    )]
    Other {
        /// The address.
        url: String,
        /// What it answers.
        found: String,
    },
}

/// What a server of another protocol answers.
pub const OTHER_SUBPROTOCOL: &str = "it has another subprotocol, as rosbridge does";
/// What is known of a server that does not answer.
pub const NO_ANSWER: &str = "it does not answer";

/// Why a connection ended.
#[derive(Debug, Error)]
pub enum Lost {
    /// A message is longer than any that is read.
    #[error("the server sent a message of {0} bytes, and {MAX_MESSAGE} are the most that is taken")]
    TooLong(usize),
    /// The server is silent.
    #[error("the server is silent")]
    Silent,
    /// The connection was closed.
    #[error("the server closed it")]
    Closed,
    /// The connection broke.
    #[error("{0}")]
    Broken(String),
}

/// That a connection is lost and tried again.
#[must_use]
pub fn connecting_again(url: &str, lost: &Lost, wait_s: f64) -> String {
    format!("{url}: the connection is lost ({lost}); connecting again for {wait_s:.0} s")
}

/// That it is there again.
#[must_use]
pub fn connected_again(url: &str) -> String {
    format!("{url}: connected again")
}

/// Who listens: it has its own ways out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Host {
    /// The command.
    Command,
    /// The page.
    Page,
    /// A program in Python.
    Python,
}

impl Heard {
    /// Why a drive has no scan, if the connection shows it.
    #[must_use]
    pub fn without_scans(&self, url: &str, host: Host) -> Option<String> {
        if self.scans > 0 {
            return None;
        }
        let topics = self.topics.iter().take(LISTED);
        let topics: Vec<String> = topics
            .map(|(topic, kind)| format!("{topic} ({kind})"))
            .collect();
        let topics = if topics.is_empty() {
            "it has no topics".to_owned()
        } else {
            format!("it has {}", topics.join(", "))
        };
        let mut clouds = self.topics.iter();
        let unread = clouds.find_map(|(topic, kind)| unread_cloud(topic, &kind_of(kind)));
        Some(match &self.end {
            DriveEnd::NoScans if let Some(unread) = unread => format!("{url}: {unread}"),
            DriveEnd::NoScans => {
                let advice = match host {
                    Host::Command => ", choose with --scan-topic, or wait longer with --wait",
                    Host::Page => " and connect again",
                    Host::Python => ", choose with scan_topic, or wait longer with wait",
                };
                format!("{url}: no scan came; {topics}. Start the driver of the laser{advice}")
            }
            DriveEnd::NotBack(why) => {
                format!("{url}: the connection was lost before the first scan ({why}); {topics}")
            }
            DriveEnd::Asked => format!("{url}: it was interrupted before its first scan; {topics}"),
            DriveEnd::TooLong(why) => format!("{url}: {why}"),
            DriveEnd::Recording(error) => {
                format!("{url}: the recording cannot be written: {error}")
            }
        })
    }

    /// Sentences on what the network did; `recording` has all that came, if it is kept.
    #[must_use]
    pub fn remarks(&self, url: &str, recording: Option<&str>, host: Host) -> Vec<String> {
        let mut remarks = Vec::new();
        for gap in &self.gaps {
            remarks.push(format!(
                "{url}: the connection was lost for {:.1} s; what the robot saw meanwhile is missing",
                gap.as_secs_f64()
            ));
        }
        if self.dropped > 0 {
            let advice = match host {
                Host::Command => "slam2d run maps all of them",
                Host::Page => "save it and open it to map all of them",
                Host::Python => "Pipeline maps all of them",
            };
            let rest = match recording {
                Some(recording) => format!("they are in {recording}: {advice}"),
                None => "pass recording to keep them in a file".to_owned(),
            };
            remarks.push(format!(
                "{url}: {} of {} scans arrived faster than this computer maps them and were left out; {rest}",
                self.dropped, self.scans
            ));
        }
        match &self.end {
            DriveEnd::NotBack(why) => remarks.push(format!(
                "{url}: the connection was lost ({why}) and did not come back; the drive ends there"
            )),
            DriveEnd::TooLong(why) if host != Host::Command => {
                remarks.push(format!("{url}: {why}; the drive ended there"));
            }
            _ => {}
        }
        remarks
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::time::Duration;

    use super::*;

    fn heard(scans: usize, end: DriveEnd) -> Heard {
        let topics = [("/tf", "tf2_msgs/msg/TFMessage"), ("/camera", "Image")];
        let topics = topics.map(|(name, kind)| (name.to_owned(), kind.to_owned()));
        Heard {
            scans,
            dropped: scans / 30,
            gaps: vec![Duration::from_millis(2500)],
            topics: BTreeMap::from(topics),
            lasers: Vec::new(),
            end,
        }
    }

    #[test]
    fn dropped_scans_and_gaps_are_said() {
        let heard = heard(1200, DriveEnd::NotBack(Lost::Silent.to_string()));
        for (host, advice) in [
            (Host::Command, "slam2d run"),
            (Host::Page, "save it"),
            (Host::Python, "Pipeline"),
        ] {
            let said = heard.remarks("ws://r:1", Some("d/recording.mcap"), host);
            assert!(said[0].contains("lost for 2.5 s"), "{said:?}");
            assert!(
                said[1].contains("40 of 1200 scans arrived faster"),
                "{said:?}"
            );
            let is_named = said[1].contains(&format!("d/recording.mcap: {advice}"));
            assert!(is_named, "{said:?}");
            let is_over = said[2].contains("(the server is silent) and did not come back");
            assert!(is_over, "{said:?}");
            assert_eq!(heard.without_scans("ws://r:1", host), None);
        }
        let said = heard.remarks("ws://r:1", None, Host::Python);
        assert!(
            said[1].ends_with("left out; pass recording to keep them in a file"),
            "{said:?}"
        );
    }

    #[test]
    fn without_scans_the_topics_are_listed() {
        let listed = "ws://r:1: no scan came; it has /camera (Image), /tf (tf2_msgs/msg/TFMessage). Start the driver of the laser";
        let heard = heard(0, DriveEnd::NoScans);
        let said = |host| heard.without_scans("ws://r:1", host).unwrap();
        assert_eq!(
            said(Host::Command),
            format!("{listed}, choose with --scan-topic, or wait longer with --wait")
        );
        assert_eq!(said(Host::Page), format!("{listed} and connect again"));
    }
}
