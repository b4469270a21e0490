//! Listens to a robot: subscribes to what is read, records it, and passes it to the estimator.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use command_line::interrupt::Interrupt;
use robot_io::ros::{McapWriter, MessageUse, Topic};
use tungstenite::Message;

use super::connection::{Address, Connection, Lost};
use super::protocol::{Channel, ServerText, message_data, subscribe};
use super::queue::Feeder;

/// Time between two attempts to connect again.
const RETRY: Duration = Duration::from_millis(200);
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
    /// Number of scans that came faster than they were mapped.
    pub dropped: usize,
    /// Time of each loss of the connection that came back.
    pub gaps: Vec<Duration>,
    /// All topics with their types.
    pub topics: BTreeMap<String, String>,
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

/// Listens to a server.
pub struct Listener<W> {
    address: Address,
    /// Topics of scans that are asked for; all lasers if there are none.
    asked: Vec<String>,
    /// How long to wait for the first scan, and for a lost connection.
    wait: Duration,
    interrupt: Interrupt,
    is_ended: Arc<AtomicBool>,
    recording: W,
    writer: McapWriter,
    feeder: Feeder,
    subscriptions: BTreeMap<u32, Subscribed>,
    heard: Heard,
}

impl<W: Write> Listener<W> {
    /// Creates a listener that records to `recording` and passes the same bytes to `feeder`.
    pub fn new(address: Address, recording: W, feeder: Feeder) -> Self {
        Self {
            address,
            asked: Vec::new(),
            wait: Duration::ZERO,
            interrupt: Interrupt::default(),
            is_ended: Arc::default(),
            recording,
            writer: McapWriter::default(),
            feeder,
            subscriptions: BTreeMap::new(),
            heard: Heard {
                scans: 0,
                dropped: 0,
                gaps: Vec::new(),
                topics: BTreeMap::new(),
                end: DriveEnd::Asked,
            },
        }
    }

    /// Reads scans of these topics only.
    pub fn of_scans(mut self, topics: Vec<String>) -> Self {
        self.asked = topics;
        self
    }

    /// Waits for the first scan and for a lost connection as long as this.
    pub fn waiting(mut self, wait: Duration) -> Self {
        self.wait = wait;
        self
    }

    /// Ends when a signal comes, or when `is_ended` is set.
    pub fn until(mut self, interrupt: Interrupt, is_ended: Arc<AtomicBool>) -> Self {
        (self.interrupt, self.is_ended) = (interrupt, is_ended);
        self
    }

    /// Listens until the drive ends.
    pub fn listen(mut self, connection: Connection) -> Heard {
        let listened = self.listen_through(connection);
        let ended = McapWriter::end();
        let written = self.recording.write_all(&ended);
        let written = written.and_then(|()| self.recording.flush());
        self.feeder.add(ended);
        self.heard.end = match (listened, written) {
            (Err(error), _) | (Ok(_), Err(error)) => DriveEnd::Recording(error),
            (Ok(end), Ok(())) => end,
        };
        self.heard
    }

    fn listen_through(&mut self, mut connection: Connection) -> io::Result<DriveEnd> {
        self.record(self.writer.start())?;
        let since = Instant::now();
        loop {
            if self.is_over() {
                return Ok(DriveEnd::Asked);
            }
            if self.heard.scans == 0 && since.elapsed() > self.wait {
                return Ok(DriveEnd::NoScans);
            }
            let lost = match connection.next() {
                Ok(Some(message)) => self.take(&message, &mut connection)?,
                Ok(None) => {
                    self.recording.flush()?;
                    None
                }
                Err(lost) => Some(lost),
            };
            match lost {
                None => {}
                Some(lost @ Lost::TooLong(_)) => return Ok(DriveEnd::TooLong(lost.to_string())),
                Some(lost) => {
                    self.recording.flush()?;
                    let heard = connection.heard;
                    // A server may take one client at a time.
                    drop(connection);
                    match self.connect_again(&lost, heard) {
                        Ok(again) => connection = again,
                        Err(end) => return Ok(end),
                    }
                }
            }
        }
    }

    fn is_over(&self) -> bool {
        self.interrupt.came() || self.is_ended.load(Ordering::Relaxed)
    }

