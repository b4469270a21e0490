//! Listens to a robot: subscribes to what is read, records it, and passes it to the estimator.

use std::io::{self, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use command_line::interrupt::Interrupt;
use robot_io::live::drive::{Drive, DriveEnd, Heard};
use robot_io::live::network::{Lost, connected_again, connecting_again};
use tungstenite::Message;

use super::connection::{Address, Connection};

/// Time between two attempts to connect again.
const RETRY: Duration = Duration::from_millis(200);

/// Listens to a server.
pub struct Listener<W> {
    address: Address,
    /// How long to wait for the first scan, and for a lost connection.
    wait: Duration,
    interrupt: Interrupt,
    is_ended: Arc<AtomicBool>,
    recording: W,
    drive: Drive,
}

impl<W: Write> Listener<W> {
    /// Creates a listener that records `drive` to `recording`.
    pub fn new(address: Address, recording: W, drive: Drive) -> Self {
        Self {
            address,
            wait: Duration::ZERO,
            interrupt: Interrupt::default(),
            is_ended: Arc::default(),
            recording,
            drive,
        }
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
            if self.is_over() {
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

    fn is_over(&self) -> bool {
        self.interrupt.came() || self.is_ended.load(Ordering::Relaxed)
    }

    /// Connects again after a loss.
    fn connect_again(&mut self, lost: &Lost, heard: Instant) -> Result<Connection, DriveEnd> {
        self.drive.lost();
        let (url, wait_s) = (&self.address.url, self.wait.as_secs_f64());
        eprintln!("slam2d: {}", connecting_again(url, lost, wait_s));
        let since = Instant::now();
        loop {
            if self.is_over() {
                return Err(DriveEnd::Asked);
            }
            if let Ok(connection) = Connection::open(&self.address) {
                self.drive.heard.gaps.push(heard.elapsed());
                eprintln!("slam2d: {}", connected_again(url));
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
            eprintln!("slam2d: {}: reads {name} ({schema})", self.address.url);
        }
        let mut requests = self.drive.take_requests().into_iter();
        let sent = requests.try_for_each(|request| connection.send(request));
        Ok(sent.err())
    }
}
