//! Finding the nearest map point within τ: cells as wide as τ, and the nine around the query.
//!
//! ```sh
//! cargo run -p ch16_slam2d --example find_the_nearest
//! ```

use std::collections::HashMap;

use ch16_slam2d::prelude::*;

/// Points by the cell that they lie in.
pub type Cells = HashMap<(i32, i32), Vec<Point2<f64>>>;

fn cell_of(point: Point2<f64>, tau_m: f64) -> (i32, i32) {
    let index = |at: f64| (at / tau_m).floor() as i32;
    (index(point.x), index(point.y))
}

/// Sorts points into cells as wide as τ.
pub fn cells(points: &[Point2<f64>], tau_m: f64) -> Cells {
    let mut cells = Cells::new();
    for &point in points {
        cells.entry(cell_of(point, tau_m)).or_default().push(point);
    }
    cells
}

/// The point nearest to `query`, if one is closer than τ: no such point lies beyond the nine cells.
pub fn nearest(cells: &Cells, query: Point2<f64>, tau_m: f64) -> Option<Point2<f64>> {
    let (i, j) = cell_of(query, tau_m);
    let (mut found, mut least_m2) = (None, tau_m * tau_m);
    for cell in (i - 1..=i + 1).flat_map(|i| (j - 1..=j + 1).map(move |j| (i, j))) {
        for &point in cells.get(&cell).into_iter().flatten() {
            let distance_m2 = (point - query).norm_squared();
            if distance_m2 < least_m2 {
                (found, least_m2) = (Some(point), distance_m2);
            }
        }
    }
    found
}

/// A wall along x, a point every 10 cm, m.
pub fn wall() -> Vec<Point2<f64>> {
    let along = (0..20).map(|k| 0.1 * f64::from(k));
    along.map(|x| Point2::new(x, 0.0)).collect()
}

/// Prints the nearest wall point of some queries.
pub fn main() {
    let tau_m = 0.5;
    let cells = cells(&wall(), tau_m);
    for query in [Point2::new(0.43, 0.2), Point2::new(0.43, 0.6)] {
        match nearest(&cells, query, tau_m) {
            Some(partner) => println!("{query}: its partner is {partner}"),
            None => println!("{query}: no partner within {tau_m} m"),
        }
    }
}
