//! Loops tested alone by the gate, and against each other by pairwise consistency and graduated non-convexity.

use ch16_lab::lap::LapConfig;
use ch16_slam2d::chapter::path_information;
use ch16_slam2d::loops::chi_squared_gate;
use ch16_slam2d::prelude::Vector3;
use nalgebra::Matrix3;
use pr_geom::{Rng, SE2};
use pr_optim::robust::{ConsistencySettings, Gnc, GncSettings, consistent_set, is_sequential};
use pr_optim::{Between, JacobianModel, Problem, Settings};
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::{Shown, SketchSpec, Slider};

/// Poses of one round of a ring; the robot drives two.
const ROUND: usize = 20;
/// Length of an edge, m.
const EDGE_M: f64 = 0.4;
/// Standard deviations of an edge and of a loop, m and rad.
const EDGE_SIGMAS: [f64; 2] = [0.015, 0.004];
const LOOP_SIGMAS: [f64; 2] = [0.02, 0.005];
/// True loops; the nodes of the false ones lie between theirs.
const TRUE_LOOPS: usize = 5;
/// What every false loop claims: the second round lies here on the first, m.
const LIE_M: f64 = 0.4;

/// The three tests, as rows of the picture from below.
const TESTS: [&str; 3] = ["GNC", "pairwise", "gate"];

pub(super) const SKETCH: SketchSpec = SketchSpec {
    name: "agree",
    title: "Loops against each other",
    slider: Slider {
        label: "false loops that agree",
        unit: "",
        min: 0.0,
        max: 10.0,
        step: 1.0,
        default: 3.0,
        decimals: 0,
    },
    at,
    handle,
};

/// The last loop.
fn handle(false_loops: f64) -> (&'static str, [f64; 2]) {
    ("agree", [TRUE_LOOPS as f64 + false_loops, 3.6])
}

fn noise(sigmas: [f64; 2], rng: &mut Rng) -> SE2 {
    let [position, heading] = sigmas;
    let draws = [position, position, heading].map(|sigma| rng.normal(0.0, sigma));
    SE2::exp(&Vector3::from(draws))
}

fn information([position, heading]: [f64; 2]) -> Matrix3<f64> {
    let variances = [position, position, heading].map(|sigma| sigma * sigma);
    Matrix3::from_diagonal(&Vector3::from(variances.map(|variance| 1.0 / variance)))
}

/// Two rounds of a ring by odometry, then the true loops, then the false ones.
fn graph(false_loops: usize) -> Problem {
    let mut rng = Rng::new(16);
    let turn = core::f64::consts::TAU / ROUND as f64;
    let step = SE2::new(EDGE_M, 0.0, turn);
    let mut problem = Problem::new();
    let mut truth = vec![SE2::identity()];
    problem.add_fixed_pose(truth[0]);
    for from in 0..2 * ROUND {
        let measurement = step * noise(EDGE_SIGMAS, &mut rng);
        let pose = problem.poses()[from] * measurement;
        truth.push(truth[from] * step);
        problem.add_pose(pose);
        problem.add_factor(Between {
            from,
            to: from + 1,
            measurement,
            information: information(EDGE_SIGMAS),
        });
    }
    let mut close = |from: usize, lie: SE2| {
        let to = from + ROUND;
        let measurement = truth[from].between(&(lie * truth[to])) * noise(LOOP_SIGMAS, &mut rng);
        problem.add_factor(Between {
            from,
            to,
            measurement,
            information: information(LOOP_SIGMAS),
        });
    };
    for k in 0..TRUE_LOOPS {
        close(4 * k, SE2::identity());
    }
    for k in 0..false_loops {
        close(
            (2 + 4 * k) % ROUND + k / TRUE_LOOPS,
            SE2::from_xy(LIE_M, 0.0),
        );
    }
    problem
}

/// Which loops each of the tests accepts, in the order of [`TESTS`].
fn accepted(problem: &Problem) -> [Vec<bool>; 3] {
    let factors = problem.factors();
    let loops = |accepted: &dyn Fn(usize, &Between) -> bool| -> Vec<bool> {
        let loops = factors.iter().enumerate();
        let loops = loops.filter(|(_, factor)| !is_sequential(factor));
        loops
            .map(|(index, factor)| accepted(index, factor))
            .collect()
    };
    let config = LapConfig::default().slam.chapter.loops;
    let passes = |_: usize, factor: &Between| {
        let predicted = problem.poses()[factor.from].between(&problem.poses()[factor.to]);
        let innovation = predicted.between(&factor.measurement).log();
        let information = path_information(factor.to - factor.from, &config);
        chi_squared_gate(&innovation, &information, config.gate_chi2).passes()
    };
    let trusted = factors.iter().map(is_sequential).collect();
    let solver = Settings {
        jacobians: JacobianModel::Exact,
        ..Settings::default()
    };
    let gnc = Gnc::new(problem, trusted, solver, GncSettings::default()).run(&mut problem.clone());
    let consistent = consistent_set(problem, &ConsistencySettings::default());
    [
        loops(&|index, _| gnc.as_ref().is_ok_and(|outcome| outcome.is_inlier(index))),
        loops(&|index, _| consistent[index]),
        loops(&passes),
    ]
}

