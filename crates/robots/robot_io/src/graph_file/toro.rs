//! Converts records of TORO and iSAM, and loops with a switch or a weight, to records of g2o.
//!
//! `EDGE_SE2_SWITCHABLE from to switch dx dy dtheta I…` and `EDGE_SE2_MAXMIX from to weight dx dy dtheta I…` become edges.
//! Source: Sünderhauf, Protzel, "Switchable constraints for robust pose graph SLAM", 2012; Olson, Agarwal, "Inference on
//! networks of mixtures for robust robot mapping", 2012; the files of Vertigo.

use std::borrow::Cow;

use nalgebra::Matrix3;

use crate::plural::plural;

/// Text in g2o's records, with remarks on what was changed.
pub struct AsG2o<'a> {
    /// The text.
    pub text: Cow<'a, [u8]>,
    /// Remarks on information in an unexpected order, and on switches and weights that are left out.
    pub remarks: Vec<String>,
}

/// Records of loops with a switch or a weight.
const ROBUST: [&str; 2] = ["EDGE_SE2_SWITCHABLE", "EDGE_SE2_MAXMIX"];

/// Converts every such record of a text to g2o, line by line; other lines are unchanged.
#[must_use]
pub fn as_g2o(bytes: &[u8]) -> AsG2o<'_> {
    let is_one_of = |line: &[u8], names: &[&str]| {
        let mut words = line.split(u8::is_ascii_whitespace);
        let name = words.find(|word| !word.is_empty()).unwrap_or_default();
        names.iter().any(|known| known.as_bytes() == name)
    };
    let is_robust = |line: &[u8]| is_one_of(line, &ROBUST);
    let is_toro =
        |line: &[u8]| is_one_of(line, &["VERTEX2", "EDGE2", "ODOMETRY"]) || is_robust(line);
    let lines = || bytes.split_inclusive(|&byte| byte == b'\n');
    let toro = || {
        lines()
            .filter(|line| is_toro(line))
            .filter_map(|line| std::str::from_utf8(line).ok())
    };
    if toro().next().is_none() && !lines().any(is_toro) {
        return AsG2o {
            text: Cow::Borrowed(bytes),
            remarks: Vec::new(),
        };
    }
    let is_g2o_order = toro().any(|line| !is_information(line, TORO_ORDER))
        && toro().all(|line| is_information(line, G2O_ORDER));
    let mut text = Vec::with_capacity(bytes.len() + bytes.len() / 8);
    for line in lines() {
        match std::str::from_utf8(line) {
            Ok(words) if is_toro(line) => {
                text.extend_from_slice(toro_line(words, is_g2o_order).as_bytes());
                text.push(b'\n');
            }
            _ => text.extend_from_slice(line),
        }
    }
    let order = is_g2o_order.then(|| {
        "its EDGE2 records have the information in g2o's order, because it would be indefinite in TORO's order; they are read in g2o's order".to_owned()
    });
    let robust = lines().position(is_robust).map(|first| {
        format!(
            "line {}: {} read as EDGE_SE2, without switch or weight; reject wrong loops with --robust gnc",
            first + 1,
            plural(lines().filter(|line| is_robust(line)).count(), "switchable or max-mixture edge")
        )
    });
    AsG2o {
        text: Cow::Owned(text),
        remarks: order.into_iter().chain(robust).collect(),
    }
}

/// Positions of xx, xy, xθ, yy, yθ, θθ in a record of each format.
const TORO_ORDER: [usize; 6] = [0, 1, 4, 2, 5, 3];
const G2O_ORDER: [usize; 6] = [0, 1, 2, 3, 4, 5];

