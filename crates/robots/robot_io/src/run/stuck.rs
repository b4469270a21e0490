//! Odometry that stands still for a while although the robot drives.

use crate::remark::{NO_ODOMETRY, Part, Remark};

/// Fewer poor scans may be people who walk past a robot at rest.
const ENOUGH_SCANS: usize = 5;

/// Consecutive scans between which odometry does not move.
#[derive(Clone, Copy, Debug, Default)]
struct Stretch {
    first_s: f64,
    last_s: f64,
    scans: usize,
    poor: usize,
}

/// The stretch with the most scans that do not fit the map.
#[derive(Clone, Debug, Default)]
pub(super) struct StuckOdometry {
    now: Stretch,
    worst: Stretch,
}

impl StuckOdometry {
    /// Takes the next scan: whether odometry stands still since the one before, and whether the scan fits poorly.
    pub fn add(&mut self, stamp_s: f64, stands: bool, is_poor: bool) {
        if !stands {
            self.now = Stretch::default();
            return;
        }
        let now = &mut self.now;
        if now.scans == 0 {
            now.first_s = stamp_s;
        }
        now.last_s = stamp_s;
        now.scans += 1;
        now.poor += usize::from(is_poor);
        if now.poor > self.worst.poor {
            self.worst = *now;
        }
    }

    /// A remark if most scans of a stretch fit poorly: a robot at rest sees what it has just mapped.
    pub fn remark(&self) -> Option<Remark> {
        let Stretch {
            first_s,
            last_s,
            scans,
            poor,
        } = self.worst;
        (poor >= ENOUGH_SCANS && 2 * poor > scans).then(|| {
            let text = format!(
                "odometry stands still from {first_s:.2} to {last_s:.2} s, where {poor} of {scans} scans do not fit the map, as if the wheels were not counted while the robot drove; check their driver, or map with {NO_ODOMETRY}"
            );
            Remark::wrong(Part::Odometry, text).with_option(NO_ODOMETRY)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn remark(scans: impl IntoIterator<Item = (bool, bool)>) -> Option<String> {
        let mut stuck = StuckOdometry::default();
        for (number, (stands, is_poor)) in scans.into_iter().enumerate() {
            stuck.add(number as f64, stands, is_poor);
        }
        stuck.remark().map(|remark| remark.text)
    }

    #[test]
    fn odometry_that_stands_while_scans_do_not_fit_is_named() {
        let drives = [(false, false); 10];
        let stuck = [(true, true); 8];
        let said = remark(drives.into_iter().chain(stuck).chain(drives)).unwrap();
        assert!(
            said.contains("from 10.00 to 17.00 s, where 8 of 8"),
            "{said}"
        );
        // Poor scans while it drives, or a few of many at rest.
        assert_eq!(remark([(false, true); 20]), None);
        let rest = (0..40).map(|scan| (true, scan % 4 == 0));
        assert_eq!(remark(rest), None);
    }
}
