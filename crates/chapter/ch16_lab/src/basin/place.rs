//! Where the sweeps of the experiment are taken.

/// The location of the two sweeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum BasinPlace {
    /// Room A, almost a square: false minima at other headings.
    #[default]
    Room,
    /// In front of a row of equal posts: false minima at other offsets.
    Fence,
}
