//! Subscribes to what is read of a robot, records it, and passes it to the estimator's stream.

use std::collections::BTreeMap;
use std::io;
use std::mem;
use std::time::Duration;

use super::protocol::{Channel, ServerText, message_data, subscribe};
use super::queue::Feeder;
use crate::ros::{McapWriter, MessageUse, Topic};

/// Most topics that are taken, so that a server cannot fill the memory with them.
const MAX_TOPICS: usize = 1000;

/// Why the drive ended.
#[derive(Debug)]
pub enum DriveEnd {
    /// The user ended it, or the estimator did.
    Asked,
    /// No scan came in time.
    NoScans,
    /// The connection was lost and did not come back in time.
    NotBack(String),
    /// The server sent more than is taken.
    TooLong(String),
    /// The recording cannot be written.
    Recording(io::Error),
}

/// What came.
#[derive(Debug)]
pub struct Heard {
    /// Number of scans.
    pub scans: usize,
    /// Number of scans that arrived faster than they were mapped.
    pub dropped: usize,
    /// Time of each loss of the connection that came back.
    pub gaps: Vec<Duration>,
    /// All topics with their types.
    pub topics: BTreeMap<String, String>,
    /// Topics of laser scans.
    pub lasers: Vec<String>,
    /// Why it ended.
    pub end: DriveEnd,
}

/// A subscription.
struct Subscribed {
    /// Number of the topic in the recording.
    number: u16,
    is_scan: bool,
    channel: u64,
}

/// A drive: messages of the server go in, and requests to it, bytes of the recording and names of topics come out.
pub struct Drive {
    /// Topics of scans that are asked for; all lasers if there are none.
    asked: Vec<String>,
    writer: McapWriter,
    feeder: Feeder,
    subscriptions: BTreeMap<u32, Subscribed>,
    requests: Vec<String>,
    recorded: Vec<u8>,
    read: Vec<(String, String)>,
    /// What came so far.
    pub heard: Heard,
}

impl Drive {
    /// Starts a drive whose recording also goes to `feeder`; of scans, only these topics are read, or all lasers if there
    /// are none.
    #[must_use]
    pub fn new(feeder: Feeder, asked: Vec<String>) -> Self {
        let mut drive = Self {
            asked,
            writer: McapWriter::default(),
            feeder,
            subscriptions: BTreeMap::new(),
            requests: Vec::new(),
            recorded: Vec::new(),
            read: Vec::new(),
            heard: Heard {
                scans: 0,
                dropped: 0,
                gaps: Vec::new(),
                topics: BTreeMap::new(),
                lasers: Vec::new(),
                end: DriveEnd::Asked,
            },
        };
        drive.record(drive.writer.start());
        drive
    }

    /// Takes a text of the server; those of no use here are passed over.
    pub fn text(&mut self, text: &str) {
        match serde_json::from_str(text) {
            Ok(ServerText::Advertise { channels }) => {
                for channel in &channels {
                    self.advertised(channel);
                }
            }
            Ok(ServerText::Unadvertise { channel_ids }) => self
                .subscriptions
                .retain(|_, subscribed| !channel_ids.contains(&subscribed.channel)),
            Ok(ServerText::Other) | Err(_) => {}
        }
    }

    /// Takes a binary message of the server: records the message of a topic, and passes it on.
    pub fn binary(&mut self, bytes: &[u8]) {
        let Some((subscription, time_ns, bytes)) = message_data(bytes) else {
            return;
        };
        let Some(subscribed) = self.subscriptions.get(&subscription) else {
            return;
        };
        let record = McapWriter::message(subscribed.number, time_ns, bytes);
        let is_scan = subscribed.is_scan;
        self.recorded.extend_from_slice(&record);
        let is_taken = self.feeder.offer(record, is_scan);
        self.heard.scans += usize::from(is_scan);
        self.heard.dropped += usize::from(is_scan && !is_taken);
    }

