//! Records of a bag: a header with named fields, and data.

use std::collections::{BTreeMap, BTreeSet};

use crate::ros::container::{MAX_BYTES, Recorded, kind_of};
use crate::ros::wire::Wire;

/// More topics than any robot has.
const MAX_CONNECTIONS: usize = 10_000;

/// Kinds of records, by their `op` field.
pub mod op {
    pub const MESSAGE: u8 = 2;
    pub const INDEX: u8 = 4;
    pub const CHUNK: u8 = 5;
    pub const CONNECTION: u8 = 7;
    /// Bytes of an index entry: a time and an offset.
    pub const INDEX_ENTRY: usize = 12;
}

/// Topic and type of a connection.
#[derive(Clone, Debug)]
struct Connection {
    topic: String,
    kind: String,
}

/// The connections declared so far, by id.
#[derive(Clone, Debug, Default)]
pub struct Connections {
    known: BTreeMap<u32, Connection>,
    /// Ids that messages used before they were declared.
    orphans: BTreeSet<u32>,
}

impl Connections {
    /// Reads a record that is not a chunk; returns its message if it is one.
    pub fn read(
        &mut self,
        fields: &HeaderFields<'_>,
        data: &[u8],
    ) -> Result<Option<Recorded>, String> {
        match fields.op()? {
            op::CONNECTION => self.read_connection(fields, data).map(|()| None),
            op::MESSAGE => self.message(fields, data).map(Some),
            _ => Ok(None),
        }
    }

    fn read_connection(&mut self, named: &HeaderFields<'_>, data: &[u8]) -> Result<(), String> {
        let number = named.u32("conn")?;
        let topic = named.name("topic")?;
        let kind = HeaderFields::parse(data)?.name("type")?;
        if self.known.len() < MAX_CONNECTIONS {
            let kind = kind_of(&kind);
            self.known.insert(number, Connection { topic, kind });
        }
        Ok(())
    }

    /// Whether messages were lost whose connection is known by now.
    pub fn has_orphans(&self) -> bool {
        self.orphans
            .iter()
            .any(|number| self.known.contains_key(number))
    }

    fn message(&mut self, named: &HeaderFields<'_>, data: &[u8]) -> Result<Recorded, String> {
        let number = named.u32("conn")?;
        let Some(connection) = self.known.get(&number) else {
            self.orphans.insert(number);
            return Err(format!(
                "a message names connection {number}, which is unknown"
            ));
        };
        let [seconds, nanoseconds] = [named.time(0)?, named.time(4)?];
        Ok(Recorded {
            topic: connection.topic.clone(),
            kind: connection.kind.clone(),
            wire: Wire::Ros1,
            bytes: data.to_vec(),
            recorded_s: f64::from(seconds) + f64::from(nanoseconds) * 1e-9,
        })
    }
}

/// Bytes that suffice to recognize a record: the headers of known records are shorter.
pub const LONGEST_START: usize = 1024;

/// Whether a valid record starts here.
pub fn begins(bytes: &[u8]) -> bool {
    let mut rest = bytes;
    let Ok(header) = piece(&mut rest, "a header") else {
        return false;
    };
    let is_known = HeaderFields::parse(header).and_then(|fields| fields.op());
    let length = rest
        .first_chunk::<4>()
        .map(|length| u32::from_le_bytes(*length));
    is_known.is_ok_and(|op| (2..=7).contains(&op))
        && length.is_some_and(|length| length as usize <= MAX_BYTES)
}

/// Splits off a length and that many bytes.
pub fn piece<'a>(rest: &mut &'a [u8], what: &str) -> Result<&'a [u8], String> {
    let short = || format!("expected {what}, but the bytes end");
    let (length, after) = rest.split_first_chunk::<4>().ok_or_else(short)?;
    let length = u32::from_le_bytes(*length) as usize;
    let (piece, after) = after.split_at_checked(length).ok_or_else(short)?;
    *rest = after;
    Ok(piece)
}

/// The named fields of a header.
pub struct HeaderFields<'a> {
    named: BTreeMap<&'a [u8], &'a [u8]>,
}

impl<'a> HeaderFields<'a> {
    /// Parses the fields of these bytes.
    pub fn parse(mut header: &'a [u8]) -> Result<Self, String> {
        let mut named = BTreeMap::new();
        while !header.is_empty() {
            let field = piece(&mut header, "a field")?;
            let equals = field.iter().position(|&byte| byte == b'=');
            let equals = equals.ok_or("expected a field ‘name=value’")?;
            named.insert(&field[..equals], &field[equals + 1..]);
        }
        Ok(Self { named })
    }

    fn value(&self, name: &str) -> Result<&'a [u8], String> {
        let value = self.named.get(name.as_bytes()).copied();
        value.ok_or_else(|| format!("expected a field ‘{name}’"))
    }

    /// The kind of record.
    pub fn op(&self) -> Result<u8, String> {
        match self.value("op")? {
            &[op] => Ok(op),
            _ => Err("expected a field ‘op’ of one byte".to_owned()),
        }
    }

    /// A 32-bit integer.
    pub fn u32(&self, name: &str) -> Result<u32, String> {
        let value = self.value(name)?.try_into();
        let value = value.map_err(|_| format!("expected a field ‘{name}’ of four bytes"))?;
        Ok(u32::from_le_bytes(value))
    }

    /// Half of the `time` field, starting at byte `from`.
    fn time(&self, from: usize) -> Result<u32, String> {
        let value = self.value("time")?.get(from..from + 4);
        let value = value.and_then(|value| value.try_into().ok());
        let value = value.ok_or("expected a field ‘time’ of eight bytes")?;
        Ok(u32::from_le_bytes(value))
    }

    /// A printable name; invalid bytes become question marks.
    pub fn name(&self, name: &str) -> Result<String, String> {
        let text = String::from_utf8_lossy(self.value(name)?);
        Ok(crate::lines::name(&text))
    }
}
