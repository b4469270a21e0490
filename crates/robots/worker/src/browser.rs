//! Interface of the worker to JavaScript: files and orders in, updates out.

use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::time::Duration;

use ch16_slam2d::localize::StartPose;
use js_sys::{Array, Function, JsString, Object, Reflect, Uint8Array};
use log_messages::MapperOrder;
use pr_geom::SE2;
use robot_io::live::drive::DriveEnd;
use robot_io::live::network::Lost;
use robot_io::live::{MAX_MESSAGE, WAIT_S};
use robot_io::log::LogOptions;
use robot_io::log_bytes::LogBytes;
use wasm_bindgen::prelude::*;

use crate::engine::{Engine, NoConnection};
use crate::given::{self, Given, GivenFile};
use crate::sample;
use crate::update::Update;

/// Bytes of a file that are read at a time.
const PIECE_BYTES: usize = 1 << 18;

/// A file that JavaScript reads: `read(which, from, to)` returns the bytes of that range.
struct JsFile {
    read: Function,
    which: f64,
    at: u64,
    size: u64,
}

impl Read for JsFile {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let end = self.size.min(self.at + into.len() as u64);
        if end <= self.at {
            return Ok(0);
        }
        // File sizes are integers far below 2⁵³.
        let (from, to) = (
            JsValue::from_f64(self.at as f64),
            JsValue::from_f64(end as f64),
        );
        let which = JsValue::from_f64(self.which);
        let read = self.read.call3(&JsValue::NULL, &which, &from, &to);
        let bytes = read.map_err(|_| io::Error::other("the browser can no longer read it"))?;
        let bytes = Uint8Array::new(&bytes);
        let count = (bytes.length() as usize).min(into.len());
        bytes.subarray(0, count as u32).copy_to(&mut into[..count]);
        self.at += count as u64;
        Ok(count)
    }
}

impl Seek for JsFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let at = match to {
            SeekFrom::Start(at) => Some(at),
            SeekFrom::End(by) => self.size.checked_add_signed(by),
            SeekFrom::Current(by) => self.at.checked_add_signed(by),
        };
        let before = || {
            io::Error::new(
                io::ErrorKind::InvalidInput,
                "a position before the start of the file",
            )
        };
        self.at = at.ok_or_else(before)?;
        Ok(self.at)
    }
}

/// A log that is being mapped.
#[wasm_bindgen]
pub struct LogMapper {
    engine: Engine<'static>,
}

#[wasm_bindgen]
impl LogMapper {
    /// Opens files that were given together: `read(which, from, to)` returns bytes of one of them as a `Uint8Array`,
    /// and `chosen` has one option per line: `scan-topic /front`.
    ///
    /// # Errors
    /// If they cannot be mapped; the message is one sentence.
    #[wasm_bindgen(constructor)]
    pub fn new(
        names: Vec<String>,
        sizes: &[f64],
        read: &Function,
        chosen: &str,
    ) -> Result<Self, JsError> {
        let opened = given(names, sizes, read)
            .and_then(|given| Engine::open(given, &given::options(chosen)?));
        let engine = opened.map_err(|message| JsError::new(&message))?;
        Ok(Self { engine })
    }

    /// Maps a robot at this address while it drives; `chosen` as for files. The page connects, and tells what comes.
    ///
    /// # Errors
    /// If a line is not an option; the message is one sentence.
    pub fn listen(url: &str, chosen: &str) -> Result<Self, JsError> {
        let options = given::options(chosen)
            .and_then(LogOptions::of_drive)
            .map_err(|message| JsError::new(&message))?;
        let engine = Engine::listen(url, &options);
        Ok(Self { engine })
    }

    /// A text of the robot's server.
    #[wasm_bindgen(js_name = hearText)]
    pub fn hear_text(&mut self, text: &JsString) {
        if self.is_taken(text.length()) {
            self.engine.hear_text(&String::from(text));
        }
    }

    /// A binary message of the robot's server.
    #[wasm_bindgen(js_name = hearBytes)]
    pub fn hear_bytes(&mut self, bytes: &Uint8Array) {
        if self.is_taken(bytes.length()) {
            self.engine.hear_bytes(&bytes.to_vec());
        }
    }

    /// Whether a message of this length is taken; one that is too long ends the drive, before it is copied.
    fn is_taken(&mut self, length: u32) -> bool {
        let length = length as usize;
        if length > MAX_MESSAGE {
            let end = DriveEnd::TooLong(Lost::TooLong(length).to_string());
            self.engine.end_with(end);
        }
        length <= MAX_MESSAGE
    }

    /// What happened to the connection: `refused`, `unanswered`, `subprotocol` or `address` before there was one;
    /// `lost` or `silent`; `back` after that many seconds; `asked`, `no-scans`, `not-back` or `never-heard` at the end.
    pub fn network(&mut self, event: &str, seconds: f64) {
        let gone = match event {
            "silent" | "never-heard" => Lost::Silent,
            _ => Lost::Closed,
        };
        match event {
            "address" => self.engine.is_not_there(NoConnection::Address),
            "refused" => self.engine.is_not_there(NoConnection::Refused),
            "unanswered" => self.engine.is_not_there(NoConnection::Silent),
            "subprotocol" => self.engine.is_not_there(NoConnection::OtherSubprotocol),
            "lost" | "silent" => self.engine.lose(&gone),
            "back" => {
                let gap = Duration::try_from_secs_f64(seconds);
                self.engine.regain(gap.unwrap_or_default());
            }
            "no-scans" => self.engine.end_without_scans(),
            "not-back" | "never-heard" => {
                self.engine.end_with(DriveEnd::NotBack(gone.to_string()));
            }
            _ => self.engine.end_with(DriveEnd::Asked),
        }
    }

