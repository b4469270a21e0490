//! Corrects the stamps of a stream of messages by their neighbours and by the time of recording.
//!
//! | fault | correction |
//! |---|---|
//! | stamp of zero | the time of recording, shifted by the clocks' median offset |
//! | one stamp for all messages | the time of recording |
//! | stamp far from its neighbours | the same, or interpolated if no time was recorded |
//! | clock that steps (reset of simulated time, NTP) | later stamps are shifted back by the step |
//! | equal stamps, as in a log with six digits | spread evenly up to the next stamp |
//!
//! Swapped messages keep their stamps; they are sorted later.

mod remarks;

use pr_geom::sort_numbers;

/// Number of stamps on each side that a stamp is compared with.
const NEIGHBOURS: usize = 5;
/// A stamp closer than this to the median of its neighbours is accepted, s.
const MIN_OFF_S: f64 = 0.5;
/// The same in periods of the stream.
const MIN_OFF_PERIODS: f64 = 8.0;
/// Smaller steps back are swapped messages, s.
pub const MIN_STEP_S: f64 = 1.0;
/// Smallest step that the time of recording can show, s, and in multiples of the jitter.
const MIN_STEP_BY_RECORD_S: f64 = 0.15;
const JITTERS: f64 = 8.0;
/// Messages with coarse stamps are assumed to be at most this far apart, s.
const LONGEST_SPREAD_S: f64 = 1.0;

/// A step of a clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClockStep {
    /// Index of the first message after it.
    pub at: usize,
    /// Size of the step, s; negative if the clock went back.
    pub by_s: f64,
}

/// Corrected stamps, and what was corrected.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MendedStamps {
    /// Stamp of each message, s.
    pub stamps_s: Vec<f64>,
    /// Number of messages without a stamp.
    pub unset: usize,
    /// The stamp that all messages have, s, if their times of recording show that it is not theirs.
    pub only_s: Option<f64>,
    /// Number of messages whose stamp was far from its neighbours.
    pub outliers: usize,
    /// Number of messages with the stamp of the one before.
    pub equal: usize,
    /// Clock steps that were removed.
    pub steps: Vec<ClockStep>,
    /// Number of messages that follow one with a later stamp.
    pub swapped: usize,
    /// Median time between messages, s.
    pub period_s: f64,
    /// Median of stamp minus time of recording, s; `None` if the file has no time of recording.
    pub ahead_s: Option<f64>,
}

impl MendedStamps {
    /// Corrects the stamps (s) of messages in the order of the file; `recorded_s` is their time of recording, NaN if
    /// unknown. A stamp that is not positive is unset.
    #[must_use]
    pub fn new(stamps_s: &[f64], recorded_s: &[f64]) -> Self {
        // Times of recording that are all equal carry no information.
        let is_same = recorded_s.windows(2).all(|two| two[0] == two[1]);
        let recorded_s = if is_same && recorded_s.len() > 1 {
            &[]
        } else {
            recorded_s
        };
        let only_s = only_stamp_s(stamps_s).filter(|_| !recorded_s.is_empty());
        let no_stamps = vec![f64::NAN; stamps_s.len()];
        let stamps_s = only_s.map_or(stamps_s, |_| &no_stamps[..]);
        let mut work = Work::new(stamps_s, recorded_s);
        work.find_outliers();
        let steps = work.remove_steps();
        let unset = work.is_unset.iter().filter(|&&unset| unset).count();
        let outliers = work.is_good.iter().filter(|&&good| !good).count() - unset;
        let unset = if only_s.is_some() { 0 } else { unset };
        work.fill();
        let equal = spread_equal(&mut work.stamps_s);
        let swapped = swapped(&work.stamps_s);
        Self {
            period_s: period_s(&work.stamps_s),
            ahead_s: ahead_s(&work.stamps_s, recorded_s),
            stamps_s: work.stamps_s,
            unset,
            only_s,
            outliers,
            equal,
            steps,
            swapped,
        }
    }

    /// Shifts these stamps by the steps of another stream of the same clock, because each stream locates a step only to
    /// within its own period.
    pub fn apply_steps_of(&mut self, other: &Self) {
        if self.steps.len() != other.steps.len() {
            return;
        }
        for (own, other_step) in self.steps.clone().into_iter().zip(&other.steps) {
            let off_s = own.by_s - other_step.by_s;
            if off_s.abs() <= 2.0 * (self.period_s + other.period_s) {
                self.stamps_s[own.at..]
                    .iter_mut()
                    .for_each(|stamp_s| *stamp_s += off_s);
            }
        }
    }

