//! The tables of a widget: beside its picture, and in the CSV files.

/// A table: one CSV file, one block of readouts.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// File name without ending: `errors-over-time`.
    pub id: &'static str,
    /// Title on screen.
    pub title: String,
    /// Head of every column, with units.
    pub columns: Vec<String>,
    /// The rows; a cell is text or a number already formatted.
    pub rows: Vec<Vec<String>>,
    /// Shown beside the picture, or only exported as CSV.
    pub place: TablePlace,
}

impl Table {
    /// A table beside the picture.
    #[must_use]
    pub fn shown(
        id: &'static str,
        title: impl Into<String>,
        columns: &[&str],
        rows: Vec<Vec<String>>,
    ) -> Self {
        let columns = columns.iter().map(|&head| head.to_owned());
        Self {
            id,
            title: title.into(),
            columns: columns.collect(),
            rows,
            place: TablePlace::Shown,
        }
    }

    /// A table for the export alone.
    #[must_use]
    pub fn exported(
        id: &'static str,
        title: impl Into<String>,
        columns: &[&str],
        rows: Vec<Vec<String>>,
    ) -> Self {
        Self {
            place: TablePlace::ExportOnly,
            ..Self::shown(id, title, columns, rows)
        }
    }

    /// A table for the export alone, a row for each item.
    #[must_use]
    pub fn of_items<T>(
        id: &'static str,
        title: impl Into<String>,
        items: impl IntoIterator<Item = T>,
        columns: &[TableColumn<'_, T>],
    ) -> Self {
        let heads: Vec<_> = columns.iter().map(|(head, _)| *head).collect();
        let row = |item| columns.iter().map(|(_, cell)| cell(&item).0).collect();
        Self::exported(id, title, &heads, items.into_iter().map(row).collect())
    }
}

/// A column: its head with the unit, and its cell in the row of an item.
pub type TableColumn<'a, T> = (&'a str, &'a dyn Fn(&T) -> TableCell);

/// A cell of a table: text, or a number with all its digits; empty for a number that is not finite.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableCell(String);

impl From<f64> for TableCell {
    fn from(value: f64) -> Self {
        Self(if value.is_finite() {
            value.to_string()
        } else {
            String::new()
        })
    }
}

impl From<Option<f64>> for TableCell {
    fn from(value: Option<f64>) -> Self {
        value.unwrap_or(f64::NAN).into()
    }
}

impl From<usize> for TableCell {
    fn from(value: usize) -> Self {
        Self(value.to_string())
    }
}

impl From<&str> for TableCell {
    fn from(text: &str) -> Self {
        Self(text.to_owned())
    }
}

/// Where a table is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TablePlace {
    /// Beside the picture.
    Shown,
    /// In the CSV export alone.
    ExportOnly,
}
