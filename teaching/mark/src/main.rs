//! The command `ch16-mark`: recomputes the answers that students saved from the page, and marks them.

mod answers;
mod exercise;
mod gradebook;
mod written;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{bail, ensure};
use clap::Parser;
use rayon::prelude::*;
use serde::Serialize;

use answers::StudentAnswers;
use command_line::output::{print_json, say};
use command_line::program;
use exercise::{AnswerMark, Marked};
use gradebook::{Columns, Roster};

/// Mark the answers that students saved from the page.
#[derive(Parser, Clone, Debug)]
#[command(name = "ch16-mark", version)]
struct MarkArgs {
    /// Files that the page saved with "Save my answers".
    #[arg(required = true, value_name = "ANSWERS.json")]
    files: Vec<PathBuf>,
    /// Print a gradebook: a row for each student, a column for each question, and the total.
    #[arg(long, conflicts_with = "json")]
    csv: bool,
    /// With --csv, a row for each answer instead.
    #[arg(long, requires = "csv", conflicts_with_all = ["roster", "columns"])]
    long: bool,
    /// With --csv, the students of the course: a table that Canvas or Moodle exported. Rows keep its order.
    #[arg(long, requires = "csv", value_name = "ROSTER.csv")]
    roster: Option<PathBuf>,
    /// The column of the roster that holds what the students gave as name or token; default: the usual ones.
    #[arg(long, requires = "roster", value_name = "COLUMN")]
    by: Option<String>,
    /// With --csv, whose column names it has.
    #[arg(long, requires = "csv", value_enum, default_value_t = Columns::Plain)]
    columns: Columns,
    /// Print one JSON object for each file, one per line.
    #[arg(long)]
    json: bool,
}

/// The marks of one file.
#[derive(Serialize)]
struct Sheet {
    file: String,
    student: String,
    /// Whether the file is as the page saved it.
    intact: bool,
    /// Number of exercises in the chapter, and of functions that the file has.
    exercises: usize,
    /// Number of answers that are right or within tolerance, and of functions that pass their tests.
    right: usize,
    answers: Vec<Marked>,
}

fn main() -> ExitCode {
    program::start("ch16-mark", |args| run(args).map(|()| ExitCode::SUCCESS))
}

/// Marks every file that can be read, in order.
///
/// # Errors
/// If a file cannot be read or was edited; all that can be read are marked.
fn run(args: &MarkArgs) -> anyhow::Result<()> {
    let by = args.by.as_deref();
    let roster = args.roster.as_deref().map(|path| Roster::read(path, by));
    let roster = roster.transpose()?;
    let sheets: Vec<_> = args.files.par_iter().map(|path| sheet_of(path)).collect();
    if args.long && sheets.iter().any(Result::is_ok) {
        say!("{}", CSV_HEAD);
    }
    let files = sheets.len();
    let mut unusable = 0;
    let mut problems = Vec::new();
    let mut graded = Vec::new();
    for sheet in sheets {
        if let Ok(sheet) = sheet.as_ref()
            && !sheet.intact
        {
            problems.push(format!(
                "{} was changed after the page saved it (its digest is broken); ask {} for the file as it was saved",
                sheet.file,
                one_line(sheet.identity())
            ));
        }
        match sheet {
            Ok(sheet) if args.json => print_json(&sheet),
            Ok(sheet) if args.long => sheet.print_csv(),
            Ok(sheet) if args.csv => graded.push(sheet),
            Ok(sheet) => sheet.print(),
            Err(error) if files == 1 => return Err(error),
            Err(error) => {
                eprintln!("ch16-mark: {error}");
                unusable += 1;
            }
        }
    }
    if args.csv && !args.long {
        problems.extend(gradebook::print(&graded, roster.as_ref(), args.columns));
    }
    for problem in &problems {
        eprintln!("ch16-mark: {problem}");
    }
    ensure!(unusable == 0, "{unusable} of {files} files are not marked");
    match problems.len() {
        0 => {}
        1 => bail!("all files are marked; look at the one above first"),
        several => bail!("all files are marked; look at the {several} lines above first"),
    }
    Ok(())
}

