//! The free space of scans, computed once for each.

use std::sync::Arc;

use rustc_hash::FxHashMap;

use super::RangeProfile;
use crate::cloud::PointCloud;

/// The range profiles of scans by identity: equal scans at different addresses are different scans.
#[derive(Clone, Debug, Default)]
pub struct ScanProfiles {
    /// By the address of the scan, which stays its own while it is kept here.
    known: FxHashMap<usize, (Arc<PointCloud>, Arc<RangeProfile>)>,
}

impl ScanProfiles {
    /// The profile of a scan.
    pub fn of(&mut self, scan: &Arc<PointCloud>) -> Arc<RangeProfile> {
        let known = self.known.entry(Arc::as_ptr(scan) as usize);
        let (_, profile) =
            known.or_insert_with(|| (Arc::clone(scan), Arc::new(RangeProfile::new(scan))));
        Arc::clone(profile)
    }

    /// Forgets all other scans.
    pub fn keep_only(&mut self, scans: &[Arc<PointCloud>]) {
        self.known
            .retain(|_, (known, _)| scans.iter().any(|scan| Arc::ptr_eq(scan, known)));
    }
}
