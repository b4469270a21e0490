//! Parses and checks numeric arguments; error messages state the range.

use std::num::NonZeroUsize;
use std::ops::RangeInclusive;

/// Largest |offset| of a start, m: the Apartment is 12 m long.
const MAX_OFFSET_M: f64 = 20.0;

/// A finite number.
fn finite(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|value: &f64| value.is_finite())
        .ok_or_else(|| "not a finite number".to_owned())
}

fn within(text: &str, range: RangeInclusive<f64>, unit: &str) -> Result<f64, String> {
    let value = finite(text)?;
    if range.contains(&value) {
        Ok(value)
    } else {
        Err(format!(
            "not within {} to {}{unit}",
            range.start(),
            range.end()
        ))
    }
}

/// A correspondence distance τ in metres.
pub fn tau_m(text: &str) -> Result<f64, String> {
    within(text, 0.01..=10.0, " m")
}

/// Cell size of a map in metres.
pub fn cell_m(text: &str) -> Result<f64, String> {
    within(text, 0.01..=1.0, " m")
}

/// A time to wait in seconds.
pub fn wait_s(text: &str) -> Result<f64, String> {
    within(text, 0.0..=86_400.0, " s")
}

/// A number of laps.
pub fn laps(text: &str) -> Result<usize, String> {
    let range = 1..=10_000;
    let count = text.parse().ok().filter(|count| range.contains(count));
    count.ok_or_else(|| "not within 1 to 10000".to_owned())
}

/// An offset in metres.
pub fn offset_m(text: &str) -> Result<f64, String> {
    within(text, -MAX_OFFSET_M..=MAX_OFFSET_M, " m")
}

/// A share, 0 to 1.
pub fn share(text: &str) -> Result<f64, String> {
    within(text, 0.0..=1.0, "")
}

/// A factor of odometry noise.
pub fn noise_factor(text: &str) -> Result<f64, String> {
    within(text, 0.0..=100.0, "")
}

/// Shifts along each axis of a cost landscape: at least two, and a thousand take seconds.
pub fn shifts(text: &str) -> Result<usize, String> {
    let range = 2..=1001;
    let count = text.parse().ok().filter(|count| range.contains(count));
    count.ok_or_else(|| format!("not an integer from {} to {}", range.start(), range.end()))
}

/// A number of threads.
pub fn threads(text: &str) -> Result<NonZeroUsize, String> {
    let count = text.parse();
    count.map_err(|_| "not a positive integer; omit it to use all cores".to_owned())
}

/// Headings in degrees: one, or `from:to:step` with both ends included.
#[derive(Clone, Debug, PartialEq)]
pub struct Headings(pub Vec<f64>);

/// Most headings of one run.
const MAX_HEADINGS: f64 = 100_000.0;

/// Reads `A` or `A:B:STEP`.
pub fn headings_deg(text: &str) -> Result<Headings, String> {
    let heading = |text: &str| within(text, -360.0..=360.0, "°");
    let parts: Vec<&str> = text.split(':').collect();
    let (from, to, step) = match parts[..] {
        [one] => return Ok(Headings(vec![heading(one)?])),
        [from, to, step] => (heading(from)?, heading(to)?, finite(step)?),
        _ => return Err("expected A or A:B:STEP".to_owned()),
    };
    let count = ((to - from) / step + 1e-9).floor();
    if step == 0.0 || count < 0.0 {
        return Err(format!("a step of {step} does not reach {to} from {from}"));
    }
    if count >= MAX_HEADINGS {
        return Err(format!(
            "a step of {step} gives too many headings; use at most {MAX_HEADINGS}"
        ));
    }
    Ok(Headings(
        (0..=count as u32)
            .map(|k| from + f64::from(k) * step)
            .collect(),
    ))
}

/// Seeds as a half-open or inclusive range, `A..B` or `A..=B`, or a single one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seeds {
    /// The first seed.
    pub first: u32,
    /// The last seed, included.
    pub last: u32,
}

impl Seeds {
    /// Number of seeds.
    #[must_use]
    pub fn count(&self) -> u64 {
        u64::from(self.last) - u64::from(self.first) + 1
    }
}

/// Reads a seed, decimal or with `0x`.
pub fn seed(text: &str) -> Result<u32, String> {
    let parsed = match text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        Some(hex) => u32::from_str_radix(hex, 16),
        None => text.parse(),
    };
    parsed.map_err(|_| format!("not an integer from 0 to {}", u32::MAX))
}

/// Reads `A`, `A..B` or `A..=B`.
pub fn seeds(text: &str) -> Result<Seeds, String> {
    let empty = || "the range of seeds is empty".to_owned();
    let (first, last) = if let Some((first, last)) = text.split_once("..=") {
        (seed(first)?, seed(last)?)
    } else if let Some((first, end)) = text.split_once("..") {
        (seed(first)?, seed(end)?.checked_sub(1).ok_or_else(empty)?)
    } else {
        let one = seed(text)?;
        (one, one)
    };
    if last < first {
        return Err(empty());
    }
    Ok(Seeds { first, last })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_of_headings_has_both_its_ends() {
        assert_eq!(headings_deg("25").unwrap().0, [25.0]);
        assert_eq!(headings_deg("-2:2:2").unwrap().0, [-2.0, 0.0, 2.0]);
        assert_eq!(headings_deg("2:-2:-2").unwrap().0, [2.0, 0.0, -2.0]);
        assert_eq!(headings_deg("-180:180:1").unwrap().0.len(), 361);
        assert_eq!(headings_deg("0:1:0.1").unwrap().0.len(), 11);
        for wrong in [
            "", "x", "1:2", "1:2:0", "1:2:-1", "0:9:inf", "nan", "900", "1:2:3:4",
        ] {
            assert!(headings_deg(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_step_in_the_wrong_direction_differs_from_one_that_is_too_small() {
        let rejected = |text| headings_deg(text).unwrap_err();
        for away in ["0:10:-1", "0:10:0", "10:10:0"] {
            assert!(rejected(away).contains("does not reach"), "{away}");
        }
        for small in ["0:10:1e-9", "0:10:1e-320", "0:100:0.001"] {
            assert!(rejected(small).contains("too many headings"), "{small}");
        }
        assert_eq!(headings_deg("0:99.999:0.001").unwrap().0.len(), 100_000);
        // With equal ends, any step is accepted.
        assert_eq!(headings_deg("3:3:1").unwrap().0, [3.0]);
    }

    #[test]
    fn seeds_are_ranges_as_rust_writes_them() {
        let range = |text| seeds(text).map(|s| (s.first, s.last));
        assert_eq!(range("1..=1000"), Ok((1, 1000)));
        assert_eq!(range("1..5"), Ok((1, 4)));
        assert_eq!(range("0xC0FFEE"), Ok((0x00C0_FFEE, 0x00C0_FFEE)));
        assert_eq!(seeds("0..=4294967295").unwrap().count(), 1 << 32);
        for wrong in ["", "5..5", "5..=4", "0..0", "-1", "1..", "4294967296"] {
            assert!(seeds(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn numbers_out_of_range_and_not_finite_are_rejected() {
        assert_eq!(tau_m("0.7"), Ok(0.7));
        for wrong in ["0", "-1", "inf", "NaN", "11", "0.7m"] {
            assert!(tau_m(wrong).is_err(), "{wrong}");
        }
        assert!(noise_factor("-0.5").is_err());
        assert!(share("1.5").is_err());
        assert!(offset_m("21").is_err());
    }
}
