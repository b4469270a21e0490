//! Local maps of keyframes, on which loops are registered.

use core::ops::RangeInclusive;

use super::{LocalMap, MapRegistrationConfig, ScanProfiles};
use crate::slam::Mapper;

/// The submap of the last verification, with what the next ones reuse.
#[derive(Clone)]
pub(super) struct Submaps {
    pub registration: MapRegistrationConfig,
    pub map: LocalMap,
    profiles: ScanProfiles,
}

impl Submaps {
    pub fn new(registration: MapRegistrationConfig) -> Self {
        Self {
            registration,
            map: LocalMap::default(),
            profiles: ScanProfiles::default(),
        }
    }

    /// Builds the map from the keyframes of a range, in the frame of keyframe `center`.
    pub fn build(&mut self, mapper: &Mapper, nodes: RangeInclusive<usize>, center: usize) {
        let poses = mapper.poses();
        let profiles = nodes
            .clone()
            .map(|node| self.profiles.of(mapper.scan(node)));
        let profiles: Vec<_> = profiles.collect();
        self.map
            .rebuild(nodes.zip(&profiles).map(|(node, profile)| {
                let pose = poses[center].between(&poses[node]);
                (pose, &**mapper.scan(node), profile)
            }));
    }

    /// Forgets what is kept for the scans of removed keyframes.
    pub fn forget(&mut self) {
        self.profiles = ScanProfiles::default();
    }
}
