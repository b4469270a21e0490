//! Positions and labels of axis ticks.

/// Ticks of one axis: evenly spaced round numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Ticks {
    /// Positions, rising.
    pub values: Vec<f64>,
    /// Distance between neighbours.
    pub step: f64,
    /// What stands at 1, 2, … in place of numbers, if anything.
    names: Vec<String>,
}

/// The round numbers of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// 1, 2, 5 times a power of ten.
    Decimal,
    /// Whole round numbers.
    Whole,
    /// Parts of a turn: 5, 10, 15, 30, 45, 60, 90, 180 degrees.
    Degrees,
}

impl Scale {
    /// Degrees if the label contains the unit, whole numbers if it counts steps.
    #[must_use]
    pub fn from_label(label: &str) -> Self {
        if label.contains('°') {
            Scale::Degrees
        } else if label == "step" {
            Scale::Whole
        } else {
            Scale::Decimal
        }
    }
}

impl Ticks {
    /// At most `most` ticks between `min` and `max`, with the smallest round step that allows it.
    #[must_use]
    pub fn new(min: f64, max: f64, most: usize, scale: Scale) -> Self {
        let step = round_step((max - min) / most.max(1) as f64, scale);
        // A value that exceeds the limit by rounding only still belongs to the axis.
        let slack = 1e-9 * step;
        let first = ((min - slack) / step).ceil() as i64;
        let last = ((max + slack) / step).floor() as i64;
        let values = (first..=last).map(|k| k as f64 * step).collect();
        Self {
            values,
            step,
            names: Vec::new(),
        }
    }

    /// A tick at every name that lies between `min` and `max`.
    #[must_use]
    pub fn from_names(names: &[String], min: f64, max: f64) -> Self {
        let places = (1..=names.len()).map(|place| place as f64);
        Self {
            values: places.filter(|at| (min..=max).contains(at)).collect(),
            step: 1.0,
            names: names.to_vec(),
        }
    }

    /// A tick's label, with the digits that the step needs and a true minus sign.
    #[must_use]
    pub fn label(&self, value: f64) -> String {
        if !self.names.is_empty() {
            let place = (value.round() as usize).saturating_sub(1);
            return self.names.get(place).cloned().unwrap_or_default();
        }
        let mut decimals = 0;
        let mut scaled = self.step;
        while decimals < 6 && (scaled - scaled.round()).abs() > 1e-6 * scaled.abs() {
            scaled *= 10.0;
            decimals += 1;
        }
        signed(value, decimals)
    }
}

/// Formats a number with that many digits after the point and a true minus sign, never `−0`.
#[must_use]
pub fn signed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|b| b == b'0' || b == b'.') => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => text,
    }
}

/// The smallest round number that is not below `step`.
fn round_step(step: f64, scale: Scale) -> f64 {
    if !(step.is_finite() && step > 0.0) || (scale == Scale::Whole && step < 1.0) {
        return 1.0;
    }
    if scale == Scale::Degrees && step > 1.0 {
        const PARTS: [f64; 10] = [2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 60.0, 90.0, 180.0, 360.0];
        if let Some(part) = PARTS.into_iter().find(|part| *part >= step) {
            return part;
        }
    }
    let power = 10_f64.powi(step.log10().floor() as i32);
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|round| *round >= step * (1.0 - 1e-9))
        .unwrap_or(10.0 * power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_one_two_five() {
        let ticks = Ticks::new(0.0, 12.0, 7, Scale::Decimal);
        assert_eq!(ticks.values, [0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0]);
        let ticks = Ticks::new(-0.05, 0.31, 4, Scale::Decimal);
        assert_eq!(ticks.step, 0.1);
        assert_eq!(ticks.values.len(), 4);
    }

    #[test]
    fn a_count_of_steps_is_a_whole_number() {
        let ticks = Ticks::new(0.0, 5.0, 10, Scale::from_label("step"));
        assert_eq!(ticks.values, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    }

    #[test]
    fn headings_are_divided_into_parts_of_a_turn() {
        let ticks = Ticks::new(-180.0, 180.0, 5, Scale::Degrees);
        assert_eq!(ticks.values, [-180.0, -90.0, 0.0, 90.0, 180.0]);
        assert_eq!(ticks.label(-90.0), "−90");
    }

    #[test]
    fn labels_carry_the_digits_of_the_step_and_no_negative_zero() {
        let ticks = Ticks::new(-1.3, 1.3, 6, Scale::Decimal);
        assert_eq!(ticks.step, 0.5);
        assert_eq!(ticks.label(-0.0), "0.0");
        assert_eq!(ticks.label(-1.0), "−1.0");
        assert_eq!(signed(-0.001, 2), "0.00");
    }

    #[test]
    fn there_is_at_most_one_tick_too_many() {
        for k in 1..200 {
            let max = 0.037 * f64::from(k * k);
            for most in 2..9 {
                let ticks = Ticks::new(0.0, max, most, Scale::Decimal);
                assert!(ticks.values.len() <= most + 1, "{max} {most}");
            }
        }
    }

    #[test]
    fn an_empty_axis_has_at_most_one_tick() {
        assert!(Ticks::new(1.0, 1.0, 5, Scale::Decimal).values.len() <= 1);
    }
}
