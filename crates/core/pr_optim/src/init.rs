//! Initial guesses for the poses, from the measurements alone.

mod chordal;
mod spanning_tree;

pub use chordal::chordal;
pub use spanning_tree::spanning_tree;
