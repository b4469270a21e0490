//! Stamps of one stream of messages, judged by their neighbours and by the recording's own time.
//!
//! | fault | what becomes of it |
//! |---|---|
//! | a stamp of zero | the recording's time, moved by the clocks' usual difference |
//! | a stamp far from its neighbours | the same, or between its neighbours where no time was recorded |
//! | a clock that steps (a reset of simulated time, a step of NTP) | what follows is moved back by the step |
//! | several equal stamps, as of a log with six digits | spread evenly up to the next stamp |
//!
//! Two messages that changed places keep their stamps: they are sorted later.

mod told;

use pr_geom::sort_numbers;

/// Stamps on each side that judge one between them.
const NEIGHBOURS: usize = 5;
/// A stamp nearer than this to the median of its neighbours is believed, s.
const LEAST_OFF_S: f64 = 0.5;
/// The same in periods of the stream.
const LEAST_OFF_PERIODS: f64 = 8.0;
/// Smaller steps back are messages that changed places, s.
const LEAST_STEP_S: f64 = 1.0;
/// Where the recording's time shows a step, it may be as small as this, s, and so many times the jitter.
const LEAST_STEP_BY_RECORD_S: f64 = 0.15;
const JITTERS: f64 = 8.0;
/// Scans of which only coarse stamps are known are taken to be no farther apart, s.
const LONGEST_SPREAD_S: f64 = 1.0;

/// A step of a clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClockStep {
    /// The first message after it.
    pub at: usize,
    /// How far the clock stepped, s; negative where it went back.
    pub by_s: f64,
}

/// Stamps that can be used, and what was done to get them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MendedStamps {
    /// A stamp for each message, s.
    pub stamps_s: Vec<f64>,
    /// Messages whose stamp was not set.
    pub unset: usize,
    /// Messages whose stamp was far from those around it.
    pub outliers: usize,
    /// Messages whose stamp was that of the one before.
    pub equal: usize,
    /// Steps of the clock, which are taken out.
    pub steps: Vec<ClockStep>,
    /// Messages before which one with a later stamp stands.
    pub swapped: usize,
    /// From one message to the next, median, s.
    pub period_s: f64,
    /// Stamp minus the recording's time, median, s; none where the file does not say when they were recorded.
    pub ahead_s: Option<f64>,
}

impl MendedStamps {
    /// Mends the stamps (s) of messages in the order of the file; `recorded_s` is when each was recorded,
    /// NaN where the file does not say. A stamp that is not above zero was not set.
    #[must_use]
    pub fn new(stamps_s: &[f64], recorded_s: &[f64]) -> Self {
        // Times of recording that are all the same say nothing.
        let is_same = recorded_s.windows(2).all(|two| two[0] == two[1]);
        let recorded_s = if is_same && recorded_s.len() > 1 {
            &[]
        } else {
            recorded_s
        };
        let mut work = Work::new(stamps_s, recorded_s);
        work.find_outliers();
        let steps = work.take_steps_out();
        let unset = work.is_unset.iter().filter(|&&unset| unset).count();
        let outliers = work.is_good.iter().filter(|&&good| !good).count() - unset;
        work.fill();
        let equal = spread_equal(&mut work.stamps_s);
        let swapped = swapped(&work.stamps_s);
        Self {
            period_s: period_s(&work.stamps_s),
            ahead_s: ahead_s(&work.stamps_s, recorded_s),
            stamps_s: work.stamps_s,
            unset,
            outliers,
            equal,
            steps,
            swapped,
        }
    }

    /// Moves these stamps by the steps of another stream of the same clock: both stepped by the same, which each
    /// knows only to its own period.
    pub fn take_steps_of(&mut self, other: &Self) {
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

    /// Whether nothing was changed.
    #[must_use]
    pub fn is_unchanged(&self) -> bool {
        self.unset + self.outliers + self.equal == 0 && self.steps.is_empty()
    }
}

struct Work<'a> {
    stamps_s: Vec<f64>,
    recorded_s: &'a [f64],
    is_unset: Vec<bool>,
    is_good: Vec<bool>,
    /// Whether the recording's times tell anything that the stamps do not.
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

