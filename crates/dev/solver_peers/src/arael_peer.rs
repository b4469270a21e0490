//! arael 0.9: Levenberg–Marquardt on generated derivatives, sparse faer backend.
// The macros write code that is neither documented nor free of clippy's warnings.
#![allow(missing_docs, clippy::all)]

use arael::model::{CrossBlock, Param, SelfBlock};
use arael::refs::{self, Ref};
use arael::simple_lm::{LmConfig, LmSession, SparseFaer};
use arael::vect::{vect2d, vect3d};
use bench_support::timed;
use pr_geom::SE2;
use pr_optim::Problem;

use crate::{Peer, Solve};

#[arael::model]
struct Pose {
    position: Param<vect2d>,
    heading: Param<f64>,
    block: SelfBlock<Pose>,
}

/// g2o's residual, whitened: the rows are a square root of Ω, its planar part turned by −θ_z.
#[arael::model]
#[arael(constraint(block, {
    let shift = matrix2sym::rotation(from.heading).transpose() * (to.position - from.position)
        - link.shift;
    let turn = rad_diff(to.heading, from.heading + link.turn);
    [link.row_x.x * shift.x + link.row_x.y * shift.y + link.row_x.z * turn,
     link.row_y.x * shift.x + link.row_y.y * shift.y + link.row_y.z * turn,
     link.row_t.x * shift.x + link.row_t.y * shift.y + link.row_t.z * turn]
}))]
struct Link {
    #[arael(ref = root.poses)]
    from: Ref<Pose>,
    #[arael(ref = root.poses)]
    to: Ref<Pose>,
    shift: vect2d,
    turn: f64,
    row_x: vect3d,
    row_y: vect3d,
    row_t: vect3d,
    block: CrossBlock<Pose, Pose>,
}

#[arael::model]
#[arael(root)]
struct Graph {
    poses: refs::Vec<Pose>,
    links: std::vec::Vec<Link>,
}

fn graph_of(problem: &Problem) -> Graph {
    let mut graph = Graph {
        poses: refs::Vec::new(),
        links: std::vec::Vec::new(),
    };
    for (pose, &is_fixed) in problem.poses().iter().zip(problem.fixed()) {
        let position = vect2d::new(pose.x(), pose.y());
        let heading = pose.theta();
        // The same fixed node as in our solver: the file's FIX, or its first vertex.
        let (position, heading) = if is_fixed {
            (Param::fixed(position), Param::fixed(heading))
        } else {
            (Param::new(position), Param::new(heading))
        };
        graph.poses.push(Pose {
            position,
            heading,
            block: SelfBlock::new(),
        });
    }
    for factor in problem.factors() {
        let z = factor.measurement;
        let turned = z.rotation();
        // Rows of Lᵀ, Ω = L Lᵀ, applied to (Rᵀ shift, turn).
        let [row_x, row_y, row_t] = transposed_cholesky(factor).map(|[a, b, c]| {
            let (x, y) = turned.rotate(a, b);
            vect3d::new(x, y, c)
        });
        graph.links.push(Link {
            from: graph.poses.ref_at(factor.from),
            to: graph.poses.ref_at(factor.to),
            shift: vect2d::new(z.x(), z.y()),
            turn: z.theta(),
            row_x,
            row_y,
            row_t,
            block: CrossBlock::new(),
        });
    }
    graph
}

fn transposed_cholesky(factor: &pr_optim::Between) -> [[f64; 3]; 3] {
    let omega = |row: usize, column: usize| factor.information[(row, column)];
    let xx = omega(0, 0).sqrt();
    let (yx, tx) = (omega(1, 0) / xx, omega(2, 0) / xx);
    let yy = (omega(1, 1) - yx * yx).sqrt();
    let ty = (omega(2, 1) - yx * tx) / yy;
    let tt = (omega(2, 2) - tx * tx - ty * ty).sqrt();
    [[xx, yx, tx], [0.0, yy, ty], [0.0, 0.0, tt]]
}

fn config() -> LmConfig<f64> {
    LmConfig {
        initial_lambda: 1e-14,
        rel_precision: 1e-6,
        abs_precision: 0.0,
        gradient_tolerance: None,
        num_threads: 1,
        ..LmConfig::well_conditioned()
    }
}

/// arael with a graph, and a session that keeps the symbolic analysis.
pub struct Arael {
    problem: Problem,
    session: LmSession<f64, SparseFaer<f64>>,
}

impl Arael {
    /// Keeps the graph.
    pub fn new(problem: Problem) -> Self {
        Self {
            problem,
            session: LmSession::new(SparseFaer::new()),
        }
    }
}

fn solve(session: &mut LmSession<f64, SparseFaer<f64>>, problem: &Problem) -> Solve {
    let mut graph = graph_of(problem);
    let config = config();
    let (result, cpu_ms) = timed(|| session.solve(&mut graph, &config));
    let poses = || {
        let poses = graph.poses.iter();
        poses
            .map(|pose| {
                let position = pose.position.value;
                SE2::new(position.x, position.y, pose.heading.value)
            })
            .collect()
    };
    Solve {
        cpu_ms,
        poses: result.is_ok().then(poses),
        iterations: result.ok().map(|result| result.iterations),
    }
}

impl Peer for Arael {
    fn name(&self) -> &'static str {
        "arael"
    }

    fn solve_cold(&mut self) -> Solve {
        solve(&mut LmSession::new(SparseFaer::new()), &self.problem)
    }

    fn solve_warm(&mut self) -> Option<Solve> {
        Some(solve(&mut self.session, &self.problem))
    }
}
