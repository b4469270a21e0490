//! Converts records of TORO and iSAM to records of g2o.

use std::borrow::Cow;

use nalgebra::Matrix3;

/// Text in g2o's records, with a remark on its order.
pub struct AsG2o<'a> {
    /// The text.
    pub text: Cow<'a, [u8]>,
    /// Remark if the information was in an unexpected order.
    pub remark: Option<String>,
}

/// Converts every TORO or iSAM record of a text to g2o, line by line; other lines are unchanged.
#[must_use]
pub fn as_g2o(bytes: &[u8]) -> AsG2o<'_> {
    let is_toro = |line: &[u8]| {
        let line = line.trim_ascii_start();
        [&b"VERTEX2"[..], b"EDGE2", b"ODOMETRY"].iter().any(|name| {
            line.starts_with(name) && line.get(name.len()).is_some_and(u8::is_ascii_whitespace)
        })
    };
    let lines = || bytes.split_inclusive(|&byte| byte == b'\n');
    let toro = || {
        lines()
            .filter(|line| is_toro(line))
            .filter_map(|line| std::str::from_utf8(line).ok())
    };
    if toro().next().is_none() && !lines().any(is_toro) {
        return AsG2o {
            text: Cow::Borrowed(bytes),
            remark: None,
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
    AsG2o {
        text: Cow::Owned(text),
        remark: is_g2o_order.then(|| {
            "its EDGE2 records have the information in g2o's order, because it would be indefinite in TORO's order; they are read in g2o's order".to_owned()
        }),
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

/// A record of TORO or iSAM as a g2o record; a wrong number of fields is passed on.
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
        assert!(
            as_g2o(b"EDGE2 0 1 1 0 0 100 0 0 100 0 400\n")
                .remark
                .is_some()
        );
    }
}
