//! Ranges that can only be in millimetres.

use ch16_slam2d::scan::LaserScan;

use crate::stamps::median;

/// Longer ranges are not in metres.
pub const LONGEST_M: f64 = 400.0;
/// No robot's laser is so far from most of what it sees.
const TYPICAL_M: f64 = 50.0;

/// A sentence on ranges that can only be in millimetres.
pub fn millimetres(ranges: &[f64]) -> Option<String> {
    if !ranges.iter().any(|&range| range > LONGEST_M) {
        return None;
    }
    let returns = ranges.iter().copied();
    let returns = returns.filter(|&range| range.is_finite() && range > 0.0);
    let typical = median(returns.collect()).filter(|&typical| typical > LONGEST_M)?;
    Some(format!(
        "its ranges are about {typical:.0}, in millimetres; they were divided by 1000. Publish metres"
    ))
}

/// A sentence on ranges that are too long for metres and too short for millimetres.
pub fn centimetres(ranges: &[f64]) -> Option<String> {
    let returns = ranges.iter().copied();
    let returns: Vec<f64> = returns
        .filter(|&range| range.is_finite() && range > 0.0)
        .collect();
    let longest = returns.iter().copied().fold(0.0, f64::max);
    let typical = median(returns)?;
    (longest > LONGEST_M && (TYPICAL_M..=LONGEST_M).contains(&typical)).then(|| {
        format!(
            "its ranges are about {typical:.0} and up to {longest:.0}, which look like centimetres: name the unit in the header or in --columns, such as ranges_cm"
        )
    })
}

/// Converts ranges that can only be in millimetres; returns a sentence on it.
pub fn in_metres(scan: &mut LaserScan) -> Option<String> {
    let sentence = millimetres(&scan.ranges_m)?;
    for range in &mut scan.ranges_m {
        *range *= 1e-3;
    }
    (scan.range_min_m, scan.range_max_m) = limits_in_metres(scan.range_min_m, scan.range_max_m);
    Some(sentence)
}

/// The shortest and the longest range of a sensor whose ranges are in millimetres: if the longest is, both are.
pub fn limits_in_metres(min: f64, max: f64) -> (f64, f64) {
    let is_long = |limit: f64| limit.is_finite() && limit > LONGEST_M;
    let scale = |is_millimetres: bool| if is_millimetres { 1e-3 } else { 1.0 };
    (
        min * scale(is_long(min) || is_long(max)),
        max * scale(is_long(max)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_in_millimetres_are_converted_together() {
        let [millimetres, metres, unlimited] =
            [(50.0, 12000.0), (0.05, 12.0), (0.05, f64::INFINITY)]
                .map(|(min, max)| limits_in_metres(min, max));
        assert_eq!(millimetres, (0.05, 12.0));
        assert_eq!(metres, (0.05, 12.0));
        assert_eq!(unlimited, (0.05, f64::INFINITY));
    }
}