fn sheet_of(path: &Path) -> anyhow::Result<Sheet> {
    let file = StudentAnswers::read(path)?;
    let answers: Vec<Marked> = file
        .answers
        .iter()
        .map(|answer| exercise::mark(answer, &file.student))
        .chain(file.code.iter().map(written::mark))
        .collect();
    let is_right =
        |answer: &&Marked| matches!(answer.mark, AnswerMark::Right | AnswerMark::WithinTolerance);
    Ok(Sheet {
        file: path.display().to_string(),
        intact: file.is_intact(),
        exercises: exercise::count() + file.code.len(),
        right: answers.iter().filter(is_right).count(),
        answers,
        student: file.student,
    })
}

const CSV_HEAD: &str =
    "file,student,intact,exercise,mark,prediction,right,result,unit,attempts,time,note";

impl Sheet {
    /// The name or token; the file if there is none.
    fn identity(&self) -> &str {
        match self.student.trim() {
            "" => &self.file,
            name => name,
        }
    }

    fn print(&self) {
        let student = match self.student.as_str() {
            "" => "no name, the chapter's own tasks".to_owned(),
            name => one_line(name),
        };
        say!(
            "{}: {student}; {} of {} answered, {} as predicted",
            self.file,
            self.answers.len(),
            self.exercises,
            self.right
        );
        for answer in &self.answers {
            let right = match (&answer.right, &answer.result) {
                (Some(right), Some(result)) if right != result => {
                    format!("{right} ({result}{})", spaced(&answer.unit))
                }
                (Some(right), _) => format!("{right}{}", spaced(&answer.unit)),
                _ => String::new(),
            };
            say!(
                "  {:<16} {:<16} {} → {right}",
                one_line(&answer.exercise),
                answer.mark.words(),
                one_line(&answer.prediction)
            );
            if let Some(note) = &answer.note {
                say!("    {}", one_line(note));
            }
        }
    }

    fn print_csv(&self) {
        for answer in &self.answers {
            let attempts = answer.attempts.to_string();
            let cells = [
                self.file.as_str(),
                &self.student,
                if self.intact { "yes" } else { "no" },
                &answer.exercise,
                answer.mark.words(),
                &answer.prediction,
                answer.right.as_deref().unwrap_or_default(),
                answer.result.as_deref().unwrap_or_default(),
                &answer.unit,
                &attempts,
                &answer.time,
                answer.note.as_deref().unwrap_or_default(),
            ];
            say!("{}", cells.map(csv_cell).join(","));
        }
    }
}

impl AnswerMark {
    /// As in the JSON.
    fn words(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::WithinTolerance => "within-tolerance",
            Self::Wrong => "wrong",
            Self::NotMarked => "not-marked",
        }
    }
}

fn spaced(unit: &str) -> String {
    if unit.is_empty() {
        String::new()
    } else {
        format!(" {unit}")
    }
}

/// A student's text, which may not add a line to the report.
fn one_line(text: &str) -> String {
    text.chars()
        .map(|letter| if letter.is_control() { ' ' } else { letter })
        .collect()
}

/// One cell. A spreadsheet computes a text that starts like a formula, so such a text gets an apostrophe.
fn csv_cell(text: &str) -> String {
    let is_formula =
        text.starts_with(['=', '+', '-', '@', '\t', '\r']) && text.parse::<f64>().is_err();
    let guarded = if is_formula {
        format!("'{text}")
    } else {
        text.to_owned()
    };
    if guarded.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", guarded.replace('"', "\"\""))
    } else {
        guarded
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_is_text_whatever_a_student_writes() {
        assert_eq!(csv_cell("0.585"), "0.585");
        assert_eq!(csv_cell("-3"), "-3");
        assert_eq!(csv_cell("=SUM(A1)"), "'=SUM(A1)");
        assert_eq!(csv_cell("Ann, \"B\""), "\"Ann, \"\"B\"\"\"");
    }
}
