//! The cells of a straight line, in integers (Bresenham 1965, in the form for all octants).

/// A cell by column (x) and row (y); may be outside of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Cell {
    /// Column, increasing with x.
    pub column: i32,
    /// Row, increasing with y.
    pub row: i32,
}

/// Iterates over all cells of the line from `from` to `to`, both included, without gaps at corners.
///
/// A tie between a straight and a diagonal step goes to the diagonal one.
#[inline]
pub fn bresenham(from: Cell, to: Cell) -> impl Iterator<Item = Cell> {
    let columns = (to.column - from.column).abs();
    let rows = (to.row - from.row).abs();
    let column_step = (to.column - from.column).signum();
    let row_step = (to.row - from.row).signum();
    let mut error = columns - rows;
    let mut cell = from;
    // Each step moves one column, one row, or both: the longer side counts the steps.
    (0..=columns.max(rows)).map(move |_| {
        let current = cell;
        let doubled = 2 * error;
        if doubled >= -rows {
            error -= rows;
            cell.column += column_step;
        }
        if doubled <= columns {
            error += columns;
            cell.row += row_step;
        }
        current
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(column: i32, row: i32) -> Cell {
        Cell { column, row }
    }

    #[test]
    fn a_line_has_both_ends_and_no_gaps_in_every_octant() {
        for column in -7..=7 {
            for row in -7..=7 {
                let (from, to) = (cell(2, -1), cell(2 + column, -1 + row));
                let line: Vec<_> = bresenham(from, to).collect();
                assert_eq!(line.first(), Some(&from));
                assert_eq!(line.last(), Some(&to));
                for pair in line.windows(2) {
                    assert!((pair[1].column - pair[0].column).abs() <= 1);
                    assert!((pair[1].row - pair[0].row).abs() <= 1);
                }
            }
        }
    }

    #[test]
    fn every_cell_is_within_half_a_cell_of_the_line() {
        // Bresenham's defining property, measured along the shorter axis.
        for (column, row) in [(7, 3), (7, -3), (3, 7), (-3, 7), (-7, -2)] {
            for c in bresenham(cell(0, 0), cell(column, row)) {
                let (x, y) = (f64::from(c.column), f64::from(c.row));
                let (dx, dy) = (f64::from(column), f64::from(row));
                let off = if dx.abs() > dy.abs() {
                    y - x * dy / dx
                } else {
                    x - y * dx / dy
                };
                assert!(off.abs() <= 0.5 + 1e-12, "{c:?} is {off} off");
            }
        }
    }
}
