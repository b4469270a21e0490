//! Mounting of a planar laser on the body.

use std::str::FromStr;

use ch16_slam2d::scan::LaserScan;
use pr_geom::SE2;

use crate::lines::finite;
use crate::plausible::plausible_pose;

/// Pose of a planar laser on the body, and whether its axis points up or down.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LaserMount {
    /// Pose of the sensor on the body, in the plane.
    pub body_from_sensor: SE2,
    /// Whether its beams turn clockwise seen from above: it is mounted upside down, or its driver reverses them.
    pub is_flipped: bool,
}

impl LaserMount {
    /// Sets the mounting of a scan, and reverses its beams if needed.
    pub fn apply(&self, scan: &mut LaserScan) {
        scan.body_from_sensor = self.body_from_sensor;
        if self.is_flipped {
            flip(scan);
        }
    }

    /// The command line option that sets it: `--laser 0.1,0,180,flipped`.
    #[must_use]
    pub fn option(&self) -> String {
        format!("--laser {}", self.value())
    }

    /// The value of that option.
    #[must_use]
    pub fn value(&self) -> String {
        let [x, y, theta] = self.body_from_sensor.to_array();
        let flipped = if self.is_flipped { ",flipped" } else { "" };
        // Rounds, and avoids negative zero.
        let tidy = |value: f64, scale: f64| (value * scale).round() / scale + 0.0;
        format!(
            "{},{},{}{flipped}",
            tidy(x, 1e3),
            tidy(y, 1e3),
            tidy(theta.to_degrees(), 10.0)
        )
    }
}

/// Reverses the order of the beams.
pub fn flip(scan: &mut LaserScan) {
    scan.first_angle_rad = -scan.first_angle_rad;
    scan.angle_step_rad = -scan.angle_step_rad;
}

impl FromStr for LaserMount {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || {
            "the laser's mounting must be x,y,degrees, with ,flipped if it is upside down, such as 0.1,0,180".to_owned()
        };
        let mut fields = text.split(',').map(str::trim);
        let mut number = |name| finite(fields.next(), name).map_err(|_| expected());
        let (x, y, heading) = (number("x")?, number("y")?, number("degrees")?);
        let is_flipped = match fields.next() {
            None => false,
            Some("flipped") => true,
            Some(_) => return Err(expected()),
        };
        if fields.next().is_some() {
            return Err(expected());
        }
        Ok(Self {
            body_from_sensor: plausible_pose(SE2::new(x, y, heading.to_radians()))?,
            is_flipped,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mounting_reads_back_from_the_option_that_sets_it() {
        for text in ["0.1,-0.05,180", "0,0,0,flipped", "0.25,0,-90.5"] {
            let mount: LaserMount = text.parse().unwrap();
            assert_eq!(mount.option(), format!("--laser {text}"));
        }
        for text in [
            "",
            "1,2",
            "1,2,x",
            "1,2,3,turned",
            "1,2,3,flipped,4",
            "1e99,0,0",
        ] {
            assert!(text.parse::<LaserMount>().is_err(), "{text}");
        }
    }
}
