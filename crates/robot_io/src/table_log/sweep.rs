//! Beams that become a scan.

use crate::plausible::MAX_BEAMS;
use crate::ros::ScanFields;
use crate::stamps::median;

/// A sweep has at least this many beams.
const FEWEST: usize = 8;
/// A bearing that goes back by this share of the sweep begins the next one.
const BACK: f64 = 0.25;

/// Beams in the order of the file.
#[derive(Clone, Debug, Default)]
pub struct Sweep {
    /// Bearing and range of each beam, in the units of the file.
    beams: Vec<(f64, f64)>,
    /// Times of the first and the last beam, s.
    times_s: Option<(f64, f64)>,
    /// x, y and heading of odometry at the first beam.
    pub pose: [Option<f64>; 3],
}

impl Sweep {
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

    /// Whether a beam at this bearing belongs to the next sweep.
    pub fn is_before(&self, angle: f64) -> bool {
        let (Some(first), Some(last)) = (self.beams.first(), self.beams.last()) else {
            return false;
        };
        let extent = last.0 - first.0;
        self.beams.len() >= 2 && (angle - last.0) * extent.signum() < -BACK * extent.abs()
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
