//! Computes the motion between two clouds with known pairs, in closed form.
//!
//! `cargo run -p ch16_slam2d --example align_two_clouds`

use ch16_slam2d::prelude::*;

/// The corners of a room as the robot sees them before and after it moves, m.
fn corners() -> ([Point2<f64>; 4], [Point2<f64>; 4]) {
    let before = [(2.0, -1.0), (2.0, 1.5), (-1.0, 1.5), (-1.0, -1.0)];
    let after = [(1.5, -1.2), (1.5, 1.3), (-1.5, 1.3), (-1.5, -1.2)];
    let points = |places: [(f64, f64); 4]| places.map(|(x, y)| Point2::new(x, y));
    (points(before), points(after))
}

/// `before_from_after`: the robot's present pose in the frame of its previous pose.
pub fn motion() -> SE2 {
    let (before, after) = corners();
    svd_align(&after, &before)
}

/// Prints the motion and the remaining distance of each pair.
pub fn main() {
    let motion = motion();
    let (before, after) = corners();
    println!(
        "The robot moved by {:.2} m, {:.2} m and turned by {:.1}°.",
        motion.translation().x,
        motion.translation().y,
        motion.theta().to_degrees()
    );
    for (p, q) in after.iter().zip(&before) {
        let off_m = (motion.transform(*p) - q).norm();
        println!("A corner ends {off_m:.3} m from its partner.");
    }
}
