//! Dates and times of day as seconds.

/// Seconds since 1970 of a date with a time, or since midnight of a time alone: `2026-11-30T14:05:00.25Z`,
/// `30.11.2026 14:05:00,25` or `14:05:00.25`. A date with slashes has its month first, unless that is more than twelve.
pub fn seconds(text: &str) -> Option<f64> {
    let text = text.trim();
    let (date, time) = match text.split_once(['T', 't', ' ', '_']) {
        Some((date, time)) => (Some(date), time.trim()),
        None => (None, text),
    };
    let days = date.map_or(Some(0), days)?;
    let time = time.trim_end_matches(['Z', 'z']).trim_end_matches(" UTC");
    let (time, zone_s) = match time.rfind(['+', '-']) {
        Some(at) => (time[..at].trim(), zone_s(&time[at..])?),
        None => (time, 0.0),
    };
    let parts: Vec<&str> = time.split(':').collect();
    let [hours, minutes, rest @ ..] = &parts[..] else {
        return None;
    };
    let seconds = match rest {
        [] if date.is_some() => 0.0,
        [seconds] => super::number(seconds)?,
        _ => return None,
    };
    let (hours, minutes): (u32, u32) = (hours.parse().ok()?, minutes.parse().ok()?);
    let is_time = hours < 24 && minutes < 60 && (0.0..61.0).contains(&seconds);
    let of_day = f64::from(hours * 3600 + minutes * 60) + seconds;
    is_time.then_some(days as f64 * 86_400.0 + of_day - zone_s)
}

/// Days since 1970.
fn days(date: &str) -> Option<i64> {
    let parts: Option<Vec<i64>> = date
        .split(['-', '.', '/'])
        .map(|part| part.parse().ok())
        .collect();
    let (year, month, day) = match parts?[..] {
        [year, month, day] if year > 31 => (year, month, day),
        [month, day, year] if date.contains('/') && month <= 12 => (year, month, day),
        [day, month, year] => (year, month, day),
        _ => return None,
    };
    let is_date =
        (1900..3000).contains(&year) && (1..=12).contains(&month) && (1..=31).contains(&day);
    // Hinnant, "chrono-Compatible Low-Level Date Algorithms": years begin in March.
    let (of_march, month) = (year - i64::from(month <= 2), (month + 9) % 12);
    let of_year = (153 * month + 2) / 5 + day - 1;
    let before = of_march * 365 + of_march / 4 - of_march / 100 + of_march / 400;
    is_date.then_some(before + of_year - 719_468)
}

/// Seconds ahead of UTC of `+02:00`, `+0200` or `-05`.
fn zone_s(text: &str) -> Option<f64> {
    let digits: String = text[1..].chars().filter(char::is_ascii_digit).collect();
    let (hours, minutes) = digits.split_at_checked(2)?;
    let minutes = if minutes.is_empty() { "0" } else { minutes };
    let ahead = hours.parse::<f64>().ok()? * 3600.0 + minutes.parse::<f64>().ok()? * 60.0;
    Some(if text.starts_with('-') { -ahead } else { ahead })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_moment_has_one_number_however_it_is_written() {
        for text in [
            "2023-11-14T22:13:20.250Z",
            "2023-11-15T00:13:20.25+02:00",
            "2023-11-14 17:13:20.25-0500",
            "2023/11/14 22:13:20.25",
            "14.11.2023 22:13:20,250",
            "11/14/2023 22:13:20.25",
            "14/11/2023 22:13:20.25",
        ] {
            assert_eq!(seconds(text), Some(1_700_000_000.25), "{text}");
        }
        assert_eq!(seconds("00:01:00.5"), Some(60.5));
        assert_eq!(seconds("2000-02-29 00:00"), Some(951_782_400.0));
        for text in [
            "",
            "12",
            "12:30",
            "1.5",
            "25:00:00",
            "2023-13-01 00:00:00",
            "a b",
        ] {
            assert_eq!(seconds(text), None, "{text}");
        }
    }
}
