//! Listens to a robot: subscribes to what is read, records it, and passes it to the estimator.

use std::fmt;
use std::io::{self, Write};
use std::thread;
use std::time::{Duration, Instant};

use robot_io::live::drive::{Drive, DriveEnd, Heard};
use robot_io::live::network::{Lost, connected_again, connecting_again};
use tungstenite::Message;

use crate::connection::{Address, Connection};

/// Time between two attempts to connect again.
const RETRY: Duration = Duration::from_millis(200);

/// What happens to a connection, each with its sentence.
#[derive(Clone, Debug)]
pub enum Event {
    /// A topic is read.
    Reads(String),
    /// The connection is lost.
    Lost(String),
    /// It is there again.
    Back(String),
}

impl fmt::Display for Event {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::Reads(sentence) | Self::Lost(sentence) | Self::Back(sentence)) = self;
        f.write_str(sentence)
    }
}

/// Listens to a server.
pub struct Listener<W> {
    address: Address,
    /// How long to wait for the first scan, and for a lost connection.
    wait: Duration,
    is_over: Box<dyn Fn() -> bool + Send>,
    say: Box<dyn Fn(Event) + Send>,
    recording: W,
    drive: Drive,
}

impl<W: Write> Listener<W> {
    /// Creates a listener that waits for nothing and records `drive` to `recording`.
    pub fn new(address: Address, recording: W, drive: Drive) -> Self {
        Self {
            address,
            wait: Duration::ZERO,
            is_over: Box::new(|| false),
            say: Box::new(|_| {}),
            recording,
            drive,
        }
    }

    /// Waits for the first scan and for a lost connection as long as this.
    #[must_use]
    pub fn waiting(mut self, wait: Duration) -> Self {
        self.wait = wait;
        self
    }

    /// Ends once `is_over`.
    #[must_use]
    pub fn until(mut self, is_over: impl Fn() -> bool + Send + 'static) -> Self {
        self.is_over = Box::new(is_over);
        self
    }

    /// Passes what happens to `say`.
    #[must_use]
    pub fn saying(mut self, say: impl Fn(Event) + Send + 'static) -> Self {
        self.say = Box::new(say);
        self
    }

    /// Listens until the drive ends.
    pub fn listen(mut self, connection: Connection) -> Heard {
        let listened = self.listen_through(connection);
        let (mut heard, last) = self.drive.end();
        let written = self.recording.write_all(&last);
        let written = written.and_then(|()| self.recording.flush());
        heard.end = match (listened, written) {
            (Err(error), _) | (Ok(_), Err(error)) => DriveEnd::Recording(error),
            (Ok(end), Ok(())) => end,
        };
        heard
    }

    fn listen_through(&mut self, mut connection: Connection) -> io::Result<DriveEnd> {
        let since = Instant::now();
        loop {
            if (self.is_over)() {
                return Ok(DriveEnd::Asked);
            }
            if self.drive.heard.scans == 0 && since.elapsed() > self.wait {
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

    /// Connects again after a loss.
    fn connect_again(&mut self, lost: &Lost, heard: Instant) -> Result<Connection, DriveEnd> {
        self.drive.lost();
        let (url, wait_s) = (&self.address.url, self.wait.as_secs_f64());
        (self.say)(Event::Lost(connecting_again(url, lost, wait_s)));
        let since = Instant::now();
        loop {
            if (self.is_over)() {
                return Err(DriveEnd::Asked);
            }
            if let Ok(connection) = Connection::open(&self.address) {
                self.drive.heard.gaps.push(heard.elapsed());
                (self.say)(Event::Back(connected_again(url)));
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
            Message::Text(text) => self.drive.text(text),
            Message::Binary(bytes) => self.drive.binary(bytes),
            _ => {}
        }
        self.recording.write_all(&self.drive.take_recorded())?;
        for (name, schema) in self.drive.take_read() {
            let sentence = format!("{}: reads {name} ({schema})", self.address.url);
            (self.say)(Event::Reads(sentence));
        }
        let mut requests = self.drive.take_requests().into_iter();
        let sent = requests.try_for_each(|request| connection.send(request));
        Ok(sent.err())
    }
}
