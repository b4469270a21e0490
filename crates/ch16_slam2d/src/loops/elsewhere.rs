//! How well a scan fits elsewhere, judged by nothing but what was seen there.

use core::f64::consts::PI;

use nalgebra::Matrix3;
use pr_geom::{Point2, SE2, math};

use super::KeyframeView;
use crate::cloud::PointCloud;
use crate::search::{LikelihoodConfig, LikelihoodGrid};

/// Cells of the grid, and steps from one place to the next, m.
const CELL_M: f64 = 0.15;
/// Cells that were seen or not are so many times as wide.
const COARSE: usize = 3;
/// Sectors of a view.
const SECTORS: usize = 180;
/// A point so far behind what a sector saw is not known, m.
const BEHIND_M: f64 = 0.3;
/// Walls so far beyond the window take part, m.
const MARGIN_M: f64 = 10.0;
/// Beams are followed so far, m: farther off, gaps between them are wider than cells.
const FARTHEST_M: f64 = 15.0;
/// A place is left out where a fifth of the points fits so much worse than all of them at the found one.
const FEW: f64 = 0.3;
/// A place at which less of the scan falls on what was seen says nothing.
const MIN_SEEN: f64 = 0.2;
/// Of keyframes that stand so near to each other and look the same way one is enough, m and rad.
const SAME_VIEW: (f64, f64) = (0.4, 0.3);

/// Places that the graph leaves a keyframe, and what counts as a lead over them.
#[derive(Clone, Copy)]
pub(crate) struct AllowedPlaces {
    /// Where the graph takes it to be.
    pub belief: SE2,
    /// Of its error, 3×3, translation first, in the frame of the belief.
    pub covariance: Matrix3<f64>,
    /// Squared norm of the error's translation that is allowed.
    pub gate_chi2: f64,
    /// And largest error along x and along y, m.
    pub half_width_m: f64,
    /// Places nearer to the found one are the same, m.
    pub apart_m: f64,
    /// A point on what nobody has seen counts as one of the found place, less this.
    pub unseen: f64,
    /// A smaller lead is none.
    pub margin: f64,
}

/// What older keyframes have seen around one of them, in its frame.
///
/// Where a robot comes back to the edge of its map, half of what it sees was never mapped. A score that
/// counts these points as misses prefers a false place farther inside, where everything is mapped. Here
/// a point that falls on what no keyframe has seen counts nearly as one of the found place does.
pub(crate) struct Surroundings {
    grid: LikelihoodGrid,
    /// Whether a coarse cell was seen, row by row.
    seen: Vec<bool>,
    coarse_columns: usize,
}

/// How a scan fits at a place.
#[derive(Clone, Copy)]
struct Share {
    /// Share of its points on what was seen that lie at walls.
    fits: f64,
    /// Share of its points on what was seen.
    seen: f64,
}

/// How far a scan reaches by direction, m.
fn reaches_m(scan: &PointCloud) -> [f64; SECTORS] {
    let mut reaches_m = [0.0; SECTORS];
    for point in scan.iter() {
        let turn = 0.5 + 0.5 * math::atan2(point.y, point.x) / PI;
        let reach_m = &mut reaches_m[(turn * SECTORS as f64) as usize % SECTORS];
        *reach_m = math::max(*reach_m, math::norm2(point.x, point.y));
    }
    reaches_m
}

impl Surroundings {
    /// What keyframes 0 to `last` have seen within `half_width_m` of `center` and somewhat beyond.
    ///
    /// None where they saw nothing.
    pub fn new(
        view: KeyframeView<'_>,
        center: usize,
        last: usize,
        half_width_m: f64,
    ) -> Option<Self> {
        let reach_m = half_width_m + MARGIN_M;
        let origin = view.poses[center];
        let is_near = |point: &Point2<f64>| point.x.abs() <= reach_m && point.y.abs() <= reach_m;
        let mut walls = PointCloud::default();
        let mut views = Vec::new();
        for node in 0..=last.min(view.poses.len() - 1) {
            let pose = origin.between(&view.poses[node]);
            let is_known = |(other, _): &(SE2, _)| {
                let apart = pose.between(other);
                math::norm2(apart.x(), apart.y()) < SAME_VIEW.0 && apart.theta().abs() < SAME_VIEW.1
            };
            if is_near(&pose.position()) && !views.iter().any(is_known) {
                let scan = &view.keyframes[node].scan;
                walls.extend_transformed(scan, &pose);
                views.push((pose, reaches_m(scan)));
            }
        }
        let walls: PointCloud = walls.iter().filter(is_near).collect();
        let config = LikelihoodConfig {
            cell_m: CELL_M,
            sigma_m: CELL_M,
        };
        let grid = LikelihoodGrid::build(&walls, config).ok()?;
        let coarse_columns = grid.columns() / COARSE + 1;
        let mut around = Self {
            seen: vec![false; coarse_columns * (grid.rows() / COARSE + 1)],
            coarse_columns,
            grid,
        };
        for (pose, reaches_m) in &views {
            around.see(pose, reaches_m);
        }
        Some(around)
    }

