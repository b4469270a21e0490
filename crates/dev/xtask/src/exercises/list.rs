//! The exercises, their order and their files.

use std::fs;
use std::path::PathBuf;

use crate::run::root;

/// An order of the exercises.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Plan {
    /// As they are numbered.
    #[default]
    List,
    /// As in the lab of teaching/guide/lectures.md, the two for homework at the end.
    Lab,
}

impl Plan {
    /// Places in [`EXERCISES`].
    pub fn order(self) -> [usize; EXERCISES.len()] {
        match self {
            Self::List => [0, 1, 2, 3, 4, 5, 6],
            Self::Lab => [0, 5, 2, 3, 4, 1, 6],
        }
    }
}

/// The exercises in their order, each with a hint.
pub const EXERCISES: [(&str, &str); 7] = [
    (
        "svd_align",
        "Subtract both means first; then only a rotation is left to find, and t follows from the means.",
    ),
    (
        "point_to_plane_step",
        "Sum the outer products of the rows, add the ridge, solve. Then turn about the centroid, not the origin.",
    ),
    (
        "residual",
        "Z⁻¹ comes first in the product. SE2 has inverse, log and adjoint; the product is `*`.",
    ),
    (
        "gauss_newton",
        "Each edge adds four 3×3 blocks and two 3-vectors; skip the held node's, and give it a diagonal.",
    ),
    (
        "verify_loop",
        "The belief is in the candidate's frame: T₀ = T_candidate⁻¹ T_node. The gate compares T̂ with T₀, not with the world.",
    ),
    (
        "trimmed_icp",
        "Trim after each association, the first one too. Count what is kept with ceil, and keep at least one.",
    ),
    (
        "range_histogram",
        "A bin is the range times 64/max_range, rounded down, 63 at most. Skip bins that are empty in both.",
    ),
];

/// The student's file.
pub fn source(exercise: &str) -> PathBuf {
    root().join(format!("teaching/exercises/src/{exercise}.rs"))
}

/// Whether the file still contains the original stub.
pub fn is_untouched(exercise: &str) -> bool {
    fs::read_to_string(source(exercise)).is_ok_and(|text| text.contains("not_written("))
}
