//! Checks the fields of a laser scan against each other.
//!
//! A driver states redundant values: the first and the last angle, the step between two beams and their number; the
//! time of a beam and that of a scan; ranges and their limits. If they are inconsistent, the value on which two of them
//! agree is used and a sentence reports it; otherwise the scan is rejected.

use core::f64::consts::{PI, TAU};

use ch16_slam2d::scan::LaserScan;

use crate::range_unit::{limits_in_metres, millimetres};

/// A sweep is at most a turn, up to the rounding of 32-bit floats and one extra beam.
const FULL_TURN: f64 = 1.02 * TAU;
/// No scanner sees less, degrees: smaller angles that are more than a turn in radians are not degrees either.
const LEAST_VIEW_DEG: f64 = 20.0;
/// A sweep may take this many scan periods: stamps jitter.
pub const SWEEP_SLACK: f64 = 1.3;

/// A sweep of more scan periods has another unit of time.
const MOST_PERIODS: f64 = 50.0;

/// Fields of `sensor_msgs/LaserScan`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScanFields {
    /// Angle of the first beam, rad.
    pub angle_min: f64,
    /// Angle of the last beam, rad.
    pub angle_max: f64,
    /// Angle from one beam to the next, rad.
    pub angle_increment: f64,
    /// Time from one beam to the next, s.
    pub time_increment: f64,
    /// Time between scans, s.
    pub scan_time: f64,
    /// Shorter ranges are no returns, m.
    pub range_min: f64,
    /// Longer ranges are no returns, m.
    pub range_max: f64,
    /// One range per beam, m.
    pub ranges_m: Vec<f64>,
}

/// A scan, and the inconsistencies of its fields.
pub type Checked = (LaserScan, Vec<String>);

impl ScanFields {
    /// Checks the fields; `period_s` is the time between scans, 0 if unknown.
    ///
    /// # Errors
    /// If fields are inconsistent and cannot be corrected.
    pub fn checked(self, period_s: f64) -> Result<Checked, String> {
        if self.ranges_m.is_empty() {
            return Err("a scan must have ranges, and this one has none".to_owned());
        }
        let mut remarks = Vec::new();
        let (first_angle_rad, angle_step_rad) = self.angles(&mut remarks)?;
        let beam_interval_s = self.beam_interval_s(period_s, &mut remarks);
        let (range_min_m, range_max_m, scale) = self.ranges(&mut remarks);
        let mut ranges_m = self.ranges_m;
        if scale != 1.0 {
            ranges_m.iter_mut().for_each(|range_m| *range_m *= scale);
        }
        // No return within the limit, by REP 117: stored as a reading at the limit, which other formats can represent.
        if range_max_m.is_finite() {
            let is_beyond = |range_m: &&mut f64| **range_m == f64::INFINITY;
            ranges_m
                .iter_mut()
                .filter(is_beyond)
                .for_each(|range_m| *range_m = range_max_m);
        }
        let scan = LaserScan {
            first_angle_rad,
            angle_step_rad,
            range_min_m,
            range_max_m,
            beam_interval_s,
            ranges_m,
            ..LaserScan::default()
        };
        Ok((scan, remarks))
    }

    /// First angle and step, rad.
    fn angles(&self, remarks: &mut Vec<String>) -> Result<(f64, f64), String> {
        let beams = self.ranges_m.len();
        let gaps = (beams - 1).max(1) as f64;
        let (min, max, step) = (self.angle_min, self.angle_max, self.angle_increment);
        let has_step = step.is_finite() && step != 0.0;
        let has_ends = min.is_finite() && max.is_finite() && min != max;
        if !has_ends {
            let from = match (min.is_finite(), max.is_finite()) {
                (true, _) => min,
                (false, true) if has_step => max - gaps * step,
                _ => {
                    return Err(format!(
                        "angle_min is {min} and angle_max {max}; set them in the driver"
                    ));
                }
            };
            if !has_step {
                return Err(format!(
                    "angle_increment is {step} and cannot be computed from angle_min and angle_max; set it in the driver"
                ));
            }
            let (from, step) = if is_in_degrees(step * gaps) {
                remarks.push(
                    "its angles are in degrees; they were converted. Publish radians".to_owned(),
                );
                (from.to_radians(), step.to_radians())
            } else {
                (from, step)
            };
            return in_a_turn(from, step, gaps);
        }
        let of_ends = (max - min) / gaps;
        if !has_step {
            remarks.push(format!(
                "angle_increment is {step}; {:.4}° is used, from angle_min, angle_max and {beams} beams",
                of_ends.to_degrees()
            ));
            return in_a_turn(min, of_ends, gaps);
        }
        // The last angle is that of the last beam or of the one after it; either may be in degrees.
        let agrees = |ends: f64, step: f64| {
            (ends - step * gaps).abs() <= 1.5 * step.abs()
                || (ends / (step * gaps) - 1.0).abs() < 0.01
        };
        if agrees(max - min, step) {
            if (step * gaps).abs() <= FULL_TURN {
                return Ok((min, step));
            }
            if !is_in_degrees(step * gaps) {
                return in_a_turn(min, step, gaps);
            }
            remarks
                .push("its angles are in degrees; they were converted. Publish radians".to_owned());
            return in_a_turn(min.to_radians(), step.to_radians(), gaps);
        }
        if agrees(max - min, step.to_radians()) && (max - min).abs() <= FULL_TURN {
            remarks.push(format!(
                "angle_increment is {step}, in degrees; angle_min and angle_max are in radians. Publish radians"
            ));
            return Ok((min, step.to_radians()));
        }
        if agrees((max - min).to_radians(), step) && (step * gaps).abs() <= FULL_TURN {
            remarks.push(format!(
                "angle_min {min} and angle_max {max} are in degrees; angle_increment is in radians. Publish radians"
            ));
            return Ok((min.to_radians(), step));
        }
        let contradiction = |taken: &str| {
            format!(
                "angle_min {:.2}°, angle_max {:.2}° and {beams} beams give a step of {:.4}°, but angle_increment is {:.4}°; {taken}. Correct the driver",
                min.to_degrees(),
                max.to_degrees(),
                of_ends.to_degrees(),
                step.to_degrees()
            )
        };
        if (max - min).abs() <= FULL_TURN {
            remarks.push(contradiction(
                "the step from angle_min and angle_max is used",
            ));
            return Ok((min, of_ends));
        }
        if (step * gaps).abs() <= FULL_TURN {
            remarks.push(contradiction(
                "angle_increment is used, because angle_min and angle_max differ by more than a turn",
            ));
            return Ok((min, step));
        }
        Err(contradiction("neither gives a sweep of at most a turn"))
    }

