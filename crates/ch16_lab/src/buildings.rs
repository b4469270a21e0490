//! Simulated recordings of office buildings, and how the defaults for robots do on them.
//!
//! A building is drawn from a seed: corridors, rooms with open and closed doors, furniture, glass. A
//! robot drives through it with a scan every few decimetres; its wheels slip, drift and jump, beams
//! pass through glass, people walk by. What it records is all that the estimator sees. A [`Trial`]
//! runs [`SlamConfig::for_robot`](ch16_slam2d::slam::SlamConfig::for_robot) on it and compares the
//! keyframes with the truth.
//!
//! What it cannot show: floors that tilt, walls that are not straight, and what nobody thought of.

pub mod kinds;
mod plan;
mod recording;
mod robots;
mod trial;

pub use kinds::{Kind, recorded, recorded_by};
pub use plan::{BuildingConfig, BuildingPlan, Layout, Rooms};
pub use recording::{Mounting, RecordedFrame, Recorder, Recording};
pub use robots::Robot;
pub use trial::{Trial, TrialLoops};
