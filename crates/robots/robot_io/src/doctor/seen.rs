//! What the frames show by themselves: times without scans or odometry, and beams that never return.

use super::{Checkup, OdometrySummary};
use crate::log::LogNotes;
use crate::plural::plural;
use crate::remark::{Part, Remark};
use crate::stamps::median;

/// A longer time between two scans is a pause, s, if it is this many times longer than usual.
const PAUSE_S: f64 = 10.0;
const PAUSE_PERIODS: f64 = 20.0;
/// Without odometry, scans are missing if the time between two is longer than this many usual ones.
const GAP_PERIODS: f64 = 5.0;
/// A beam that never returns in fewer scans is not named.
const ENOUGH_SCANS: usize = 20;

impl Checkup {
    /// The usual time between two scans, s.
    fn period_s(&self) -> Option<f64> {
        median(self.gaps.iter().map(|gap| gap.0).collect())
    }

    /// Times without a scan that are much longer than usual.
    fn long_gaps(&self) -> impl Iterator<Item = &(f64, f64, bool)> {
        let most_s = self
            .period_s()
            .map_or(f64::INFINITY, |usual_s| GAP_PERIODS * usual_s);
        self.gaps.iter().filter(move |gap| gap.0 > most_s)
    }

    /// The longest time in which the scans have no odometry, if others have some.
    pub(super) fn uncovered_remark(&self, odometry: &OdometrySummary) -> Option<Remark> {
        let least_s = GAP_PERIODS * self.period_s()?;
        let runs = self
            .gaps
            .chunk_by(|a, b| a.2 == b.2)
            .filter(|run| !run[0].2);
        let runs = runs.map(|run| (run[0].1, run[run.len() - 1].1));
        let (from_s, to_s) = runs.max_by(|a, b| (a.1 - a.0).total_cmp(&(b.1 - b.0)))?;
        (to_s - from_s > least_s).then(|| {
            let text = format!(
                "{:.0}% of the scans have odometry; the longest time without is {:.1} s, from {from_s:.2} to {to_s:.2} s, where scans are matched alone",
                100.0 * odometry.covered,
                to_s - from_s
            );
            Remark::mended(Part::Odometry, text)
        })
    }

    /// The beams that never have a return, as the end of a sentence.
    pub(super) fn dead_beams(&self) -> String {
        let dead: Vec<usize> = (0..self.returns.len())
            .filter(|&beam| self.returns[beam] == 0)
            .collect();
        // A beam of few scans may meet nothing.
        let (Some(first), Some(last)) = (dead.first(), dead.last()) else {
            return String::new();
        };
        if dead.len() == self.returns.len() || self.info.scans < ENOUGH_SCANS {
            return String::new();
        }
        if last - first + 1 == dead.len() {
            return format!("; beams {first} to {last} never return");
        }
        format!(
            "; {} of the beams never return, the first is beam {first}",
            dead.len()
        )
    }

    /// Times without a scan in which nothing measures the motion.
    pub(super) fn gaps_remark(&self) -> Option<Remark> {
        let gaps = || self.long_gaps().filter(|gap| !gap.2);
        let (_, first_s, _) = gaps().next()?;
        let longest_s = gaps().fold(0.0, |longest: f64, gap| longest.max(gap.0));
        let text = format!(
            "scans are missing {} for up to {longest_s:.1} s, first before {first_s:.2} s, and without odometry nothing measures the motion meanwhile; record odometry, or keep the connection that loses the scans",
            plural(gaps().count(), "time")
        );
        Some(Remark::mended(Part::Clocks, text))
    }

    /// The order of the stamps, and the longest gap that nothing else says.
    pub(super) fn clocks_remark(&self, notes: &LogNotes, is_said: bool) -> Option<Remark> {
        let mut warnings = notes.warnings.iter();
        if warnings.any(|remark| remark.part == Part::Clocks) {
            return None;
        }
        if self.info.late > 0 {
            let text = format!("{} scans are not later than the one before", self.info.late);
            return Some(Remark::wrong(Part::Clocks, text));
        }
        let mut text = format!(
            "all stamps are in order, over {:.1} s",
            self.info.duration_s
        );
        let longest = self.long_gaps().max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((gap_s, at_s, _)) = longest.filter(|gap| gap.2 && !is_said) {
            text.push_str(&format!(
                "; the longest time without a scan is {gap_s:.1} s before {at_s:.2} s, and odometry measures it"
            ));
        }
        Some(Remark::good(Part::Clocks, text))
    }

    /// The longest pause, in which the robot may have been carried.
    pub(super) fn pause_remark(&self) -> Option<Remark> {
        // The first of equal ones.
        let longest = self.gaps.iter().rev().max_by(|a, b| a.0.total_cmp(&b.0));
        let &(gap_s, at_s, _) = longest?;
        let usual_s = (self.info.duration_s - gap_s) / self.info.scans.max(1) as f64;
        (gap_s > PAUSE_S && gap_s > PAUSE_PERIODS * usual_s).then(|| {
            let text = format!(
                "there is no scan for {gap_s:.0} s before {at_s:.2} s; if the robot was carried meanwhile, what follows is mapped separately until it is found on the map"
            );
            Remark::mended(Part::Clocks, text)
        })
    }
}