    /// Whether nothing was corrected.
    #[must_use]
    pub fn is_unchanged(&self) -> bool {
        self.unset + self.outliers + self.equal == 0
            && self.only_s.is_none()
            && self.steps.is_empty()
    }
}

struct Work<'a> {
    stamps_s: Vec<f64>,
    recorded_s: &'a [f64],
    is_unset: Vec<bool>,
    is_good: Vec<bool>,
    /// Whether the times of recording carry information beyond the stamps.
    is_recorded: bool,
}

impl<'a> Work<'a> {
    fn new(stamps_s: &[f64], recorded_s: &'a [f64]) -> Self {
        let is_unset: Vec<bool> = stamps_s
            .iter()
            .map(|&stamp_s| !(stamp_s > 0.0 && stamp_s.is_finite()))
            .collect();
        let is_good = is_unset.iter().map(|unset| !unset).collect();
        let pairs = stamps_s.iter().zip(recorded_s).zip(&is_unset);
        let mut known = pairs.filter(|((_, recorded_s), _)| recorded_s.is_finite());
        let is_recorded = known
            .any(|((stamp_s, recorded_s), unset)| *unset || (stamp_s - recorded_s).abs() > 1e-6);
        Self {
            stamps_s: stamps_s.to_vec(),
            recorded_s,
            is_unset,
            is_good,
            is_recorded,
        }
    }

    fn recorded(&self, at: usize) -> Option<f64> {
        let recorded_s = self.recorded_s.get(at).copied()?;
        (self.is_recorded && recorded_s.is_finite()).then_some(recorded_s)
    }

    /// Median of stamp minus time of recording over the good stamps of a range, s.
    fn ahead_s(&self, from: usize, to: usize) -> Option<f64> {
        let range = from..to.min(self.stamps_s.len());
        let ahead = range.filter(|&at| self.is_good[at]).filter_map(|at| {
            let recorded_s = self.recorded(at)?;
            Some(self.stamps_s[at] - recorded_s)
        });
        median(ahead.collect())
    }

    fn find_outliers(&mut self) {
        let good: Vec<usize> = (0..self.stamps_s.len())
            .filter(|&at| self.is_good[at])
            .collect();
        let stamps: Vec<f64> = good.iter().map(|&at| self.stamps_s[at]).collect();
        let far_s = (MIN_OFF_PERIODS * period_s(&stamps)).max(MIN_OFF_S);
        let all_ahead_s = self.ahead_s(0, self.stamps_s.len());
        let mut outliers = Vec::new();
        for (k, &at) in good.iter().enumerate() {
            let from = k.saturating_sub(NEIGHBOURS);
            let around = &stamps[from..stamps.len().min(k + NEIGHBOURS + 1)];
            let (before, after) = around.split_at(k - from);
            let stamp_s = stamps[k];
            let typical_s = median(around.to_vec()).unwrap_or(stamp_s);
            if (stamp_s - typical_s).abs() <= far_s {
                continue;
            }
            // A pause of the recording is no fault: stamps in order are accepted unless the time of recording
            // contradicts them and the next stamp does not.
            let is_inverted = before.iter().any(|&other_s| other_s > stamp_s + far_s)
                || after.iter().any(|&other_s| other_s < stamp_s - far_s);
            let is_reset = self.is_step_back(&stamps, k);
            let off_s = self.recorded(at).zip(all_ahead_s);
            let is_off = off_s.is_some_and(|(recorded_s, ahead_s)| {
                (stamp_s - recorded_s - ahead_s).abs() > far_s
                    && after
                        .get(1)
                        .is_none_or(|&next_s| (next_s - stamp_s).abs() > far_s)
            });
            if is_inverted && !is_reset || is_off && (after.len() <= 2 || before.len() <= 1) {
                outliers.push(at);
            }
        }
        for at in outliers {
            self.is_good[at] = false;
        }
    }

