//! The output of `slam2d sweep` as a block of the page.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

/// The sweep of the page.
const ARGS: [&str; 5] = ["sweep", "--seeds", "1..=1000", "--noise", "0.25,1,2,4"];

/// Runs the sweep with the command `slam2d` and returns the block; progress is printed on the terminal.
///
/// # Errors
/// One sentence if the command cannot be started or fails.
pub fn block(slam2d: &Path) -> Result<String, String> {
    let say = |what: &dyn std::fmt::Display| format!("{} sweep: {what}", slam2d.display());
    let started = Instant::now();
    let output = Command::new(slam2d)
        .args(ARGS)
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| say(&error))?;
    if !output.status.success() {
        return Err(say(&output.status));
    }
    let printed = String::from_utf8(output.stdout).map_err(|error| say(&error))?;
    Ok(text(&printed, started.elapsed().as_secs_f64()))
}

fn text(printed: &str, seconds: f64) -> String {
    format!(
        "`slam2d {}` took {seconds:.0} s and printed:\n\n```text\n{}\n```",
        ARGS.join(" "),
        printed.trim_end()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_block_names_its_command_and_keeps_the_lines() {
        let expected = "`slam2d sweep --seeds 1..=1000 --noise 0.25,1,2,4` took 21 s and printed:\
            \n\n```text\nnoise ×1\n  rms 0.5\n```";
        assert_eq!(text("noise ×1\n  rms 0.5\n\n", 20.7), expected);
    }
}
