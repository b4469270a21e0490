//! What the name of a column means.
//!
//! Case, separators and what it belongs to (`pose.`, `field.`, `odom_`) do not count; its unit is a suffix or in brackets.

use super::{ColumnMeaning, Scaled};

/// What a column of a pose may belong to.
const OF_POSE: [&str; 6] = [
    "pose",
    "odometry",
    "odom",
    "position",
    "robot",
    "orientation",
];
/// What a column of a scan may belong to.
const OF_SCAN: [&str; 4] = ["laserscan", "laser", "lidar", "scan"];
/// What any column may belong to.
const OF_ANY: [&str; 5] = ["field", "header", "message", "msg", "data"];

/// The meaning of a name, and the factor of its unit.
pub fn column(name: &str) -> Scaled {
    let name = name.trim().to_lowercase();
    let (text, bracket) = name.split_once(['[', '(']).unwrap_or((&name, ""));
    let last = bracket.rsplit(['[', '(']).next().unwrap_or_default();
    let of_bracket = unit(last.trim_end_matches([']', ')', ' ']).trim());
    let text = text.trim();
    let is_counted = bracket.starts_with(|c: char| c.is_ascii_digit());
    let whole = meaning(text, is_counted);
    if let Some((column, factor)) = whole {
        return (column, of_bracket.or(factor));
    }
    let of_stem = text.trim_end_matches('_').rsplit_once(['_', ' ']);
    let of_stem = of_stem.and_then(|(stem, suffix)| {
        let factor = unit(suffix)?;
        Some((meaning(stem, is_counted)?.0, Some(factor)))
    });
    of_stem.unwrap_or((ColumnMeaning::Other, of_bracket))
}

/// The factor of a unit.
fn unit(name: &str) -> Option<f64> {
    Some(match name {
        "s" | "sec" | "secs" | "second" | "seconds" | "m" | "meter" | "meters" | "metre"
        | "metres" | "rad" | "radian" | "radians" => 1.0,
        "ms" | "msec" | "milliseconds" | "mm" | "millimeters" | "millimetres" => 1e-3,
        "us" | "µs" | "μs" | "usec" | "microseconds" => 1e-6,
        "ns" | "nsec" | "nanoseconds" => 1e-9,
        "cm" | "centimeters" | "centimetres" => 1e-2,
        "ft" | "feet" => 0.3048,
        "in" | "inch" | "inches" => 0.0254,
        "deg" | "degs" | "degree" | "degrees" | "°" | "grad" => 1.0_f64.to_radians(),
        _ => return None,
    })
}

/// The meaning of a name without its unit, and the factor that it implies; `None` if it is not known. `is_counted`: a number
/// in brackets follows.
fn meaning(name: &str, is_counted: bool) -> Option<Scaled> {
    let key: String = name.chars().filter(|c| c.is_alphanumeric()).collect();
    let (mut key, mut is_of_pose, mut is_of_scan) = (&key[..], false, false);
    loop {
        let without_number = key.trim_end_matches(|c: char| c.is_ascii_digit());
        if (is_counted || without_number.len() < key.len())
            && matches!(
                without_number,
                "range" | "ranges" | "dist" | "distance" | "r" | "d" | "scan" | "beam" | "abstand"
            )
        {
            return Some((ColumnMeaning::Ranges, None));
        }
        if let Some((column, factor)) = word(key) {
            return match column {
                // The laser's place on the robot.
                ColumnMeaning::X | ColumnMeaning::Y | ColumnMeaning::Heading if is_of_scan => None,
                ColumnMeaning::Angle if is_of_pose => Some((ColumnMeaning::Heading, factor)),
                _ => Some((column, factor)),
            };
        }
        let strip = |owners: &[&str]| owners.iter().find_map(|owner| key.strip_prefix(owner));
        let (of_pose, of_scan) = (strip(&OF_POSE), strip(&OF_SCAN));
        is_of_pose |= of_pose.is_some();
        is_of_scan |= of_scan.is_some();
        key = of_pose.or(of_scan).or_else(|| strip(&OF_ANY))?;
    }
}