    /// Whether stamp `k` is close to a step back: all stamps on one side are later than those on the other.
    fn is_step_back(&self, stamps: &[f64], k: usize) -> bool {
        let near = k.saturating_sub(NEIGHBOURS)..(k + NEIGHBOURS).min(stamps.len());
        near.filter(|&cut| cut > 0).any(|cut| {
            let before = &stamps[cut.saturating_sub(NEIGHBOURS)..cut];
            let after = &stamps[cut..stamps.len().min(cut + NEIGHBOURS)];
            let is_wide = before.len() >= NEIGHBOURS && after.len() >= NEIGHBOURS;
            is_wide && lowest(before) > highest(after) + MIN_STEP_S
        })
    }

    /// Median change of stamp minus time of recording from one message to the next, s.
    fn jitter_s(&self, good: &[usize]) -> f64 {
        let ahead = good
            .iter()
            .filter_map(|&at| Some(self.stamps_s[at] - self.recorded(at)?));
        let ahead: Vec<f64> = ahead.collect();
        let changes = ahead.windows(2).map(|two| (two[1] - two[0]).abs());
        median(changes.collect()).unwrap_or(0.0)
    }

    /// Finds steps of the clock and shifts the stamps after them.
    fn remove_steps(&mut self) -> Vec<ClockStep> {
        let good: Vec<usize> = (0..self.stamps_s.len())
            .filter(|&at| self.is_good[at])
            .collect();
        let period_s = period_s(&good.iter().map(|&at| self.stamps_s[at]).collect::<Vec<_>>());
        let original: Vec<f64> = self.stamps_s.clone();
        let least_s = (JITTERS * self.jitter_s(&good)).max(MIN_STEP_BY_RECORD_S);
        let mut steps = Vec::new();
        for k in 1..good.len() {
            let (last, now) = (good[k - 1], good[k]);
            let moved_s = original[now] - original[last];
            let before = &good[k.saturating_sub(NEIGHBOURS)..k];
            let after = &good[k..good.len().min(k + NEIGHBOURS)];
            let ahead = |of: &[usize]| {
                let ahead = of
                    .iter()
                    .filter_map(|&at| Some(original[at] - self.recorded(at)?));
                median(ahead.collect())
            };
            let by_record = ahead(before)
                .zip(ahead(after))
                .map(|(old_s, new_s)| new_s - old_s);
            let recorded_s = self.recorded(now).zip(self.recorded(last));
            let by_record = by_record.filter(|by_s| {
                // The stamps must jump while the recording continues as before: a delayed recorder is no step.
                let jumps = (moved_s - period_s - by_s).abs() < 0.5 * by_s.abs();
                let off_s = (moved_s - period_s).abs();
                let is_steady = recorded_s
                    .is_none_or(|(now_s, last_s)| 2.0 * (now_s - last_s - period_s).abs() < off_s);
                jumps && is_steady && by_s.abs() >= least_s
            });
            let stamps = |of: &[usize]| of.iter().map(|&at| original[at]).collect::<Vec<_>>();
            let goes_back = lowest(&stamps(before)) > highest(&stamps(after)) + MIN_STEP_S;
            let Some(by_s) = by_record.or(goes_back.then_some(moved_s - period_s)) else {
                continue;
            };
            steps.push(ClockStep { at: now, by_s });
            for stamp_s in &mut self.stamps_s[now..] {
                *stamp_s -= by_s;
            }
        }
        steps
    }

    /// Assigns stamps to the messages without a good one.
    fn fill(&mut self) {
        let all_ahead_s = self.ahead_s(0, self.stamps_s.len());
        let filled: Vec<(usize, f64)> = (0..self.stamps_s.len())
            .filter(|&at| !self.is_good[at])
            .filter_map(|at| {
                let from = at.saturating_sub(4 * NEIGHBOURS);
                let ahead_s = self.ahead_s(from, at + 4 * NEIGHBOURS + 1).or(all_ahead_s);
                let by_record = self.recorded(at);
                let stamp_s = match by_record {
                    Some(recorded_s) => Some(recorded_s + ahead_s.unwrap_or(0.0)),
                    None => self.between_neighbours(at),
                };
                Some((at, stamp_s.or_else(|| self.recorded_s.get(at).copied())?))
            })
            .collect();
        for (at, stamp_s) in filled {
            self.stamps_s[at] = stamp_s;
        }
    }

