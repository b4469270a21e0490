//! Bags of ROS 1, version 2.0: records of a header with named fields and data.
//!
//! Source: "Bag format, version 2.0", wiki.ros.org/Bags/Format/2.0. The crate `rosbag` maps files
//! into memory and needs C, so that it cannot work in a browser; the format is small.

use std::collections::{BTreeMap, VecDeque};
use std::io::{BufRead, Read};

use super::container::{Container, ContainerError, MOST_BYTES, Recorded, kind_of};
use super::decompress::Packing;
use super::wire::Wire;

/// More topics than any robot has.
const MOST_CONNECTIONS: usize = 10_000;

/// Kinds of records, by their field `op`.
mod op {
    pub const MESSAGE: u8 = 2;
    pub const CHUNK: u8 = 5;
    pub const CONNECTION: u8 = 7;
}

/// Header and data of a record.
type Record = (Vec<u8>, Vec<u8>);

/// Topic and type of a connection.
#[derive(Clone, Debug)]
struct Connection {
    topic: String,
    kind: String,
}

/// Messages of a bag, in the order of the file.
pub struct BagFile<R> {
    source: R,
    offset: u64,
    is_started: bool,
    connections: BTreeMap<u32, Connection>,
    /// Messages of the chunk under way.
    chunk: VecDeque<Recorded>,
}

impl<R: BufRead> BagFile<R> {
    /// A reader at the file's start.
    pub fn new(source: R) -> Self {
        Self {
            source,
            offset: 0,
            is_started: false,
            connections: BTreeMap::new(),
            chunk: VecDeque::new(),
        }
    }

    /// `count` bytes, read in pieces as they come: a length that is a lie costs no memory.
    fn bytes(&mut self, count: usize, what: &str) -> Result<Vec<u8>, ContainerError> {
        if count > MOST_BYTES {
            return Err(ContainerError::Broken(format!(
                "{what} of {MOST_BYTES} bytes at most was expected, and it has {count}"
            )));
        }
        let mut bytes = Vec::new();
        let read = self
            .source
            .by_ref()
            .take(count as u64)
            .read_to_end(&mut bytes);
        self.offset += bytes.len() as u64;
        read.map_err(ContainerError::Io)?;
        if bytes.len() < count {
            return Err(ContainerError::CutOff(format!(
                "{what} of {count} bytes was expected, and {} are there",
                bytes.len()
            )));
        }
        Ok(bytes)
    }

    /// The next record's header and data; none at the end of the file.
    fn record(&mut self) -> Result<Option<Record>, ContainerError> {
        if self
            .source
            .fill_buf()
            .map_err(ContainerError::Io)?
            .is_empty()
        {
            return Ok(None);
        }
        let header = self.with_length("a record's header")?;
        let data = self.with_length("a record's data")?;
        Ok(Some((header, data)))
    }

    fn with_length(&mut self, what: &str) -> Result<Vec<u8>, ContainerError> {
        let length = self.bytes(4, "a length")?;
        let length = u32::from_le_bytes(length.try_into().expect("four bytes"));
        self.bytes(length as usize, what)
    }

    /// Takes a record of the file.
    fn take(&mut self, header: &[u8], data: Vec<u8>) -> Result<(), String> {
        let fields = fields(header)?;
        match fields.op()? {
            op::CHUNK => {
                let size = fields.u32("size")? as usize;
                let packing = fields.text("compression")?;
                let size = size.min(MOST_BYTES);
                let content = match packing.as_str() {
                    "none" => data,
                    "lz4" => Packing::Lz4.unpack(&data, size)?,
                    "bz2" => Packing::Bzip2.unpack(&data, size)?,
                    other => {
                        return Err(format!(
                            "a chunk packed by bz2, lz4 or none was expected, and it is packed by ‘{}’",
                            crate::lines::printable(other)
                        ));
                    }
                };
                self.take_chunk(&content)
            }
            op::CONNECTION => self.take_connection(&fields, &data),
            // Version 2.0 keeps messages in chunks; some writers do not.
            op::MESSAGE => self.take_message(&fields, data),
            _ => Ok(()),
        }
    }

    fn take_chunk(&mut self, mut rest: &[u8]) -> Result<(), String> {
        while !rest.is_empty() {
            let header = piece(&mut rest, "a record's header inside of a chunk")?;
            let data = piece(&mut rest, "a record's data inside of a chunk")?;
            let fields = fields(header)?;
            match fields.op()? {
                op::CONNECTION => self.take_connection(&fields, data)?,
                op::MESSAGE => self.take_message(&fields, data.to_vec())?,
                _ => {}
            }
        }
        Ok(())
    }