    /// How far the good stamps of a range are ahead of the recording, median, s.
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
        let far_s = (LEAST_OFF_PERIODS * period_s(&stamps)).max(LEAST_OFF_S);
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
            // A pause of the recording is no fault: what stands in order is believed, unless the
            // recording's own time contradicts it and the next stamp does not.
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

    /// Whether stamp `k` is near to a step back: those on one side are all later than those on the other.
    fn is_step_back(&self, stamps: &[f64], k: usize) -> bool {
        let near = k.saturating_sub(NEIGHBOURS)..(k + NEIGHBOURS).min(stamps.len());
        near.filter(|&cut| cut > 0).any(|cut| {
            let before = &stamps[cut.saturating_sub(NEIGHBOURS)..cut];
            let after = &stamps[cut..stamps.len().min(cut + NEIGHBOURS)];
            let is_wide = before.len() >= NEIGHBOURS && after.len() >= NEIGHBOURS;
            is_wide && lowest(before) > highest(after) + LEAST_STEP_S
        })
    }

    /// How much the difference of stamps and recorded times changes from one message to the next, median, s.
    fn jitter_s(&self, good: &[usize]) -> f64 {
        let ahead = good
            .iter()
            .filter_map(|&at| Some(self.stamps_s[at] - self.recorded(at)?));
        let ahead: Vec<f64> = ahead.collect();
        let changes = ahead.windows(2).map(|two| (two[1] - two[0]).abs());
        median(changes.collect()).unwrap_or(0.0)
    }

    /// Finds steps of the clock and moves what follows.
    fn take_steps_out(&mut self) -> Vec<ClockStep> {
        let good: Vec<usize> = (0..self.stamps_s.len())
            .filter(|&at| self.is_good[at])
            .collect();
        let period_s = period_s(&good.iter().map(|&at| self.stamps_s[at]).collect::<Vec<_>>());
        let original: Vec<f64> = self.stamps_s.clone();
        let least_s = (JITTERS * self.jitter_s(&good)).max(LEAST_STEP_BY_RECORD_S);
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
                // The stamps have to jump by it while the recording goes on as ever: a recorder that was
                // held up is no step.
                let jumps = (moved_s - period_s - by_s).abs() < 0.5 * by_s.abs();
                let off_s = (moved_s - period_s).abs();
                let goes_on = recorded_s
                    .is_none_or(|(now_s, last_s)| 2.0 * (now_s - last_s - period_s).abs() < off_s);
                jumps && goes_on && by_s.abs() >= least_s
            });
            let stamps = |of: &[usize]| of.iter().map(|&at| original[at]).collect::<Vec<_>>();
            let goes_back = lowest(&stamps(before)) > highest(&stamps(after)) + LEAST_STEP_S;
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

    /// Gives the messages without a good stamp one.
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

/// How far stamps are ahead of the recording's times, median, s: each in its own order, so that messages which
/// changed places count for nothing.
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
/// One in twenty is left as it is: a scan that was sent twice is no fault of the clock.
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

/// Stamps below the highest one before them.
fn swapped(stamps_s: &[f64]) -> usize {
    let mut newest_s = f64::NEG_INFINITY;
    let late = stamps_s.iter().filter(|&&stamp_s| {
        let is_late = stamp_s < newest_s;
        newest_s = newest_s.max(stamp_s);
        is_late
    });
    late.count()
}

/// Median time from one stamp to the next later one, s; 0 of fewer than two.
fn period_s(stamps_s: &[f64]) -> f64 {
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

/// The middle one of some numbers.
pub(crate) fn median(mut values: Vec<f64>) -> Option<f64> {
    sort_numbers(&mut values);
    values.get(values.len() / 2).copied()
}

#[cfg(test)]
mod tests;
