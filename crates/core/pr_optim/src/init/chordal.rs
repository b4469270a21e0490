//! Chordal relaxation: headings by one linear least-squares problem, positions by another.
//!
//! A heading is a unit vector `c = (cos θ, sin θ)`. Without the constraint of unit length, the headings that
//! agree best with the measured rotations `R` solve
//!
//! ```text
//! min Σ κ ‖cⱼ − R cᵢ‖²,   κ = Ω_θθ
//! ```
//!
//! which is linear. The vectors are then normalized, and the positions solve the remaining problem, also linear.
//! If the rotations are accurate, Gauss–Newton needs one or two steps from here.
//!
//! Sources: Martinec & Pajdla, "Robust rotation and translation estimation in multiview
//! reconstruction", 2007; Carlone, Tron, Daniilidis, Dellaert, "Initialization techniques for 3D
//! SLAM: a survey on rotation estimation and its use in pose graph optimization", 2015.

use pr_geom::{Rotation, SE2, math};

use crate::error::OptimizeError;
use crate::linear::LinearSolver;
use crate::problem::Problem;
use crate::system::{Block, NormalEquations};

/// Poses from the chordal relaxation; fixed poses stay. `linear` is an analysis of the same graph.
///
/// # Errors
/// [`OptimizeError::NotPositiveDefinite`] if a node is not connected to a fixed one, or if the information
/// matrices leave a heading or a position unconstrained.
pub fn chordal(problem: &Problem, linear: &mut LinearSolver) -> Result<Vec<SE2>, OptimizeError> {
    let headings = relax_headings(problem, linear)?;
    positions_for(problem, linear, &headings)
}

/// Unit vectors that agree best with the measured rotations.
fn relax_headings(
    problem: &Problem,
    linear: &mut LinearSolver,
) -> Result<Vec<Rotation>, OptimizeError> {
    let start: Vec<[f64; 2]> = problem
        .poses()
        .iter()
        .zip(problem.fixed())
        .map(|(pose, &fixed)| {
            let Rotation { cos, sin } = pose.rotation();
            if fixed { [cos, sin] } else { [0.0, 0.0] }
        })
        .collect();
    let solution = solve_pairs(problem, linear, &start, |factor| {
        let measured = factor.measurement.rotation();
        let kappa = factor.information[(2, 2)];
        Link {
            weight: [kappa, 0.0, kappa],
            turn: measured,
            offset: [0.0, 0.0],
        }
    })?;
    Ok(solution
        .into_iter()
        .map(|[cos, sin]| {
            let length = math::norm2(cos, sin);
            // A vector of length zero has no heading.
            if length > 0.0 {
                Rotation {
                    cos: cos / length,
                    sin: sin / length,
                }
            } else {
                Rotation { cos: 1.0, sin: 0.0 }
            }
        })
        .collect())
}

/// The positions that agree best with the measurements, given the headings.
fn positions_for(
    problem: &Problem,
    linear: &mut LinearSolver,
    headings: &[Rotation],
) -> Result<Vec<SE2>, OptimizeError> {
    let start: Vec<[f64; 2]> = problem
        .poses()
        .iter()
        .zip(problem.fixed())
        .map(|(pose, &fixed)| {
            if fixed {
                [pose.x(), pose.y()]
            } else {
                [0.0; 2]
            }
        })
        .collect();
    let solution = solve_pairs(problem, linear, &start, |factor| {
        let from = headings[factor.from];
        let z = factor.measurement.rotation();
        let (x, y) = from.rotate(factor.measurement.x(), factor.measurement.y());
        // The residual, and so Ω, is in the frame that the measurement predicts for `to`.
        let (cos, sin) = from.rotate(z.cos, z.sin);
        let omega = &factor.information;
        let (xx, xy, yy) = (omega[(0, 0)], omega[(0, 1)], omega[(1, 1)]);
        let (a, b) = (cos * xx - sin * xy, cos * xy - sin * yy);
        let (c, d) = (sin * xx + cos * xy, sin * xy + cos * yy);
        Link {
            weight: [a * cos - b * sin, a * sin + b * cos, c * sin + d * cos],
            turn: Rotation { cos: 1.0, sin: 0.0 },
            offset: [x, y],
        }
    })?;
    Ok(solution
        .into_iter()
        .zip(headings)
        .zip(problem.poses().iter().zip(problem.fixed()))
        .map(|(([x, y], heading), (pose, &fixed))| {
            if fixed {
                *pose
            } else {
                SE2::new(x, y, math::atan2(heading.sin, heading.cos))
            }
        })
        .collect())
}

