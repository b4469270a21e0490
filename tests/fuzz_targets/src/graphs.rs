//! Arbitrary sparse pose graphs, with every start, method, kernel and factorization.

use arbitrary::{Result, Unstructured};
use nalgebra::Matrix3;
use pr_geom::SE2;
use pr_optim::robust::{GncSettings, is_sequential, select_inliers};
use pr_optim::{Between, FactorUse, JacobianModel, Method, Problem, RobustKernel, Settings, Start};

use crate::numbers::{finite, scale, tame};
use crate::solve::solve;

const MAX_NODES: usize = 10;
const MAX_FACTORS: usize = 16;
const MAX_ITERATIONS: usize = 10;

/// The result is finite and costs no more than its start, or the error is typed; never a panic.
pub fn fuzz(data: &[u8]) {
    let mut bytes = Unstructured::new(data);
    // Missing bytes read as zeros.
    if let Ok((mut problem, settings, start)) = case(&mut bytes) {
        choose_loops(&problem, settings);
        solve(&mut problem, settings, start);
    }
}

/// Selects inlier loops, or returns a typed error.
fn choose_loops(problem: &Problem, solver: Settings) {
    let trusted: Vec<bool> = problem.factors().iter().map(is_sequential).collect();
    let Ok(selection) = select_inliers(problem, &trusted, solver, &GncSettings::default()) else {
        return;
    };
    assert!(selection.cost.is_finite());
    let is_finite = |pose: &SE2| {
        [pose.x(), pose.y(), pose.theta()]
            .iter()
            .all(|v| v.is_finite())
    };
    assert!(selection.poses.iter().all(is_finite));
    let pairs = trusted.iter().zip(&selection.inliers);
    assert!(pairs.fold(true, |all, (trusted, inliers)| all
        && (!trusted || *inliers)));
}

fn case(bytes: &mut Unstructured<'_>) -> Result<(Problem, Settings, Start)> {
    let settings = settings(bytes)?;
    let start = *bytes.choose(&[
        Start::Auto,
        Start::Given,
        Start::SpanningTree,
        Start::Chordal,
        Start::LeastSquares,
    ])?;
    let mut problem = Problem::new();
    let nodes = bytes.int_in_range(1..=MAX_NODES)?;
    for node in 0..nodes {
        let pose = pose(bytes)?;
        // Most graphs have only their first node fixed.
        if node == 0 || bytes.ratio(1, 16)? {
            problem.add_fixed_pose(pose);
        } else {
            problem.add_pose(pose);
        }
    }
    if nodes == 1 {
        return Ok((problem, settings, start));
    }
    for _ in 0..bytes.int_in_range(0..=MAX_FACTORS)? {
        let from = bytes.int_in_range(0..=nodes - 1)?;
        let to = (from + bytes.int_in_range(1..=nodes - 1)?) % nodes;
        problem.add_factor(Between {
            from,
            to,
            measurement: pose(bytes)?,
            information: information(bytes)?,
        });
    }
    Ok((problem, settings, start))
}

fn settings(bytes: &mut Unstructured<'_>) -> Result<Settings> {
    let positive = |bytes: &mut Unstructured<'_>| -> Result<f64> {
        Ok(tame(bytes)?.abs().max(1e-3) * scale(bytes)?)
    };
    Ok(Settings {
        method: if bytes.arbitrary()? {
            Method::GaussNewton
        } else {
            Method::LevenbergMarquardt {
                initial_damping: *bytes.choose(&[1e-4, 0.0, 1e-12, 1.0, 1e6])?,
            }
        },
        jacobians: *bytes.choose(&[JacobianModel::Exact, JacobianModel::Chapter])?,
        kernel: match bytes.int_in_range(0..=3)? {
            0 => RobustKernel::Huber {
                width: positive(bytes)?,
            },
            1 => RobustKernel::Dcs {
                phi: positive(bytes)?,
            },
            _ => RobustKernel::None,
        },
        max_iterations: bytes.int_in_range(0..=MAX_ITERATIONS)?,
        step_tolerance: *bytes.choose(&[1e-6, 0.0, 1e-12])?,
        decrease_tolerance: *bytes.choose(&[0.0, 1e-8, 0.5])?,
        ridge: *bytes.choose(&[1e-9, 0.0, 1.0])?,
        factor_use: *bytes.choose(&[FactorUse::EveryStep, FactorUse::WhileStepsShrink])?,
    })
}

fn pose(bytes: &mut Unstructured<'_>) -> Result<SE2> {
    Ok(if bytes.ratio(15, 16)? {
        SE2::new(tame(bytes)?, tame(bytes)?, tame(bytes)?)
    } else {
        SE2::new(finite(bytes)?, finite(bytes)?, finite(bytes)?)
    })
}

/// `L Lᵀ` of a tame `L`, scaled; sometimes any symmetric matrix, definite or not.
fn information(bytes: &mut Unstructured<'_>) -> Result<Matrix3<f64>> {
    match bytes.int_in_range(0..=15)? {
        0..=7 => Ok(Matrix3::identity() * scale(bytes)?),
        8..=13 => {
            let [a, b, c] = [tame(bytes)?, tame(bytes)?, tame(bytes)?];
            let [d, e, f] = [tame(bytes)?, tame(bytes)?, tame(bytes)?];
            let root = Matrix3::new(a, 0.0, 0.0, b, c, 0.0, d, e, f);
            Ok(root * root.transpose() * scale(bytes)?)
        }
        _ => {
            let [a, b, c] = [finite(bytes)?, finite(bytes)?, finite(bytes)?];
            let [d, e, f] = [finite(bytes)?, finite(bytes)?, finite(bytes)?];
            Ok(Matrix3::new(a, b, c, b, d, e, c, e, f))
        }
    }
}
