//! What the worker's JavaScript sees: a file in, orders in, updates out.

use std::io::{self, BufReader, Read, Seek, SeekFrom};

use ch16_slam2d::localize::StartPose;
use js_sys::{Array, Float64Array, Function, Object, Reflect, Uint8Array};
use pr_geom::SE2;
use robot_io::log::{LogOption, LogOptions};
use robot_io::log_bytes::LogBytes;
use wasm_bindgen::prelude::*;

use crate::engine::Engine;
use crate::sample;
use crate::update::{Stage, Update};

/// So much of a file is asked for at once, bytes.
const PIECE_BYTES: usize = 1 << 18;

/// A file that JavaScript reads: `read(from, to)` gives the bytes of that part.
struct JsFile {
    read: Function,
    at: u64,
    size: u64,
}

impl Read for JsFile {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let end = self.size.min(self.at + into.len() as u64);
        if end <= self.at {
            return Ok(0);
        }
        // Sizes of files are whole numbers far below 2⁵³.
        let (from, to) = (
            JsValue::from_f64(self.at as f64),
            JsValue::from_f64(end as f64),
        );
        let read = self.read.call2(&JsValue::NULL, &from, &to);
        let bytes = read.map_err(|_| io::Error::other("the browser cannot read it any more"))?;
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
        let before = || io::Error::new(io::ErrorKind::InvalidInput, "a place before the file");
        self.at = at.ok_or_else(before)?;
        Ok(self.at)
    }
}

/// A log on its way to a map.
#[wasm_bindgen]
pub struct Robot {
    engine: Engine<'static>,
}

#[wasm_bindgen]
impl Robot {
    /// Opens a file; `read(from, to)` gives its bytes as a `Uint8Array`, and `chosen` holds the options
    /// of recordings, a line each: `scan-topic /front`.
    ///
    /// # Errors
    /// One sentence where it cannot be mapped.
    #[wasm_bindgen(constructor)]
    pub fn new(name: &str, size: f64, read: Function, chosen: &str) -> Result<Self, JsError> {
        let source = source(size, read);
        let engine = Engine::open(source, name, size as u64, &options(chosen));
        let engine = engine.map_err(|said| JsError::new(&said))?;
        Ok(Self { engine })
    }

    /// Looks for the robot of another log on the map; `start` is `[x, y, θ]`, m and rad, or empty where
    /// it may be anywhere.
    ///
    /// # Errors
    /// One sentence where that cannot be done.
    pub fn locate(
        &mut self,
        name: &str,
        size: f64,
        read: Function,
        chosen: &str,
        start: &[f64],
    ) -> Result<(), JsError> {
        let start = match start {
            &[x, y, theta] => StartPose::Near(SE2::new(x, y, theta)),
            _ => StartPose::Anywhere,
        };
        let source = source(size, read);
        let chosen = options(chosen);
        let begun = self
            .engine
            .locate(source, name, size as u64, &chosen, start);
        begun.map_err(|said| JsError::new(&said))
    }

    /// Does the next piece of work; false where nothing is left to do.
    pub fn step(&mut self) -> bool {
        self.engine.step()
    }

    /// Whether all of the file's work is done, or nothing came of it.
    #[wasm_bindgen(js_name = isOver)]
    pub fn is_over(&self) -> bool {
        matches!(self.engine.stage(), Stage::Done | Stage::Failed)
    }

    /// Does what the reader asks.
    pub fn order(&mut self, order: &str) {
        self.engine.order(order);
    }

    /// What changed since the last call: objects of kind, text, numbers, bytes.
    pub fn updates(&mut self) -> Array {
        self.engine.updates().iter().map(to_js).collect()
    }

    /// Takes the file of a reference.
    ///
    /// # Errors
    /// One sentence where it is none.
    pub fn reference(&mut self, bytes: &[u8], name: &str) -> Result<(), JsError> {
        let taken = self.engine.take_reference(bytes, name);
        taken.map_err(|said| JsError::new(&said))
    }

    /// The bytes of a file to save.
    ///
    /// # Errors
    /// One sentence where there is nothing to write.
    pub fn file(&mut self, name: &str) -> Result<Vec<u8>, JsError> {
        self.engine.file(name).map_err(|said| JsError::new(&said))
    }
}

/// The bytes of a file, which are read once more for each pass over it.
fn source(size: f64, read: Function) -> LogBytes<'static> {
    LogBytes::new(move || {
        let file = JsFile {
            read: read.clone(),
            at: 0,
            size: size as u64,
        };
        Ok(BufReader::with_capacity(PIECE_BYTES, file))
    })
}

fn options(chosen: &str) -> LogOptions {
    let mut options = LogOptions::default();
    for (name, value) in chosen.lines().filter_map(|line| line.split_once(' ')) {
        if let Some(option) = LogOption::ALL
            .into_iter()
            .find(|option| option.name() == name)
        {
            options = options.with(option, value);
        }
    }
    options
}

fn to_js(update: &Update) -> JsValue {
    let object = Object::new();
    let set = |name: &str, value: &JsValue| {
        // A fresh object takes every property.
        let _ = Reflect::set(&object, &JsValue::from_str(name), value);
    };
    set("kind", &JsValue::from_str(update.kind));
    set("text", &JsValue::from_str(&update.text));
    set("numbers", &Float64Array::from(update.numbers.as_slice()));
    set("bytes", &Uint8Array::from(update.bytes.as_slice()));
    object.into()
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
