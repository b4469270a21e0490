"""Changes one place in a Rust solution at a time; a test must fail for each.

    python teaching/exercises/mutants.py [EXERCISE]

The mutant replaces the student's file, which is restored at the end. The script ends with 1 if a mutant survives
that has no reason below. `python/mutants.py` does the same in Python.
"""

import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
LISTINGS = HERE.parent.parent / "crates/core/ch16_listings/src"
OURS = HERE / "solutions/src"
HEAD = """#![allow(warnings, missing_docs, clippy::all, clippy::pedantic)]
use ch16_listings::*;
use nalgebra::{Matrix2, Matrix3, Point2, Vector2, Vector3};
use petgraph::graph::NodeIndex;
"""

#: By exercise: the file of its solution, where that begins, and the mutants: a place, its replacement, and why no
#: test can fail, if none can.
EXERCISES = {
    "svd_align": (LISTINGS / "align.rs", "pub fn svd_align", [
        ("src.is_empty()", "src.len() == 1"),
        ("(mean(src), mean(dst))", "(Vector2::zeros(), mean(dst))"),
        ("(mean(src), mean(dst))", "(mean(src), Vector2::zeros())"),
        ("v * Matrix2::from_diagonal(&Vector2::new(1.0, sign))", "v"),
        ("Vector2::new(1.0, sign)", "Vector2::new(sign, 1.0)"),
        ("q_mean - r * p_mean", "q_mean - p_mean"),
        ("q_mean - r * p_mean", "q_mean - r.transpose() * p_mean"),
        ("(r[(1, 0)], r[(0, 0)])", "(r[(0, 1)], r[(0, 0)])"),
        ("atan2(r[(1, 0)], r[(0, 0)])", "asin(r[(1, 0)])"),
    ]),
    "point_to_plane_step": (LISTINGS / "align.rs", "pub fn point_to_plane_step", [
        ("planes.len() < MIN_ROWS", "planes.len() < 4"),
        ("planes.len() < MIN_ROWS", "planes.len() < 2"),
        ("n.dot(&(pair.src - pair.dst))", "n.dot(&(pair.dst - pair.src))"),
        ("sum / planes.len() as f64", "Vector2::zeros()"),
        ("(p.coords - centroid).perp(&n)", "n.perp(&(p.coords - centroid))"),
        ("1e-4 * h.trace() / 3.0 + 1e-12", "1e-12"),
        ("1e-4 * h.trace() / 3.0 + 1e-12", "1e-4"),
        ("h.trace() / 3.0", "h.trace()"),
        ("solve(&-g)", "solve(&g)"),
        ("* about * SE2::new(Vector2::zeros(), step.z) * about.inverse()", "* SE2::new(Vector2::zeros(), step.z)"),
        ("SE2::new(step.xy(), 0.0) * about * SE2::new(Vector2::zeros(), step.z) * about.inverse()",
         "about * SE2::new(Vector2::zeros(), step.z) * about.inverse() * SE2::new(step.xy(), 0.0)"),
    ]),
    "residual": (OURS / "residual.rs", "pub fn residual", [
        ("z.inverse() * from.inverse() * *to", "from.inverse() * *to * z.inverse()"),
        ("z.inverse() * from.inverse() * *to", "z.inverse() * to.inverse() * *from"),
        ("z.inverse() * from.inverse() * *to", "*z * from.inverse() * *to"),
        ("-z.inverse().adjoint()", "z.inverse().adjoint()"),
        ("-z.inverse().adjoint()", "-z.adjoint()"),
        ("-z.inverse().adjoint()", "-Matrix3::identity()"),
        (", Matrix3::identity())", ", -Matrix3::identity())"),
    ]),
    "gauss_newton": (OURS / "gauss_newton.rs", "pub fn optimize_once", [
        ("* 1e-9", "* 0.0"),
        ("* 1e-9", "* 1e-3"),
        ("e.dot(&(edge.omega * e)).sqrt()", "e.dot(&(edge.omega * e))"),
        ("e.dot(&(edge.omega * e)).sqrt()", "e.norm()"),
        ("huber / m }", "(huber / m).powi(2) }"),
        ("if m > huber", "if m < huber"),
        ("*node != fixed", "true"),
        ("gradient += left.transpose() * omega", "gradient -= left.transpose() * omega"),
        ("gradient += left.transpose() * omega", "gradient += left.transpose() * edge.omega"),
        ("block += left", "block -= left"),
        ("h[(k, k)] += 1.0", "h[(k, k)] += 2.0", "the gradient of the fixed pose is zero, so any positive diagonal holds it"),
        ("return f64::NAN", "return 0.0"),
        ("graph.graph[node] * SE2::exp(&correction)", "SE2::exp(&correction) * graph.graph[node]"),
        (" + correction.z.abs()", ""),
        ("largest.max(", "largest.min("),
        ("largest.is_nan() || ", ""),
        ("|| largest < tolerance", ""),
        ("optimize_once(graph, huber);", "optimize_once(graph, f64::INFINITY);"),
        ("return step", "return step - 1"),
        ("1..=max_iters", "1..=max_iters + 1"),
    ]),
    "verify_loop": (LISTINGS / "loop_closure.rs", "pub fn verify_loop", [
        ("candidate_from_world * graph.pose(node)", "graph.pose(node) * candidate_from_world"),
        ("(cfg.radius / 2.0).max(0.6)", "cfg.radius / 2.0"),
        ("(cfg.radius / 2.0).max(0.6)", "0.6"),
        ("(cfg.radius / 2.0).max(0.6)", "cfg.radius.max(0.6)"),
        ("max_iters: 30,", ""),
        ("max_iters: 30,", "max_iters: 100,"),
        ("max_iters: 30,", "max_iters: 30, variant: IcpVariant::PointToPlane,"),
        ("&map, belief, &settings", "&map, SE2::identity(), &settings"),
        ("(belief.inverse() * found.pose).log()", "found.pose.log()"),
        ("(belief.inverse() * found.pose).log()", "(found.pose.inverse() * belief).log()",
         "χ² of a diagonal S is the same for log(T) and log(T⁻¹) = −log(T)"),
        ("(node.index() - candidate.index()) as f64", "1.0"),
        ("(node.index() - candidate.index()) as f64", "(node.index() - candidate.index() + 1) as f64"),
        ("= cfg.drift;", "= (0.045, 0.012);"),
        ("theta * theta)", "xy * xy)"),
        ("&found.pose, settings.tau", "&belief, settings.tau"),
        ("= cfg.trust;", "= (0.05, 25.0);"),
        ("sigma, inflate), 1.0", "sigma, inflate), 0.0"),
        ("2500.0)", "f64::INFINITY)"),
        ("z: found.pose", "z: belief"),
        ("EdgeKind::Loop", "EdgeKind::Odometry"),
        ("found.rmse <= cfg.max_rmse", "found.rmse <= 0.16"),
        ("found.rmse <= cfg.max_rmse", "found.rmse < cfg.max_rmse"),
        (">= cfg.min_inliers.max(settings.min_pairs)", ">= 25"),
        (">= cfg.min_inliers.max(settings.min_pairs)", "> cfg.min_inliers.max(settings.min_pairs)"),
        (">= cfg.min_inliers.max(settings.min_pairs)", ">= cfg.min_inliers"),
        ("chi2 <= cfg.gate", "chi2 <= 7.815"),
        ("chi2 <= cfg.gate", "chi2 < cfg.gate"),
        ("\n            && chi2", "\n            || chi2"),
    ]),
    "trimmed_icp": (LISTINGS / "registration.rs", "pub fn icp", [
        ("share <= 0.0 || pairs.is_empty()", "share <= 0.0", "with no pairs, no length is read"),
        ("share <= 0.0 || pairs.is_empty()", "true"),
        (".ceil().max(1.0)", ".floor().max(1.0)"),
        (".ceil().max(1.0)", ".ceil()"),
        ("(1.0 - share)", "share"),
        ("lengths[kept - 1]", "lengths[0]"),
        ("trace.len() <= cfg.max_iters", "trace.len() < cfg.max_iters"),
        ("trace.len() <= cfg.max_iters && ", ""),
        ("pairs.len() >= cfg.min_pairs", "pairs.len() > cfg.min_pairs"),
        ("increment * pose", "pose * increment"),
        ("measures_pose(&pairs, cfg);", "true;"),
        ("measures_pose(&pairs, cfg);", "pairs.len() >= cfg.min_pairs;"),
        ("converged = false", "converged = true"),
        ("vec![pose]", "vec![]"),
        ("increment.step_size() < cfg.tolerance", "increment.log().xy().norm() < cfg.tolerance"),
        ("increment.step_size() < cfg.tolerance", "increment.step_size() < 1e-4"),
        ("f64::INFINITY", "0.0"),
        ("(IcpVariant::PointToPlane, Some(n)) =>", "(IcpVariant::PointToPlane, Some(n)) if false =>"),
        ("/ pairs.len() as f64", ""),
        ("inliers: pairs.len()", "inliers: cloud.points.len()"),
    ]),
    "range_histogram": (OURS / "range_histogram.rs", "pub fn range_histogram", [
        ("bin.min(64 - 1)", "bin.min(64 - 2)"),
        ("64 as f64 / max_range", "63.0 / max_range"),
        ("1.0 / cloud.points.len() as f64", "1.0"),
        ("*a + *b > 0.0", "*a * *b > 0.0"),
        ("0.5 * terms", "terms"),
        ("(a - b).powi(2)", "(a - b).abs()"),
        ("(node + 1).saturating_sub(min_gap)", "node.saturating_sub(min_gap)"),
        (".min(node)", ".min(node + 1)"),
        ("*distance <= max_distance", "*distance < max_distance"),
        ("a.0.total_cmp(&b.0)", "b.0.total_cmp(&a.0)"),
    ]),
}


