//! Accuracy of a trajectory against relations between two times or against the true poses.

mod relation_errors;
mod statistics;
mod truth_errors;

pub use relation_errors::{RelationErrors, RelationReport, relation_errors};
pub use statistics::{PoseErrors, Spread};
pub use truth_errors::{
    Alignment, RelativeErrors, TruthProblem, TruthReport, onto_truth, truth_errors,
};