    /// Marks what lies along the beams of a scan.
    fn see(&mut self, pose: &SE2, reaches_m: &[f64; SECTORS]) {
        let step_m = 0.5 * COARSE as f64 * CELL_M;
        let rays = reaches_m
            .iter()
            .enumerate()
            .filter(|(_, reach_m)| **reach_m > 0.0);
        for (sector, reach_m) in rays {
            let bearing = (2.0 * (sector as f64 + 0.5) / SECTORS as f64 - 1.0) * PI;
            let (sin, cos) = math::sin_cos(pose.theta() + bearing);
            let reach_m = math::min(reach_m + BEHIND_M, FARTHEST_M);
            for step in 0..=(reach_m / step_m) as usize {
                let along_m = step as f64 * step_m;
                let cell = self
                    .grid
                    .cell(pose.x() + along_m * cos, pose.y() + along_m * sin);
                if let Some(at) = self.inside(cell) {
                    let coarse = self.coarse(at);
                    self.seen[coarse] = true;
                }
            }
        }
    }

    /// Column and row of a cell, where the grid has it.
    fn inside(&self, (column, row): (i64, i64)) -> Option<[usize; 2]> {
        let (columns, rows) = (self.grid.columns() as i64, self.grid.rows() as i64);
        let is_inside = (0..columns).contains(&column) && (0..rows).contains(&row);
        is_inside.then_some([column as usize, row as usize])
    }

    /// The number of the coarse cell that holds a cell.
    fn coarse(&self, [column, row]: [usize; 2]) -> usize {
        row / COARSE * self.coarse_columns + column / COARSE
    }

    /// By how much the scan fits better at `found` than at any other place that is allowed; its own
    /// share where there is none. It is not looked further once the lead is below the margin.
    ///
    /// Poses are in the frame of the keyframe in the middle; the heading is that of `found` everywhere.
    pub fn lead(&self, scan: &PointCloud, found: &SE2, allowed: &AllowedPlaces) -> f64 {
        let AllowedPlaces {
            belief,
            covariance,
            gate_chi2,
            half_width_m,
            apart_m,
            unseen,
            margin,
        } = *allowed;
        let turned = scan.transformed(found);
        let cells: Vec<(i64, i64)> = turned.iter().map(|p| self.grid.cell(p.x, p.y)).collect();
        let Some(Share { fits: own, .. }) = self.score(&cells, (0, 0)) else {
            return 0.0;
        };
        let lead_over =
            |share: Share| share.seen * (own - share.fits) + (1.0 - share.seen) * unseen;
        let few: Vec<(i64, i64)> = cells.iter().copied().step_by(5).collect();
        let to_belief = [belief.x() - found.x(), belief.y() - found.y()];
        let steps = |metres: f64| (metres / CELL_M).round() as i64;
        let most = self.grid.columns().max(self.grid.rows()) as i64;
        let reach = steps(half_width_m).min(most);
        let around = |middle_m: f64| steps(middle_m) - reach..=steps(middle_m) + reach;
        let (sin, cos) = math::sin_cos(belief.theta());
        let (xx, xy, yy) = (covariance[(0, 0)], covariance[(0, 1)], covariance[(1, 1)]);
        let determinant = xx * yy - xy * xy;
        let mut lead = own;
        for j in around(to_belief[1]) {
            for i in around(to_belief[0]) {
                let (x, y) = (i as f64 * CELL_M, j as f64 * CELL_M);
                if math::norm2(x, y) <= apart_m {
                    continue;
                }
                // The covariance stands in the body's frame at the belief.
                let (x, y) = (x - to_belief[0], y - to_belief[1]);
                let (x, y) = (cos * x + sin * y, cos * y - sin * x);
                let chi2 = (yy * x * x - 2.0 * xy * x * y + xx * y * y) / determinant;
                if chi2 > gate_chi2 {
                    continue;
                }
                // A few points say whether all of them are worth a look.
                let at_few = self.score(&few, (i, j));
                if at_few.is_none_or(|share| lead_over(share) > FEW) {
                    continue;
                }
                if let Some(share) = self.score(&cells, (i, j)) {
                    lead = math::min(lead, lead_over(share));
                    if lead < margin {
                        return lead;
                    }
                }
            }
        }
        lead
    }

