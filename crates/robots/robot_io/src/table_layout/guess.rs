//! What the columns of a table without known names may be, as a proposal for the user to check.

use super::{column, list, number, words};
use crate::stamps::median;
use crate::table_layout::ColumnMeaning;

/// Number of lines that are looked at.
pub const LINES: usize = 12;
/// A row of a beam has fewer columns.
const MOST_OF_BEAM: usize = 8;
/// Evenly spaced angles of this step or more are degrees: beams are less than 7° apart.
const STEP_DEG: f64 = 0.12;
/// No laser of a robot sees farther, m: longer ranges are millimetres.
const FARTHEST_M: f64 = 150.0;
/// Readings are rarely this near, of the typical one.
const NEAR: f64 = 0.05;
/// Largest quality that drivers state.
const MOST_QUALITY: f64 = 255.0;

/// How the lines may be read, as the end of a sentence.
pub fn advice(lines: &[String]) -> String {
    if are_points(lines) {
        return "its rows are points x, y, not beams: write each as a bearing atan2(y, x) and a range hypot(x, y) as the laser sees it, under a header such as time,angle_rad,range_m".to_owned();
    }
    match proposal(lines) {
        Some(columns) => {
            let count = lines.first().map_or(0, |line| words(line).count());
            let angles = if columns.contains('@') {
                ", with the first and the last angle of the laser, in degrees,"
            } else {
                ""
            };
            format!(
                "if its {count} columns are what they seem to be, pass --columns {columns}{angles} and check the map"
            )
        }
        None => "if it is a table, name its columns with --columns, such as time_s,ranges_m@-90:90 or angle_deg,range_mm".to_owned(),
    }
}

/// Whether the first line names x and y of something, and no heading.
fn are_points(lines: &[String]) -> bool {
    let names: Vec<String> = match lines.first() {
        Some(line) => words(line).map(str::to_lowercase).collect(),
        None => return false,
    };
    let is_turned = |name: &String| column(name).0 == ColumnMeaning::Heading;
    let is_pair = |two: &[String]| {
        let stem = two[0].strip_suffix('x');
        stem.is_some_and(|stem| two[1].strip_suffix('y') == Some(stem))
    };
    names.len() < MOST_OF_BEAM && names.windows(2).any(is_pair) && !names.iter().any(is_turned)
}

/// The value of `--columns` that may fit; `None` if the lines are no rows of numbers.
fn proposal(lines: &[String]) -> Option<String> {
    let numbers = |line: &String| -> Option<Vec<f64>> {
        let items = words(line).flat_map(|word| list(word).map(number).collect::<Vec<_>>());
        items.collect()
    };
    let names: Option<Vec<&str>> = lines
        .first()
        .filter(|line| words(line).all(|word| number(word).is_none()))
        .map(|line| words(line).collect());
    let rows = &lines[usize::from(names.is_some())..];
    let rows: Option<Vec<Vec<f64>>> = rows.iter().map(numbers).collect();
    let rows = rows.filter(|rows| rows.len() > 1)?;
    let count = rows.iter().map(Vec::len).min()?;
    if count < 2 {
        return None;
    }
    if count < MOST_OF_BEAM {
        return beam(&rows, count, names.as_deref());
    }
    Some(scan(&rows, names.as_deref()))
}

/// Columns of rows that are beams.
fn beam(rows: &[Vec<f64>], count: usize, names: Option<&[&str]>) -> Option<String> {
    let of = |at: usize| rows.iter().map(move |row| row[at]);
    let steps = |at: usize| rows.windows(2).map(move |two| two[1][at] - two[0][at]);
    let angle = (0..count).find(|&at| {
        let step = steps(at).next().unwrap_or(0.0);
        let is_even = steps(at).all(|other| (other - step).abs() < 0.2 * step.abs());
        step != 0.0 && is_even && of(at).all(|value| value.abs() <= 360.0)
    })?;
    let spread = |at: &usize| {
        let (low, high) = of(*at).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        high - low
    };
    let others = (0..count).filter(|at| *at != angle);
    let range = others.max_by(|a, b| spread(a).total_cmp(&spread(b)))?;
    let step = steps(angle).next().unwrap_or(0.0).abs();
    let is_quality = |at: usize| {
        of(at).all(|value| value.fract() == 0.0 && (1.0..=MOST_QUALITY).contains(&value))
    };
    let is_time = |at: &usize| {
        let is_other = ![angle, range].contains(at) && !is_quality(*at);
        is_other && steps(*at).all(|step| step >= 0.0)
    };
    let time = (0..count).find(is_time);
    let column = |at: usize| {
        if at == angle {
            let is_deg = step >= STEP_DEG;
            return if is_deg { "angle_deg" } else { "angle_rad" };
        }
        if at == range {
            return unit(of(at).fold(0.0, f64::max), ["range_m", "range_mm"]);
        }
        if let Some((ColumnMeaning::Other, _)) = names
            .and_then(|names| names.get(at))
            .map(|name| column(name))
        {
            return "-";
        }
        match (is_quality(at), time == Some(at)) {
            (true, _) => "quality",
            (false, true) => "time",
            (false, false) => "-",
        }
    };
    Some((0..count).map(column).collect::<Vec<_>>().join(","))
}

