//! Report of a run as one HTML file with pictures, without scripts or other files.
//!
//! One picture shows map, path, loops and uncertainty; two charts show χ² and the uncertainty over time. Below are the
//! doubts, every loop with its evidence, and the keyframes. Colours follow the reader's light or dark scheme.

mod chart;
mod picture;

use std::collections::BTreeMap;
use std::fmt::{Display, Write as _};

use crate::map_image::{MapError, MapImage};
use crate::plural::plural;
use crate::quality::{LinkQuality, Quality};

/// Longer tables are cut after this many rows, with a note.
const MAX_ROWS: usize = 2000;

/// All colours by name, `[light, dark]`, of which the report uses some.
const PALETTE: &str = include_str!("../palette.json");
const COLORS: [&str; 7] = [
    "ink",
    "soft",
    "faint",
    "paper",
    "posterior",
    "revisit",
    "series-3",
];

const STYLE: &str = "
body { font: 16px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--paper);
  max-width: 60rem; margin: 2rem auto; padding: 0 1rem; overflow-wrap: anywhere }
svg { width: 100%; height: auto; display: block }
svg.map { max-height: 80vh }
svg text { fill: var(--ink); font: 12px system-ui, sans-serif }
@media (max-width: 40rem) { svg.chart { overflow: visible; margin-top: .8rem } svg.chart text { font-size: 24px } }
.wall { fill: var(--ink) } .path { fill: none; stroke: var(--posterior) }
.uncertainty { fill: none; stroke: var(--posterior); opacity: .5 }
.loop { stroke: var(--revisit); fill: none } .rejected { stroke: var(--series-3); fill: none; stroke-dasharray: 4 3 }
.axis { stroke: var(--faint); fill: none }
.curve { fill: none; stroke: var(--posterior); stroke-width: 1.5 }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; overflow-wrap: normal }
.scroll { overflow-x: auto }
th, td { text-align: right; padding: .15rem .6rem; border-bottom: 1px solid var(--faint) }
td.text, th.text { text-align: left }
.key { color: var(--soft) }
";

/// The colours as properties, light and dark by the reader's scheme.
fn color_style() -> String {
    let palette: BTreeMap<&str, [&str; 2]> =
        serde_json::from_str(PALETTE).expect("the palette is JSON");
    let shades = |theme: usize| -> String {
        let used = COLORS.iter();
        used.map(|name| format!(" --{name}: {};", palette[name][theme]))
            .collect()
    };
    format!(
        "\n:root {{ color-scheme: light dark;{} }}\n@media (prefers-color-scheme: dark) {{ :root {{{} }} }}",
        shades(0),
        shades(1)
    )
}

/// Content of the report.
#[derive(Clone, Copy, Debug)]
pub struct LogReport<'a> {
    /// Name of the log.
    pub name: &'a str,
    /// Number of scans.
    pub scans: usize,
    /// Keyframes, loops and doubts.
    pub quality: &'a Quality,
    /// Time (s) and χ² of the graph after each keyframe.
    pub chi2_over_time: &'a [[f64; 2]],
    /// The map, or why there is none.
    pub map: Result<&'a MapImage, &'a MapError>,
    /// Sentences about the log and its evaluation, one paragraph each.
    pub remarks: &'a [String],
}

