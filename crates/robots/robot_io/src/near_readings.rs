//! Readings that the user declares to be no returns: nearer than a range, or on the robot.

use pr_geom::{Point2, math};

use crate::footprint::Footprint;
use crate::log::{LogError, LogFrame, LogNotes, LogReader};

/// Removes near readings.
pub struct NearReadings<'a> {
    inner: Box<dyn LogReader + 'a>,
    min_range_m: f64,
    footprint: Option<Footprint>,
}

/// A reader without the readings that the user declares to be none.
#[must_use]
pub fn without_near_readings<'a>(
    inner: Box<dyn LogReader + 'a>,
    min_range_m: Option<f64>,
    footprint: Option<Footprint>,
) -> Box<dyn LogReader + 'a> {
    if min_range_m.is_none() && footprint.is_none() {
        return inner;
    }
    Box::new(NearReadings {
        inner,
        min_range_m: min_range_m.unwrap_or(0.0),
        footprint,
    })
}

impl LogReader for NearReadings<'_> {
    fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError> {
        let mut frame = self.inner.next_frame()?;
        if let Some(frame) = &mut frame {
            let scan = &mut frame.scan;
            scan.range_min_m = math::max(scan.range_min_m, self.min_range_m);
            let covered: Vec<usize> = (0..scan.ranges_m.len())
                .filter(|&beam| {
                    let (sin, cos) = math::sin_cos(scan.bearing_rad(beam));
                    let range_m = scan.ranges_m[beam];
                    let end = Point2::new(range_m * cos, range_m * sin);
                    let end = scan.body_from_sensor.transform(end);
                    scan.is_return(range_m)
                        && self
                            .footprint
                            .is_some_and(|footprint| footprint.covers(end))
                })
                .collect();
            for beam in covered {
                scan.ranges_m[beam] = f64::NAN;
            }
        }
        Ok(frame)
    }

    fn notes(&self) -> &LogNotes {
        self.inner.notes()
    }
}

#[cfg(test)]
mod tests {
    use crate::json_log::JsonLogReader;

    use super::*;

    #[test]
    fn readings_on_the_robot_and_nearer_than_the_limit_are_no_returns() {
        // Beams to the front, the left, the back and the right of a laser 0.2 m ahead.
        let line = r#"{"stamp_s":1,"first_angle_rad":0,"angle_step_rad":1.5707963,"body_from_sensor":[0.2,0,0],"ranges_m":[0.4,0.1,0.4,5]}"#;
        let returns = |min_range_m: Option<f64>, footprint: Option<&str>| {
            let reader = Box::new(JsonLogReader::new(line.as_bytes(), "x"));
            let footprint = footprint.map(|text| text.parse().unwrap());
            let mut reader = without_near_readings(reader, min_range_m, footprint);
            let scan = reader.next_frame().unwrap().unwrap().scan;
            let is_return = |beam: &usize| scan.is_return(scan.ranges_m[*beam]);
            (0..4).filter(is_return).collect::<Vec<usize>>()
        };
        assert_eq!(returns(None, None), [0, 1, 2, 3]);
        assert_eq!(returns(Some(0.3), None), [0, 2, 3]);
        assert_eq!(returns(None, Some("-0.3,-0.2,0.3,0.2")), [0, 3]);
        assert!("1,2,3".parse::<Footprint>().is_err());
    }
}
