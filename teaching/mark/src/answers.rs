//! The file of answers that a reader saves from the page.
//!
//! ```json
//! {"schema": "slam2d-answers/1", "student": "Ann", "digest": "9f86…", "answers": [{"exercise": "16.5a",
//!  "widget": "w16.2", "state": "noise=4&t=129&seed=7", "prediction": "twice", "result": "1.2",
//!  "attempts": 1, "time": "2026-11-27T02:06:47.000Z"}]}
//! ```
//!
//! Functions that the reader wrote may follow: `"code": [{"function": "gate", "code": "function gate…", "attempts": 3,
//! "time": "…", "help": 0}]`.
//!
//! The digest is the SHA-256 of `["slam2d-answers/1","Ann",["16.5a","w16.2",…,1,"2026-…"],…]` as compact JSON, with
//! `["gate","function gate…",3,"2026-…",0]` for a function. It detects accidental changes, but no forgery: the algorithm is public.

use std::collections::HashSet;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use anyhow::{bail, ensure};
use serde::Deserialize;
use sha2::{Digest, Sha256};

use command_line::in_file::InFile as _;

/// Name and version of the format.
const SCHEMA: &str = "slam2d-answers/1";
/// Size limit; the answers to all exercises of a chapter are a few kilobytes.
const MAX_BYTES: u64 = 1 << 20;

/// The answers of one student.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudentAnswers {
    schema: String,
    /// Name or token; empty for the tasks of the chapter.
    pub student: String,
    /// One for each exercise, in the order in which they were first given.
    pub answers: Vec<Answer>,
    /// The functions that the student wrote, as they were run last.
    #[serde(default)]
    pub code: Vec<Written>,
    digest: String,
}

/// A function that the student wrote.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Written {
    /// Its name: `svd_align`.
    pub function: String,
    /// The text of the editor.
    pub code: String,
    /// Number of runs.
    pub attempts: u32,
    /// Moment of the last one, by the student's clock.
    pub time: String,
    /// Steps of help that the student took, [`SOLUTION_SHOWN`] at most; earlier pages did not count them.
    pub help: Option<u32>,
}

/// The last step of help: the page shows its solution.
pub const SOLUTION_SHOWN: u32 = 4;

/// The last answer to one exercise.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Answer {
    /// Id of the exercise.
    pub exercise: String,
    widget: String,
    /// State of the widget, as in a link.
    pub state: String,
    /// Name of a choice, or a number.
    pub prediction: String,
    /// Verdict or number that the page showed.
    pub result: String,
    /// Number of answers to this exercise.
    pub attempts: u32,
    /// Moment of this answer, by the student's clock.
    pub time: String,
}

/// The bytes without the mark with which some editors begin a file in UTF-8.
pub fn without_bom(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

impl StudentAnswers {
    /// Reads a file of answers.
    ///
    /// # Errors
    /// If it is not a file of answers of this version, with at most one for each exercise.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let mut bytes = Vec::new();
        let file = File::open(path).in_file(path)?;
        file.take(MAX_BYTES + 1)
            .read_to_end(&mut bytes)
            .in_file(path)?;
        ensure!(
            bytes.len() as u64 <= MAX_BYTES,
            "{} has more than {MAX_BYTES} bytes; give a file that the page saved",
            path.display()
        );
        let answers: Self = serde_json::from_slice(without_bom(&bytes))
            .map_err(|error| {
                format!("{error}; give a file that the page saved with “Save my answers”")
            })
            .in_file(path)?;
        ensure!(
            answers.schema == SCHEMA,
            "{} has the schema `{}`, not `{SCHEMA}`; mark it with the version of its page",
            path.display(),
            answers.schema
        );
        let mut seen = HashSet::new();
        let exercises = answers.answers.iter().map(|answer| &answer.exercise);
        let functions = answers.code.iter().map(|written| &written.function);
        if let Some(twice) = exercises.chain(functions).find(|id| !seen.insert(*id)) {
            bail!(
                "{} answers exercise {twice} twice; keep one of the two",
                path.display()
            );
        }
        Ok(answers)
    }

    /// Whether the digest is that of the answers.
    pub fn is_intact(&self) -> bool {
        let digest = Sha256::digest(self.canonical());
        let hexadecimal: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
        hexadecimal == self.digest
    }

    fn canonical(&self) -> String {
        let mut rows = vec![self.schema.as_str().into(), self.student.as_str().into()];
        rows.extend(self.answers.iter().map(|answer| {
            serde_json::json!([
                answer.exercise,
                answer.widget,
                answer.state,
                answer.prediction,
                answer.result,
                answer.attempts,
                answer.time,
            ])
        }));
        rows.extend(self.code.iter().map(|written| {
            let mut row = vec![
                serde_json::json!(written.function),
                serde_json::json!(written.code),
                serde_json::json!(written.attempts),
                serde_json::json!(written.time),
            ];
            row.extend(written.help.map(serde_json::Value::from));
            serde_json::Value::Array(row)
        }));
        serde_json::Value::Array(rows).to_string()
    }
}