    /// Whether more of the robot may come.
    #[wasm_bindgen(js_name = isDriving)]
    pub fn is_driving(&self) -> bool {
        self.engine.is_driving()
    }

    /// Requests to the robot's server since the last call.
    pub fn requests(&mut self) -> Vec<String> {
        self.engine.take_requests()
    }

    /// Bytes of the recording since the last call.
    pub fn recorded(&mut self) -> Vec<u8> {
        self.engine.take_recorded()
    }

    /// Localizes another log on the map; `start` is `[x, y, θ]`, m and rad, or empty if the initial pose
    /// is unknown.
    ///
    /// # Errors
    /// If that is not possible; the message is one sentence.
    pub fn locate(
        &mut self,
        names: Vec<String>,
        sizes: &[f64],
        read: &Function,
        chosen: &str,
        start: &[f64],
    ) -> Result<(), JsError> {
        let start = match start {
            &[x, y, theta] => StartPose::Near(SE2::new(x, y, theta)),
            _ => StartPose::Anywhere,
        };
        let begun = given(names, sizes, read)
            .and_then(|given| self.engine.locate(given, &given::options(chosen)?, start));
        begun.map_err(|message| JsError::new(&message))
    }

    /// Does the next piece of work; returns false if there is none.
    pub fn step(&mut self) -> bool {
        self.engine.step()
    }

    /// Whether the map is complete.
    #[wasm_bindgen(js_name = isMapped)]
    pub fn is_mapped(&self) -> bool {
        self.engine.is_mapped()
    }

    /// Makes the changes of an earlier worker, the text of its last update `edits`, once the map is complete.
    pub fn repeat(&mut self, edits: &str) {
        self.engine
            .repeat(serde_json::from_str(edits).unwrap_or_default());
    }

    /// Executes the order of a request of the widget; returns whether it is one of many of a drag.
    pub fn order(&mut self, request: &str) -> bool {
        let Some(order) = MapperOrder::from_request(request) else {
            return false;
        };
        self.engine.order(order);
        matches!(order, MapperOrder::Pin(..))
    }

    /// Stops reading, and keeps what was read.
    pub fn cancel(&mut self) {
        self.engine.cancel();
    }

    /// Changes since the last call: objects with kind, text and bytes.
    pub fn updates(&mut self) -> Array {
        self.engine.updates().iter().map(to_js).collect()
    }

    /// Reads a reference file.
    ///
    /// # Errors
    /// If it is not a reference; the message is one sentence.
    pub fn reference(&mut self, bytes: &[u8], name: &str) -> Result<(), JsError> {
        let taken = self.engine.take_reference(bytes, name);
        taken.map_err(|message| JsError::new(&message))
    }

    /// The content of a file to save.
    ///
    /// # Errors
    /// If there is nothing to write; the message is one sentence.
    pub fn file(&mut self, name: &str) -> Result<Vec<u8>, JsError> {
        self.engine
            .file(name)
            .map_err(|message| JsError::new(&message))
    }
}

/// The log that the files make up; each file is read again in each pass.
fn given(names: Vec<String>, sizes: &[f64], read: &Function) -> Result<Given<'static>, String> {
    let files = names.into_iter().zip(sizes).enumerate();
    let files = files.map(|(which, (name, &size))| {
        let read = read.clone();
        let open = move || {
            let file = JsFile {
                read: read.clone(),
                which: which as f64,
                at: 0,
                size: size as u64,
            };
            Ok(BufReader::with_capacity(PIECE_BYTES, file))
        };
        GivenFile {
            name,
            size_bytes: size as u64,
            bytes: LogBytes::new(open),
        }
    });
    Given::new(files.collect())
}

fn to_js(update: &Update) -> JsValue {
    let object = Object::new();
    let set = |name: &str, value: &JsValue| {
        // A new object accepts every property.
        let _ = Reflect::set(&object, &JsValue::from_str(name), value);
    };
    let bytes = match update {
        Update::Report(report) => report.to_bytes(),
        _ => Vec::new(),
    };
    set("kind", &JsValue::from_str(update.kind()));
    set("text", &JsValue::from_str(&update.json()));
    set("bytes", &Uint8Array::from(bytes.as_slice()));
    object.into()
}

/// How long the page waits for the first scan, and for a lost connection, ms.
#[wasm_bindgen(js_name = patienceMs)]
#[must_use]
pub fn patience_ms() -> f64 {
    1e3 * WAIT_S
}

/// The sample log, its true trajectory, and the log of another day.
#[wasm_bindgen(js_name = sampleFiles)]
#[must_use]
pub fn sample_files() -> Array {
    let (log, truth) = sample::ring();
    [log, truth, sample::another_day()]
        .iter()
        .map(|bytes| JsValue::from(Uint8Array::from(bytes.as_slice())))
        .collect()
}
