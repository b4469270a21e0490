//! Diagnosis of a recording: sensor, odometry, mounting, clocks and file on one screen.
//!
//! [`Checkup`] takes every frame of a log. What the reader repaired, and what the comparison of scans and odometry
//! found, comes from the log's notes.

mod seen;

use serde::Serialize;

use crate::info::LogInfo;
use crate::log::{LogError, LogFrame, LogNotes, LogOption};
use crate::motion::MotionComparison;
use crate::path_lengths::factor;
use crate::remark::{Condition, Part, Remark};

/// A lower share of returns suggests a covered laser or wrong range limits.
const MIN_VALID: f64 = 0.1;

/// Summary of the scans.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SensorSummary {
    /// Number of scans.
    pub scans: usize,
    /// Most beams of a scan.
    pub beams: usize,
    /// From the first beam to the last, degrees.
    pub field_of_view_deg: f64,
    /// Shortest valid range, m.
    pub range_min_m: f64,
    /// Longest valid range, m; `None` if the sensor states none.
    pub range_max_m: Option<f64>,
    /// Scans per second.
    pub rate_hz: f64,
    /// Share of the beams with a return.
    pub valid: f64,
}

/// Summary of the odometry.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct OdometrySummary {
    /// Topic; `None` in a log of lines.
    pub source: Option<String>,
    /// Poses per second; `None` in a log of lines.
    pub rate_hz: Option<f64>,
    /// Path length, m.
    pub path_m: f64,
    /// Share of the scans with odometry.
    pub covered: f64,
}

/// Diagnosis of a recording.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Diagnosis {
    /// Name of the recording.
    pub name: String,
    /// Worst of the verdicts.
    pub verdict: Condition,
    /// The scans.
    pub sensor: SensorSummary,
    /// The odometry; `None` if there is none.
    pub odometry: Option<OdometrySummary>,
    /// Mounting of the laser, as `--laser` sets it; `None` if each line of the log states it.
    pub laser: Option<String>,
    /// Comparison of scans and odometry.
    pub motion: MotionComparison,
    /// One remark for each check.
    pub remarks: Vec<Remark>,
}

/// Accumulates statistics over the frames of a log.
#[derive(Clone, Debug, Default)]
pub struct Checkup {
    info: LogInfo,
    beams: usize,
    valid: usize,
    covered: usize,
    range_min_m: f64,
    range_max_m: f64,
    last_s: Option<f64>,
    /// The times between scans, s, the stamp of the second one, s, and whether it has odometry.
    gaps: Vec<(f64, f64, bool)>,
    /// Number of returns of each beam.
    returns: Vec<usize>,
    /// Why the rest of the log was not read.
    stopped: Option<String>,
}

impl Checkup {
    /// Adds the next frame.
    pub fn add(&mut self, frame: &LogFrame) {
        self.info.add(frame);
        let gap_s = frame.stamp_s - self.last_s.replace(frame.stamp_s).unwrap_or(frame.stamp_s);
        if gap_s > 0.0 {
            let gap = (gap_s, frame.stamp_s, frame.odometry.is_some());
            self.gaps.push(gap);
        }
        let scan = &frame.scan;
        self.beams += scan.ranges_m.len();
        let most = self.returns.len().max(scan.ranges_m.len());
        self.returns.resize(most, 0);
        for (count, &range_m) in self.returns.iter_mut().zip(&scan.ranges_m) {
            let is_return = usize::from(scan.is_return(range_m));
            *count += is_return;
            self.valid += is_return;
        }
        self.covered += usize::from(frame.odometry.is_some());
        (self.range_min_m, self.range_max_m) = (scan.range_min_m, scan.range_max_m);
    }

    /// Ends the pass where the log could not be read any further.
    pub fn stop(&mut self, problem: &LogError) {
        self.stopped = Some(match problem {
            LogError::Io {
                position, source, ..
            } => format!("{position}: {source}"),
            other => other.to_string(),
        });
    }

