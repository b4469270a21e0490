//! Databases that rosbag2's writers made, intact and damaged.

use std::io::Cursor;

use super::*;

const PLAIN: &[u8] = include_bytes!("../../../recordings/plain.db3");

fn count(bytes: &[u8]) -> (usize, usize) {
    let mut file = SqliteFile::new(Box::new(Cursor::new(bytes)));
    let (mut messages, mut lost) = (0, 0);
    loop {
        match file.next_message() {
            Ok(Some(message)) => {
                assert!(message.topic.starts_with('/') && message.recorded_s > 1.6e9);
                messages += 1;
            }
            Ok(None) => return (messages, lost),
            Err(error) if error.is_recoverable() => lost += 1,
            Err(_) => return (messages, lost + 1),
        }
        assert!(messages + lost < 10_000, "it never ends");
    }
}

#[test]
fn every_message_of_a_database_comes_once() {
    // One transform, and 24 scans with two poses each.
    assert_eq!(count(PLAIN), (73, 0));
}

#[test]
fn a_damaged_page_costs_the_rows_on_it() {
    let pages = PLAIN.len() / 4096;
    let mut kept = Vec::new();
    for page in 1..pages {
        let mut bytes = PLAIN.to_vec();
        bytes[page * 4096..page * 4096 + 12].fill(0xff);
        let (messages, lost) = count(&bytes);
        kept.push(messages);
        assert!(messages == 73 || lost > 0, "{page}");
    }
    assert!(
        kept.iter().filter(|&&messages| messages > 40).count() * 2 > kept.len(),
        "{kept:?}"
    );
}

#[test]
fn other_databases_are_rejected_by_their_tables() {
    let mut bytes = PLAIN.to_vec();
    let name = b"messages";
    let at: Vec<usize> = (0..4096)
        .filter(|&at| bytes[at..].starts_with(name))
        .collect();
    for at in at {
        bytes[at] = b'M';
    }
    let mut file = SqliteFile::new(Box::new(Cursor::new(&bytes[..])));
    let error = file.next_message().unwrap_err();
    assert!(
        matches!(error, ContainerError::Broken(error) if error.contains("expected a database with rosbag2's tables"))
    );
}
