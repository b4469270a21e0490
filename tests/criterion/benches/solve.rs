//! Times of the solver on generated graphs: a short and a long walk on a street grid.
//!
//! The workload `solve` has the graph of the lap.

use std::hint::black_box;

use criterion::Criterion;
use nalgebra::{Matrix3, Vector3};
use pr_geom::SE2;
use pr_optim::system::NormalEquations;
use pr_optim::{
    Between, JacobianModel, LinearSolver, Optimizer, Problem, RobustKernel, Settings, SolveSession,
    Start,
};

/// Uniform numbers in (−1, 1) from a 64-bit linear congruential generator (Knuth's constants).
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn twist(&mut self, metres: f64, radians: f64) -> Vector3<f64> {
        Vector3::new(
            metres * self.next(),
            metres * self.next(),
            radians * self.next(),
        )
    }
}

/// A walk of unit steps on a street grid of `side` blocks; every later visit of a crossing is measured
/// against the first one.
fn street_walk(nodes: usize, side: i64) -> Problem {
    let mut noise = Noise(7);
    let mut truth = vec![SE2::identity()];
    let mut first_visit = std::collections::BTreeMap::from([((0_i64, 0_i64), 0_usize)]);
    let mut problem = Problem::new();
    problem.add_fixed_pose(SE2::identity());
    let information = Matrix3::from_diagonal(&Vector3::new(500.0, 500.0, 2000.0));
    while truth.len() < nodes {
        let last = truth[truth.len() - 1];
        let quarter = if noise.next() > 0.4 {
            (2.0 * noise.next()).round()
        } else {
            0.0
        };
        let turned = last * SE2::new(0.0, 0.0, quarter * core::f64::consts::FRAC_PI_2);
        let next = turned * SE2::from_xy(1.0, 0.0);
        let place = (next.x().round() as i64, next.y().round() as i64);
        if place.0.abs() > side || place.1.abs() > side {
            continue;
        }
        let node = truth.len();
        truth.push(next);
        let mut measure = |problem: &mut Problem, from: usize| {
            let measurement = truth[from].between(&next).boxplus(&noise.twist(0.04, 0.02));
            if problem.node_count() == node {
                let pose = problem.poses()[from] * measurement;
                problem.add_pose(pose);
            }
            problem.add_factor(Between {
                from,
                to: node,
                measurement,
                information,
            });
        };
        measure(&mut problem, node - 1);
        match first_visit.get(&place) {
            Some(&before) if before + 1 < node => measure(&mut problem, before),
            Some(_) => {}
            None => {
                first_visit.insert(place, node);
            }
        }
    }
    problem
}

fn settings() -> Settings {
    Settings {
        jacobians: JacobianModel::Exact,
        step_tolerance: 0.0,
        decrease_tolerance: 1e-8,
        ..Settings::default()
    }
}

fn solve(optimizer: &mut Optimizer, mut problem: Problem) -> f64 {
    let session =
        SolveSession::new(optimizer, &mut problem, Start::Auto).expect("a connected graph");
    session.run().report.chi2
}

pub fn parts_of_an_iteration(criterion: &mut Criterion) {
    let problem = street_walk(3500, 25);
    let mut linear = LinearSolver::new(&problem);
    let mut equations = NormalEquations::default();
    let assemble = |equations: &mut NormalEquations, linear: &LinearSolver| {
        let (model, kernel) = (JacobianModel::Exact, RobustKernel::None);
        equations.assemble(&problem, linear.structure(), model, kernel, 1e-9);
    };
    let mut group = criterion.benchmark_group("iteration_3500");
    group.bench_function("analyse", |bencher| {
        bencher.iter(|| LinearSolver::new(black_box(&problem)));
    });
    group.bench_function("assemble", |bencher| {
        bencher.iter(|| assemble(&mut equations, &linear));
    });
    assemble(&mut equations, &linear);
    group.bench_function("factorize", |bencher| {
        bencher.iter(|| linear.factorize(black_box(&equations), 0.0));
    });
    let mut rhs = equations.gradient.clone();
    group.bench_function("solve", |bencher| {
        bencher.iter(|| {
            rhs.copy_from_slice(&equations.gradient);
            linear.solve(black_box(&mut rhs));
        });
    });
    group.bench_function("marginals", |bencher| {
        bencher.iter(|| linear.marginals(&problem))
    });
    group.bench_function("joint_covariance", |bencher| {
        bencher.iter(|| linear.joint_covariance(&problem, 100, black_box(3400)));
    });
    group.finish();
}

pub fn whole_solves(criterion: &mut Criterion) {
    for (name, problem) in [
        ("streets_41", street_walk(41, 2)),
        ("streets_3500", street_walk(3500, 25)),
    ] {
        let mut group = criterion.benchmark_group(name);
        let mut kept = Optimizer::new(settings());
        group.bench_function("warm", |bencher| {
            bencher.iter(|| solve(&mut kept, problem.clone()));
        });
        group.bench_function("cold", |bencher| {
            bencher.iter(|| solve(&mut Optimizer::new(settings()), problem.clone()));
        });
        group.finish();
    }
}