    /// Number of scans so far.
    #[must_use]
    pub fn scans(&self) -> usize {
        self.info.scans
    }

    /// The diagnosis of the log with that name.
    #[must_use]
    pub fn finish(&self, name: &str, notes: &LogNotes, motion: &MotionComparison) -> Diagnosis {
        let info = &self.info;
        let per_second = |count: usize| {
            let gaps = count.saturating_sub(1) as f64;
            if info.duration_s > 0.0 {
                gaps / info.duration_s
            } else {
                0.0
            }
        };
        let sensor = SensorSummary {
            scans: info.scans,
            beams: info.most_beams,
            field_of_view_deg: info.field_of_view_deg,
            range_min_m: self.range_min_m,
            range_max_m: self.range_max_m.is_finite().then_some(self.range_max_m),
            rate_hz: per_second(info.scans),
            valid: self.valid as f64 / self.beams.max(1) as f64,
        };
        let odometry = info.odometry_path_length_m.map(|path_m| {
            let taken = notes
                .offers
                .iter()
                .find(|offer| offer.option == LogOption::OdometryTopic);
            let source = taken.and_then(|offer| offer.taken.clone());
            let count = source.as_ref().and_then(|topic| {
                let start = format!("{topic} ");
                let of_topic = notes
                    .records
                    .iter()
                    .find(|(key, _)| key.starts_with(&start));
                of_topic.map(|(_, &count)| count)
            });
            OdometrySummary {
                rate_hz: count.map(per_second),
                source,
                path_m,
                covered: self.covered as f64 / info.scans.max(1) as f64,
            }
        });
        let mut remarks = vec![
            file_remark(notes, self.stopped.as_ref()),
            sensor_remark(&sensor, &self.dead_beams()),
        ];
        let is_faulty = notes
            .warnings
            .iter()
            .any(|remark| remark.part == Part::Odometry);
        let compared = motion.agrees_with_itself() && !is_faulty;
        remarks.push(odometry_remark(
            odometry.as_ref(),
            compared.then_some(motion),
        ));
        remarks.extend(odometry.as_ref().and_then(|it| self.uncovered_remark(it)));
        remarks.extend(mounting_remark(notes, motion, odometry.is_some()));
        let pause = self.pause_remark().or_else(|| self.gaps_remark());
        remarks.extend(self.clocks_remark(notes, pause.is_some()));
        remarks.extend(pause);
        remarks.extend(notes.warnings.iter().cloned());
        let mut diagnosis = Diagnosis {
            name: name.to_owned(),
            verdict: Condition::Good,
            sensor,
            odometry,
            laser: notes.laser.map(|mount| mount.value()),
            motion: motion.clone(),
            remarks: Vec::new(),
        };
        diagnosis.extend(remarks);
        diagnosis
    }
}

fn file_remark(notes: &LogNotes, stopped: Option<&String>) -> Remark {
    let records: usize = notes.records.values().sum();
    let plain = LogNotes {
        broken: notes.broken,
        first_broken: notes.first_broken.clone(),
        truncated: notes.truncated.clone(),
        ended_early: stopped.or(notes.ended_early.as_ref()).cloned(),
        ..LogNotes::default()
    };
    let sentences = plain.sentences("the file").join("; ");
    match (sentences.is_empty(), plain.ended_early.is_some()) {
        (true, _) => Remark::good(Part::File, format!("all {records} records were read")),
        (false, false) => Remark::mended(Part::File, sentences),
        (false, true) => Remark::wrong(Part::File, sentences),
    }
}

