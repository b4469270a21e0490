//! The gradebook: a row for each student, a column for each question and the total, joined to a roster.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use anyhow::ensure;

use crate::answers::without_bom;
use crate::exercise::{self, AnswerMark};
use crate::{Sheet, csv_cell, written};
use command_line::in_file::InFile as _;
use command_line::output::say;

/// Whose column names the gradebook has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Columns {
    /// `student`, or the columns of the roster.
    #[default]
    Plain,
    /// Those that Canvas imports.
    Canvas,
    /// Those that Moodle maps.
    Moodle,
}

/// The columns that Canvas wants first, in its order.
const CANVAS: [&str; 5] = ["Student", "ID", "SIS User ID", "SIS Login ID", "Section"];
/// The columns by which Moodle finds a student.
const MOODLE: [&str; 3] = ["Username", "ID number", "Email address"];
/// The columns of any roster that may hold what a student typed as name or token.
const IDENTIFIERS: [&str; 11] = [
    "Student",
    "Name",
    "ID",
    "SIS User ID",
    "SIS Login ID",
    "Username",
    "ID number",
    "Email address",
    "Email",
    "Token",
    "Full name",
];

/// The students of a course.
#[derive(Clone, Debug)]
pub struct Roster {
    head: Vec<String>,
    rows: Vec<Vec<String>>,
    /// Columns that identify a student.
    identifiers: Vec<usize>,
}

impl Roster {
    /// Reads a table of CSV whose first line names the columns, as Canvas and Moodle export it.
    ///
    /// # Errors
    /// If it cannot be read or no column identifies a student.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let bytes = fs::read(path).in_file(path)?;
        let text = String::from_utf8_lossy(without_bom(&bytes)).into_owned();
        let mut rows = table(&text).into_iter();
        let head = rows.next().unwrap_or_default();
        let is_identifier = |name: &String| {
            let known = |known: &&str| known.eq_ignore_ascii_case(name.trim());
            IDENTIFIERS.iter().any(known)
        };
        let columns = head.iter().enumerate();
        let identifiers: Vec<usize> = columns
            .filter(|(_, name)| is_identifier(name))
            .map(|(column, _)| column)
            .collect();
        ensure!(
            !identifiers.is_empty(),
            "{} has no column that identifies a student; name one of its columns {}",
            path.display(),
            IDENTIFIERS.join(", ")
        );
        // Canvas exports the points possible as if they were a student.
        let rows = rows.filter(|row| {
            let first = row.first().map_or("", |cell| cell.trim());
            first != "Points Possible" && row.iter().any(|cell| !cell.trim().is_empty())
        });
        Ok(Self {
            rows: rows.collect(),
            identifiers,
            head,
        })
    }

    /// The only row of which an identifier is this name or token.
    fn row_of(&self, student: &str) -> Option<usize> {
        let is_it = |row: &Vec<String>| {
            let mut cells = self
                .identifiers
                .iter()
                .filter_map(|&column| row.get(column));
            cells.any(|cell| cell.trim() == student)
        };
        let mut found = self.rows.iter().enumerate().filter(|(_, row)| is_it(row));
        let (at, _) = found.next()?;
        found.next().is_none().then_some(at)
    }

    fn cell(&self, row: usize, name: &str) -> &str {
        let column = self.head.iter().position(|head| head.trim() == name);
        let cell = column.and_then(|column| self.rows[row].get(column));
        cell.map_or("", String::as_str)
    }
}