/// Columns of rows that are scans.
fn scan(rows: &[Vec<f64>], names: Option<&[&str]>) -> String {
    // The number of ranges stands before them, perhaps with a word between them, or only a time does.
    let counted = |at: usize| {
        let between = |between: &usize| {
            rows.iter()
                .all(|row| row[at] == (row.len() - at - 1 - between) as f64)
        };
        Some(at + (0..2).find(between)?)
    };
    let first = rows.iter().map(Vec::len).min().unwrap_or(0);
    let counted = (0..first.saturating_sub(MOST_OF_BEAM / 2)).find_map(counted);
    let is_later = |at: usize| rows.windows(2).all(|two| two[1][at] > two[0][at]);
    let time = usize::from(is_later(0));
    // A pose may stand between: it is negative or near its start, and no range is.
    let typical = median(rows.iter().flatten().copied().collect()).unwrap_or_default();
    let is_range = |at: &usize| {
        let mut column = rows.iter().map(|row| row[*at]);
        let least = column.clone().fold(0.0, f64::min);
        least >= 0.0 && column.next().is_some_and(|first| first > NEAR * typical)
    };
    let unnamed = (time..first).find(is_range).unwrap_or(time);
    let named = names.and_then(numbered);
    let before = named.or(counted.map(|at| at + 1)).unwrap_or(unnamed);
    let is_pose = named.is_none() && counted.is_none() && before == time + 3;
    let columns = (0..before).map(|at| match names.map(|names| column(names[at]).0) {
        Some(ColumnMeaning::Time) => "time",
        Some(ColumnMeaning::X) => "x",
        Some(ColumnMeaning::Y) => "y",
        Some(ColumnMeaning::Heading) => "heading",
        _ if at < time => "time",
        _ if is_pose => ["x", "y", "heading"][at - time],
        _ => "-",
    });
    let longest = rows
        .iter()
        .flat_map(|row| &row[before..])
        .copied()
        .fold(0.0, f64::max);
    let ranges = unit(longest, ["ranges_m@-90:90", "ranges_mm@-90:90"]);
    columns.chain([ranges]).collect::<Vec<_>>().join(",")
}

/// The first of many names that differ by their number only: readings, whatever they are called.
fn numbered(names: &[&str]) -> Option<usize> {
    let stem = |name: &str| {
        let digits = |c: char| c.is_ascii_digit() || [']', ')'].contains(&c);
        let stem = name.trim_end_matches(digits);
        (stem.len() < name.len()).then(|| stem.to_owned())
    };
    let is_run = |many: &[&str]| {
        let first = stem(many[0]);
        first.is_some() && many.iter().all(|name| stem(name) == first)
    };
    names.windows(MOST_OF_BEAM).position(is_run)
}

/// The name in metres or in millimetres, by the largest value.
fn unit(largest: f64, [metres, millimetres]: [&'static str; 2]) -> &'static str {
    if largest > FARTHEST_M {
        millimetres
    } else {
        metres
    }
}

#[cfg(test)]
mod tests {
    use super::super::TableLayout;
    use super::*;

    fn proposed(rows: impl Iterator<Item = String>) -> Option<String> {
        let lines: Vec<String> = rows.take(LINES).collect();
        let columns = proposal(&lines)?;
        // What is proposed is accepted.
        columns.parse::<TableLayout>().unwrap();
        Some(columns)
    }

    #[test]
    fn beams_and_scans_without_names_are_recognized_by_their_numbers() {
        let beams = (0..20).map(|k| format!("{:.2},{:05}.00,47,0.0", 3 * k, 1500 + 7 * k * k));
        assert_eq!(proposed(beams).unwrap(), "angle_deg,range_mm,quality,time");
        let metres = (0..20).map(|k| {
            format!(
                "{} {}",
                0.0087 * f64::from(k),
                1.5 + 0.01 * f64::from(k * k)
            )
        });
        assert_eq!(proposed(metres).unwrap(), "angle_rad,range_m");
        let ranges =
            |k: i32| (0..61).map(move |beam| format!(" {}", 2.0 + 0.01 * f64::from(beam + k)));
        let counted = (0..5).map(|k| format!("{k} 61{}", ranges(k).collect::<String>()));
        assert_eq!(proposed(counted).unwrap(), "time,-,ranges_m@-90:90");
        // Rawseeds: the offset of the first angle stands between the number of ranges and them.
        let offset = (0..5).map(|k| format!("{k} 61 {}{}", k % 2, ranges(k).collect::<String>()));
        assert_eq!(proposed(offset).unwrap(), "time,-,-,ranges_m@-90:90");
        let timed = (0..5).map(|k| format!("{k}{}", ranges(k).collect::<String>()));
        assert_eq!(proposed(timed).unwrap(), "time,ranges_m@-90:90");
    }

    #[test]
    fn the_pose_before_ranges_is_no_range_whatever_it_is_called() {
        let rows = |k: i32| {
            let ranges = (0..60).map(|beam| format!(";{}", 1.5 + 0.01 * f64::from(beam)));
            format!(
                "{k};{};{};-0.2{}",
                0.01 * f64::from(k),
                0.0,
                ranges.collect::<String>()
            )
        };
        let unnamed = (0..5).map(rows);
        assert_eq!(
            proposed(unnamed).unwrap(),
            "time,x,y,heading,ranges_m@-90:90"
        );
        let names = (0..60).map(|beam| format!(";Messwert{beam}"));
        let header = format!(
            "Zeit;Position X;Position Y;Kurs{}",
            names.collect::<String>()
        );
        let named = [header].into_iter().chain((0..5).map(rows));
        assert_eq!(proposed(named).unwrap(), "time,x,y,-,ranges_m@-90:90");
    }

    #[test]
    fn points_are_not_proposed_as_beams() {
        for header in ["time,px,py", "scan_id,timestamp,x,y,intensity", "x,y"] {
            let advice = advice(&[header.to_owned(), "0,1,2,3,4".to_owned()]);
            assert!(advice.contains("atan2(y, x)"), "{advice}");
        }
    }

    #[test]
    fn prose_has_no_columns() {
        let prose = ["a line of text", "and another one"];
        assert_eq!(proposed(prose.iter().map(|line| (*line).to_owned())), None);
    }
}
