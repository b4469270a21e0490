//! Errors against relations between two times.
//!
//! For each relation, `E = δ*⁻¹ ∘ (x₁⁻¹ x₂)`; its translation and its rotation are two errors.
//! Kümmerle, Steder, Dornhege, Ruhnke, Grisetti, Stachniss, Kleiner, "On measuring the accuracy of
//! SLAM algorithms", Autonomous Robots 27, 2009, eq. (4).

use pr_geom::math;
use serde::Serialize;

use super::Spread;
use crate::relations::Relation;
use crate::trajectory::Trajectory;

/// A relation may lie this far beyond the ends of a trajectory, s: stamps are printed with fewer digits.
const SLACK_S: f64 = 0.5;

/// The errors of all relations.
#[derive(Clone, Debug, PartialEq)]
pub struct RelationErrors {
    /// ‖E.t‖ of each relation, m.
    pub translations_m: Vec<f64>,
    /// |E.θ| of each relation, degrees.
    pub rotations_deg: Vec<f64>,
    /// Relations whose times lie outside of the trajectory; they are not included.
    pub outside: usize,
}

/// Statistics of the errors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct RelationReport {
    /// Number of relations included.
    pub n: usize,
    /// ‖E.t‖, m.
    pub trans: Spread,
    /// |E.θ|, degrees.
    pub rot_deg: Spread,
    /// ‖E.t‖², m².
    pub trans2: Spread,
    /// |E.θ|², degrees².
    pub rot2: Spread,
}

/// Compares a trajectory with relations.
#[must_use]
pub fn relation_errors(trajectory: &Trajectory, relations: &[Relation]) -> RelationErrors {
    let mut errors = RelationErrors {
        translations_m: Vec::with_capacity(relations.len()),
        rotations_deg: Vec::with_capacity(relations.len()),
        outside: 0,
    };
    for relation in relations {
        let first = trajectory.at(relation.first_s, SLACK_S);
        let second = trajectory.at(relation.second_s, SLACK_S);
        let (Some(first), Some(second)) = (first, second) else {
            errors.outside += 1;
            continue;
        };
        let error = relation.motion.between(&first.between(&second));
        errors
            .translations_m
            .push(math::norm2(error.x(), error.y()));
        errors.rotations_deg.push(error.theta().abs().to_degrees());
    }
    errors
}

impl RelationErrors {
    /// Statistics of the errors.
    #[must_use]
    pub fn report(&self) -> RelationReport {
        let squares = |errors: &[f64]| errors.iter().map(|e| e * e).collect::<Vec<_>>();
        RelationReport {
            n: self.translations_m.len(),
            trans: Spread::from_values(&self.translations_m),
            rot_deg: Spread::from_values(&self.rotations_deg),
            trans2: Spread::from_values(&squares(&self.translations_m)),
            rot2: Spread::from_values(&squares(&self.rotations_deg)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trajectory::StampedPose;
    use pr_geom::SE2;

    #[test]
    fn a_relation_that_says_a_metre_where_two_were_driven_is_off_by_one() {
        let pose = |stamp_s, x| StampedPose {
            stamp_s,
            pose: SE2::new(x, 3.0, 0.0),
        };
        let driven = Trajectory::new(vec![pose(0.0, 1.0), pose(1.0, 3.0)]);
        let relation = |first_s, second_s, motion| Relation {
            first_s,
            second_s,
            motion,
        };
        let relations = [
            relation(0.0, 1.0, SE2::new(1.0, 0.0, 0.0)),
            relation(1.0, 0.0, SE2::new(-2.0, 0.0, 0.5)),
            relation(0.0, 9.0, SE2::identity()),
        ];
        let errors = relation_errors(&driven, &relations);
        assert_eq!(errors.outside, 1);
        let report = errors.report();
        assert_eq!(report.n, 2);
        // 1e-12: a few roundings of numbers about 1.
        assert!((report.trans.mean - 0.5).abs() < 1e-12);
        assert!((report.trans2.mean - 0.5).abs() < 1e-12);
        assert!((report.rot_deg.mean - 0.25_f64.to_degrees()).abs() < 1e-12);
        assert!((report.rot2.mean - 0.5 * 0.5_f64.to_degrees().powi(2)).abs() < 1e-9);
    }
}
