//! All names that the chapter prints, for `use ch16_listings::prelude::*`: its tests compile as printed.

pub use nalgebra::{Matrix2, Matrix3, Point2, Vector2, Vector3};

pub use crate::*;