/// Prints the gradebook and returns the problems, a sentence each: files of one student, and students without a row.
pub fn print(sheets: &[Sheet], roster: Option<&Roster>, columns: Columns) -> Vec<String> {
    let mut problems = Vec::new();
    let mut of_student: HashMap<&str, &Sheet> = HashMap::new();
    let mut order = Vec::new();
    for sheet in sheets {
        let student = sheet.identity();
        if let Some(first) = of_student.get(student) {
            problems.push(format!(
                "{} and {} are both of {student}; the first one counts, so keep the right one",
                first.file, sheet.file
            ));
            continue;
        }
        of_student.insert(student, sheet);
        order.push(student);
    }
    let identity: Vec<String> = match (columns, roster) {
        (Columns::Plain, None) => vec!["student".to_owned()],
        (Columns::Plain, Some(roster)) => roster.head.clone(),
        (Columns::Canvas, _) => CANVAS.map(str::to_owned).to_vec(),
        (Columns::Moodle, None) => vec![MOODLE[1].to_owned()],
        (Columns::Moodle, Some(roster)) => {
            let has = |name: &&str| roster.head.iter().any(|head| head.trim() == *name);
            MOODLE.into_iter().filter(has).map(str::to_owned).collect()
        }
    };
    let title = |question: &str| match columns {
        Columns::Plain => question.to_owned(),
        Columns::Canvas | Columns::Moodle => format!("Question {question}"),
    };
    let ids = ids(sheets);
    let mut head = identity.clone();
    head.extend(ids.iter().map(|id| title(id)));
    head.push(match columns {
        Columns::Plain => "total".to_owned(),
        Columns::Canvas | Columns::Moodle => "Questions total".to_owned(),
    });
    line(&head);
    match roster {
        Some(roster) => {
            let mut answered: HashMap<usize, &Sheet> = HashMap::new();
            for student in order {
                let Some(row) = roster.row_of(student) else {
                    problems.push(format!(
                        "{}: {student} is in no row of the roster, or in several",
                        of_student[student].file
                    ));
                    continue;
                };
                if let Some(first) = answered.insert(row, of_student[student]) {
                    problems.push(format!(
                        "{} and {} are both of row {} of the roster; the second one counts, so keep the right one",
                        first.file,
                        of_student[student].file,
                        row + 2
                    ));
                }
            }
            for row in 0..roster.rows.len() {
                let cells = identity.iter().map(|name| roster.cell(row, name.trim()));
                let mut cells: Vec<String> = cells.map(str::to_owned).collect();
                cells.extend(points(&ids, answered.get(&row).copied()));
                line(&cells);
            }
        }
        None => {
            for student in order {
                let mut cells = vec![student.to_owned()];
                if columns == Columns::Canvas {
                    cells = ["", "", "", "", ""].map(str::to_owned).to_vec();
                    cells[0] = student.to_owned();
                    cells[3] = student.to_owned();
                }
                cells.extend(points(&ids, of_student.get(student).copied()));
                line(&cells);
            }
        }
    }
    problems
}

/// The questions, and the functions if a student wrote one.
fn ids(sheets: &[Sheet]) -> Vec<&'static str> {
    let mut answers = sheets.iter().flat_map(|sheet| &sheet.answers);
    let has_code = answers.any(|answer| written::ids().any(|id| id == answer.exercise));
    let functions = written::ids().filter(|_| has_code);
    exercise::ids().chain(functions).collect()
}

/// A point for each question that is right or within tolerance, nothing for one without a mark, and the total.
fn points(ids: &[&str], sheet: Option<&Sheet>) -> Vec<String> {
    let mark = |id: &str| {
        let answers = sheet.map_or(&[][..], |sheet| &sheet.answers);
        answers
            .iter()
            .find(|answer| answer.exercise == id)
            .map(|answer| answer.mark)
    };
    let cell = |id: &str| match mark(id) {
        Some(AnswerMark::Right | AnswerMark::WithinTolerance) => "1",
        Some(AnswerMark::Wrong) => "0",
        Some(AnswerMark::NotMarked) | None => "",
    };
    let mut cells: Vec<String> = ids.iter().map(|id| cell(id).to_owned()).collect();
    cells.push(sheet.map_or_else(String::new, |sheet| sheet.right.to_string()));
    cells
}

fn line(cells: &[String]) {
    let cells: Vec<String> = cells.iter().map(|cell| csv_cell(cell)).collect();
    say!("{}", cells.join(","));
}

/// The rows of a table of CSV (RFC 4180).
fn table(text: &str) -> Vec<Vec<String>> {
    let (mut rows, mut row, mut cell) = (Vec::new(), Vec::new(), String::new());
    let mut is_quoted = false;
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '"' if is_quoted && letters.peek() == Some(&'"') => {
                cell.push('"');
                letters.next();
            }
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => row.push(core::mem::take(&mut cell)),
            '\r' if !is_quoted => {}
            '\n' if !is_quoted => {
                row.push(core::mem::take(&mut cell));
                rows.push(core::mem::take(&mut row));
            }
            _ => cell.push(letter),
        }
    }
    if !cell.is_empty() || !row.is_empty() {
        row.push(cell);
        rows.push(row);
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_may_hold_commas_quotes_and_lines() {
        let rows = table("Student,ID\r\n\"Lee, \"\"Ann\"\"\",7\n\"two\nlines\",\n");
        assert_eq!(
            rows,
            [["Student", "ID"], ["Lee, \"Ann\"", "7"], ["two\nlines", ""]]
        );
    }
}
