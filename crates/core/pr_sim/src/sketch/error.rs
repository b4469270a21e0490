//! Errors of a floor plan in a link, one sentence each.

use thiserror::Error;

/// Why the text of a link cannot be read as a floor plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SketchError {
    /// The text was damaged or truncated.
    #[error(
        "the flat is damaged or cut off: copy its whole link, or open the file that it was saved as"
    )]
    Damaged,
    /// A newer version wrote it.
    #[error("the flat was written by a newer version: reload the page, or open its file")]
    Newer,
    /// It exceeds the limits.
    #[error(
        "the flat has more than {walls} walls or {way_points} waypoints, or one more than {coordinate_m} m from the origin: leave some out",
        walls = super::limits::WALLS,
        way_points = super::limits::WAY_POINTS,
        coordinate_m = super::limits::COORDINATE_M
    )]
    TooLarge,
}