fn sensor_remark(sensor: &SensorSummary, dead: &str) -> Remark {
    let reach = sensor
        .range_max_m
        .map_or("no limit".to_owned(), |range_m| format!("{range_m:.1} m"));
    let text = format!(
        "{} scans of {} beams over {:.0}°, from {:.2} m to {reach}, {:.1} scans per second; {:.0}% of the beams have a return{dead}",
        sensor.scans,
        sensor.beams,
        sensor.field_of_view_deg,
        sensor.range_min_m,
        sensor.rate_hz,
        100.0 * sensor.valid
    );
    if sensor.valid < MIN_VALID {
        let text = format!(
            "{text}. Check range_min and range_max, and whether something covers the laser"
        );
        return Remark::wrong(Part::Sensor, text);
    }
    Remark::good(Part::Sensor, text)
}

/// `motion` is the comparison with the scans, if that supports a figure.
fn odometry_remark(
    odometry: Option<&OdometrySummary>,
    motion: Option<&MotionComparison>,
) -> Remark {
    let Some(odometry) = odometry else {
        let text = "there is none; matching scans alone needs a high scan rate and a path without featureless corridors";
        return Remark::mended(Part::Odometry, text.to_owned());
    };
    let source = odometry.source.as_deref().unwrap_or("from the log");
    let mut text = format!("{source}, {:.1} m path length", odometry.path_m);
    if let Some(rate_hz) = odometry.rate_hz {
        text.push_str(&format!(", {rate_hz:.1} poses per second"));
    }
    if let Some((scale, drift)) = motion.and_then(|motion| motion.scale.zip(motion.drift_m_per_m)) {
        text.push_str(&format!(
            "; {scale:.2} m per metre by scans, with a drift of {:.1} cm per metre",
            100.0 * drift
        ));
    }
    let turn_scale = motion.and_then(|motion| motion.turn_scale);
    if let Some(turn) = turn_scale.filter(|turn| *turn > 0.0) {
        text.push_str(&format!("; {turn:.2}° per degree by scans"));
    }
    Remark::good(Part::Odometry, text)
}

fn mounting_remark(
    notes: &LogNotes,
    motion: &MotionComparison,
    has_odometry: bool,
) -> Option<Remark> {
    if notes
        .warnings
        .iter()
        .any(|remark| remark.part == Part::Mounting)
    {
        return None;
    }
    let mount = notes
        .laser
        .map_or("the laser's mounting in the log".to_owned(), |mount| {
            let [x, y, theta] = mount.body_from_sensor.to_array();
            let flipped = if mount.is_flipped {
                ", upside down"
            } else {
                ""
            };
            format!(
                "the laser at {x:.2} m, {y:.2} m, {:.0}°{flipped}",
                theta.to_degrees()
            )
        });
    Some(match (motion.direction_rad, motion.correlation) {
        (Some(direction_rad), Some(correlation)) if motion.confirms_mounting() => Remark::good(
            Part::Mounting,
            format!(
                "{mount} agrees with scans and odometry to {:.1}°, and their turns correlate ({correlation:.2})",
                direction_rad.to_degrees().abs()
            ),
        ),
        (Some(_), Some(correlation)) => Remark::mended(
            Part::Mounting,
            format!(
                "{mount} cannot be checked, because the paths of scans matched alone and of odometry differ too much (correlation of the turns {correlation:.2}, {:.0} cm per metre apart{})",
                100.0 * motion.drift_m_per_m.unwrap_or_default(),
                motion
                    .scale
                    .filter(|scale| !(0.8..=1.25).contains(scale))
                    .map_or(String::new(), |scale| format!(
                        ", odometry {}",
                        factor(scale)
                    ))
            ),
        ),
        _ => Remark::mended(
            Part::Mounting,
            format!(
                "{mount} cannot be checked against odometry, because {}",
                if has_odometry {
                    "the path is too short or has too few turns"
                } else {
                    "there is none"
                }
            ),
        ),
    })
}

impl Diagnosis {
    /// Adds remarks, such as those on the map of the recording.
    pub fn extend(&mut self, remarks: impl IntoIterator<Item = Remark>) {
        self.remarks.extend(remarks);
        self.remarks.sort_by_key(|remark| remark.part);
        let worst = self.remarks.iter().map(|remark| remark.verdict).max();
        self.verdict = worst.unwrap_or(Condition::Good);
    }