/// Numbers of accepted true and false loops.
fn counts(accepted: &[bool]) -> [usize; 2] {
    let count = |loops: &[bool]| loops.iter().filter(|loop_| **loop_).count();
    let (right, wrong) = accepted.split_at(TRUE_LOOPS);
    [count(right), count(wrong)]
}

fn at(false_loops: f64) -> Shown {
    let false_loops = false_loops as usize;
    let accepted = accepted(&graph(false_loops));
    let [gnc, pairs, gate] = [0, 1, 2].map(|test| counts(&accepted[test]));
    let sentence = format!(
        "Of {TRUE_LOOPS} true and {false_loops} false loops, the gate accepts {} and {}, pairwise consistency {} and {}, GNC {} \
         and {}.",
        gate[0], gate[1], pairs[0], pairs[1], gnc[0], gnc[1]
    );
    Shown {
        scene: Scene {
            panels: vec![picture(&accepted)],
        },
        sentence,
    }
}

fn picture(accepted: &[Vec<bool>; 3]) -> Panel {
    let places = |is_accepted: bool, is_true: bool| -> Vec<[f64; 2]> {
        let rows = accepted.iter().enumerate();
        rows.flat_map(|(row, loops)| {
            let here = loops
                .iter()
                .enumerate()
                .filter(move |(k, loop_)| **loop_ == is_accepted && (*k < TRUE_LOOPS) == is_true);
            here.map(move |(k, _)| [k as f64 + 1.0, row as f64 + 1.0])
        })
        .collect()
    };
    let border = TRUE_LOOPS as f64 + 0.5;
    let newest = accepted[0].len() as f64;
    Panel {
        id: "agree",
        title: "Which loops each test accepts".to_owned(),
        weight: Weight::Main,
        aspect: Aspect::Free,
        x: Axis::new("loop number", 0.4, TRUE_LOOPS as f64 + 10.6),
        y: Axis {
            max: 4.2,
            ..Axis::from_names("", TESTS.map(str::to_owned))
        },
        layers: vec![
            Layer::segments(
                vec![[[border, 0.4], [border, 4.2]]],
                Stroke::Dotted,
                Tone::Ink,
                1.5,
            ),
            Layer::points(places(true, true), Mark::Square, Tone::Posterior, 6.0),
            Layer::points(places(true, false), Mark::Square, Tone::Strained, 6.0),
            Layer::points(places(false, true), Mark::Circle, Tone::Truth, 5.0),
            Layer::points(places(false, false), Mark::Circle, Tone::Truth, 5.0),
            Layer::points(vec![[newest, 3.6]], Mark::Triangle, Tone::Ink, 5.0),
        ],
        legend: vec![
            LegendEntry::mark("true, accepted", Tone::Posterior, Mark::Square),
            LegendEntry::mark("false, accepted", Tone::Strained, Mark::Square),
            LegendEntry::mark("rejected", Tone::Truth, Mark::Circle),
        ],
        color_bar: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pr_optim::robust::with_factors;

    fn all(false_loops: usize) -> [[usize; 2]; 3] {
        let accepted = accepted(&graph(false_loops));
        [0, 1, 2].map(|test| counts(&accepted[test]))
    }

    #[test]
    fn without_a_lie_every_test_takes_every_loop() {
        assert_eq!(all(0), [[TRUE_LOOPS, 0]; 3]);
    }

    /// The gate tests each loop alone: how many others agree is nothing to it.
    #[test]
    fn the_gate_takes_false_loops_that_the_others_reject_while_true_ones_are_the_majority() {
        for false_loops in 1..TRUE_LOOPS - 1 {
            let [gnc, pairs, gate] = all(false_loops);
            assert_eq!(gate, [TRUE_LOOPS, false_loops]);
            assert_eq!(
                (gnc, pairs),
                ([TRUE_LOOPS, 0], [TRUE_LOOPS, 0]),
                "{false_loops}"
            );
        }
    }

    #[test]
    fn pairwise_consistency_follows_a_majority_and_gnc_weighs_odometry_as_well() {
        let [gnc, pairs, _] = all(10);
        assert_eq!((gnc, pairs), ([TRUE_LOOPS, 0], [0, 10]));
        // Odometry decides: the less it is trusted, the more of the lie GNC accepts.
        assert!(accepted_if_odometry_counts(0.1)[1] > 0);
        assert_eq!(accepted_if_odometry_counts(0.03)[1], 10);
    }

    /// What GNC accepts if the information of odometry is multiplied by `weight`.
    fn accepted_if_odometry_counts(weight: f64) -> [usize; 2] {
        let graph = graph(10);
        let mut doubted = with_factors(&graph, |_| false);
        for factor in graph.factors() {
            let weight = if is_sequential(factor) { weight } else { 1.0 };
            doubted.add_factor(Between {
                information: factor.information * weight,
                ..*factor
            });
        }
        counts(&accepted(&doubted)[0])
    }
}
