//! What explains the readings of each beam at pairs of places: that it sees something that travels with the robot, or the
//! world.

use std::collections::VecDeque;

use ch16_slam2d::scan::LaserScan;
use pr_geom::{Point2, SE2, math};

use super::line::Line;
use super::{BODY_M, Cut, FARTHEST_M, FIXED, fixed_m};
use crate::stamps::median;

/// Places differ by this, m or rad.
const APART: f64 = 0.3;
/// Pairs of places for a decision, and the number after which no more are looked for, if the robot turned in some.
const FEWEST_PAIRS: usize = 10;
const ENOUGH_PAIRS: usize = 60;
/// Pairs in which the robot turned and saw the floor's line all the same: a wall beside the way stays behind.
const FEWEST_TURNS: usize = 3;
/// Places that are kept: the first is far enough for readings up to 13 m.
const PLACES: usize = 5;
/// A point of the world is met again within this, m, and this share of its distance: odometry drifts.
const WORLD_M: f64 = 0.08;
const WORLD_SHARE: f64 = 0.05;
/// Share of pairs in which the world must fail to explain what a beam sees.
const NO_WORLD: f64 = 0.5;
/// Share of all readings that the world must explain: else odometry tells nothing.
const EXPLAINED: f64 = 0.3;

/// How far from its place a point of the world is met again, m.
fn world_m(range_m: f64) -> f64 {
    WORLD_M + WORLD_SHARE * range_m
}

/// A beam at two places.
#[derive(Clone, Copy, Debug)]
struct Seen {
    pair: usize,
    /// Whether the robot turned.
    turns: bool,
    ranges_m: [f64; 2],
    /// Whether the world explains the reading; `None` if no other beam looks there.
    is_met: Option<bool>,
}

/// How a pair compares with something that travels with the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Against {
    On,
    Beyond,
    /// Something nearer hides it.
    Hidden,
}

impl Seen {
    fn against(&self, range_m: f64) -> Against {
        let tolerance_m = fixed_m(range_m);
        let off_m = self.ranges_m.map(|seen_m| seen_m - range_m);
        if off_m.iter().any(|off_m| *off_m <= -tolerance_m) {
            Against::Hidden
        } else if off_m.iter().all(|off_m| *off_m < tolerance_m) {
            Against::On
        } else {
            Against::Beyond
        }
    }
}

/// How often each beam was explained.
#[derive(Debug, Default)]
pub(super) struct Trial {
    /// The last places, newest first.
    places: VecDeque<(SE2, LaserScan)>,
    pairs: usize,
    /// Pairs in which the robot turned, or shortly before.
    turns: usize,
    beams: Vec<Vec<Seen>>,
    readings: usize,
    explained: usize,
}

impl Trial {
    /// The scan at the last place.
    pub fn last(&self) -> Option<&LaserScan> {
        self.places.front().map(|(_, scan)| scan)
    }

    /// Whether more pairs would tell no more.
    pub fn is_enough(&self) -> bool {
        self.pairs >= ENOUGH_PAIRS && self.turns >= FEWEST_PAIRS
    }

    /// Compares a scan with those of the last places; false if the beams have changed.
    pub fn add(&mut self, body: Option<SE2>, scan: &LaserScan) -> bool {
        let Some(odometry) = body else {
            return true;
        };
        let Some((before, old)) = self.places.front() else {
            self.beams = vec![Vec::new(); scan.ranges_m.len()];
            self.places.push_front((odometry, scan.clone()));
            return true;
        };
        if !old.same_beams(scan) {
            return false;
        }
        let is_apart = |moved: &SE2, apart_m: f64| {
            math::norm2(moved.x(), moved.y()) >= apart_m || moved.theta().abs() >= APART
        };
        let moved = before.between(&odometry);
        if !is_apart(&moved, APART) {
            return true;
        }
        let pair = self.pairs;
        let mount = scan.body_from_sensor;
        let moves: Vec<SE2> = self
            .places
            .iter()
            .map(|(then, _)| then.between(&odometry))
            .collect();
        for (beam, &now_m) in scan.ranges_m.iter().enumerate() {
            if !scan.is_return(now_m) {
                continue;
            }
            // Where both explanations differ by twice what either leaves open.
            let is_far = |moved: &SE2| is_apart(moved, 2.0 * world_m(now_m));
            let Some(place) = moves.iter().position(is_far) else {
                continue;
            };
            let then_from_now = (mount.inverse() * moves[place]) * mount;
            let (sin, cos) = math::sin_cos(scan.bearing_rad(beam));
            let point = then_from_now.transform(Point2::new(now_m * cos, now_m * sin));
            let (_, then) = &self.places[place];
            let is_met = is_met(then, point);
            self.readings += 1;
            self.explained += usize::from(is_met == Some(true));
            let then_m = then.ranges_m[beam];
            if then.is_return(then_m) {
                self.beams[beam].push(Seen {
                    pair,
                    turns: moves[place].theta().abs() >= APART,
                    ranges_m: [then_m, now_m],
                    is_met,
                });
            }
        }
        self.turns += usize::from(moves.iter().any(|moved| moved.theta().abs() >= APART));
        self.pairs += 1;
        self.places.push_front((odometry, scan.clone()));
        self.places.truncate(PLACES);
        true
    }

