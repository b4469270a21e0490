"""Changes one place in a solution at a time; a test must fail for each.

    python mutants.py [EXERCISE]

Ends with 1 if a mutant survives that has no reason below. CONTRIBUTING: a new rule of an exercise gets a mutant.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent

#: By exercise: a place in the solution, its replacement, and why no test can fail, if none can.
MUTANTS = {
    "svd_align": [
        ("len(src) == 0", "len(src) == 1"),
        ("np.zeros(3)", "np.ones(3)"),
        ("np.mean(src, axis=0)", "0.0 * src[0]"),
        ("np.mean(dst, axis=0)", "0.0 * dst[0]"),
        ("(src - p_mean).T @ (dst - q_mean)", "(dst - q_mean).T @ (src - p_mean)"),
        ("np.sign(np.linalg.det(v_t.T @ u.T))", "1.0"),
        ("[1.0, sign]", "[sign, 1.0]"),
        ("q_mean - r @ p_mean", "q_mean - p_mean"),
        ("q_mean - r @ p_mean", "q_mean - r.T @ p_mean"),
        ("np.arctan2(r[1, 0], r[0, 0])", "np.arcsin(r[1, 0])"),
        ("np.arctan2(r[1, 0], r[0, 0])", "np.arctan2(r[0, 1], r[0, 0])"),
    ],
    "point_to_plane_step": [
        ("known.sum() < 3", "known.sum() < 4"),
        ("known.sum() < 3", "known.sum() < 2"),
        ("~np.isnan(normals[:, 0])", "np.ones(len(src), bool)"),
        ("c = p.mean(axis=0)", "c = np.zeros(2)"),
        ("c = p.mean(axis=0)", "c = src.mean(axis=0)"),
        ("n * (p - q)", "n * (q - p)"),
        ("- (p - c)[:, 1] * n[:, 0]", "+ (p - c)[:, 1] * n[:, 0]"),
        ("np.trace(h) / 3", "np.trace(h)"),
        ("1e-4 * np.trace(h) / 3 + 1e-12", "1e-12"),
        ("1e-4 * np.trace(h) / 3 + 1e-12", "1e-4"),
        ("1e-4 * np.trace(h) / 3 + 1e-12", "1e-4 * np.trace(h) / 3",
         "1e-12 counts only if all normals and arms are zero"),
        ("-j.T @ e", "j.T @ e"),
        ("rs.compose((x, y, 0.0), about)", "rs.compose(about, (x, y, 0.0))"),
        ("rs.compose((x, y, 0.0), about)", "np.array([x, y, theta])"),
    ],
    "residual": [
        ("rs.log(", "("),
        ("rs.inverse(z), rs.compose", "z, rs.compose"),
        ("rs.inverse(from_), to", "rs.inverse(to), from_"),
        ("rs.compose(rs.inverse(z), rs.compose(rs.inverse(from_), to))",
         "rs.compose(rs.compose(rs.inverse(from_), to), rs.inverse(z))"),
        ("x, y, theta = rs.inverse(z)", "x, y, theta = z"),
        ("-sin, y", "sin, y"),
        ("cos, -x", "cos, x"),
        ("sin, y]", "sin, -y]"),
        ("return -adjoint", "return adjoint"),
        ("np.eye(3)", "-np.eye(3)"),
    ],
    "gauss_newton": [
        ("1e-9 * np.eye(size)", "0.0 * np.eye(size)"),
        ("1e-9 * np.eye(size)", "1e-3 * np.eye(size)"),
        ("np.sqrt(max(e @ omega @ e, 0.0))", "max(e @ omega @ e, 0.0)"),
        ("np.sqrt(max(e @ omega @ e, 0.0))", "np.sqrt(max(e @ e, 0.0))"),
        ("huber / m if", "(huber / m) ** 2 if"),
        ("if m > huber", "if m < huber"),
        ("if k != fixed", "if k != 0"),
        ("if k != fixed", "if True"),
        ("+= left.T @ weighted @ e", "-= left.T @ weighted @ e"),
        ("+= left.T @ weighted @ e", "+= left.T @ omega @ e"),
        ("= np.array(poses, dtype=float)", "= poses",
         "the poses are composed into new ones, so the copy only makes an array of a list"),
        ("+= left.T @ weighted @ right", "= left.T @ weighted @ right"),
        ("3 * fixed + 3):", "3 * fixed + 2):", "1e-9 holds the fixed pose as well, because its gradient is zero"),
        ("h[k, k] += 1.0", "h[k, k] += 2.0", "the gradient of the fixed pose is zero, so any positive diagonal holds it"),
        ("return poses, np.nan", "return poses, 0.0"),
        ("rs.compose(pose, rs.exp(step))", "pose + step"),
        ("rs.compose(pose, rs.exp(step))", "rs.compose(rs.exp(step), pose)"),
        ("np.hypot(steps[:, 0], steps[:, 1]) + np.abs(steps[:, 2])", "np.hypot(steps[:, 0], steps[:, 1])"),
        ("np.max(np.hypot", "np.min(np.hypot"),
        ("np.isnan(largest) or largest < tolerance", "largest < tolerance"),
        ("np.isnan(largest) or largest < tolerance", "np.isnan(largest)"),
        ("fixed, huber)\n        if", "fixed)\n        if"),
        ("range(1, max_iters + 1)", "range(1, max_iters + 2)"),
        ("return poses, step", "return poses, step - 1"),
    ],
    "verify_loop": [
        ("poses[candidate], poses[node])\n", "poses[node], poses[candidate])\n"),
        ("submap(poses, sweeps, candidate, config)", "submap(poses, sweeps, candidate)"),
        ("max(config.radius / 2, 0.6)", "config.radius / 2"),
        ("max(config.radius / 2, 0.6)", "max(config.radius, 0.6)"),
        ("max(config.radius / 2, 0.6)", "0.6"),
        ("max_iterations=30", "max_iterations=25"),
        ("max_iterations=30", "max_iterations=100"),
        ('"point-to-point"', '"point-to-plane"'),
        ("init=belief, ", ""),
        ("rs.between(belief, found.pose)", "rs.between(found.pose, belief)",
         "χ² of a diagonal S is the same for log(T) and log(T⁻¹) = −log(T)"),
        ("rs.log(rs.between(belief, found.pose))", "rs.between(belief, found.pose)"),
        ("rs.log(rs.between(belief, found.pose))", "rs.log(found.pose)"),
        ("(node - candidate) *", "(node - candidate + 1) *"),
        ("(node - candidate) *", "1.0 *"),
        ("config.drift", "(0.045, 0.012)"),
        ("theta**2]", "xy**2]"),
        ("innovation**2 / variances", "np.abs(innovation) / variances"),
        ("moved, normals[partners], *config.trust", "moved, normals[partners], 0.05, 25.0"),
        ("normals[partners]", "normals[paired]"),
        ("1.0, 2500.0", "0.0, 2500.0"),
        ("1.0, 2500.0", "1.0, np.inf"),
        ("<= config.max_rmse", "<= 0.16"),
        ("<= config.max_rmse", "< config.max_rmse"),
        (">= max(config.min_inliers, 8)", ">= 25"),
        (">= max(config.min_inliers, 8)", "> max(config.min_inliers, 8)"),
        (">= max(config.min_inliers, 8)", ">= config.min_inliers"),
        ("chi2 <= config.gate", "chi2 <= 7.815"),
        ("chi2 <= config.gate", "chi2 < config.gate"),
        ("fits and chi2", "fits or chi2"),
        ("pose=found.pose", "pose=belief"),
    ],
    "trimmed_icp": [
        ("lengths < tau**2", "lengths < tau"),
        ("trim > 0 and len(lengths) > 0", "trim > 0"),
        ("trim > 0 and len(lengths) > 0", "False"),
        ("np.ceil((1 - trim)", "np.floor((1 - trim)"),
        ("(1 - trim)", "trim"),
        ("max(1, int", "max(0, int"),
        ("[kept - 1]", "[0]"),
        ("len(trace) <= max_iterations", "len(trace) < max_iterations"),
        ("len(trace) <= max_iterations", "True"),
        ("len(moved) >= min_pairs", "len(moved) > min_pairs"),
        ("len(moved) >= min_pairs", "len(moved) > 0"),
        ("rs.compose(step, pose)", "rs.compose(pose, step)"),
        ("trace = [pose]", "trace = []"),
        ("converged = False", "converged = True"),
        ("measures_pose(moved, known, variant, min_pairs)", "True"),
        ("+ abs(step[2]) < tolerance", "< tolerance"),
        ("+ abs(step[2]) < tolerance", "+ abs(step[2]) < 1e-4"),
        ("np.where(np.isnan(along), errors, along)", "along"),
        ("if is_plane:\n        along", "if False:\n        along"),
        ("else np.inf", "else 0.0"),
        ("len(errors), np", "len(source), np"),
        ("    moved, nearest = associate(source, target, pose, max_distance, trim)\n    while",
         "    moved, nearest = associate(source, target, pose, max_distance, 0.0)\n    while"),
    ],
    "range_histogram": [
        ("BINS - 1).astype", "BINS).astype"),
        ("(BINS / max_range)", "((BINS - 1) / max_range)"),
        ("/ max(len(points), 1)", ""),
        ("a + b > 0", "a * b > 0"),
        ("0.5 * np.sum", "np.sum"),
        ("(a - b) ** 2", "np.abs(a - b)"),
        ("node + 1 - min_gap", "node - min_gap"),
        ("min(node, max(node + 1 - min_gap, 0))", "max(node + 1 - min_gap, 0)"),
        ("sorted(alike)", "alike"),
        ("sorted(alike)", "sorted(alike, reverse=True)"),
        ("distance <= max_distance", "distance < max_distance"),
        ("/ max_range", "/ 6.0"),
    ],
}


def survives(name, solution):
    """Whether every test of an exercise passes with this text of its solution."""
    with tempfile.TemporaryDirectory() as folder:
        for file in (HERE / "solutions").glob("*.py"):
            Path(folder, file.name).write_text(file.read_text("utf-8"), "utf-8")
        Path(folder, f"{name}.py").write_text(solution, "utf-8")
        command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", f"tests/test_{name}.py"]
        environment = dict(os.environ, EXERCISES=folder, PYTHONDONTWRITEBYTECODE="1")
        return subprocess.run(command, cwd=HERE, env=environment, capture_output=True).returncode == 0


def main(chosen):
    """Runs the mutants of the chosen exercises, or of all."""
    unexplained = 0
    for name in chosen or MUTANTS:
        text = (HERE / "solutions" / f"{name}.py").read_text("utf-8")
        for place, instead, *reason in MUTANTS[name]:
            if place not in text:
                sys.exit(f"{name}: {place!r} is not in the solution")
            if survives(name, text.replace(place, instead, 1)):
                unexplained += not reason
                print(f"{name}: {place!r} → {instead!r} survives: {reason[0] if reason else 'no reason is known'}")
        print(f"{name}: {len(MUTANTS[name])} mutants")
    return unexplained > 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
