//! A certificate of optimality: a lower bound on the cost of a pose graph over all poses.
//!
//! Positions and headings are complex numbers, tᵢ and rᵢ with |rᵢ| = 1. With isotropic weights, and the heading
//! residual measured along the chord, the cost is a quadratic form,
//!
//! ```text
//! f = Σ p |tⱼ − tᵢ − rᵢ z|² + h |rⱼ − rᵢ c|²
//! ```
//!
//! For given headings the best positions solve a linear problem, which leaves `f = rᴴ Q r`. For any Λ = diag(λ),
//! `f = Σ λ + rᴴ (Q − Λ) r ≥ Σ λ + n min(0, least eigenvalue of Q − Λ)` for all headings of unit length. With
//! λᵢ = Re(r̄ᵢ (Q r)ᵢ) at the given headings Σ λ is their own cost: if the eigenvalue is zero, no poses cost less.
//!
//! Source: Carlone, Calafiore, Tommolillo, Dellaert, "Planar pose graph optimization: duality, optimal solutions, and
//! verification", 2016.

use core::ops::{Add, Mul, Sub};

use pr_geom::{SE2, math};
use pr_optim::Problem;

/// Halvings of the interval that contains the least eigenvalue.
const HALVINGS: usize = 40;

/// The cost of given headings, with the best positions, and a bound that no poses are below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// Cost with the heading residuals along their chords; close to χ² for small residuals.
    pub cost: f64,
    /// No poses cost less.
    pub lower_bound: f64,
}

impl Certificate {
    /// Whether no poses cost less by more than this share of the cost.
    pub fn confirms(&self, share: f64) -> bool {
        self.cost - self.lower_bound <= share * self.cost
    }

    /// The certificate of a graph's headings. The information of an edge counts by its mean over both axes, and by
    /// that of the heading.
    pub fn of(problem: &Problem) -> Self {
        let nodes = problem.node_count();
        let mut form = Form::of(problem);
        form.eliminate(nodes - 1);
        let mut dual = form.without(nodes - 1);
        let headings: Vec<Complex> = problem.poses().iter().map(heading).collect();
        let mut cost = 0.0;
        for (node, r) in headings.iter().enumerate() {
            let zero = Complex::default();
            let terms = headings.iter().enumerate();
            let gradient = terms.fold(zero, |sum, (other, r)| {
                sum + form.at(nodes - 1 + node, nodes - 1 + other) * *r
            });
            let multiplier = (r.conjugate() * gradient).re;
            cost += multiplier;
            dual.shift(node, -multiplier);
        }
        Self {
            cost,
            lower_bound: cost + nodes as f64 * dual.least_eigenvalue().min(0.0),
        }
    }
}

/// A complex number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Complex {
    re: f64,
    im: f64,
}

impl Complex {
    fn conjugate(self) -> Self {
        Self {
            im: -self.im,
            ..self
        }
    }

    fn scaled(self, factor: f64) -> Self {
        let (re, im) = (factor * self.re, factor * self.im);
        Self { re, im }
    }
}

impl Add for Complex {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (re, im) = (self.re + other.re, self.im + other.im);
        Self { re, im }
    }
}

impl Sub for Complex {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + other.scaled(-1.0)
    }
}

impl Mul for Complex {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self {
            re: self.re * other.re - self.im * other.im,
            im: self.re * other.im + self.im * other.re,
        }
    }
}

fn heading(pose: &SE2) -> Complex {
    let rotation = pose.rotation();
    Complex {
        re: rotation.cos,
        im: rotation.sin,
    }
}

/// A Hermitian matrix, row by row.
#[derive(Clone, Debug)]
struct Form {
    size: usize,
    entries: Vec<Complex>,
}

impl Form {
    fn zero(size: usize) -> Self {
        let entries = vec![Complex::default(); size * size];
        Self { size, entries }
    }

    /// The cost as a form in `(t₁ … tₙ₋₁, r₀ … rₙ₋₁)`; t₀ is 0.
    fn of(problem: &Problem) -> Self {
        let nodes = problem.node_count();
        let mut form = Self::zero(2 * nodes - 1);
        let one = Complex { re: 1.0, im: 0.0 };
        let minus = one.scaled(-1.0);
        for factor in problem.factors() {
            let (from, to, information) = (factor.from, factor.to, &factor.information);
            let z = Complex {
                re: factor.measurement.x(),
                im: factor.measurement.y(),
            };
            let heading_at = |node: usize| nodes - 1 + node;
            let position = 0.5 * (information[(0, 0)] + information[(1, 1)]);
            let placed = [(to, one), (from, minus)].into_iter();
            let placed = placed.filter(|(node, _)| *node > 0);
            let mut terms: Vec<_> = placed.map(|(node, sign)| (node - 1, sign)).collect();
            terms.push((heading_at(from), z.scaled(-1.0)));
            form.add_square(&terms, position);
            let turned = heading(&factor.measurement).scaled(-1.0);
            let turn = [(heading_at(to), one), (heading_at(from), turned)];
            form.add_square(&turn, information[(2, 2)]);
        }
        form
    }

