//! Runs other programs.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use anyhow::{Context as _, bail};

/// The workspace's root.
pub fn root() -> PathBuf {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
    manifest.ancestors().nth(3).unwrap_or(manifest).to_owned()
}

/// The cargo that runs this program.
pub fn cargo() -> Command {
    program(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// Whether an environment variable is set to anything but an empty text, `0` or `false`.
pub fn is_set(variable: &str) -> bool {
    !matches!(
        std::env::var(variable).as_deref(),
        Err(_) | Ok("" | "0" | "false")
    )
}

/// Returns a command that runs in the workspace's root.
pub fn program(name: impl AsRef<std::ffi::OsStr>) -> Command {
    let mut command = Command::new(name);
    command.current_dir(root());
    command
}

/// Runs a program to its end, passes its output through, and prints its duration.
///
/// # Errors
/// If it cannot be started or fails.
pub fn run(what: &str, command: &mut Command) -> anyhow::Result<()> {
    println!("\n── {what}");
    let started = Instant::now();
    let name = command.get_program().display().to_string();
    let status = command.status();
    let status = status.with_context(|| format!("{what}: {name} cannot be started"))?;
    if !status.success() {
        bail!("{what}: failed ({status})");
    }
    println!("── {what}: {:.0} s", started.elapsed().as_secs_f64());
    Ok(())
}

/// Returns the trimmed standard output of a program if it succeeds.
pub fn output(command: &mut Command) -> Option<String> {
    let output = command.output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_that_is_missing_or_fails_is_an_error_with_its_name() {
        let missing = run("Trying", &mut program("no-such-program-anywhere")).unwrap_err();
        assert!(missing.to_string().contains("no-such-program-anywhere"));
        let failing = cargo().arg("no-such-command").output().unwrap();
        assert!(!failing.status.success());
        assert!(run("Trying", cargo().arg("no-such-command")).is_err());
        assert_eq!(output(cargo().arg("no-such-command")), None);
    }
}
