//! Map, path, loops and uncertainty as one SVG, in metres.

use std::convert::Infallible;
use std::fmt::Write as _;

use crate::map_image::MapImage;
use crate::quality::Quality;

/// Most ellipses that are drawn: more hide the path.
const MAX_ELLIPSES: usize = 60;

/// The picture; walls are the map's occupied cells.
pub fn map(quality: &Quality, map: Option<&MapImage>) -> String {
    let (low, high) = bounds(quality, map);
    let [width, height] = [high[0] - low[0], high[1] - low[1]];
    // For a picture of 900 pixels, with lines 1.5 pixels wide.
    let pixel_m = width.max(height) / 900.0;
    let mut svg = format!(
        "<svg class=\"map\" viewBox=\"{:.3} {:.3} {width:.3} {height:.3}\" role=\"img\" \
         aria-label=\"Map with the robot's path\">\n<g transform=\"scale(1,-1)\">\n",
        low[0], -high[1]
    );
    if let Some(map) = map {
        let _ = writeln!(svg, "<path class=\"wall\" d=\"{}\"/>", walls(map));
    }
    let position = |keyframe: usize| {
        let [x, y, _] = quality.keyframes.get(keyframe)?.pose;
        Some((x, y))
    };
    let rejected = quality.tried.iter().filter(|tried| !tried.accepted);
    for tried in rejected.chain(&quality.links) {
        let (Some((ax, ay)), Some((bx, by))) = (position(tried.from), position(tried.to)) else {
            continue;
        };
        let class = if tried.accepted { "loop" } else { "rejected" };
        let _ = writeln!(
            svg,
            "<line class=\"{class}\" stroke-width=\"{:.4}\" style=\"stroke-dasharray:{}\" \
             x1=\"{ax:.3}\" y1=\"{ay:.3}\" x2=\"{bx:.3}\" y2=\"{by:.3}\"><title>{} to {}</title></line>",
            1.5 * pixel_m,
            if tried.accepted {
                "none".to_owned()
            } else {
                format!("{:.3}", 4.0 * pixel_m)
            },
            tried.from,
            tried.to
        );
    }
    let _ = write!(
        svg,
        "<polyline class=\"path\" stroke-width=\"{:.4}\" points=\"",
        1.5 * pixel_m
    );
    for keyframe in &quality.keyframes {
        let [x, y, _] = keyframe.pose;
        let _ = write!(svg, "{x:.3},{y:.3} ");
    }
    svg.push_str("\"/>\n");
    let every = quality.keyframes.len().div_ceil(MAX_ELLIPSES).max(1);
    for keyframe in quality.keyframes.iter().step_by(every) {
        let (long, short, heading) = keyframe.ellipse();
        let [x, y, _] = keyframe.pose;
        let _ = writeln!(
            svg,
            "<ellipse class=\"uncertainty\" stroke-width=\"{pixel_m:.4}\" rx=\"{:.4}\" ry=\"{:.4}\" \
             transform=\"translate({x:.3} {y:.3}) rotate({:.2})\"/>",
            3.0 * long,
            3.0 * short,
            heading.to_degrees()
        );
    }
    svg.push_str("</g>\n</svg>\n");
    svg
}

/// Bounding box of everything drawn, with a margin, m.
fn bounds(quality: &Quality, map: Option<&MapImage>) -> ([f64; 2], [f64; 2]) {
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    let mut take = |point: [f64; 2]| {
        for axis in 0..2 {
            low[axis] = low[axis].min(point[axis]);
            high[axis] = high[axis].max(point[axis]);
        }
    };
    for keyframe in &quality.keyframes {
        take([keyframe.pose[0], keyframe.pose[1]]);
    }
    if let Some(map) = map {
        let [x, y] = map.origin_m;
        take([x, y]);
        take([
            x + map.width as f64 * map.cell_m,
            y + map.height as f64 * map.cell_m,
        ]);
    }
    if low[0] > high[0] {
        return ([-1.0; 2], [1.0; 2]);
    }
    (low.map(|value| value - 0.5), high.map(|value| value + 0.5))
}

/// Runs of occupied cells as rectangles of one path.
fn walls(map: &MapImage) -> String {
    let mut path = String::new();
    let [x0, y0] = map.origin_m;
    let mut row = map.height;
    let Ok(()) = map.rows(|cells| {
        row -= 1;
        let y = y0 + row as f64 * map.cell_m;
        let mut start = None;
        for column in 0..=map.width {
            let is_wall = cells.get(column).is_some_and(|&log_odds| log_odds > 0.6);
            match (start, is_wall) {
                (None, true) => start = Some(column),
                (Some(from), false) => {
                    let x = x0 + from as f64 * map.cell_m;
                    let length = (column - from) as f64 * map.cell_m;
                    let side = map.cell_m;
                    let _ = write!(path, "M{x:.2} {y:.2}h{length:.2}v{side:.2}h-{length:.2}z");
                    start = None;
                }
                _ => {}
            }
        }
        Ok::<(), Infallible>(())
    });
    path
}
