//! Running other programs, with a line that says what is going on and for how long.

use std::fmt;
use std::fs::{self, File};
use std::io::{self, IsTerminal as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;
use std::time::{Duration, Instant};

/// Why a command of the project ended early, in words for the reader.
#[derive(Debug)]
pub struct Failure(String);

impl Failure {
    /// A failure with that message.
    pub fn new(message: impl Into<String>) -> Self {
        Self(message.into())
    }

    /// The same failure, and on the same line what the reader can do about it.
    pub fn with_way_out(self, what_to_do: &str) -> Self {
        Self(format!("{self}; {what_to_do}"))
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

/// The workspace's root.
pub fn root() -> PathBuf {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
    manifest.ancestors().nth(2).unwrap_or(manifest).to_owned()
}

/// The cargo that started us.
pub fn cargo() -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root());
    command
}

/// A program that works in the workspace's root.
pub fn program(name: impl AsRef<std::ffi::OsStr>) -> Command {
    let mut command = Command::new(name);
    command.current_dir(root());
    command
}

/// Runs a program to its end and shows its output as it comes.
///
/// # Errors
/// Where it cannot be started or fails.
pub fn show(what: &str, command: &mut Command) -> Result<(), Failure> {
    println!("\n── {what}");
    let started = Instant::now();
    let status = command
        .status()
        .map_err(|error| cannot_start(what, command, &error))?;
    if !status.success() {
        return Err(Failure::new(format!("{what}: failed ({status})")));
    }
    println!("── {what}: {:.0} s", started.elapsed().as_secs_f64());
    Ok(())
}

/// Runs a program to its end under one progress line; its output goes to a file, of which the end
/// is shown where it fails.
///
/// # Errors
/// Where it cannot be started or fails.
pub fn step(what: &str, command: &mut Command) -> Result<(), Failure> {
    let log_path = log_path(what)?;
    let failed = |error: io::Error| Failure::new(format!("{what}: {error}"));
    let log = File::create(&log_path).map_err(failed)?;
    command.stdout(log.try_clone().map_err(failed)?).stderr(log);
    let mut child = command
        .spawn()
        .map_err(|error| cannot_start(what, command, &error))?;

    let started = Instant::now();
    let mut line = ProgressLine::new(what);
    let status = loop {
        if let Some(status) = child.try_wait().map_err(failed)? {
            break status;
        }
        thread::sleep(Duration::from_millis(100));
        line.tick(started.elapsed());
    };
    line.end(started.elapsed());
    if status.success() {
        return Ok(());
    }
    let log = fs::read_to_string(&log_path).unwrap_or_default();
    let lines: Vec<_> = log.lines().collect();
    for line in &lines[lines.len().saturating_sub(40)..] {
        eprintln!("  {line}");
    }
    Err(Failure::new(format!(
        "{what}: failed ({status}); all of its output is in {}",
        log_path.display()
    )))
}

fn log_path(what: &str) -> Result<PathBuf, Failure> {
    let folder = root().join("target/xtask");
    fs::create_dir_all(&folder)
        .map_err(|error| Failure::new(format!("{}: {error}", folder.display())))?;
    let name: String = what
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' })
        .collect();
    Ok(folder.join(format!("{name}.log")))
}

fn cannot_start(what: &str, command: &Command, error: &io::Error) -> Failure {
    let name = command.get_program().to_string_lossy();
    Failure::new(match error.kind() {
        io::ErrorKind::NotFound => format!("{what}: {name} is not installed, or not on the PATH"),
        _ => format!("{what}: {name} cannot be started ({error})"),
    })
}

/// `Compiling … 12 s`: rewritten in place on a terminal, every half minute in a log.
struct ProgressLine<'a> {
    what: &'a str,
    rewrites: bool,
    last_shown_s: u64,
}

impl<'a> ProgressLine<'a> {
    fn new(what: &'a str) -> Self {
        let rewrites = io::stdout().is_terminal();
        if !rewrites {
            println!("{what} …");
        }
        Self {
            what,
            rewrites,
            last_shown_s: 0,
        }
    }

    fn tick(&mut self, elapsed: Duration) {
        let seconds = elapsed.as_secs();
        if self.rewrites && seconds != self.last_shown_s {
            print!("\r{} … {seconds} s", self.what);
            // A terminal that went away is no reason to stop.
            let _ = io::stdout().flush();
            self.last_shown_s = seconds;
        } else if !self.rewrites && seconds >= self.last_shown_s + 30 {
            println!("{} … {seconds} s", self.what);
            self.last_shown_s = seconds;
        }
    }

    fn end(&self, elapsed: Duration) {
        let start = if self.rewrites { "\r" } else { "" };
        println!("{start}{}: {:.1} s", self.what, elapsed.as_secs_f64());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_that_is_not_there_is_named() {
        let failure = show("Trying", &mut program("no-such-program-anywhere")).unwrap_err();
        assert_eq!(
            failure.to_string(),
            "Trying: no-such-program-anywhere is not installed, or not on the PATH"
        );
    }
}
