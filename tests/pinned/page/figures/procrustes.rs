//! Rotations and reflections over pairs of points, like w16.11.

use ch16_lab::procrustes::{Handedness, Pairs, Procrustes, Shape, Winner};

/// Seeds of the noise along the wall, from 1 on.
const SEEDS: u32 = 1000;

/// `wall.mirrored`, `upside.turn.cost`: by shape, then by kind of matrix.
pub fn value(path: &[&str]) -> Option<f64> {
    let problem = |shape, seed| {
        let pairs = Pairs::seen(shape, seed);
        Procrustes::new(&pairs.source, &pairs.target)
    };
    match *path {
        ["wall", "seeds"] => Some(f64::from(SEEDS)),
        ["wall", "mirrored"] => {
            let mirrored = |seed: &u32| problem(Shape::Wall, *seed).winner() == Winner::Mirror;
            Some((1..=SEEDS).filter(mirrored).count() as f64)
        }
        [shape, kind, "cost"] => {
            let shape = match shape {
                "upside" => Shape::UpsideDown,
                _ => return None,
            };
            let kind = match kind {
                "turn" => Handedness::Turn,
                "mirror" => Handedness::Mirror,
                _ => return None,
            };
            let problem = problem(shape, 1);
            Some(problem.cost_m2(kind, problem.best(kind).theta_rad))
        }
        _ => None,
    }
}