    /// Connects again after a loss.
    fn connect_again(&mut self, lost: &Lost, heard: Instant) -> Result<Connection, DriveEnd> {
        self.subscriptions.clear();
        let (url, wait_s) = (&self.address.url, self.wait.as_secs_f64());
        eprintln!(
            "slam2d: {url}: the connection is lost ({lost}); connecting again for {wait_s:.0} s"
        );
        let since = Instant::now();
        loop {
            if self.is_over() {
                return Err(DriveEnd::Asked);
            }
            if let Ok(connection) = Connection::open(&self.address) {
                self.heard.gaps.push(heard.elapsed());
                eprintln!("slam2d: {url}: connected again");
                return Ok(connection);
            }
            if since.elapsed() >= self.wait {
                return Err(DriveEnd::NotBack(lost.to_string()));
            }
            thread::sleep(RETRY);
        }
    }

    /// Takes a message of the server.
    fn take(&mut self, message: &Message, connection: &mut Connection) -> io::Result<Option<Lost>> {
        match message {
            Message::Text(text) => match serde_json::from_str(text) {
                Ok(ServerText::Advertise { channels }) => {
                    for channel in &channels {
                        if let Err(lost) = self.advertised(channel, connection)? {
                            return Ok(Some(lost));
                        }
                    }
                }
                Ok(ServerText::Unadvertise { channel_ids }) => self
                    .subscriptions
                    .retain(|_, subscribed| !channel_ids.contains(&subscribed.channel)),
                // Texts of no use here.
                Ok(ServerText::Other) | Err(_) => {}
            },
            Message::Binary(bytes) => {
                if let Some((subscription, time_ns, bytes)) = message_data(bytes) {
                    self.message(subscription, time_ns, bytes)?;
                }
            }
            _ => {}
        }
        Ok(None)
    }

    /// Subscribes to a topic if it is read.
    fn advertised(
        &mut self,
        channel: &Channel,
        connection: &mut Connection,
    ) -> io::Result<Result<(), Lost>> {
        let topic = channel.topic();
        let mut channels = self.subscriptions.values();
        let is_known = channels.any(|subscribed| subscribed.channel == channel.id);
        if self.heard.topics.len() >= MAX_TOPICS || is_known {
            return Ok(Ok(()));
        }
        let [name, schema] =
            [&topic.name, &topic.schema].map(|name| name.escape_debug().to_string());
        self.heard.topics.insert(name.clone(), schema.clone());
        let Some(use_of) = self.use_of(&topic) else {
            return Ok(Ok(()));
        };
        let Some((number, declared)) = self.writer.declare(&topic) else {
            return Ok(Ok(()));
        };
        if !declared.is_empty() {
            self.record(declared)?;
            eprintln!("slam2d: {}: reads {name} ({schema})", self.address.url);
        }
        let last = self.subscriptions.last_key_value();
        let subscription = last.map_or(0, |(id, _)| id.wrapping_add(1));
        let subscribed = Subscribed {
            number,
            is_scan: use_of != MessageUse::Motion,
            channel: channel.id,
        };
        self.subscriptions.insert(subscription, subscribed);
        Ok(connection.send(subscribe(subscription, channel.id)))
    }

    /// What a topic is read for: clouds only if they are asked for, because a camera's fill a Wi-Fi.
    fn use_of(&self, topic: &Topic) -> Option<MessageUse> {
        let use_of = MessageUse::of(&topic.schema, &topic.encoding)?;
        let is_asked = self.asked.contains(&topic.name);
        let is_read = match use_of {
            MessageUse::Motion => true,
            MessageUse::Scan => self.asked.is_empty() || is_asked,
            MessageUse::Cloud => is_asked,
        };
        is_read.then_some(use_of)
    }

    /// Records a message and passes it on.
    fn message(&mut self, subscription: u32, time_ns: u64, bytes: &[u8]) -> io::Result<()> {
        let Some(subscribed) = self.subscriptions.get(&subscription) else {
            return Ok(());
        };
        let record = McapWriter::message(subscribed.number, time_ns, bytes);
        let is_scan = subscribed.is_scan;
        self.recording.write_all(&record)?;
        let is_taken = self.feeder.offer(record, is_scan);
        self.heard.scans += usize::from(is_scan);
        self.heard.dropped += usize::from(is_scan && !is_taken);
        Ok(())
    }

    /// Records bytes that the rest depends on, and passes them on.
    fn record(&mut self, bytes: Vec<u8>) -> io::Result<()> {
        self.recording.write_all(&bytes)?;
        self.feeder.add(bytes);
        Ok(())
    }
}
