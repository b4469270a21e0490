//! Distances from points and segments to walls.

use pr_geom::Point2;

use crate::world::{Wall, World, distance_to_segment};

/// The wall nearest to a point: its index and its distance in metres.
pub(super) fn nearest_wall(world: &World, point: Point2<f64>) -> (usize, f64) {
    nearest(world, |wall| distance_to(wall, point))
}

/// The wall nearest to the segment between two points: its index and its distance in metres.
pub(super) fn nearest_wall_to_leg(
    world: &World,
    from: Point2<f64>,
    to: Point2<f64>,
) -> (usize, f64) {
    let leg = Wall {
        start: from,
        end: to,
    };
    nearest(world, |wall| distance_between(wall, &leg))
}

fn nearest(world: &World, distance_m: impl Fn(&Wall) -> f64) -> (usize, f64) {
    let distances = world.walls().iter().map(distance_m).enumerate();
    distances.fold((0, f64::INFINITY), |best, next| {
        if next.1 < best.1 { next } else { best }
    })
}

fn distance_to(wall: &Wall, point: Point2<f64>) -> f64 {
    let (to_start, edge) = (wall.start - point, wall.end - wall.start);
    distance_to_segment(to_start.x, to_start.y, edge.x, edge.y)
}

/// Distance between two segments: 0 if they cross, otherwise the least distance of an end of one to the other.
fn distance_between(one: &Wall, other: &Wall) -> f64 {
    if separates(one, other) && separates(other, one) {
        return 0.0;
    }
    let ends = [
        distance_to(one, other.start),
        distance_to(one, other.end),
        distance_to(other, one.start),
        distance_to(other, one.end),
    ];
    ends.into_iter().fold(f64::INFINITY, f64::min)
}

/// Whether the ends of `other` are on different sides of the line through `line`.
fn separates(line: &Wall, other: &Wall) -> bool {
    let edge = line.end - line.start;
    let side = |point: Point2<f64>| {
        let from_start = point - line.start;
        edge.x * from_start.y - edge.y * from_start.x
    };
    side(other.start) * side(other.end) < 0.0
}
