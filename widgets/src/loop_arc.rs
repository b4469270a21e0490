//! Loops on a map.

use pr_geom::math;

/// Lowest and highest arc of a loop, m; in between its height is the distance of its ends.
const ARC_HEIGHT_M: [f64; 2] = [0.7, 1.2];
/// Segments of a loop's arc.
const ARC_STEPS: u32 = 24;

/// A loop's factor as an arc to the north; straight, the factors of the corridor would hide it.
pub fn loop_arc(from: [f64; 2], to: [f64; 2]) -> Vec<[f64; 2]> {
    let apart = math::norm2(to[0] - from[0], to[1] - from[1]);
    let top = apart.clamp(ARC_HEIGHT_M[0], ARC_HEIGHT_M[1]);
    (0..=ARC_STEPS)
        .map(|step| {
            let s = f64::from(step) / f64::from(ARC_STEPS);
            let height = top * 4.0 * s * (1.0 - s);
            [
                from[0] + s * (to[0] - from[0]),
                from[1] + s * (to[1] - from[1]) + height,
            ]
        })
        .collect()
}