impl LogReport<'_> {
    /// The complete HTML file.
    #[must_use]
    pub fn html(&self) -> String {
        let quality = self.quality;
        let name = escape_html(self.name);
        let closed = quality.tried.iter().filter(|tried| tried.accepted);
        let mut page = format!(
            "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width\">\n<title>Map of {name}</title>\n\
             <style>{}{STYLE}</style>\n<h1>Map of {name}</h1>\n",
            color_style()
        );
        push_line(
            &mut page,
            format_args!(
                "<p>{} gave {} over a path length of {:.1} m. Loops during the run: {} tested, {} accepted; \
                 in the graph at the end: {}.</p>",
                plural(self.scans, "scan"),
                plural(quality.keyframes.len(), "keyframe"),
                quality.path_length_m(),
                quality.tried.len(),
                closed.clone().count(),
                quality.links.len()
            ),
        );
        for remark in self.remarks {
            push_line(&mut page, format_args!("<p>{}</p>", escape_html(remark)));
        }
        push_line(&mut page, format_args!("<h2>Doubts</h2>"));
        if quality.doubts.is_empty() {
            push_line(
                &mut page,
                format_args!("<p>None: no measurement contradicts the rest of the graph.</p>"),
            );
        } else {
            push_line(&mut page, format_args!("<ul>"));
            for doubt in &quality.doubts {
                push_line(&mut page, format_args!("<li>{}</li>", escape_html(doubt)));
            }
            push_line(&mut page, format_args!("</ul>"));
        }
        push_line(&mut page, format_args!("<h2>The map</h2>"));
        if let Err(problem) = self.map {
            push_line(
                &mut page,
                format_args!("<p>No walls are drawn: {problem}.</p>"),
            );
        }
        page.push_str(&picture::map(quality, self.map.ok()));
        push_line(
            &mut page,
            format_args!(
                "<p class=\"key\">The line is the path over the keyframes. A solid line between keyframes is a loop of \
                 the graph, a dashed one a rejected loop. Ellipses are the position's uncertainty (3σ).</p>"
            ),
        );
        push_line(&mut page, format_args!("<h2>Over time</h2>"));
        let start_s = quality.keyframes.first().map_or(0.0, |k| k.stamp_s);
        let loops: Vec<f64> = closed
            .filter_map(|tried| Some(quality.keyframes.get(tried.from)?.stamp_s - start_s))
            .collect();
        let chi2 = self.chi2_over_time.iter();
        let chi2: Vec<[f64; 2]> = chi2.map(|&[at_s, chi2]| [at_s - start_s, chi2]).collect();
        page.push_str(&chart::over_time("χ² of the graph", &chi2, &loops));
        let sigma = quality.keyframes.iter();
        let sigma: Vec<[f64; 2]> = sigma
            .map(|keyframe| [keyframe.stamp_s - start_s, keyframe.sigma_m()])
            .collect();
        page.push_str(&chart::over_time("σ of the position, m", &sigma, &loops));
        push_line(
            &mut page,
            format_args!(
                "<p class=\"key\">Seconds since the first scan. Vertical lines are accepted loops.</p>"
            ),
        );
        push_line(&mut page, format_args!("<h2>Loops</h2>"));
        if quality.tried.is_empty() && quality.links.is_empty() {
            push_line(&mut page, format_args!("<p>No location was revisited.</p>"));
        }
        loops_table(&mut page, "In the graph at the end", &quality.links);
        loops_table(&mut page, "Tested during the run", &quality.tried);
        keyframes_table(&mut page, quality);
        page.push_str("</html>\n");
        page
    }
}

fn loops_table(page: &mut String, title: &str, loops: &[LinkQuality]) {
    if loops.is_empty() {
        return;
    }
    push_line(page, format_args!("<h3>{title}</h3>"));
    push_line(
        page,
        format_args!(
            "<div class=\"scroll\"><table><tr><th>from<th>to<th>score<th>RMSE, m<th>inliers<th>margin<th>χ²<th>gate\
             <th class=\"text\">verdict</tr>"
        ),
    );
    for tried in loops.iter().take(MAX_ROWS) {
        let verdict = match (&tried.reason, tried.accepted) {
            (_, true) => "closed".to_owned(),
            (Some(why), false) => format!("rejected: {why}"),
            (None, false) => "rejected".to_owned(),
        };
        push_line(
            page,
            format_args!(
                "<tr><td>{}<td>{}<td>{}<td>{}<td>{}<td>{}<td>{}<td>{:.1}<td class=\"text\">{}</tr>",
                tried.from,
                tried.to,
                number(tried.score, 2),
                number(tried.rmse_m, 3),
                tried.inliers,
                number(tried.margin, 3),
                number(tried.chi2, 1),
                tried.gate_chi2,
                escape_html(&verdict)
            ),
        );
    }
    push_line(page, format_args!("</table></div>"));
    more(page, loops.len());
}

