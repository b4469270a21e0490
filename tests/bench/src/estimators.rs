//! Laps by other estimators than the chapter's, so that their bits are compared as well.

use ch16_lab::ancestor::{Ancestor, AncestorTrace};
use ch16_lab::lap::{Drive, LapConfig, LapRecord, LapRunner};
use ch16_slam2d::submaps::FrontEndChoice;

use crate::{Run, prepared};

/// The canonical lap on submaps, simulated and estimated.
pub(crate) fn submaps_lap() -> Box<dyn Run> {
    prepared(
        None,
        |record: &mut Option<LapRecord>| {
            let config = LapConfig::default().with_front_end(FrontEndChoice::Submaps);
            // A runner that has driven before would leave the simulation out.
            *record = Some(LapRunner::new().run(&config));
        },
        |record, digest| {
            if let Some(record) = record {
                digest.add_bits(record.digest());
            }
        },
    )
}

/// The ancestor on the frames of the canonical lap.
pub(crate) fn ancestor_lap(ancestor: Ancestor) -> Box<dyn Run> {
    let config = LapConfig::default();
    let drive = Drive::simulate(&config.drive);
    prepared(
        (ancestor, config, drive, None),
        |(ancestor, config, drive, trace)| {
            *trace = Some(AncestorTrace::run(*ancestor, config, drive));
        },
        |(.., trace), digest| {
            let poses = trace
                .iter()
                .flat_map(|t| t.poses.iter().chain(&t.estimates));
            poses.for_each(|pose| digest.add_pose(pose));
        },
    )
}
