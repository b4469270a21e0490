//! Places the letters of a picture of classes in the middle of the widest areas.

use pr_geom::order_by;

/// Distance in cells between a letter and the border of its area.
const MIN_ROOM: u16 = 3;
/// Smallest distance of equal letters in columns or rows.
const APART: usize = 24;
/// Smallest distance of different letters in columns or rows.
const DIFFERENT_APART: usize = 8;
/// Columns and rows around a mark without letters.
const CLEAR: (f64, f64) = (7.0, 6.0);

/// A cell with room for a letter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LetterCell<C> {
    /// Its column.
    pub column: usize,
    /// Its row.
    pub row: usize,
    /// Its class.
    pub class: C,
    /// Chessboard distance to the border of its area.
    pub room: u16,
}

/// All cells with enough room for a letter, by decreasing room.
pub fn rooms<C: Copy + PartialEq>(cells: &[Option<C>], columns: usize) -> Vec<LetterCell<C>> {
    let distances = distances(cells, columns);
    let wide = cells.iter().zip(distances).enumerate();
    let rooms: Vec<_> = wide
        .filter(|(_, (_, room))| *room >= MIN_ROOM)
        .filter_map(|(k, (class, room))| {
            class.map(|class| LetterCell {
                column: k % columns,
                row: k / columns,
                class,
                room,
            })
        })
        .collect();
    // Among equal rooms the first one in the picture comes first.
    let order = order_by(rooms.len(), &|at| -f64::from(rooms[at].room));
    order.into_iter().map(|at| rooms[at]).collect()
}

/// A selection of the rooms that are far apart, and not near the spot (column, row).
pub fn spread<C: Copy + PartialEq>(
    rooms: &[LetterCell<C>],
    keep_clear: (f64, f64),
) -> Vec<LetterCell<C>> {
    let mut chosen: Vec<LetterCell<C>> = Vec::new();
    for room in rooms {
        let hides = (room.column as f64 - keep_clear.0).abs() < CLEAR.0
            && (room.row as f64 - keep_clear.1).abs() < CLEAR.1;
        let crowds = |other: &LetterCell<C>| {
            let apart = if other.class == room.class {
                APART
            } else {
                DIFFERENT_APART
            };
            other.column.abs_diff(room.column) < apart && other.row.abs_diff(room.row) < apart
        };
        if !hides && !chosen.iter().any(crowds) {
            chosen.push(*room);
        }
    }
    chosen
}

/// Chessboard distance of every cell to the next cell of another class or to the border, 1 at the
/// edge of an area, in two passes (Rosenfeld & Pfaltz 1966).
fn distances<C: Copy + PartialEq>(cells: &[Option<C>], columns: usize) -> Vec<u16> {
    let rows = cells.len() / columns;
    let mut distances = vec![u16::MAX; cells.len()];
    let mut relax = |column: usize, row: usize, steps: [[isize; 2]; 4]| {
        let k = row * columns + column;
        for [dc, dr] in steps {
            let neighbour = column
                .checked_add_signed(dc)
                .filter(|c| *c < columns)
                .zip(row.checked_add_signed(dr).filter(|r| *r < rows))
                .map(|(c, r)| r * columns + c)
                .filter(|n| cells[*n] == cells[k]);
            let beyond = neighbour.map_or(0, |n| distances[n]);
            distances[k] = distances[k].min(beyond.saturating_add(1));
        }
    };
    for row in 0..rows {
        for column in 0..columns {
            relax(column, row, [[-1, 0], [-1, -1], [0, -1], [1, -1]]);
        }
    }
    for row in (0..rows).rev() {
        for column in (0..columns).rev() {
            relax(column, row, [[1, 0], [1, 1], [0, 1], [-1, 1]]);
        }
    }
    distances
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOWHERE: (f64, f64) = (-100.0, -100.0);

    #[test]
    fn room_is_the_distance_to_the_next_cell_of_another_class() {
        let mut cells = vec![Some('a'); 9 * 9];
        cells[4 * 9 + 8] = Some('b');
        let distances = distances(&cells, 9);
        assert_eq!(
            distances[4 * 9 + 4],
            4,
            "four columns from the b, five from the border"
        );
        assert_eq!(distances[0], 1);
        assert_eq!(distances[4 * 9 + 8], 1);
    }

    #[test]
    fn every_wide_area_gets_a_letter_and_narrow_ones_do_not() {
        let cells: Vec<_> = (0..20)
            .flat_map(|_| 0..60)
            .map(|column| match column {
                0..=29 => Some('a'),
                30..=32 => Some('b'),
                _ => Some('c'),
            })
            .collect();
        let letters = spread(&rooms(&cells, 60), NOWHERE);
        assert!(letters.iter().any(|room| room.class == 'a'));
        assert!(letters.iter().any(|room| room.class == 'c'));
        for room in letters {
            assert_ne!(room.class, 'b', "three cells are too narrow for a letter");
            assert_eq!(cells[room.row * 60 + room.column], Some(room.class));
        }
    }

    #[test]
    fn a_strip_between_two_wide_areas_still_gets_its_letter() {
        let cells: Vec<_> = (0..41)
            .flat_map(|_| 0..100)
            .map(|column| match column {
                0..=39 => 'a',
                40..=49 => 'b',
                _ => 'c',
            })
            .map(Some)
            .collect();
        let letters = spread(&rooms(&cells, 100), NOWHERE);
        assert!(letters.iter().any(|room| room.class == 'b'), "{letters:?}");
    }

    #[test]
    fn no_letter_hides_the_mark_of_the_start() {
        let cells = vec![Some('a'); 20 * 20];
        let rooms = rooms(&cells, 20);
        assert!(!spread(&rooms, NOWHERE).is_empty());
        for room in spread(&rooms, (9.5, 9.5)) {
            let away = (room.column as f64 - 9.5).abs() >= CLEAR.0
                || (room.row as f64 - 9.5).abs() >= CLEAR.1;
            assert!(away, "{room:?}");
        }
    }

    #[test]
    fn cells_not_computed_yet_have_no_letter() {
        assert!(rooms(&vec![None::<char>; 400], 20).is_empty());
    }
}
