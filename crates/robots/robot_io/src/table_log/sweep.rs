//! Beams that become a scan.

use core::f64::consts::TAU;

use crate::plausible::MAX_BEAMS;
use crate::ros::ScanFields;
use crate::stamps::median;

/// A sweep has at least this many beams.
const FEWEST: usize = 8;
/// A bearing that goes back by this share of the sweep begins the next one.
const BACK: f64 = 0.25;

/// Beams in the order of the file.
#[derive(Clone, Debug, Default)]
pub struct BeamBuffer {
    /// Bearing and range of each beam, in the units of the file.
    beams: Vec<(f64, f64)>,
    /// Times of the first and the last beam, s.
    times_s: Option<(f64, f64)>,
    /// A turn in the units of the file, once the sweep passed one.
    turn: Option<f64>,
    /// x, y and heading of odometry at the first beam.
    pub pose: [Option<f64>; 3],
}

impl BeamBuffer {
    /// Adds a beam.
    pub fn add(
        &mut self,
        angle: f64,
        range: f64,
        time_s: Option<f64>,
        pose: [Option<f64>; 3],
    ) -> Result<(), String> {
        if !angle.is_finite() {
            return Err("an angle must be a finite number".to_owned());
        }
        if self.beams.len() >= MAX_BEAMS {
            return Err(format!("a scan has more than {MAX_BEAMS} beams"));
        }
        if self.beams.is_empty() {
            self.pose = pose;
        }
        self.beams.push((angle, range));
        if let Some(time_s) = time_s {
            let (first_s, _) = self.times_s.unwrap_or((time_s, time_s));
            self.times_s = Some((first_s, time_s));
        }
        Ok(())
    }

    /// The bearing of a beam in this sweep, a turn on if it passes the one from which bearings are counted; `None` if
    /// the beam begins the next sweep.
    pub fn bearing(&mut self, angle: f64, time_s: Option<f64>) -> Option<f64> {
        let (Some((first, _)), Some((last, _))) = (self.beams.first(), self.beams.last()) else {
            return Some(angle);
        };
        let extent = last - first;
        let is_back =
            self.beams.len() >= 2 && (angle - last) * extent.signum() < -BACK * extent.abs();
        // Only one time for all beams of a sweep tells a sweep from the next one.
        let one_s = self.times_s.filter(|(first_s, last_s)| first_s == last_s);
        match one_s.filter(|_| self.beams.len() >= FEWEST) {
            None => (!is_back).then_some(angle),
            Some((one_s, _)) if time_s != Some(one_s) => None,
            Some(_) if !is_back => Some(angle),
            Some(_) => {
                // Bearings of radians are less than a turn until one is passed.
                let is_in_degrees = last.abs().max(angle.abs()) > 1.02 * TAU;
                let turn = if is_in_degrees { 360.0 } else { TAU };
                let turn = *self.turn.get_or_insert(turn);
                let on = angle + turn * extent.signum();
                ((on - first).abs() < 0.999 * turn).then_some(on)
            }
        }
    }

    /// Time of the first beam, s.
    pub fn first_s(&self) -> Option<f64> {
        self.times_s.map(|(first_s, _)| first_s)
    }

    /// The fields of the scan; `None` if there are too few beams.
    pub fn fields(&self, is_clockwise: bool) -> Option<ScanFields> {
        if self.beams.len() < FEWEST {
            return None;
        }
        let (first, last) = (self.beams[0].0, self.beams[self.beams.len() - 1].0);
        let gaps = self.beams.windows(2).map(|two| (two[1].0 - two[0].0).abs());
        let step = median(gaps.filter(|gap| *gap > 0.0).collect())?;
        let steps = ((last - first).abs() / step).round();
        // Beams of another order than that of their bearings are no sweep.
        if !(steps >= 1.0 && steps < 4.0 * self.beams.len() as f64 && steps < MAX_BEAMS as f64) {
            return None;
        }
        let step = (last - first) / steps;
        let mut ranges_m = vec![0.0; steps as usize + 1];
        for &(angle, range) in &self.beams {
            let at = ((angle - first) / step).round();
            if let Some(slot) = ranges_m.get_mut(at.max(0.0) as usize)
                && range > 0.0
                && (*slot == 0.0 || range < *slot)
            {
                *slot = range;
            }
        }
        let duration_s = self
            .times_s
            .map_or(0.0, |(first_s, last_s)| last_s - first_s);
        let sign = if is_clockwise { -1.0 } else { 1.0 };
        Some(ScanFields {
            angle_min: sign * first,
            angle_max: sign * last,
            angle_increment: sign * step,
            time_increment: duration_s / steps,
            ranges_m,
            ..ScanFields::default()
        })
    }
}