/// A linear residual `vⱼ − R vᵢ − d` between two planar vectors, with its weight.
struct Link {
    /// Weight matrix: xx, xy, yy.
    weight: [f64; 3],
    /// R.
    turn: Rotation,
    /// d.
    offset: [f64; 2],
}

/// Solves `min Σ (vⱼ − R vᵢ − d)ᵀ W (vⱼ − R vᵢ − d)`; fixed nodes keep their start.
///
/// The third row of every 3×3 block is an identity, so the analysis of the graph can be reused.
fn solve_pairs(
    problem: &Problem,
    linear: &mut LinearSolver,
    start: &[[f64; 2]],
    link: impl Fn(&crate::factor::Between) -> Link,
) -> Result<Vec<[f64; 2]>, OptimizeError> {
    let structure = linear.structure();
    let mut equations = NormalEquations::default();
    equations.clear(structure, 0.0);
    for block in &mut equations.diagonal {
        block[8] = 1.0;
    }
    for (factor, &slot) in problem.factors().iter().zip(&structure.factor_slots) {
        let Link {
            weight: [xx, xy, yy],
            turn: Rotation { cos, sin },
            offset: [dx, dy],
        } = link(factor);
        let [from_x, from_y] = start[factor.from];
        let [to_x, to_y] = start[factor.to];
        let ex = to_x - (cos * from_x - sin * from_y) - dx;
        let ey = to_y - (sin * from_x + cos * from_y) - dy;
        let (gx, gy) = (xx * ex + xy * ey, xy * ex + yy * ey);
        // W R, and Rᵀ W R.
        let (ax, ay) = (xx * cos + xy * sin, xy * cos + yy * sin);
        let (bx, by) = (xy * cos - xx * sin, yy * cos - xy * sin);
        let from = structure.position_of[factor.from] as usize;
        let to = structure.position_of[factor.to] as usize;
        add_pair(&mut equations.diagonal[to], [xx, xy, xy, yy]);
        let (mx, my) = (cos * ax + sin * ay, cos * bx + sin * by);
        add_pair(
            &mut equations.diagonal[from],
            [mx, my, my, cos * by - sin * bx],
        );
        equations.gradient[3 * to] += gx;
        equations.gradient[3 * to + 1] += gy;
        equations.gradient[3 * from] -= cos * gx + sin * gy;
        equations.gradient[3 * from + 1] -= cos * gy - sin * gx;
        equations.add_off_diagonal(slot, &[-ax, -ay, 0.0, -bx, -by, 0.0, 0.0, 0.0, 0.0]);
    }
    equations.hold_fixed(problem, structure, 0.0);
    linear.factorize(&equations, 0.0)?;
    let mut solution = equations.gradient;
    linear.solve(&mut solution);
    let position_of = &linear.structure().position_of;
    Ok(start
        .iter()
        .zip(position_of)
        .map(|(&[x, y], &position)| {
            let k = 3 * position as usize;
            [x - solution[k], y - solution[k + 1]]
        })
        .collect())
}

fn add_pair(block: &mut Block, [xx, yx, xy, yy]: [f64; 4]) {
    block[0] += xx;
    block[1] += yx;
    block[3] += xy;
    block[4] += yy;
}