    /// The connection is lost: a new one has to subscribe again.
    pub fn lost(&mut self) {
        self.subscriptions.clear();
    }

    /// Ends the recording and the estimator's stream; what came, and the last bytes of the recording.
    #[must_use]
    pub fn end(mut self) -> (Heard, Vec<u8>) {
        self.record(McapWriter::end());
        (self.heard, self.recorded)
    }

    /// Requests to the server since the last call.
    pub fn take_requests(&mut self) -> Vec<String> {
        mem::take(&mut self.requests)
    }

    /// Bytes of the recording since the last call.
    pub fn take_recorded(&mut self) -> Vec<u8> {
        mem::take(&mut self.recorded)
    }

    /// Topics that are read and their types, since the last call.
    pub fn take_read(&mut self) -> Vec<(String, String)> {
        mem::take(&mut self.read)
    }

    /// Subscribes to a topic if it is read.
    fn advertised(&mut self, channel: &Channel) {
        let topic = channel.topic();
        let mut channels = self.subscriptions.values();
        let is_known = channels.any(|subscribed| subscribed.channel == channel.id);
        if self.heard.topics.len() >= MAX_TOPICS || is_known {
            return;
        }
        let [name, schema] =
            [&topic.name, &topic.schema].map(|name| name.escape_debug().to_string());
        let known = self.heard.topics.insert(name.clone(), schema.clone());
        let kind = MessageUse::of(&topic.schema, &topic.encoding);
        if known.is_none() && kind == Some(MessageUse::Scan) {
            self.heard.lasers.push(name.clone());
        }
        let Some(use_of) = kind.filter(|use_of| self.is_read(&topic, *use_of)) else {
            return;
        };
        let Some((number, declared)) = self.writer.declare(&topic) else {
            return;
        };
        if !declared.is_empty() {
            self.record(declared);
            self.read.push((name, schema));
        }
        let last = self.subscriptions.last_key_value();
        let subscription = last.map_or(0, |(id, _)| id.wrapping_add(1));
        let subscribed = Subscribed {
            number,
            is_scan: use_of != MessageUse::Motion,
            channel: channel.id,
        };
        self.subscriptions.insert(subscription, subscribed);
        self.requests.push(subscribe(subscription, channel.id));
    }

    /// Whether a topic is read: clouds only if they are asked for, because a camera's fill a Wi-Fi.
    fn is_read(&self, topic: &Topic, use_of: MessageUse) -> bool {
        let is_asked = self.asked.contains(&topic.name);
        match use_of {
            MessageUse::Motion => true,
            MessageUse::Scan => self.asked.is_empty() || is_asked,
            MessageUse::Cloud => is_asked,
        }
    }

    /// Records bytes that the rest depends on, and passes them on.
    fn record(&mut self, bytes: Vec<u8>) {
        self.recorded.extend_from_slice(&bytes);
        self.feeder.add(bytes);
    }
}

#[cfg(test)]
mod tests {
    use super::super::queue;
    use super::*;

    #[test]
    fn scans_that_come_faster_than_they_are_read_are_counted_and_recorded() {
        let (feeder, _feed) = queue::stream(true);
        let mut drive = Drive::new(feeder, Vec::new());
        drive.text(
            r#"{"op": "advertise", "channels": [{"id": 7, "topic": "/scan", "encoding": "cdr",
                "schemaName": "sensor_msgs/msg/LaserScan", "schema": ""}]}"#,
        );
        let of_start = drive.take_recorded().len();
        // Subscription 0 at time 0.
        let message = [&[1][..], &[0; 4 + 8], b"a scan"].concat();
        drive.binary(&message);
        let of_message = drive.take_recorded().len();
        assert!(of_start > 0 && of_message > message.len());
        while drive.heard.dropped < 3 && drive.heard.scans < 10_000 {
            drive.binary(&message);
        }
        assert_eq!((drive.heard.scans, drive.heard.dropped), (1003, 3));
        assert_eq!(drive.take_recorded().len(), 1002 * of_message);
    }
}
