//! Simulated recordings of office buildings, and the accuracy of the defaults for robots on them.
//!
//! A building is generated from a seed: corridors, rooms with open and closed doors, furniture, glass. A
//! robot drives through it and takes a scan every few decimetres; its odometry slips, drifts and jumps, beams
//! pass through glass, people walk by. The estimator sees only the recording. A [`BuildingRun`] runs
//! [`SlamConfig::for_robot`](ch16_slam2d::slam::SlamConfig::for_robot) on it and compares the keyframes with
//! the truth.
//!
//! Not modelled: tilted floors and curved walls.

pub mod kinds;
mod plan;
mod recording;
mod robots;
mod story;
mod trial;

pub use kinds::{Kind, recorded, recorded_by};
pub use plan::{BuildingConfig, BuildingPlan, Layout, Rooms};
pub use recording::{Mounting, RecordedFrame, Recorder, Recording};
pub use robots::Robot;
pub use story::BuildingStory;
pub use trial::{BuildingRun, TrialLoops};