/// The meaning of a whole word.
fn word(key: &str) -> Option<Scaled> {
    // The seconds and nanoseconds of a stamp have names of their own.
    let part = ["timestamp", "stamp", "time"]
        .iter()
        .find_map(|owner| key.strip_prefix(owner));
    let part = part.filter(|part| !part.is_empty()).unwrap_or(key);
    let column = match part {
        "sec" | "secs" | "seconds" => ColumnMeaning::Seconds,
        "nanosec" | "nanosecs" | "nsec" | "nsecs" | "nanoseconds" => ColumnMeaning::Nanoseconds,
        "millis" | "milliseconds" => return Some((ColumnMeaning::Time, Some(1e-3))),
        "micros" | "microseconds" => return Some((ColumnMeaning::Time, Some(1e-6))),
        _ => match key {
            "time" | "stamp" | "timestamp" | "t" | "ts" | "datetime" | "zeit" | "temps" => {
                ColumnMeaning::Time
            }
            "angle" | "theta" | "bearing" | "winkel" => ColumnMeaning::Angle,
            "range" | "distance" | "dist" | "abstand" => ColumnMeaning::Range,
            "ranges" | "distances" => ColumnMeaning::Ranges,
            "angles" | "bearings" => ColumnMeaning::Angles,
            "quality" | "q" => ColumnMeaning::Quality,
            "x" => ColumnMeaning::X,
            "y" => ColumnMeaning::Y,
            "heading" | "yaw" => ColumnMeaning::Heading,
            "orientationx" | "qx" | "quatx" => ColumnMeaning::OrientationX,
            "orientationy" | "qy" | "quaty" => ColumnMeaning::OrientationY,
            "orientationz" | "qz" | "quatz" => ColumnMeaning::OrientationZ,
            "orientationw" | "qw" | "quatw" => ColumnMeaning::OrientationW,
            "anglemin" | "minangle" | "startangle" | "firstangle" | "startwinkel" => {
                ColumnMeaning::AngleMin
            }
            "anglemax" | "maxangle" | "endangle" => ColumnMeaning::AngleMax,
            "angleincrement" | "anglestep" | "angleinc" | "angularresolution" | "winkelschritt" => {
                ColumnMeaning::AngleIncrement
            }
            "timeincrement" => ColumnMeaning::TimeIncrement,
            "scantime" => ColumnMeaning::ScanTime,
            "rangemin" | "minrange" => ColumnMeaning::RangeMin,
            "rangemax" | "maxrange" => ColumnMeaning::RangeMax,
            "sensor" | "sensorid" | "sensorname" | "frameid" | "laser" | "lidar" | "lidarid"
            | "device" | "topic" => ColumnMeaning::Sensor,
            _ => return None,
        },
    };
    Some((column, None))
}

/// Decides what follows from the columns together: of two with one meaning one is read, and an angle beside x and y is the
/// heading unless it is the bearing of a range.
pub fn settle(columns: &mut [Scaled], names: &[&str]) {
    use ColumnMeaning::{
        Angle, Heading, OrientationW, OrientationX, OrientationY, OrientationZ, Other, Range, Time,
        X, Y,
    };
    let count =
        |columns: &[Scaled], of: ColumnMeaning| columns.iter().filter(|it| it.0 == of).count();
    let has = |columns: &[Scaled], of| count(columns, of) > 0;
    let is_turned = has(columns, Heading) || has(columns, OrientationW);
    if has(columns, X)
        && has(columns, Y)
        && !is_turned
        && count(columns, Angle) > count(columns, Range).min(1)
        && let Some(angle) = columns.iter_mut().find(|it| it.0 == Angle)
    {
        angle.0 = Heading;
    }
    // A bag's own stamp is better than the time of recording before it, and odometry than a pose that was estimated.
    for one in [
        Time,
        X,
        Y,
        Heading,
        OrientationX,
        OrientationY,
        OrientationZ,
        OrientationW,
    ] {
        if count(columns, one) < 2 {
            continue;
        }
        let is_better = |at: usize| {
            let name = names[at].to_ascii_lowercase();
            name.ends_with("header.stamp") || name.starts_with("odom")
        };
        let all = || (0..columns.len()).filter(|&at| columns[at].0 == one);
        let best = all().find(|&at| is_better(at)).or_else(|| all().next());
        for (at, column) in columns.iter_mut().enumerate() {
            if column.0 == one && Some(at) != best {
                column.0 = Other;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_count_without_case_separators_owners_and_units() {
        use ColumnMeaning::{
            AngleIncrement, AngleMin, Heading, Nanoseconds, OrientationZ, Other, Ranges, ScanTime,
            Seconds, Time, X,
        };
        let degree = Some(1.0_f64.to_radians());
        for (name, expected) in [
            ("Timestamp [ms]", (Time, Some(1e-3))),
            ("time_us", (Time, Some(1e-6))),
            ("stamp_ns", (Time, Some(1e-9))),
            ("millis", (Time, Some(1e-3))),
            ("field.header.stamp.secs", (Seconds, None)),
            ("stamp_nanosec", (Nanoseconds, None)),
            ("X [mm]", (X, Some(1e-3))),
            ("pose.position.x", (X, None)),
            ("poseX", (X, None)),
            ("pose_theta", (Heading, None)),
            ("Heading (°)", (Heading, degree)),
            ("pose.pose.orientation.z", (OrientationZ, None)),
            ("angleMin", (AngleMin, None)),
            ("angle_increment [deg]", (AngleIncrement, degree)),
            ("ranges[12]", (Ranges, None)),
            ("range 12 [mm]", (Ranges, Some(1e-3))),
            ("ranges_12_cm", (Ranges, Some(1e-2))),
            ("beam7_ft", (Ranges, Some(0.3048))),
            ("scan_time", (ScanTime, None)),
            ("laser_x", (Other, None)),
            ("colour", (Other, None)),
        ] {
            assert_eq!(column(name), expected, "{name}");
        }
    }
}