def solution(source, start):
    """The text of a solution from there on, without what only the listings have."""
    text = source.read_text("utf-8")
    text = text[text.index(start):].split("\n/// The sweeps around a node", 1)[0]
    for there, here in (("pr_geom::math::atan2", "f64::atan2"), ("math::sqrt", "f64::sqrt"), ("MIN_ROWS", "3"), ("BINS", "64"),
                        ("RIDGE", "1e-9")):
        text = text.replace(there, here)
    return text


def survives(name, text):
    """Whether the exercise compiles and every test of it passes with this solution."""
    head = HEAD
    if name == "gauss_newton":
        head += "use nalgebra::{DMatrix, DVector};\nuse petgraph::visit::EdgeRef;\n"
        head += solution(OURS / "residual.rs", "pub fn residual")
    (HERE / f"src/{name}.rs").write_text(head + text, "utf-8")
    test = ["cargo", "test", "--quiet", "-p", "exercises"]
    built = subprocess.run([*test, "--no-run"], cwd=HERE, capture_output=True, text=True)
    if built.returncode != 0:
        sys.exit(f"{name}: a mutant does not compile:\n{built.stderr}")
    return subprocess.run([*test, f"{name}::"], cwd=HERE, capture_output=True).returncode == 0


def unexplained(name):
    """The number of mutants of an exercise that survive without a reason."""
    source, start, mutants = EXERCISES[name]
    student = HERE / f"src/{name}.rs"
    text, before, count = solution(source, start), student.read_bytes(), 0
    try:
        if not survives(name, text):
            sys.exit(f"{name}: the solution itself fails")
        for place, instead, *reason in mutants:
            if place not in text:
                sys.exit(f"{name}: {place!r} is not in the solution")
            if survives(name, text.replace(place, instead, 1)):
                count += not reason
                print(f"{name}: {place!r} → {instead!r} survives: {reason[0] if reason else 'no reason is known'}", flush=True)
    finally:
        student.write_bytes(before)
    print(f"{name}: {len(mutants)} mutants", flush=True)
    return count


if __name__ == "__main__":
    sys.exit(sum(unexplained(name) for name in sys.argv[1:] or EXERCISES) > 0)
