//! The gradebook: a row for each student, a column for each question and the total, joined to a roster.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use anyhow::{bail, ensure};

use crate::answers::without_bom;
use crate::exercise::{self, AnswerMark};
use crate::{Sheet, csv_cell, one_line, written};
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
/// The columns of any roster that may hold what a student typed as name or token, in English and in German.
const IDENTIFIERS: [&str; 16] = [
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
    "ID-Nummer",
    "Anmeldename",
    "E-Mail-Adresse",
    "Matrikelnummer",
    "Vollständiger Name",
];

/// The students of a course.
#[derive(Clone, Debug)]
pub struct Roster {
    head: Vec<String>,
    rows: Vec<Row>,
    /// Columns that identify a student.
    identifiers: Vec<usize>,
}

/// A student of a course.
#[derive(Clone, Debug)]
struct Row {
    /// Its number in the table, from 1; quoted cells may hold lines, so it is no line of the file.
    number: usize,
    cells: Vec<String>,
}

impl Roster {
    /// Reads a table of CSV whose first line names the columns, as Canvas and Moodle export it, with commas, semicolons
    /// or tabs. `by` names the only column that identifies a student.
    ///
    /// # Errors
    /// If it cannot be read or no column identifies a student.
    pub fn read(path: &Path, by: Option<&str>) -> anyhow::Result<Self> {
        let bytes = fs::read(path).in_file(path)?;
        let Ok(text) = str::from_utf8(without_bom(&bytes)) else {
            bail!(
                "{} is not UTF-8; save it as “CSV UTF-8”, so that every name stays as it is",
                path.display()
            );
        };
        let separator = separator(text);
        let mut rows = table(text, separator).into_iter();
        let head = rows.next().unwrap_or_default();
        let is_identifier = |name: &String| match by {
            Some(by) => name.trim() == by.trim(),
            None => IDENTIFIERS.iter().any(|known| is_same(known, name)),
        };
        let columns = head.iter().enumerate();
        let identifiers: Vec<usize> = columns
            .filter(|(_, name)| is_identifier(name))
            .map(|(column, _)| column)
            .collect();
        let is_one = identifiers.len() == 1 || (by.is_none() && !identifiers.is_empty());
        ensure!(
            is_one,
            "{} has {}; its columns, with {} between them, are {}; name the one that holds the names or tokens with --by COLUMN",
            path.display(),
            match by {
                Some(by) => format!("not one column {}", by.trim()),
                None => "no column that identifies a student".to_owned(),
            },
            name_of(separator),
            head.iter()
                .map(|name| name.trim())
                .collect::<Vec<_>>()
                .join(" | ")
        );
        let canvas_id = head.iter().position(|name| name.trim() == CANVAS[1]);
        let canvas_id = canvas_id.filter(|_| head.iter().any(|name| name.trim() == CANVAS[3]));
        let is_filled = |cells: &[String], column: usize| {
            cells
                .get(column)
                .is_some_and(|cell| !cell.trim().is_empty())
        };
        let is_student = |cells: &[String]| match canvas_id {
            // Canvas exports the points possible, and whether grades are posted by hand, as if they were students.
            Some(id) => is_filled(cells, id),
            None => {
                let first = cells.first().map_or("", |cell| cell.trim());
                let mut known = identifiers.iter();
                first != "Points Possible" && known.any(|&column| is_filled(cells, column))
            }
        };
        let rows = rows
            .enumerate()
            .filter(|(_, cells)| is_student(cells))
            .map(|(at, cells)| Row {
                number: at + 2,
                cells,
            });
        Ok(Self {
            rows: rows.collect(),
            identifiers,
            head,
        })
    }

    /// The rows of which an identifier is this name or token; without one, those in which it is but for the case.
    fn rows_of(&self, student: &str) -> Vec<usize> {
        let of = |is_it: &dyn Fn(&str) -> bool| -> Vec<usize> {
            let has = |row: &Row| {
                let mut cells = self.identifiers.iter().filter_map(|&at| row.cells.get(at));
                cells.any(|cell| is_it(cell))
            };
            let rows = self.rows.iter().enumerate();
            rows.filter(|(_, row)| has(row)).map(|(at, _)| at).collect()
        };
        let exact = of(&|cell| cell.trim() == student.trim());
        if exact.is_empty() {
            of(&|cell| is_same(cell, student))
        } else {
            exact
        }
    }

    fn has(&self, name: &str) -> bool {
        self.head.iter().any(|head| head.trim() == name)
    }

    fn cell(&self, row: usize, name: &str) -> &str {
        let column = self.head.iter().position(|head| head.trim() == name);
        let cell = column.and_then(|column| self.rows[row].cells.get(column));
        cell.map_or("", String::as_str)
    }

