//! The robot's outline, on whose area readings are of itself.

use std::str::FromStr;

use pr_geom::Point2;

/// The rectangle that the robot covers, on its body, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    low: [f64; 2],
    high: [f64; 2],
}

impl FromStr for Footprint {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<f64>> = text
            .split(',')
            .map(|word| word.trim().parse().ok().filter(|n: &f64| n.is_finite()))
            .collect();
        match numbers.as_deref() {
            Some(&[back, right, front, left]) if back < front && right < left => Ok(Self {
                low: [back, right],
                high: [front, left],
            }),
            _ => Err(
                "expected back,right,front,left in metres from the body's origin, such as -0.3,-0.2,0.3,0.2"
                    .to_owned(),
            ),
        }
    }
}

impl Footprint {
    /// Whether a point on the body lies within.
    pub(crate) fn covers(&self, point: Point2<f64>) -> bool {
        [point.x, point.y]
            .into_iter()
            .zip(self.low.into_iter().zip(self.high))
            .all(|(value, (low, high))| low <= value && value <= high)
    }
}
