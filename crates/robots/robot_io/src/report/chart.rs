//! Charts of a value over time as SVG.

use std::fmt::Write as _;

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 180.0;
const LEFT: f64 = 60.0;
const BOTTOM: f64 = 24.0;
const TOP: f64 = 22.0;

/// A curve of `[time in s, value]` from 0, with vertical lines at `marks` (s).
pub fn over_time(title: &str, points: &[[f64; 2]], marks: &[f64]) -> String {
    let last_s = points.last().map_or(1.0, |point| point[0]);
    let end_s = if last_s > 0.0 { last_s } else { 1.0 };
    let highest = points.iter().map(|point| point[1]).fold(0.0, f64::max);
    let top = if highest > 0.0 { highest } else { 1.0 };
    let x = |at_s: f64| LEFT + (WIDTH - LEFT - 10.0) * at_s / end_s;
    let y = |value: f64| HEIGHT - BOTTOM - (HEIGHT - BOTTOM - TOP) * value / top;
    let mut svg = format!(
        "<svg class=\"chart\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{title} over time\">\n\
         <text x=\"{LEFT}\" y=\"14\">{title}</text>\n\
         <path class=\"axis\" d=\"M{LEFT} {TOP}V{0}H{1}\"/>\n",
        HEIGHT - BOTTOM,
        WIDTH - 10.0
    );
    for value in [0.0, top] {
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            LEFT - 6.0,
            y(value) + 4.0,
            short(value)
        );
    }
    for at_s in [0.0, end_s / 2.0, end_s] {
        let _ = writeln!(
            svg,
            "<text x=\"{:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
            x(at_s).min(WIDTH - 24.0),
            HEIGHT - 6.0,
            short(at_s)
        );
    }
    for &at_s in marks {
        let _ = writeln!(
            svg,
            "<path class=\"loop\" d=\"M{:.1} {TOP}V{}\"/>",
            x(at_s),
            HEIGHT - BOTTOM
        );
    }
    svg.push_str("<polyline class=\"curve\" points=\"");
    for &[at_s, value] in points {
        let _ = write!(svg, "{:.1},{:.1} ", x(at_s), y(value));
    }
    svg.push_str("\"/>\n</svg>\n");
    svg
}

/// Formats with about three digits.
fn short(value: f64) -> String {
    match value {
        _ if value >= 100.0 => format!("{value:.0}"),
        _ if value >= 1.0 || value == 0.0 => format!("{value:.1}"),
        _ => format!("{value:.3}"),
    }
}
