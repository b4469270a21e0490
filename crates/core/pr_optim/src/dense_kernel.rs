//! The two dense operations that factorize a front.
//!
//! Matrices are column-major slices with a leading dimension. Tiles are six rows by three columns: two block
//! rows of one block column, nine pairs of numbers that stay in registers in the inner loop. The order of
//! operations for every number is independent of the machine's vector width, so all targets give the same
//! bits.

/// `target −= A Bᵀ` for one block column, or `target = −A Bᵀ` if `OVERWRITE` is set.
///
/// `panel` holds the columns of A, each `height` long; A is their rows from `first_row` on, B their rows
/// `first_row..first_row + 3`. `target` is three columns, each `target_height` long, of which the last
/// `height − first_row` rows are written.
#[inline]
pub fn subtract_product<const OVERWRITE: bool>(
    target: &mut [f64],
    target_height: usize,
    panel: &[f64],
    height: usize,
    first_row: usize,
) {
    let rows = height - first_row;
    let offset = target_height - rows;
    let (first, rest) = target.split_at_mut(target_height);
    let (second, third) = rest.split_at_mut(target_height);
    let columns = [
        &mut first[offset..],
        &mut second[offset..],
        &mut third[offset..target_height],
    ];
    let mut row = 0;
    let [x, y, z] = columns;
    while row + 6 <= rows {
        subtract_tile::<6, OVERWRITE>([&mut *x, &mut *y, &mut *z], row, panel, height, first_row);
        row += 6;
    }
    if row < rows {
        subtract_tile::<3, OVERWRITE>([x, y, z], row, panel, height, first_row);
    }
}

#[inline]
fn subtract_tile<const ROWS: usize, const OVERWRITE: bool>(
    columns: [&mut [f64]; 3],
    row: usize,
    panel: &[f64],
    height: usize,
    first_row: usize,
) {
    let [x, y, z] = columns.map(|column| {
        let tile: &mut [f64; ROWS] = (&mut column[row..row + ROWS])
            .try_into()
            .expect("a tile has ROWS rows");
        tile
    });
    let (mut a, mut b, mut c) = if OVERWRITE {
        ([0.0; ROWS], [0.0; ROWS], [0.0; ROWS])
    } else {
        (*x, *y, *z)
    };
    for column in panel.chunks_exact(height) {
        let factor: &[f64; 3] = column[first_row..first_row + 3]
            .try_into()
            .expect("three rows of B");
        let tile: &[f64; ROWS] = column[first_row + row..first_row + row + ROWS]
            .try_into()
            .expect("a tile of A");
        for k in 0..ROWS {
            a[k] -= tile[k] * factor[0];
            b[k] -= tile[k] * factor[1];
            c[k] -= tile[k] * factor[2];
        }
    }
    (*x, *y, *z) = (a, b, c);
}

/// Factorizes the 3×3 block at `first_row` of three columns and divides the rows below by it.
///
/// `columns` is three columns, each `height` long. Writes the reciprocals of the diagonal to
/// `reciprocal`. Returns `false` if a pivot is not positive.
#[inline]
pub fn factorize_columns(
    columns: &mut [f64],
    height: usize,
    first_row: usize,
    reciprocal: &mut [f64],
) -> bool {
    let (x, rest) = columns.split_at_mut(height);
    let (y, z) = rest.split_at_mut(height);
    let (x, y, z) = (
        &mut x[first_row..],
        &mut y[first_row..],
        &mut z[first_row..height],
    );
    let xx = x[0];
    let inverse_x = 1.0 / pr_geom::math::sqrt(xx);
    let (yx, zx) = (x[1] * inverse_x, x[2] * inverse_x);
    let yy = y[1] - yx * yx;
    let inverse_y = 1.0 / pr_geom::math::sqrt(yy);
    let zy = (y[2] - yx * zx) * inverse_y;
    let zz = z[2] - zx * zx - zy * zy;
    let inverse_z = 1.0 / pr_geom::math::sqrt(zz);
    // Written to reject a NaN pivot too.
    if !(xx > 0.0 && yy > 0.0 && zz > 0.0) {
        return false;
    }
    reciprocal.copy_from_slice(&[inverse_x, inverse_y, inverse_z]);
    for ((x, y), z) in x.iter_mut().zip(y.iter_mut()).zip(z.iter_mut()) {
        let a = *x * inverse_x;
        let b = (*y - a * yx) * inverse_y;
        let c = (*z - a * zx - b * zy) * inverse_z;
        (*x, *y, *z) = (a, b, c);
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pseudo-random numbers, so that a wrong index cannot match by chance.
    fn numbers(count: usize) -> Vec<f64> {
        (0..count)
            .map(|k| ((7 * k * k + 3 * k + 1) % 23) as f64 - 11.0)
            .collect()
    }

    #[test]
    fn product_agrees_with_the_sum_over_all_columns() {
        // Nine rows below the first three: a tile of six and one of three.
        let (height, first_row, columns) = (15, 3, 6);
        let rows = height - first_row;
        let panel = numbers(columns * height);
        let start = numbers(3 * height);
        let mut subtracted = start.clone();
        subtract_product::<false>(&mut subtracted, height, &panel, height, first_row);
        let mut overwritten = vec![f64::NAN; 3 * rows];
        subtract_product::<true>(&mut overwritten, rows, &panel, height, first_row);
        for column in 0..3 {
            for row in 0..rows {
                let product: f64 = (0..columns)
                    .map(|k| &panel[k * height..(k + 1) * height])
                    .map(|values| values[first_row + row] * values[first_row + column])
                    .sum();
                // Whole numbers below 2⁵³: no rounding.
                let place = column * height + first_row + row;
                assert_eq!(subtracted[place], start[place] - product);
                assert_eq!(overwritten[column * rows + row], -product);
            }
            // Rows above the product are left alone.
            assert_eq!(
                subtracted[column * height..column * height + first_row],
                start[column * height..column * height + first_row]
            );
        }
    }

    #[test]
    fn columns_times_their_transpose_give_the_block_back() {
        let height = 6;
        let block = [
            [25.0, 15.0, -5.0, 10.0, 5.0, 0.0],
            [15.0, 18.0, 0.0, 1.0, 2.0, 3.0],
            [-5.0, 0.0, 11.0, 4.0, -6.0, 8.0],
        ];
        let mut columns = block.concat();
        let mut reciprocal = [0.0; 3];
        assert!(factorize_columns(&mut columns, height, 0, &mut reciprocal));
        let factor = |row: usize, column: usize| {
            if row < column {
                0.0
            } else {
                columns[column * height + row]
            }
        };
        for (column, expected) in block.iter().enumerate() {
            assert!((reciprocal[column] * factor(column, column) - 1.0).abs() < 1e-15);
            for (row, expected) in expected.iter().enumerate() {
                let product: f64 = (0..3).map(|k| factor(row, k) * factor(column, k)).sum();
                assert!((product - expected).abs() < 1e-13, "{row} {column}");
            }
        }
    }

    #[test]
    fn a_pivot_that_is_not_positive_or_not_a_number_fails() {
        for bad in [0.0, -1.0, f64::NAN] {
            let mut columns = vec![1.0, 0.0, 0.0, 0.0, bad, 0.0, 0.0, 0.0, 1.0];
            assert!(!factorize_columns(&mut columns, 3, 0, &mut [0.0; 3]));
        }
    }
}