fn keyframes_table(page: &mut String, quality: &Quality) {
    push_line(
        page,
        format_args!(
            "<details><summary>All keyframes</summary><div class=\"scroll\"><table>\
             <tr><th>keyframe<th>time, s<th>x, m<th>y, m<th>heading, °<th>σ position, m<th>σ heading, °</tr>"
        ),
    );
    for (index, keyframe) in quality.keyframes.iter().take(MAX_ROWS).enumerate() {
        let [x, y, theta] = keyframe.pose;
        push_line(
            page,
            format_args!(
                "<tr><td>{index}<td>{:.2}<td>{x:.3}<td>{y:.3}<td>{:.2}<td>{:.3}<td>{:.3}</tr>",
                keyframe.stamp_s,
                theta.to_degrees(),
                keyframe.sigma_m(),
                keyframe.sigma_deg()
            ),
        );
    }
    push_line(page, format_args!("</table></div>"));
    more(page, quality.keyframes.len());
    push_line(page, format_args!("</details>"));
}

fn more(page: &mut String, rows: usize) {
    if rows > MAX_ROWS {
        push_line(
            page,
            format_args!(
                "<p class=\"key\">{} more rows are in quality.json.</p>",
                rows - MAX_ROWS
            ),
        );
    }
}

/// A number with `digits` decimals, or a dash if there is none.
fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or("–".to_owned(), |value| format!("{value:.digits$}"))
}

fn push_line(page: &mut String, text: impl Display) {
    writeln!(page, "{text}").expect("memory takes text");
}

/// Escapes external text for HTML.
fn escape_html(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quality::KeyframeQuality;

    fn quality() -> Quality {
        let keyframe = |stamp_s: f64, x: f64| KeyframeQuality {
            stamp_s,
            pose: [x, 0.0, 0.0],
            covariance: [[0.01, 0.0, 0.0], [0.0, 0.04, 0.0], [0.0, 0.0, 0.001]],
        };
        Quality {
            keyframes: vec![
                keyframe(10.0, 0.0),
                keyframe(11.0, 1.0),
                keyframe(12.0, 2.0),
            ],
            tried: vec![LinkQuality {
                from: 2,
                to: 0,
                score: None,
                rmse_m: Some(0.25),
                inliers: 40,
                margin: None,
                chi2: None,
                gate_chi2: 11.34,
                accepted: false,
                reason: Some("a < b".to_owned()),
            }],
            ..Quality::default()
        }
    }

    #[test]
    fn a_report_stands_alone_and_text_from_outside_stays_text() {
        let quality = quality();
        let report = LogReport {
            name: "<script>x</script>.mcap",
            scans: 3,
            quality: &quality,
            chi2_over_time: &[[10.0, 0.0], [11.0, 4.0]],
            map: Err(&MapError::Nothing),
            remarks: &["<b>bold</b>".to_owned()],
        };
        let page = report.html();
        assert!(page.contains("3 scans gave 3 keyframes over a path length of 2.0 m"));
        assert!(page.contains("&lt;b&gt;bold") && page.contains("rejected: a &lt; b"));
        for word in ["<script", "http:", "https:", "src=", "href=", "NaN", "inf"] {
            assert!(!page.contains(word), "{word}");
        }
        let opened = page.matches("<svg").count();
        assert_eq!((opened, page.matches("</svg>").count()), (3, 3));
    }

    /// A name that the palette lacks would be inherited, in one scheme or in both.
    #[test]
    fn the_style_uses_the_colours_that_it_declares_and_no_other() {
        let used = STYLE.split("var(--").skip(1);
        let mut used: Vec<&str> = used.filter_map(|tail| tail.split(')').next()).collect();
        used.sort_unstable();
        used.dedup();
        let mut declared = COLORS;
        declared.sort_unstable();
        assert_eq!(used, declared);
        assert!(!STYLE.contains('#'));
        let style = color_style();
        for name in COLORS {
            assert_eq!(style.matches(&format!("--{name}: #")).count(), 2, "{name}");
        }
    }

    #[test]
    fn a_run_without_anything_has_a_report() {
        let page = LogReport {
            name: "x",
            scans: 0,
            quality: &Quality::default(),
            chi2_over_time: &[],
            map: Err(&MapError::Nothing),
            remarks: &[],
        }
        .html();
        assert!(page.contains("No location was revisited"));
        assert!(
            page.contains("<p>No walls are drawn: no scan has a point, so the map is empty.</p>")
        );
        assert!(!page.contains("NaN") && !page.contains("inf"));
    }
}
