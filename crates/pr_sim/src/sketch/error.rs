//! Why a text is no flat, in one sentence each.

use thiserror::Error;

/// Why a text of a link cannot be read as a flat.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum SketchError {
    /// The text is not what was once written.
    #[error(
        "the flat is damaged or cut off: copy its whole link, or open the file that it was saved as"
    )]
    Damaged,
    /// Another version wrote it.
    #[error("the flat was written by a newer version: reload the page, or open its file")]
    Newer,
    /// Nobody could draw it.
    #[error(
        "the flat has more than {walls} walls or {way_points} way points, or one more than {coordinate_m} m from the origin: leave some out",
        walls = super::limits::WALLS,
        way_points = super::limits::WAY_POINTS,
        coordinate_m = super::limits::COORDINATE_M
    )]
    TooLarge,
}
