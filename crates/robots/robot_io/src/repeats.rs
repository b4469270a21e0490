//! Scans that repeat one before them.
//!
//! | repeat | cause |
//! |---|---|
//! | the same ranges and stamp | the scan was recorded twice |
//! | the same ranges while odometry moves | the driver sends its last scan again |

use std::hash::{DefaultHasher, Hash, Hasher};

use ch16_slam2d::metrics::position_error_m;
use ch16_slam2d::scan::LaserScan;
use pr_geom::SE2;

use crate::remark::{Part, Remark};

/// No laser sees the same in all beams after this motion, m or rad.
const MOVED: f64 = 0.05;

/// A scan with fewer different ranges is the same elsewhere by chance.
const FEWEST: usize = 8;

/// A number of the ranges of a scan, equal if they are; `None` if too few of them differ.
pub fn fingerprint(scan: &LaserScan) -> Option<u64> {
    let mut hasher = DefaultHasher::new();
    let ranges = || scan.ranges_m.iter().copied();
    ranges().for_each(|range_m| range_m.to_bits().hash(&mut hasher));
    let mut different: Vec<f64> = Vec::new();
    for range_m in ranges().filter(|&range_m| scan.is_return(range_m)) {
        if !different.contains(&range_m) {
            different.push(range_m);
        }
        if different.len() >= FEWEST {
            return Some(hasher.finish());
        }
    }
    None
}

/// Which scans of a log repeat one before them.
pub struct Repeats {
    /// For each scan.
    pub is_repeat: Vec<bool>,
    twice: usize,
    /// Number of scans that stand still, the first of them, and the motion meanwhile, m.
    still: (usize, usize, f64),
}

impl Repeats {
    /// Compares the scans of a log with these stamps (s), odometry and fingerprints.
    pub fn of(stamps_s: &[f64], odometry: &[Option<SE2>], seen: &[Option<u64>]) -> Self {
        let mut repeats = Self {
            is_repeat: vec![false; seen.len()],
            twice: 0,
            still: (0, 0, 0.0),
        };
        // The last scan that repeats none.
        let mut last = 0;
        for at in 1..seen.len() {
            if seen[at].is_none() || seen[at] != seen[last] {
                last = at;
                continue;
            }
            let moved = odometry[last].zip(odometry[at]);
            let moved = moved.map(|(from, to)| {
                (
                    position_error_m(&from, &to),
                    from.between(&to).theta().abs(),
                )
            });
            if stamps_s[at] == stamps_s[last] {
                repeats.twice += 1;
            } else if let Some((moved_m, _)) =
                moved.filter(|(moved_m, turned)| *moved_m > MOVED || *turned > MOVED)
            {
                let (count, first, most_m) = repeats.still;
                let first = if count == 0 { at } else { first };
                repeats.still = (count + 1, first, most_m.max(moved_m));
            } else {
                continue;
            }
            repeats.is_repeat[at] = true;
        }
        repeats
    }

    /// Leaves out what belongs to a repeat.
    pub fn leave_out<T>(&self, items: &mut Vec<T>) {
        let mut is_repeat = self.is_repeat.iter();
        items.retain(|_| is_repeat.next() != Some(&true));
    }

    /// One remark per kind of repeat.
    pub fn remarks(&self) -> Vec<Remark> {
        let all = self.is_repeat.len();
        let twice = (self.twice > 0).then(|| {
            format!(
                "{} of {all} scans come twice, with the same stamp and ranges; each was used once",
                self.twice
            )
        });
        let (count, first, moved_m) = self.still;
        let still = (count > 0).then(|| {
            format!(
                "{count} scans, first number {first}, are the same as the one before while odometry moves by up to {moved_m:.1} m, as if the driver sent its last scan again; they were left out. Check the laser and its cable"
            )
        });
        let remarks = [(Part::Clocks, twice), (Part::Sensor, still)].into_iter();
        remarks
            .filter_map(|(part, text)| Some(Remark::mended(part, text?)))
            .collect()
    }
}