    /// Adds `weight |Σ aₖ xₖ|²`.
    fn add_square(&mut self, terms: &[(usize, Complex)], weight: f64) {
        for (row, a) in terms {
            for (column, b) in terms {
                let product = (a.conjugate() * *b).scaled(weight);
                let entry = &mut self.entries[row * self.size + column];
                *entry = *entry + product;
            }
        }
    }

    fn at(&self, row: usize, column: usize) -> Complex {
        self.entries[row * self.size + column]
    }

    fn shift(&mut self, k: usize, by: f64) {
        self.entries[k * self.size + k].re += by;
    }

    /// The form of the unknowns from `count` on.
    fn without(&self, count: usize) -> Self {
        let kept = count..self.size;
        let rows = kept
            .clone()
            .flat_map(|row| kept.clone().map(move |column| (row, column)));
        Self {
            size: self.size - count,
            entries: rows.map(|(row, column)| self.at(row, column)).collect(),
        }
    }

    /// Eliminates the first `count` unknowns, which leaves the form for their best values; returns whether all their
    /// pivots are positive.
    fn eliminate(&mut self, count: usize) -> bool {
        for pivot in 0..count {
            let value = self.at(pivot, pivot).re;
            if value <= 0.0 {
                return false;
            }
            for row in pivot + 1..self.size {
                let factor = self.at(row, pivot).scaled(1.0 / value);
                for column in pivot + 1..self.size {
                    let product = factor * self.at(pivot, column);
                    let entry = &mut self.entries[row * self.size + column];
                    *entry = *entry - product;
                }
            }
        }
        true
    }

    /// The least eigenvalue, from below: a matrix is positive definite if all its pivots are positive.
    fn least_eigenvalue(&self) -> f64 {
        let is_above = |shift: f64| {
            let mut shifted = self.clone();
            for k in 0..self.size {
                shifted.shift(k, -shift);
            }
            shifted.eliminate(self.size)
        };
        // No eigenvalue is larger in magnitude than the largest sum of a row (Gershgorin).
        let rows = self.entries.chunks(self.size);
        let sums = rows.map(|row| row.iter().map(|z| math::norm2(z.re, z.im)).sum());
        let bound = sums.fold(0.0, math::max);
        let (mut below, mut above) = (-bound, bound);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (below + above);
            if is_above(middle) {
                below = middle;
            } else {
                above = middle;
            }
        }
        below
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::start::wound::tests::{knot, optimum};
    use pr_geom::Rng;

    #[test]
    fn the_least_eigenvalue_is_that_of_a_matrix_by_hand() {
        // [[2, i], [−i, 2]] has the eigenvalues 1 and 3.
        let z = |re: f64, im: f64| Complex { re, im };
        let matrix = Form {
            size: 2,
            entries: vec![z(2.0, 0.0), z(0.0, 1.0), z(0.0, -1.0), z(2.0, 0.0)],
        };
        // 1e-9: forty halvings of an interval of 6.
        assert!((matrix.least_eigenvalue() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn the_optimum_is_confirmed_and_the_knot_is_not() {
        let (best, knot) = (Certificate::of(&optimum()), Certificate::of(&knot()));
        // The optimum of χ² is not exactly that of the chords.
        assert!(best.confirms(0.01), "{best:?}");
        assert!(!knot.confirms(0.5), "{knot:?}");
        // Both bounds are about the same graph.
        assert!(knot.lower_bound <= best.cost, "{knot:?} {best:?}");
    }

    #[test]
    fn no_poses_cost_less_than_the_bound() {
        let best = optimum();
        let bound = Certificate::of(&best).lower_bound;
        let mut rng = Rng::new(7);
        for draw in 0..200 {
            let mut other = best.clone();
            let spread = if draw % 2 == 0 { 0.02 } else { 3.0 };
            for pose in other.poses_mut() {
                *pose = SE2::new(0.0, 0.0, pose.theta() + rng.normal(0.0, spread));
            }
            assert!(Certificate::of(&other).cost >= bound, "{draw}");
        }
    }

    #[test]
    fn along_the_chords_the_optimum_costs_about_what_it_costs_in_chi_squared() {
        let best = optimum();
        let cost = Certificate::of(&best).cost;
        // 2 %: 4 sin²(e/2) is e² up to e⁴/12.
        assert!((cost / best.chi2() - 1.0).abs() < 0.02, "{cost}");
    }
}
