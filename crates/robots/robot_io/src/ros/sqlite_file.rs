//! ROS 2 recordings in SQLite (`.db3`), which rosbag2 wrote by default until 2023.
//!
//! Reads the tables `topics` and `messages`, with a few pages in memory. Never writes.
//!
//! Source: "Database File Format", sqlite.org/fileformat2.html, sections 1.3 to 1.6 and 2. The crates that read
//! SQLite either need C or run a whole database; this needs only tables in row order.

mod pages;
mod record;
mod table;
mod write_ahead;

use std::collections::BTreeMap;

use super::container::{Container, ContainerError, Recorded, kind_of};
use super::wire::Wire;
use crate::lines::printable;
use crate::log_bytes::SeekRead;
use pages::Pages;
use record::{Value, columns};
use table::DatabaseTable;
use write_ahead::WriteAhead;

/// More topics than any robot has.
const MAX_TOPICS: usize = 10_000;

/// A topic with its type.
struct Topic {
    name: String,
    kind: String,
    /// The error is the name of an unsupported encoding.
    wire: Result<Wire, String>,
}

/// Column indices in the messages table.
#[derive(Clone, Copy)]
struct Columns {
    topic: usize,
    time: usize,
    data: usize,
}

/// Messages of a database, in row order.
pub struct SqliteFile<'a> {
    source: Option<Box<dyn SeekRead + 'a>>,
    write_ahead: Option<Box<dyn SeekRead + 'a>>,
    pages: Option<Pages<'a>>,
    topics: BTreeMap<i64, Topic>,
    messages: DatabaseTable,
    columns: Columns,
    other: Option<(String, String)>,
    has_messages: bool,
}

impl<'a> SqliteFile<'a> {
    /// Creates a reader at the file's start.
    pub fn new(source: Box<dyn SeekRead + 'a>) -> Self {
        Self {
            source: Some(source),
            write_ahead: None,
            pages: None,
            topics: BTreeMap::new(),
            messages: DatabaseTable::at(0),
            columns: Columns {
                topic: 1,
                time: 2,
                data: 3,
            },
            other: None,
            has_messages: false,
        }
    }

    /// Sets the write-ahead log beside the database.
    pub fn with_write_ahead(mut self, log: Option<Box<dyn SeekRead + 'a>>) -> Self {
        self.write_ahead = log;
        self
    }

    /// Reads the header, the list of tables and the topics.
    fn start(&mut self, source: Box<dyn SeekRead + 'a>) -> Result<(), ContainerError> {
        let newer = self.write_ahead.take().map(WriteAhead::new).transpose()?;
        let mut pages = Pages::new(source, newer.flatten())?;
        let mut tables: BTreeMap<String, (u32, Vec<String>)> = BTreeMap::new();
        let mut list = DatabaseTable::at(1);
        while let Some(row) = list.next_row(&mut pages)? {
            // type, name, tbl_name, rootpage, sql
            if let [
                Value::Text(kind),
                Value::Text(name),
                _,
                root,
                Value::Text(sql),
                ..,
            ] = &row.values[..]
                && kind == "table"
                && let Some(root) = root.integer().and_then(|root| u32::try_from(root).ok())
                && tables.len() < MAX_TOPICS
            {
                tables.insert(name.clone(), (root, columns(sql)));
            }
        }
        let find = |name: &str| {
            tables.get(name).ok_or_else(|| {
                let known = crate::lines::listed(tables.keys().take(20).map(|name| printable(name)));
                ContainerError::Broken(format!(
                    "expected a database with rosbag2's tables topics and messages, found {known}; pass a recording of ros2 bag record"
                ))
            })
        };
        let (topics_at, topic_columns) = find("topics")?;
        let (messages_at, message_columns) = find("messages")?;
        let at = |columns: &[String], name: &str, usual: usize| {
            columns
                .iter()
                .position(|column| column == name)
                .unwrap_or(usual)
        };
        self.columns = Columns {
            topic: at(message_columns, "topic_id", 1),
            time: at(message_columns, "timestamp", 2),
            data: at(message_columns, "data", 3),
        };
        let [name_at, kind_at, format_at] = [("name", 1), ("type", 2), ("serialization_format", 3)]
            .map(|(name, usual)| at(topic_columns, name, usual));
        let mut rows = DatabaseTable::at(*topics_at);
        while let Some(row) = rows.next_row(&mut pages)? {
            let text = |at: usize| {
                row.values
                    .get(at)
                    .and_then(Value::text)
                    .map(crate::lines::name)
            };
            let (Some(name), Some(kind)) = (text(name_at), text(kind_at)) else {
                continue;
            };
            let wire = match text(format_at).as_deref() {
                None | Some("cdr" | "") => Ok(Wire::Cdr),
                Some(other) => Err(other.to_owned()),
            };
            if self.topics.len() < MAX_TOPICS {
                let kind = kind_of(&kind);
                self.topics.insert(row.id, Topic { name, kind, wire });
            }
        }
        self.messages = DatabaseTable::at(*messages_at);
        self.pages = Some(pages);
        Ok(())
    }
}

impl Container for SqliteFile<'_> {
    fn next_message(&mut self) -> Result<Option<Recorded>, ContainerError> {
        if let Some(source) = self.source.take() {
            self.start(source)?;
        }
        let Some(pages) = &mut self.pages else {
            return Ok(None);
        };
        while let Some(row) = self.messages.next_row(pages)? {
            self.has_messages = true;
            let mut values = row.values;
            let integer = |at: usize, values: &[Value]| values.get(at).and_then(Value::integer);
            let topic = integer(self.columns.topic, &values).and_then(|id| self.topics.get(&id));
            let time_ns = integer(self.columns.time, &values);
            let data = values.get_mut(self.columns.data).map(std::mem::take);
            let (Some(topic), Some(time_ns), Some(Value::Blob(bytes))) = (topic, time_ns, data)
            else {
                return Err(ContainerError::Skipped(format!(
                    "row {} of messages must have a topic, a time and data",
                    row.id
                )));
            };
            let wire = match &topic.wire {
                Ok(wire) => *wire,
                Err(encoding) => {
                    self.other
                        .get_or_insert_with(|| (topic.name.clone(), encoding.clone()));
                    continue;
                }
            };
            return Ok(Some(Recorded {
                topic: topic.name.clone(),
                kind: topic.kind.clone(),
                wire,
                bytes,
                recorded_s: time_ns as f64 * 1e-9,
            }));
        }
        Ok(None)
    }

    fn offset(&self) -> u64 {
        self.pages.as_ref().map_or(0, Pages::offset)
    }

    fn instead(&self) -> Option<String> {
        if let Some((topic, encoding)) = &self.other {
            let [topic, encoding] = [topic, encoding].map(|name| printable(name));
            return Some(format!(
                "its messages have the encoding ‘{encoding}’, for example those on {topic}; record with cdr"
            ));
        }
        (!self.has_messages).then(|| {
            "it has no messages; if a file whose name ends in -wal belongs to it, give both together"
                .to_owned()
        })
    }
}

#[cfg(test)]
mod tests;
