//! Iterates over the rows of a table: the leaves of a B-tree of pages.

use super::pages::{FILE_HEADER, Pages};
use super::record::{Value, values, varint};
use crate::ros::container::{ContainerError, MAX_BYTES};

/// Deeper trees exceed any disk, or are cyclic.
const DEEPEST: usize = 20;
/// Page types: interior pages, and leaves with rows.
const INTERIOR: u8 = 5;
const LEAF: u8 = 13;

/// A row of a table.
pub struct DatabaseRow {
    /// Row id.
    pub id: i64,
    /// Values by column.
    pub values: Vec<Value>,
}

/// Current page of a level of the tree.
struct Level {
    number: u32,
    page: Vec<u8>,
    next: usize,
}

/// The rows of a table in sequence.
pub struct DatabaseTable {
    root: Option<u32>,
    /// From the root to the current leaf.
    levels: Vec<Level>,
    /// Id of the row before. Ids must increase, which ends cycles of pages.
    last_id: Option<i64>,
}

impl DatabaseTable {
    /// Creates for the table whose root is this page.
    pub fn at(root: u32) -> Self {
        Self {
            root: Some(root),
            levels: Vec::new(),
            last_id: None,
        }
    }

    /// Returns the next row; `None` at the end.
    ///
    /// # Errors
    /// If a page or a row is malformed; the next call continues after it.
    pub fn next_row(
        &mut self,
        pages: &mut Pages<'_>,
    ) -> Result<Option<DatabaseRow>, ContainerError> {
        if let Some(root) = self.root.take() {
            self.descend(root, pages)?;
        }
        while let Some(level) = self.levels.last_mut() {
            let at = level.next;
            level.next += 1;
            let start = if level.number == 1 { FILE_HEADER } else { 0 };
            let count = usize::from(number(&level.page, start + 3).unwrap_or(0));
            let is_leaf = level.page.get(start) == Some(&LEAF);
            let last = if is_leaf { count } else { count + 1 };
            if at >= last {
                self.levels.pop();
                continue;
            }
            if is_leaf {
                let spot = number(&level.page, start + 8 + 2 * at);
                let row =
                    spot.and_then(|spot| level.page.get(usize::from(spot)..).map(<[u8]>::to_vec));
                let problem = format!("row {at} of page {} of the database", level.number);
                let row = row.ok_or_else(|| broken(&problem))?;
                let row = row_of(&row, pages, &problem)?;
                if self.last_id.is_some_and(|last_id| row.id <= last_id) {
                    // A page that recurs has the same rows.
                    self.levels.pop();
                    return Err(broken(&problem));
                }
                self.last_id = Some(row.id);
                return Ok(Some(row));
            }
            let child = if at == count {
                four(&level.page, start + 8)
            } else {
                number(&level.page, start + 12 + 2 * at)
                    .and_then(|spot| four(&level.page, usize::from(spot)))
            };
            let child = child.ok_or_else(|| broken("a page of the database"))?;
            self.descend(child, pages)?;
        }
        Ok(None)
    }

    fn descend(&mut self, page_number: u32, pages: &mut Pages<'_>) -> Result<(), ContainerError> {
        if self.levels.len() >= DEEPEST
            || self.levels.iter().any(|level| level.number == page_number)
        {
            return Err(broken("a page that is not its own ancestor"));
        }
        let page = pages.page(page_number)?;
        let start = if page_number == 1 { FILE_HEADER } else { 0 };
        if !matches!(page.get(start), Some(&(INTERIOR | LEAF))) {
            return Err(broken(&format!("a page of a table as page {page_number}")));
        }
        self.levels.push(Level {
            number: page_number,
            page,
            next: 0,
        });
        Ok(())
    }
}

fn broken(expected: &str) -> ContainerError {
    ContainerError::Skipped(format!("expected {expected}, found other bytes"))
}

/// Two bytes of a page as an integer.
fn number(page: &[u8], at: usize) -> Option<u16> {
    Some(u16::from_be_bytes(page.get(at..at + 2)?.try_into().ok()?))
}

/// Four bytes of a page as an integer.
fn four(page: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_be_bytes(page.get(at..at + 4)?.try_into().ok()?))
}

/// Decodes the row of a cell, including its overflow pages.
fn row_of(cell: &[u8], pages: &mut Pages<'_>, what: &str) -> Result<DatabaseRow, ContainerError> {
    let read = || {
        let (length, first) = varint(cell)?;
        let (id, second) = varint(&cell[first..])?;
        let length = usize::try_from(length)
            .ok()
            .filter(|&length| length <= MAX_BYTES)?;
        Some((length, id as i64, &cell[first + second..]))
    };
    let (length, id, rest) = read().ok_or_else(|| broken(what))?;
    // Section 1.6 of the format: bytes that stay on the page.
    let usable = pages.usable();
    let most = usable - 35;
    let local = if length <= most {
        length
    } else {
        let least = (usable - 12) * 32 / 255 - 23;
        let fitting = least + (length - least) % (usable - 4);
        if fitting <= most { fitting } else { least }
    };
    let mut record = rest.get(..local).ok_or_else(|| broken(what))?.to_vec();
    let mut next = four(rest, local).filter(|_| local < length);
    while record.len() < length {
        let number = next
            .filter(|&number| number > 0)
            .ok_or_else(|| broken(what))?;
        let page = pages.page(number)?;
        let left = (length - record.len()).min(usable - 4);
        record.extend_from_slice(&page[4..4 + left]);
        next = four(&page, 0);
    }
    let values = values(&record).ok_or_else(|| broken(what))?;
    Ok(DatabaseRow { id, values })
}