    /// Whether the recording has scans that see something.
    #[must_use]
    pub fn can_be_mapped(&self) -> bool {
        self.sensor.scans > 0 && self.sensor.valid > 0.0
    }

    /// The report: one line per remark, under the name of its part.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = format!("{} {}\n", self.verdict.sign(), self.name);
        let mut last = None;
        for remark in &self.remarks {
            let part = match remark.part {
                Part::File => "file",
                Part::Sensor => "sensor",
                Part::Odometry => "odometry",
                Part::Mounting => "mounting",
                Part::Clocks => "clocks",
            };
            let shown = if last == Some(remark.part) { "" } else { part };
            last = Some(remark.part);
            text.push_str(&format!(
                "{} {shown:<9} {}\n",
                remark.verdict.sign(),
                remark.text
            ));
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use ch16_slam2d::scan::LaserScan;
    use pr_geom::SE2;

    use super::*;

    #[test]
    fn missing_odometry_gaps_and_dead_beams_are_said() {
        let text = |has_odometry: fn(u32) -> bool, pause_s: f64| {
            let mut checkup = Checkup::default();
            for k in 0..60 {
                let pause_s = if k < 30 { 0.0 } else { pause_s };
                checkup.add(&LogFrame {
                    stamp_s: 0.2 * f64::from(k) + pause_s,
                    odometry: has_odometry(k).then(|| SE2::from_xy(0.1 * f64::from(k), 0.0)),
                    scan: LaserScan {
                        angle_step_rad: 0.1,
                        ranges_m: vec![1.0, 0.0, 0.0, 2.0],
                        ..LaserScan::default()
                    },
                });
            }
            let notes = LogNotes::default();
            checkup
                .finish("x", &notes, &MotionComparison::default())
                .text()
        };
        let whole = text(|_| true, 0.0);
        assert!(whole.contains("; beams 1 to 2 never return"), "{whole}");
        assert!(!whole.contains("of the scans have odometry"), "{whole}");
        assert!(!whole.contains("longest time without a scan"), "{whole}");
        let half = text(|k| k < 30, 0.0);
        assert!(half.contains("50% of the scans have odometry; the longest time without is 5.8 s, from 6.00 to 11.80 s"), "{half}");
        // Odometry that starts a scan late is no fault.
        assert!(!text(|k| k > 1, 0.0).contains("of the scans have odometry"));
        let gap = text(|_| true, 3.0);
        assert!(
            gap.contains("the longest time without a scan is 3.2 s before 9.00 s"),
            "{gap}"
        );
        assert!(text(|_| false, 0.0).contains("because there is none"));
    }

    #[test]
    fn each_part_has_a_sign_and_a_sentence_and_the_worst_stands_on_top() {
        let mut checkup = Checkup::default();
        for number in 0..3 {
            checkup.add(&LogFrame {
                stamp_s: f64::from(number),
                odometry: Some(SE2::from_xy(f64::from(number), 0.0)),
                scan: LaserScan {
                    angle_step_rad: 0.1,
                    ranges_m: vec![1.0, 0.0],
                    ..LaserScan::default()
                },
            });
        }
        let diagnosis =
            checkup.finish("x.mcap", &LogNotes::default(), &MotionComparison::default());
        assert_eq!(diagnosis.verdict, Condition::Mended);
        assert_eq!(
            (diagnosis.sensor.valid, diagnosis.sensor.rate_hz),
            (0.5, 1.0)
        );
        let text = diagnosis.text();
        assert!(text.starts_with("! x.mcap\n✓ file "), "{text}");
        for part in ["sensor", "odometry", "mounting", "clocks"] {
            assert!(text.contains(&format!(" {part} ")), "{text}");
        }
    }
}