    fn between_neighbours(&self, at: usize) -> Option<f64> {
        let before = (0..at).rev().find(|&other| self.is_good[other]);
        let after = (at..self.stamps_s.len()).find(|&other| self.is_good[other]);
        match (before, after) {
            (Some(before), Some(after)) => {
                let share = (at - before) as f64 / (after - before) as f64;
                let (from_s, to_s) = (self.stamps_s[before], self.stamps_s[after]);
                Some(from_s + share * (to_s - from_s))
            }
            (Some(other), None) | (None, Some(other)) => {
                let periods = at as f64 - other as f64;
                let good = (0..self.stamps_s.len()).filter(|&other| self.is_good[other]);
                let stamps: Vec<f64> = good.map(|other| self.stamps_s[other]).collect();
                Some(self.stamps_s[other] + periods * period_s(&stamps))
            }
            (None, None) => None,
        }
    }
}

/// Median of stamp minus time of recording, s. Both are sorted, which ignores swapped messages.
fn ahead_s(stamps_s: &[f64], recorded_s: &[f64]) -> Option<f64> {
    let known = stamps_s.iter().zip(recorded_s);
    let known = known.filter(|(stamp_s, recorded_s)| (**stamp_s - **recorded_s).is_finite());
    let (mut stamps, mut recorded): (Vec<f64>, Vec<f64>) = known.unzip();
    sort_numbers(&mut stamps);
    sort_numbers(&mut recorded);
    let ahead = stamps
        .iter()
        .zip(&recorded)
        .map(|(stamp_s, recorded_s)| stamp_s - recorded_s);
    median(ahead.collect())
}

/// Spreads runs of equal stamps evenly; returns how many stamps were equal to the one before.
///
/// Up to one in twenty is left unchanged: a duplicate scan is no fault of the clock.
fn spread_equal(stamps_s: &mut [f64]) -> usize {
    let equal = stamps_s.windows(2).filter(|two| two[0] == two[1]).count();
    if equal * 20 < stamps_s.len() || stamps_s.len() < 3 {
        return 0;
    }
    let mut from = 0;
    let mut last_s = f64::NEG_INFINITY;
    while from < stamps_s.len() {
        let start_s = stamps_s[from];
        let run = stamps_s[from..]
            .iter()
            .take_while(|&&stamp_s| stamp_s == start_s);
        let count = run.count();
        let next_s = stamps_s.get(from + count).copied();
        let room_s = next_s.map_or(f64::INFINITY, |next_s| next_s - start_s);
        let step_s = (room_s / count as f64).min(LONGEST_SPREAD_S);
        let step_s = if step_s > 0.0 {
            step_s
        } else {
            LONGEST_SPREAD_S
        };
        let start_s = start_s.max(last_s + 1e-3);
        for (k, stamp_s) in stamps_s[from..from + count].iter_mut().enumerate() {
            *stamp_s = start_s + k as f64 * step_s;
        }
        last_s = stamps_s[from + count - 1];
        from += count;
    }
    equal
}

/// The stamp that all messages have, if there are more than two.
fn only_stamp_s(stamps_s: &[f64]) -> Option<f64> {
    let first = stamps_s.first().copied().filter(|first| *first > 0.0)?;
    let is_same = stamps_s.len() > 2 && stamps_s.iter().all(|stamp_s| *stamp_s == first);
    is_same.then_some(first)
}

/// Number of stamps below the maximum of those before them.
fn swapped(stamps_s: &[f64]) -> usize {
    let mut newest_s = f64::NEG_INFINITY;
    let late = stamps_s.iter().filter(|&&stamp_s| {
        let is_late = stamp_s < newest_s;
        newest_s = newest_s.max(stamp_s);
        is_late
    });
    late.count()
}

/// Median time between increasing stamps, s; 0 of fewer than two.
pub(crate) fn period_s(stamps_s: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = stamps_s.iter().copied().filter(|s| s.is_finite()).collect();
    sort_numbers(&mut sorted);
    let steps = sorted.windows(2).map(|two| two[1] - two[0]);
    median(steps.filter(|&step_s| step_s > 0.0).collect()).unwrap_or(0.0)
}

fn lowest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

fn highest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

/// Upper median.
pub(crate) fn median(mut values: Vec<f64>) -> Option<f64> {
    sort_numbers(&mut values);
    values.get(values.len() / 2).copied()
}

#[cfg(test)]
mod tests;