    fn take_connection(&mut self, named: &Fields<'_>, data: &[u8]) -> Result<(), String> {
        let number = named.u32("conn")?;
        let topic = named.text("topic")?;
        let kind = fields(data)?.text("type")?;
        if self.connections.len() < MOST_CONNECTIONS {
            let kind = kind_of(&kind);
            self.connections.insert(number, Connection { topic, kind });
        }
        Ok(())
    }

    fn take_message(&mut self, named: &Fields<'_>, bytes: Vec<u8>) -> Result<(), String> {
        let number = named.u32("conn")?;
        let Some(connection) = self.connections.get(&number) else {
            return Err(format!(
                "a message names connection {number}, which is unknown"
            ));
        };
        let [seconds, nanoseconds] = [named.time(0)?, named.time(4)?];
        self.chunk.push_back(Recorded {
            topic: connection.topic.clone(),
            kind: connection.kind.clone(),
            wire: Wire::Ros1,
            bytes,
            recorded_s: f64::from(seconds) + f64::from(nanoseconds) * 1e-9,
        });
        Ok(())
    }
}

impl<R: BufRead> Container for BagFile<R> {
    fn next_message(&mut self) -> Result<Option<Recorded>, ContainerError> {
        if !self.is_started {
            const MAGIC: &[u8] = b"#ROSBAG V2.0\n";
            if self.bytes(MAGIC.len(), "‘#ROSBAG V2.0’")? != MAGIC {
                return Err(ContainerError::Broken(
                    "‘#ROSBAG V2.0’ was expected; convert an older bag with rosbag fix".to_owned(),
                ));
            }
            self.is_started = true;
        }
        loop {
            if let Some(message) = self.chunk.pop_front() {
                return Ok(Some(message));
            }
            let Some((header, data)) = self.record()? else {
                return Ok(None);
            };
            self.take(&header, data).map_err(ContainerError::Broken)?;
        }
    }

    fn offset(&self) -> u64 {
        self.offset
    }
}

/// A length and as many bytes.
fn piece<'a>(rest: &mut &'a [u8], what: &str) -> Result<&'a [u8], String> {
    let short = || format!("{what} was expected, and the bytes end");
    let (length, after) = rest.split_first_chunk::<4>().ok_or_else(short)?;
    let length = u32::from_le_bytes(*length) as usize;
    let (piece, after) = after.split_at_checked(length).ok_or_else(short)?;
    *rest = after;
    Ok(piece)
}

/// The named fields of a header.
struct Fields<'a> {
    named: BTreeMap<&'a [u8], &'a [u8]>,
}

fn fields(mut header: &[u8]) -> Result<Fields<'_>, String> {
    let mut named = BTreeMap::new();
    while !header.is_empty() {
        let field = piece(&mut header, "a field")?;
        let equals = field.iter().position(|&byte| byte == b'=');
        let equals = equals.ok_or("a field ‘name=value’ was expected")?;
        named.insert(&field[..equals], &field[equals + 1..]);
    }
    Ok(Fields { named })
}

impl<'a> Fields<'a> {
    fn value(&self, name: &str) -> Result<&'a [u8], String> {
        let value = self.named.get(name.as_bytes()).copied();
        value.ok_or_else(|| format!("a field ‘{name}’ was expected"))
    }

    fn op(&self) -> Result<u8, String> {
        match self.value("op")? {
            &[op] => Ok(op),
            _ => Err("a field ‘op’ of one byte was expected".to_owned()),
        }
    }

    fn u32(&self, name: &str) -> Result<u32, String> {
        let value = self.value(name)?.try_into();
        let value = value.map_err(|_| format!("a field ‘{name}’ of four bytes was expected"))?;
        Ok(u32::from_le_bytes(value))
    }

    /// Half of the field `time`, which starts at byte `from`.
    fn time(&self, from: usize) -> Result<u32, String> {
        let value = self.value("time")?.get(from..from + 4);
        let value = value.and_then(|value| value.try_into().ok());
        let value = value.ok_or("a field ‘time’ of eight bytes was expected")?;
        Ok(u32::from_le_bytes(value))
    }

    fn text(&self, name: &str) -> Result<String, String> {
        Ok(String::from_utf8_lossy(self.value(name)?).into_owned())
    }
}
