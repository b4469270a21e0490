//! Scores from squared distances by a table, without an exponential each.

use pr_geom::math;

/// The score of a cell with a point at its centre.
pub(super) const FULL_SCORE: u8 = u8::MAX;

/// Scores are 0 beyond this many σ.
pub(super) const FARTHEST_SIGMAS: f64 = 3.0;

/// Number of equal parts of the range of squared distances: few enough to fill quickly, and enough
/// that hardly any contains more than one threshold.
const PARTS: usize = 1024;

/// `255 exp(−d²/(2σ²))`, rounded, as a table of the squared distances at which the score decreases by one.
///
/// Each part of the range stores the score at its near end; from there at most a few steps remain.
#[derive(Clone, Debug)]
pub(super) struct ScoreScale {
    /// The largest d² with a score of at least k, m², by k.
    farthest_m2: [f64; FULL_SCORE as usize + 1],
    /// Parts per m² of d².
    parts_per_m2: f64,
    near_end: [u8; PARTS],
}

impl ScoreScale {
    /// The scale for a blur of `sigma_m`, m.
    pub fn new(sigma_m: f64) -> Self {
        let end_m2 = FARTHEST_SIGMAS * FARTHEST_SIGMAS * sigma_m * sigma_m;
        let mut scale = Self {
            farthest_m2: [f64::INFINITY; FULL_SCORE as usize + 1],
            parts_per_m2: PARTS as f64 / end_m2,
            near_end: [FULL_SCORE; PARTS],
        };
        for (score, farthest_m2) in scale.farthest_m2.iter_mut().enumerate().skip(1) {
            let share = (score as f64 - 0.5) / f64::from(FULL_SCORE);
            *farthest_m2 = math::min(-2.0 * sigma_m * sigma_m * math::ln(share), end_m2);
        }
        for part in 1..PARTS {
            let near_m2 = part as f64 / scale.parts_per_m2;
            scale.near_end[part] = scale.fallen(scale.near_end[part - 1], near_m2);
        }
        scale
    }

    /// The score at a squared distance of `d2_m2`, m².
    #[inline]
    pub fn score(&self, d2_m2: f64) -> u8 {
        if d2_m2 > self.farthest_m2[1] {
            return 0;
        }
        let part = (d2_m2 * self.parts_per_m2) as usize;
        self.fallen(self.near_end[part.min(PARTS - 1)], d2_m2)
    }

    /// The score at `d2_m2`, searched from `at_most` downwards.
    #[inline]
    fn fallen(&self, at_most: u8, d2_m2: f64) -> u8 {
        let mut score = at_most;
        while d2_m2 > self.farthest_m2[usize::from(score)] {
            score -= 1;
        }
        score
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_score_from_the_scale_is_the_rounded_gaussian_to_the_last_of_a_million_distances() {
        for sigma_m in [0.08, 0.2, 1.0 / 3.0, 1e-9, 1e6] {
            let scale = ScoreScale::new(sigma_m);
            for k in 0..200_000 {
                let d_m = 4.0 * sigma_m * f64::from(k) / 200_000.0;
                let d2 = d_m * d_m;
                let share = math::exp(-d2 / (2.0 * sigma_m * sigma_m));
                let within = d2 <= 9.0 * sigma_m * sigma_m;
                let expected = if within {
                    (255.0 * share + 0.5) as u8
                } else {
                    0
                };
                assert_eq!(
                    scale.score(d2),
                    expected,
                    "{d_m} m at a blur of {sigma_m} m"
                );
            }
            assert_eq!(scale.score(f64::INFINITY), 0);
        }
    }
}