    /// The columns that identify a student, for Moodle, which maps any of them.
    fn moodle_columns(&self) -> Vec<String> {
        let english: Vec<&str> = MOODLE.into_iter().filter(|name| self.has(name)).collect();
        if english.is_empty() {
            let names = self.identifiers.iter().map(|&at| self.head[at].trim());
            return names.map(str::to_owned).collect();
        }
        english.into_iter().map(str::to_owned).collect()
    }
}

/// Whether two names or tokens are the same but for case and spaces around them.
fn is_same(one: &str, other: &str) -> bool {
    one.trim().to_lowercase() == other.trim().to_lowercase()
}

/// Prints the gradebook and returns the problems, a sentence each: files of one student, and students without a row.
pub fn print(sheets: &[Sheet], roster: Option<&Roster>, columns: Columns) -> Vec<String> {
    let mut problems = Vec::new();
    let mut of_student: HashMap<&str, &Sheet> = HashMap::new();
    let mut order: Vec<&str> = Vec::new();
    for sheet in sheets {
        let student = sheet.identity();
        if let Some(first) = of_student.get(student) {
            problems.push(both_of(first, sheet, &one_line(student)));
            continue;
        }
        // A roster knows whether these are two students.
        let twin = order.iter().find(|known| is_same(known, student));
        if let (Some(&twin), None) = (twin, roster) {
            problems.push(format!(
                "{} is of {} and {} of {}; if that is one student, keep the right one",
                of_student[twin].file,
                one_line(twin),
                sheet.file,
                one_line(student)
            ));
        }
        of_student.insert(student, sheet);
        order.push(student);
    }
    let identity: Vec<String> = match (columns, roster) {
        (Columns::Plain, None) => vec!["student".to_owned()],
        (Columns::Plain, Some(roster)) => roster.head.clone(),
        (Columns::Canvas, _) => CANVAS.map(str::to_owned).to_vec(),
        (Columns::Moodle, None) => vec![MOODLE[1].to_owned()],
        (Columns::Moodle, Some(roster)) => roster.moodle_columns(),
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
                let sheet = of_student[student];
                let found = roster.rows_of(student);
                let &[row] = found.as_slice() else {
                    let numbers: Vec<String> = found
                        .iter()
                        .map(|&row| roster.rows[row].number.to_string())
                        .collect();
                    let place = match numbers.as_slice() {
                        [] => "in no row of the roster".to_owned(),
                        rows => format!("in the rows {} of the roster", rows.join(" and ")),
                    };
                    let student = one_line(student);
                    problems.push(format!("{}: {student} is {place}", sheet.file));
                    continue;
                };
                if let Some(first) = answered.get(&row) {
                    let place = format!("row {} of the roster", roster.rows[row].number);
                    problems.push(both_of(first, sheet, &place));
                } else {
                    answered.insert(row, sheet);
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

fn both_of(first: &Sheet, second: &Sheet, whom: &str) -> String {
    format!(
        "{} and {} are both of {whom}; the first one counts, so keep the right one",
        first.file, second.file
    )
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

/// What separates the cells of the first line: the separator that stands there most often outside of quotes.
fn separator(text: &str) -> char {
    let mut is_quoted = false;
    let mut counts = [(',', 0), (';', 0), ('\t', 0)];
    for letter in text.chars() {
        is_quoted ^= letter == '"';
        if letter == '\n' && !is_quoted {
            break;
        }
        for (_, count) in counts
            .iter_mut()
            .filter(|(one, _)| *one == letter && !is_quoted)
        {
            *count += 1;
        }
    }
    // Of equals the first: a table of one column has none.
    let best = counts.iter().rev().max_by_key(|(_, count)| *count);
    best.map_or(',', |(letter, _)| *letter)
}

fn name_of(separator: char) -> &'static str {
    match separator {
        ';' => "semicolons",
        '\t' => "tabs",
        _ => "commas",
    }
}

/// The rows of a table of CSV (RFC 4180) with this separator.
fn table(text: &str, separator: char) -> Vec<Vec<String>> {
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
            letter if letter == separator && !is_quoted => row.push(core::mem::take(&mut cell)),
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
    fn the_first_line_shows_the_separator() {
        for (text, expected) in [
            ("a,b;c,d\n;;;;;\n", ','),
            ("\"a,b,c\";d\n,,,,\n", ';'),
            ("a\tb,c\td\n", '\t'),
            ("Token\ns1;s2;s3\n", ','),
        ] {
            assert_eq!(separator(text), expected, "{text}");
        }
    }

    #[test]
    fn cells_may_hold_commas_quotes_and_lines() {
        let text = "Student,ID\r\n\"Lee, \"\"Ann\"\"\",7\n\"two\nlines\",\n";
        let rows = table(text, separator(text));
        assert_eq!(
            rows,
            [["Student", "ID"], ["Lee, \"Ann\"", "7"], ["two\nlines", ""]]
        );
    }
}