    /// Where a beam sees something that travels with the robot, m, and whether in nearly all pairs.
    fn fixed(&self, seen: &[Seen]) -> Option<(f64, bool)> {
        let is_unlike = |seen: &&Seen| {
            let [then_m, now_m] = seen.ranges_m;
            seen.is_met == Some(false) && (now_m - then_m).abs() < fixed_m(now_m)
        };
        let ranges_m = seen.iter().filter(is_unlike).map(|seen| seen.ranges_m[1]);
        let range_m = median(ranges_m.collect())?;
        let count = |wanted| {
            let all = seen.iter().filter(|seen| seen.against(range_m) == wanted);
            all.count() as f64
        };
        let (on, beyond) = (count(Against::On), count(Against::Beyond));
        let no_world = seen
            .iter()
            .filter(|seen| seen.against(range_m) == Against::On && seen.is_met == Some(false));
        let is_fixed = on >= FEWEST_PAIRS as f64
            && on >= FIXED * (on + beyond)
            && no_world.count() as f64 >= NO_WORLD * on;
        is_fixed.then_some((range_m, on >= FIXED * self.pairs as f64))
    }

    /// What travels with the robot.
    pub fn cut(&self) -> Cut {
        let is_told = self.explained as f64 >= EXPLAINED * self.readings as f64;
        let Some(scan) = self.last().filter(|_| is_told) else {
            return Cut::default();
        };
        let mut limits_m = vec![0.0; self.beams.len()];
        let mut points = Vec::new();
        let mut farther = Vec::new();
        for (beam, seen) in self.beams.iter().enumerate() {
            match self.fixed(seen) {
                Some((range_m, true)) if range_m < FARTHEST_M => limits_m[beam] = range_m + BODY_M,
                Some((range_m, _)) => {
                    let (sin, cos) = math::sin_cos(scan.bearing_rad(beam));
                    points.push([range_m * cos, range_m * sin]);
                    farther.push((beam, range_m));
                }
                None => {}
            }
        }
        Cut {
            limits_m: Some(limits_m)
                .filter(|limits_m| limits_m.iter().any(|limit_m| *limit_m > 0.0))
                .unwrap_or_default(),
            floor: Line::of(&points).filter(|_| self.stays_in_turns(&farther)),
        }
    }

    /// Whether these beams see the same also while the robot turns.
    fn stays_in_turns(&self, fixed: &[(usize, f64)]) -> bool {
        let (mut on, mut beyond) = (vec![0; self.pairs], 0);
        for (beam, range_m) in fixed {
            for seen in self.beams[*beam].iter().filter(|seen| seen.turns) {
                match seen.against(*range_m) {
                    Against::On => on[seen.pair] += 1,
                    Against::Beyond => beyond += 1,
                    Against::Hidden => {}
                }
            }
        }
        let all = on.iter().sum::<usize>();
        let turns = on.iter().filter(|on| **on > 0).count();
        turns >= FEWEST_TURNS && all as f64 >= FIXED * (all + beyond) as f64
    }
}

/// Whether a scan meets this point in the sensor's frame; `None` if no beam looks there.
fn is_met(scan: &LaserScan, point: Point2<f64>) -> Option<bool> {
    let range_m = math::norm2(point.x, point.y);
    let turn = math::atan2(point.y, point.x) - scan.first_angle_rad;
    let turn = turn * scan.angle_step_rad.signum();
    let beam =
        (turn.rem_euclid(core::f64::consts::TAU) / scan.angle_step_rad.abs()).round() as usize;
    let near = beam.saturating_sub(1)..=beam + 1;
    let mut readings = near.filter_map(|beam| scan.ranges_m.get(beam)).peekable();
    readings.peek()?;
    Some(readings.any(|reading_m| (reading_m - range_m).abs() < world_m(range_m)))
}