    /// Time from one beam to the next, s; 0 if the stated value is implausible.
    fn beam_interval_s(&self, period_s: f64, remarks: &mut Vec<String>) -> f64 {
        let stated_s = self.time_increment;
        if !(stated_s.is_finite() && stated_s > 0.0) {
            return 0.0;
        }
        let beams = self.ranges_m.len() as f64;
        let scan_time_s = self.scan_time;
        let is_scan_time = scan_time_s > 0.0 && scan_time_s <= SWEEP_SLACK * period_s;
        let longest_s = match (is_scan_time, period_s > 0.0) {
            (true, _) => SWEEP_SLACK * scan_time_s,
            (false, true) => SWEEP_SLACK * period_s,
            // No laser is slower than one turn in two seconds.
            (false, false) => 2.0,
        };
        if stated_s * beams <= longest_s {
            return stated_s;
        }
        // A unit is accepted if the sweep then takes the scans' period or their scan_time.
        let target_s = if is_scan_time { scan_time_s } else { period_s };
        let units = [
            ("nanoseconds", 1e-9),
            ("microseconds", 1e-6),
            ("milliseconds", 1e-3),
        ];
        let unit = units.into_iter().find(|(_, unit)| {
            let sweep_s = stated_s * unit * beams;
            target_s > 0.0 && (0.7 * target_s..=SWEEP_SLACK * target_s).contains(&sweep_s)
        });
        let stated = format!(
            "time_increment is {stated_s} s, so a sweep would take {:.1} s",
            stated_s * beams
        );
        match unit {
            Some((name, unit)) => {
                remarks.push(format!("{stated}; it is read as {name}, which agrees with the scans' period. Publish seconds"));
                stated_s * unit
            }
            // A unit is wrong by a thousand; a sweep of a few periods is that of a laser whose stamps come too fast.
            None if stated_s * beams <= MOST_PERIODS * period_s => {
                remarks.push(format!(
                    "{stated}, {:.1} times the {period_s:.2} s between stamps; the stamps or time_increment are wrong, and the motion within a sweep is not removed. Stamp each scan when its first beam is measured",
                    stated_s * beams / period_s
                ));
                0.0
            }
            None => {
                remarks.push(format!(
                    "{stated}, but scans are {period_s:.2} s apart; the motion within a sweep is not removed. Correct time_increment in the driver"
                ));
                0.0
            }
        }
    }

    /// Range limits (m), and the factor for all ranges.
    fn ranges(&self, remarks: &mut Vec<String>) -> (f64, f64, f64) {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        let of_millimetres = millimetres(&self.ranges_m);
        let (min, max) = (self.range_min, self.range_max);
        let (scale, (min, max)) = match of_millimetres {
            Some(_) => (1e-3, limits_in_metres(min, max)),
            None => (1.0, (min, max)),
        };
        remarks.extend(of_millimetres);
        let range_min_m = if positive(min) { min } else { 0.0 };
        let range_max_m = if max > 0.0 { max } else { f64::INFINITY };
        if range_max_m <= range_min_m {
            remarks.push(format!(
                "range_min is {min:.3} m and range_max {max:.3} m; the smaller one is used as the shortest range. Correct the driver"
            ));
            return (range_max_m, range_min_m, scale);
        }
        (range_min_m, range_max_m, scale)
    }
}

/// Whether an angle from the first beam to the last is in degrees, not in radians.
fn is_in_degrees(view: f64) -> bool {
    view.abs() > FULL_TURN && view.abs() >= LEAST_VIEW_DEG
}

/// Checks that the angles cover at most a turn.
fn in_a_turn(first: f64, step: f64, gaps: f64) -> Result<(f64, f64), String> {
    if (step * gaps).abs() <= FULL_TURN && first.abs() <= 4.0 * PI && step != 0.0 {
        Ok((first, step))
    } else {
        let turns = (step * (gaps + 1.0)).abs() / TAU;
        let off_beams = (turns - turns.round()).abs() * TAU / step.abs();
        let remedy = if turns.round() >= 2.0 && off_beams <= 1.5 {
            format!("publish each of its {turns:.0} revolutions as a scan")
        } else {
            "correct angle_min, angle_max and angle_increment in the driver".to_owned()
        };
        Err(format!(
            "its beams cover {:.0}°, more than a turn; {remedy}",
            (step * gaps).abs().to_degrees()
        ))
    }
}

#[cfg(test)]
mod tests;
