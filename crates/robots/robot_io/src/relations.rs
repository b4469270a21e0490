//! Reference relations: relative poses of the body between two times.
//!
//! A line is `t1 t2 x y z roll pitch yaw`, in s, m and rad. Kümmerle et al., "On measuring the
//! accuracy of SLAM algorithms", 2009, provide such files for recorded logs.

use std::io::BufRead;

use pr_geom::SE2;

use crate::plausible::plausible_pose;
use crate::trajectory::{NumberLines, TextError};

/// A reference relation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relation {
    /// Time of the first pose, s.
    pub first_s: f64,
    /// Time of the second pose, s.
    pub second_s: f64,
    /// The second pose in the frame of the first, δ*.
    pub motion: SE2,
}

const LINE: &str = "t1 t2 x y z roll pitch yaw";

/// Reads a file of relations; `#` starts a comment. Height, roll and pitch are ignored.
///
/// # Errors
/// If a line is malformed, or there is no line.
pub fn read_relations(source: impl BufRead, name: &str) -> Result<Vec<Relation>, TextError> {
    let mut relations = Vec::new();
    let mut numbers = NumberLines::new(source, name, LINE);
    while let Some([first_s, second_s, x, y, _, _, _, yaw]) = numbers.next_line()? {
        let motion =
            plausible_pose(SE2::new(x, y, yaw)).map_err(|problem| numbers.reject(problem))?;
        relations.push(Relation {
            first_s,
            second_s,
            motion,
        });
    }
    numbers.at_least_one(relations.len())?;
    Ok(relations)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_relation_is_eight_numbers() {
        let text = "# by hand\n1.5 3.5 0.1 -0.2 0 0 0 0.3\n";
        let read = read_relations(text.as_bytes(), "r").unwrap();
        let expected = Relation {
            first_s: 1.5,
            second_s: 3.5,
            motion: SE2::new(0.1, -0.2, 0.3),
        };
        assert_eq!(read, [expected]);
        let short = read_relations(&b"1 2 3\n"[..], "r").unwrap_err();
        assert_eq!(
            short.to_string(),
            "r: line 1: y is missing; a line is ‘t1 t2 x y z roll pitch yaw’"
        );
    }
}
