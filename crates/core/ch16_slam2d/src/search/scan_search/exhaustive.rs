//! Exhaustive search: scores every pose of the window, as reference for branch and bound.

use core::cmp::Ordering;

use super::{LatticePose, OpenBox, ScanSearch};
use crate::search::{SearchCounts, SearchResult};

impl ScanSearch {
    /// Computes the same result by scoring every pose of the window.
    #[must_use]
    pub fn exhaustive(&self) -> SearchResult {
        let better = |champion: Option<OpenBox>, pose: OpenBox| match champion {
            Some(champion) if pose.promise(&champion) != Ordering::Greater => champion,
            _ => pose,
        };
        let best = self
            .all_poses()
            .fold(None, |best, pose| Some(better(best, pose)));
        let best = best.expect("a window has a pose");
        let elsewhere = self
            .all_poses()
            .filter(|pose| !self.is_same_place(&best, pose));
        let runner_up = elsewhere.fold(None, |best, pose| Some(better(best, pose)));
        SearchResult {
            best: self.scored(&best),
            runner_up: runner_up.map(|pose| self.scored(&pose)),
            counts: SearchCounts {
                bounds: 0,
                poses: self.lattice.len(),
                window: self.lattice.len(),
            },
        }
    }

    /// Every pose of the window with its score, in the order that decides among equals.
    fn all_poses(&self) -> impl Iterator<Item = OpenBox> + '_ {
        (0..self.lattice.headings).flat_map(|heading| self.poses_at(heading))
    }

    pub(super) fn poses_at(&self, heading: i32) -> impl Iterator<Item = OpenBox> + '_ {
        let at = move |row: i32, column: i32| LatticePose {
            heading,
            row,
            column,
        };
        let (rows, columns) = (self.lattice.rows, self.lattice.columns);
        (0..rows).flat_map(move |row| {
            (0..columns).map(move |column| self.bounded(at(row, column), self.shapes.len() - 1, 0))
        })
    }
}
