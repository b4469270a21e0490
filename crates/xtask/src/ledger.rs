//! What took how long: one row for each step of the suite, printed as a table at its end.

use std::fmt;
use std::fs;
use std::time::{Duration, Instant};

use crate::run::Failure;
use crate::unwaited::{TICKS_PER_SECOND, Watch};

/// The steps so far, in the order in which they ran.
#[derive(Debug, Default)]
pub struct Ledger {
    rows: Vec<Row>,
}

#[derive(Debug, Clone, PartialEq)]
struct Row {
    what: String,
    wall_s: f64,
    /// User and system time of everything that the step started; nothing where it cannot be had.
    cpu_s: Option<f64>,
}

impl Ledger {
    /// Does the work of a step and writes down what it took, whether it succeeds or not.
    ///
    /// # Errors
    /// Those of the work.
    pub fn time<T>(
        &mut self,
        what: &str,
        work: impl FnOnce() -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let (started, cpu_before_s) = (Instant::now(), cpu_of_children_s());
        let done = work();
        let cpu_after_s = cpu_of_children_s();
        self.rows.push(Row::new(
            what,
            started.elapsed(),
            cpu_before_s.zip(cpu_after_s),
        ));
        done
    }

    /// As [`Ledger::time`], for work with Chromium, which leaves processes that nobody waits for.
    ///
    /// # Errors
    /// Those of the work.
    pub fn time_with_chromium<T>(
        &mut self,
        what: &str,
        work: impl FnOnce() -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let watch = Watch::begin();
        let done = self.time(what, work);
        let unwaited_s = watch.end();
        if let Some(Row { cpu_s, .. }) = self.rows.last_mut() {
            *cpu_s = cpu_s.map(|waited_s| waited_s + unwaited_s);
        }
        done
    }
}

impl Row {
    fn new(what: &str, wall: Duration, cpu_s: Option<(f64, f64)>) -> Self {
        Self {
            what: what.to_owned(),
            wall_s: wall.as_secs_f64(),
            cpu_s: cpu_s.map(|(before, after)| after - before),
        }
    }
}

impl fmt::Display for Ledger {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let total = Row {
            what: "all".to_owned(),
            wall_s: self.rows.iter().map(|row| row.wall_s).sum(),
            cpu_s: self.rows.iter().map(|row| row.cpu_s).sum(),
        };
        let width = self.rows.iter().map(|row| row.what.chars().count()).max();
        let width = width.unwrap_or(0).max(4);
        writeln!(
            formatter,
            "{:width$} {:>8} {:>8}",
            "step", "wall s", "CPU s"
        )?;
        for row in self.rows.iter().chain([&total]) {
            let cpu = row
                .cpu_s
                .map_or("?".to_owned(), |cpu_s| format!("{cpu_s:.1}"));
            let Row { what, wall_s, .. } = row;
            writeln!(formatter, "{what:width$} {wall_s:8.1} {cpu:>8}")?;
        }
        Ok(())
    }
}

/// What the processes that we started, and those that they started, have used and ended with.
fn cpu_of_children_s() -> Option<f64> {
    children_in(&fs::read_to_string("/proc/self/stat").ok()?)
}

/// `cutime` + `cstime` of a line of `/proc/PID/stat`: fields 16 and 17 of proc(5). The second field,
/// the name in parentheses, may hold spaces.
fn children_in(stat: &str) -> Option<f64> {
    let (_, after_name) = stat.rsplit_once(')')?;
    let mut times = after_name.split_whitespace().skip(13);
    let mut seconds = || Some(times.next()?.parse::<f64>().ok()? / TICKS_PER_SECOND);
    Some(seconds()? + seconds()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_times_of_children_are_found_behind_a_name_with_spaces() {
        let stat = "42 (a b) c) S 1 42 42 0 -1 4194560 1 2 3 4 500 600 12345 678 20 0 1 0 9 8 7";
        assert_eq!(children_in(stat), Some(130.23));
        assert_eq!(children_in("42 (x) S 1"), None);
    }

    #[test]
    fn a_step_that_fails_has_its_row_and_the_last_row_is_the_sum() {
        let mut ledger = Ledger::default();
        let failed = ledger.time("Trying", || Err::<(), _>(Failure::new("no")));
        assert_eq!(failed.unwrap_err().to_string(), "no");
        ledger.rows = vec![
            Row::new("short", Duration::from_millis(1500), Some((1.0, 3.0))),
            Row::new(
                "a longer one",
                Duration::from_millis(2500),
                Some((3.0, 3.5)),
            ),
        ];
        let expected = "\
step           wall s    CPU s
short             1.5      2.0
a longer one      2.5      0.5
all               4.0      2.5
";
        assert_eq!(ledger.to_string(), expected);
    }

    #[test]
    fn a_time_that_is_not_known_is_not_counted_as_none() {
        let rows = vec![
            Row::new("known", Duration::ZERO, Some((1.0, 2.0))),
            Row::new("unknown", Duration::ZERO, None),
        ];
        let table = Ledger { rows }.to_string();
        let last = table.lines().last().unwrap();
        assert!(last.ends_with('?'), "{table}");
    }
}
