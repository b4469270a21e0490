//! The CPU time of processes for which nobody waits: Chromium's renderers and its drawing process.
//!
//! A process counts what its children used once it has waited for them. Chromium's own process ends
//! without waiting for those that its zygote made, so they are watched while they run, on Linux.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// Linux reports times of processes in hundredths of a second, on every machine.
pub const TICKS_PER_SECOND: f64 = 100.0;

const BETWEEN_LOOKS: Duration = Duration::from_millis(300);

/// Looks at the processes below this one until it is ended.
pub struct Watch {
    end: Sender<()>,
    thread: JoinHandle<f64>,
}

impl Watch {
    /// Starts to look.
    pub fn begin() -> Self {
        let (end, ended) = mpsc::channel();
        let thread = thread::spawn(move || {
            let mut seen = Seen::default();
            loop {
                seen.look();
                match ended.recv_timeout(BETWEEN_LOOKS) {
                    Err(RecvTimeoutError::Timeout) => {}
                    _ => return seen.cpu_s(),
                }
            }
        });
        Self { end, thread }
    }

    /// What they used, as far as it was seen.
    pub fn end(self) -> f64 {
        // The thread ends at the word as well as without anybody to say it.
        let _ = self.end.send(());
        self.thread.join().unwrap_or(0.0)
    }
}

/// One line of `/proc/PID/stat`, proc(5).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Process {
    id: u32,
    parent: u32,
    started: u64,
    ticks: u64,
}

impl Process {
    /// The second field, the name in parentheses, may hold spaces.
    fn parse(stat: &str) -> Option<Self> {
        let (id, _) = stat.split_once(' ')?;
        let (_, after_name) = stat.rsplit_once(')')?;
        let fields: Vec<_> = after_name.split_whitespace().collect();
        let number = |at: usize| fields.get(at)?.parse::<u64>().ok();
        Some(Self {
            id: id.parse().ok()?,
            parent: fields.get(1)?.parse().ok()?,
            started: number(19)?,
            ticks: number(11)? + number(12)?,
        })
    }
}

/// The last times of the processes that are nobody's to wait for; an id may be used twice.
#[derive(Default)]
struct Seen(HashMap<(u32, u64), u64>);

impl Seen {
    fn look(&mut self) {
        let Ok(entries) = fs::read_dir("/proc") else {
            return;
        };
        let read = |entry: fs::DirEntry| {
            entry.file_name().to_str()?.parse::<u32>().ok()?;
            Process::parse(&fs::read_to_string(entry.path().join("stat")).ok()?)
        };
        let running: Vec<_> = entries.flatten().filter_map(read).collect();
        self.note(&running, std::process::id(), |id| {
            fs::read(format!("/proc/{id}/cmdline"))
                .is_ok_and(|words| String::from_utf8_lossy(&words).contains("--type="))
        });
    }

    fn note(&mut self, running: &[Process], ours: u32, is_part_of_chromium: impl Fn(u32) -> bool) {
        let below = below(running, ours);
        for process in running {
            let key = (process.id, process.started);
            let is_known = self.0.contains_key(&key);
            if is_known || below.contains(&process.id) && is_part_of_chromium(process.id) {
                self.0.insert(key, process.ticks);
            }
        }
    }

    fn cpu_s(&self) -> f64 {
        self.0.values().sum::<u64>() as f64 / TICKS_PER_SECOND
    }
}

/// The processes that `ours` started, and those that these started.
fn below(running: &[Process], ours: u32) -> HashSet<u32> {
    let mut below = HashSet::from([ours]);
    loop {
        let before = below.len();
        let children = running
            .iter()
            .filter(|process| below.contains(&process.parent));
        let children: Vec<_> = children.map(|process| process.id).collect();
        below.extend(children);
        if below.len() == before {
            return below;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn process(id: u32, parent: u32, ticks: u64) -> Process {
        Process {
            id,
            parent,
            started: 7,
            ticks,
        }
    }

    #[test]
    fn a_process_is_read_whatever_its_name_is() {
        let stat = "42 (a b) c) S 9 42 42 0 -1 4194560 1 2 3 4 500 600 1 2 20 0 1 0 7 8 7";
        assert_eq!(Process::parse(stat), Some(process(42, 9, 1100)));
        assert_eq!(Process::parse("42 (x) S"), None);
    }

    #[test]
    fn a_renderer_counts_with_its_last_time_also_after_its_parent_is_gone() {
        let mut seen = Seen::default();
        let is_renderer = |id| id == 30 || id == 40;
        let browser = process(20, 10, 900);
        // 40 is the renderer of somebody else's browser.
        let others = process(40, 1, 5000);
        seen.note(&[browser, process(30, 20, 50), others], 10, is_renderer);
        seen.note(&[process(30, 1, 80), others], 10, is_renderer);
        seen.note(&[others], 10, is_renderer);
        assert_eq!(seen.cpu_s(), 0.8);
    }

    #[test]
    fn a_watch_ends_when_it_is_told_to() {
        assert_eq!(Watch::begin().end(), 0.0);
    }
}
