//! Positions, headings and score surface of a window, for display; not counted as work of the search.

use super::{LatticePose, OpenBox, PoseBox, ScanSearch};

impl ScanSearch {
    /// Number of headings of the window.
    #[must_use]
    pub fn headings(&self) -> usize {
        self.lattice.headings as usize
    }

    /// A heading of the window, not wrapped, rad.
    #[must_use]
    pub fn heading_rad(&self, heading: usize) -> f64 {
        self.lattice.heading_rad(heading as i32)
    }

    /// The scores of all positions at one heading, 0 to 1, row by row from the lowest y.
    pub fn scores_at(&self, heading: usize, scores: &mut Vec<f64>) {
        scores.clear();
        let poses = self.poses_at(heading as i32);
        scores.extend(poses.map(|pose| self.share(pose.bound)));
    }

    /// Number of rows and columns of positions at every heading.
    #[must_use]
    pub fn places(&self) -> [usize; 2] {
        [self.lattice.rows as usize, self.lattice.columns as usize]
    }

    /// Extent of the positions, including half a cell all around: lowest x and y, highest x and y, m.
    #[must_use]
    pub fn extent_m(&self) -> [[f64; 2]; 2] {
        let corner = |column: f64, row: f64| [self.lattice.x_m(column), self.lattice.y_m(row)];
        let last = self.lattice.last();
        [
            corner(-0.5, -0.5),
            corner(f64::from(last.column) + 0.5, f64::from(last.row) + 0.5),
        ]
    }

    /// The scores of one row of [`ScanSearch::scores_at`], from the lowest x.
    pub fn row_scores(&self, heading: usize, row: usize) -> impl Iterator<Item = f64> + '_ {
        let at = LatticePose {
            heading: heading as i32,
            row: row as i32,
            column: 0,
        };
        let finest = self.shapes.len() - 1;
        (0..self.lattice.columns).map(move |column| {
            let pose = self.bounded(LatticePose { column, ..at }, finest, 0);
            self.share(pose.bound)
        })
    }

    pub(super) fn pose_box(&self, open: &OpenBox) -> PoseBox {
        let last = self.last_of(open);
        let ends = |first: i32, last: i32, at: &dyn Fn(f64) -> f64| {
            [at(f64::from(first) - 0.5), at(f64::from(last) + 0.5)]
        };
        PoseBox {
            x_m: ends(open.first.column, last.column, &|at| self.lattice.x_m(at)),
            y_m: ends(open.first.row, last.row, &|at| self.lattice.y_m(at)),
            heading_rad: [
                self.lattice.heading_rad(open.first.heading),
                self.lattice.heading_rad(last.heading),
            ],
            bound: self.share(open.bound),
            is_pose: self.shapes[open.shape].is_pose(),
        }
    }
}