    /// How the points fit, moved by so many cells; none where too few fall on what was seen.
    fn score(&self, cells: &[(i64, i64)], by: (i64, i64)) -> Option<Share> {
        let (mut sum, mut seen) = (0_u32, 0_u32);
        for (column, row) in cells {
            let Some(cell) = self.inside((column + by.0, row + by.1)) else {
                continue;
            };
            let score = u32::from(self.grid.scores()[cell[1] * self.grid.columns() + cell[0]]);
            if score > 0 || self.seen[self.coarse(cell)] {
                sum += score;
                seen += 1;
            }
        }
        let share = f64::from(seen) / cells.len() as f64;
        (seen > 0 && share >= MIN_SEEN).then(|| Share {
            fits: f64::from(sum) / (255.0 * f64::from(seen)),
            seen: share,
        })
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::slam::Keyframe;

    /// A corridor along x, 2 m wide, with a niche in one wall every 4 m, and its end at x = 12 m: what is
    /// seen of it from x to 8 m ahead, in the frame of a body there.
    fn seen_from(x_m: f64) -> PointCloud {
        let mut points = Vec::new();
        for step in 0..160 {
            let along = 0.05 * f64::from(step);
            let x = x_m + along;
            if x > 12.0 {
                break;
            }
            let is_niche = (1.5..2.5).contains(&(x.rem_euclid(4.0)));
            points.push(Point2::new(along, -1.0));
            points.push(Point2::new(along, if is_niche { 1.6 } else { 1.0 }));
            if (x - 12.0).abs() < 0.03 {
                let across = (-20..=20).map(|k| Point2::new(along, 0.05 * f64::from(k)));
                points.extend(across);
            }
        }
        points.into_iter().collect()
    }

    /// The lead of a scan from `x_m` at `found_m`, after a drive from 0 to 8 m, by a graph that is 0.4 m
    /// off and 1.3 m unsure along the corridor.
    fn lead(x_m: f64, found_m: f64) -> f64 {
        let poses: Vec<SE2> = (0..=8)
            .map(|x| SE2::translation(f64::from(x), 0.0))
            .collect();
        let keyframes: Vec<Keyframe> = (0..=8)
            .map(|node| Keyframe {
                node,
                frame: node,
                stamp_s: 0.0,
                scan: Arc::new(seen_from(node as f64)),
            })
            .collect();
        let view = KeyframeView {
            poses: &poses,
            keyframes: &keyframes,
        };
        let around = Surroundings::new(view, 0, 8, 5.0).unwrap();
        let allowed = AllowedPlaces {
            belief: SE2::translation(x_m - 0.4, 0.0),
            covariance: Matrix3::from_diagonal(&[1.69, 0.04, 0.01].into()),
            gate_chi2: 11.345,
            half_width_m: 5.0,
            apart_m: 0.5,
            unseen: 0.08,
            margin: -1.0,
        };
        around.lead(&seen_from(x_m), &SE2::translation(found_m, 0.0), &allowed)
    }

    #[test]
    fn at_the_edge_of_the_map_a_false_place_inside_is_not_ahead_of_the_right_one() {
        // Three eighths of the scan were never mapped, and count 0.08 less each: 0.03.
        let lead = lead(-3.0, 1.0);
        assert!(lead < 0.04, "{lead}");
    }

    #[test]
    fn where_the_end_of_the_corridor_is_seen_the_right_place_is_ahead() {
        let (right, wrong) = (lead(5.0, 5.0), lead(5.0, 1.0));
        assert!(right > 0.04 && wrong < 0.0, "{right} {wrong}");
    }
}