/// Whether the information is positive semidefinite in this order; true if the line is not an edge.
fn is_information(line: &str, order: [usize; 6]) -> bool {
    let words: Vec<&str> = line.split_ascii_whitespace().collect();
    if words.first() != Some(&"EDGE2") || words.len() != 12 {
        return true;
    }
    let numbers: Vec<f64> = words[6..]
        .iter()
        .filter_map(|word| word.parse().ok())
        .collect();
    if numbers.len() != 6 {
        return true;
    }
    let [xx, xy, xt, yy, yt, tt] = order.map(|at| numbers[at]);
    let eigenvalues = Matrix3::new(xx, xy, xt, xy, yy, yt, xt, yt, tt).symmetric_eigenvalues();
    let size = eigenvalues.amax();
    eigenvalues.iter().all(|&value| value >= -1e-9 * size)
}

/// The information of an iSAM record by its square root; `None` if a word is no number.
fn squared(root: &[&str]) -> Option<String> {
    let numbers: Result<Vec<f64>, _> = root.iter().map(|word| word.parse()).collect();
    let [xx, xy, xt, yy, yt, tt] = numbers.ok()?[..] else {
        return None;
    };
    let root = Matrix3::new(xx, xy, xt, 0.0, yy, yt, 0.0, 0.0, tt);
    let i = root.transpose() * root;
    let upper = [
        i[(0, 0)],
        i[(0, 1)],
        i[(0, 2)],
        i[(1, 1)],
        i[(1, 2)],
        i[(2, 2)],
    ];
    Some(upper.map(|entry| entry.to_string()).join(" "))
}

/// Such a record as a g2o record; a wrong number of fields is passed on.
fn toro_line(line: &str, is_g2o_order: bool) -> String {
    let words: Vec<&str> = line.split_whitespace().collect();
    match words[..] {
        ["EDGE2", from, to, x, y, theta, xx, xy, yy, tt, xt, yt] if !is_g2o_order => {
            format!("EDGE_SE2 {from} {to} {x} {y} {theta} {xx} {xy} {xt} {yy} {yt} {tt}")
        }
        ["ODOMETRY", from, to, x, y, theta, ref root @ ..] => {
            let information = squared(root).unwrap_or_else(|| root.join(" "));
            format!("EDGE_SE2 {from} {to} {x} {y} {theta} {information}")
        }
        ["ODOMETRY", ref rest @ ..] => format!("EDGE_SE2 {}", rest.join(" ")),
        ["EDGE2", ref rest @ ..] => format!("EDGE_SE2 {}", rest.join(" ")),
        [name, from, to, _, x, y, theta, ref rest @ ..]
            if ROBUST.contains(&name) && rest.len() == 6 =>
        {
            format!("EDGE_SE2 {from} {to} {x} {y} {theta} {}", rest.join(" "))
        }
        // Some programs leave the switch out.
        [name, ref rest @ ..] if ROBUST.contains(&name) => format!("EDGE_SE2 {}", rest.join(" ")),
        [_, ref rest @ ..] => format!("VERTEX_SE2 {}", rest.join(" ")),
        [] => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_information_of_isam_is_the_square_of_its_root() {
        let text = as_g2o(b"ODOMETRY 0 1 1 0 0.5 2 1 0 3 0 10\nLANDMARK 1 0 2 1 10 0 10\n").text;
        assert_eq!(
            String::from_utf8_lossy(&text),
            "EDGE_SE2 0 1 1 0 0.5 4 2 0 10 0 100\nLANDMARK 1 0 2 1 10 0 10\n"
        );
    }

    #[test]
    fn the_order_of_the_information_is_the_definite_one() {
        let converted =
            |edge: &str| String::from_utf8(as_g2o(edge.as_bytes()).text.into_owned()).unwrap();
        let expected = "EDGE_SE2 0 1 1 0 0 10 1 2 20 3 30\n";
        assert_eq!(converted("EDGE2 0 1 1 0 0 10 1 20 30 2 3\n"), expected);
        assert_eq!(
            converted("EDGE2 0 1 1 0 0 100 0 0 100 0 400\n"),
            "EDGE_SE2 0 1 1 0 0 100 0 0 100 0 400\n"
        );
        assert!(as_g2o(b"EDGE2 0 1 1 0 0 100 0 0 100 0 400\n").remarks.len() == 1);
    }
}
