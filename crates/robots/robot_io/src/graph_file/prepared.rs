//! Converts a graph's text to what the solver takes: planar g2o records only, with every component fixed.
//!
//! - Records of TORO become records of g2o. Some programs write `EDGE2` with the information in g2o's order, which
//!   would be indefinite if read in TORO's order.
//! - Vertices that edges name and the file does not have are placed by a spanning tree of the edges, from those it has.
//! - Each connected component without a fixed vertex gets its first vertex fixed.
//! - `EDGE_PRIOR_SE2 id x y θ I…` becomes an edge from a fixed vertex at the origin.

use std::borrow::Cow;
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet, VecDeque};

use pr_geom::SE2;

use crate::lines::finite;
use crate::plural::plural;

/// A graph's text for the solver, with what was changed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Prepared<'a> {
    /// The text: the lines of the file, followed by the vertices that were missing.
    pub text: Cow<'a, [u8]>,
    /// Number of lines that belong to the graph; the lines after them fix the gauge.
    pub lines: usize,
    /// Vertices added after those lines.
    pub helpers: usize,
    /// Priors converted to edges.
    pub priors: usize,
    /// What was changed, one sentence each.
    pub remarks: Vec<String>,
}

/// An edge of the graph.
#[derive(Clone, Copy)]
struct Edge {
    from: i64,
    to: i64,
    motion: SE2,
}

/// Converts a graph's text for the solver.
///
/// # Errors
/// If the file is not a planar graph; the message names what it is.
pub fn prepared(bytes: &[u8]) -> Result<Prepared<'_>, String> {
    if bytes.starts_with(b"# Created by Octave") || bytes.starts_with(b"MATLAB") {
        return Err(
            "it is a data file of Octave or MATLAB; write its graph as lines VERTEX_SE2 id x y theta and EDGE_SE2 from to dx dy dtheta and the upper triangle of the information"
                .to_owned(),
        );
    }
    let text = super::toro::as_g2o(bytes);
    let mut remarks = text.remarks;
    let text = text.text;
    let mut ids: Vec<i64> = Vec::new();
    let mut poses: BTreeMap<i64, SE2> = BTreeMap::new();
    let mut edges: Vec<Edge> = Vec::new();
    let mut fixed: Vec<i64> = Vec::new();
    let mut priors: Vec<(i64, String)> = Vec::new();
    let mut in_space = None;
    // The first record of a landmark, and their number.
    let mut landmarks: Option<(usize, String, usize)> = None;
    for (number, line) in text.split(|&byte| byte == b'\n').enumerate() {
        let Ok(line) = std::str::from_utf8(line) else {
            continue;
        };
        let mut words = line.trim_start_matches('\u{feff}').split_ascii_whitespace();
        let Some(kind) = words.next() else {
            continue;
        };
        let words: Vec<&str> = words.collect();
        let id = |at: usize| words.get(at).and_then(|word| word.parse::<i64>().ok());
        let number_at = |at: usize| finite(words.get(at).copied(), "").ok();
        match kind {
            "VERTEX_SE2" => {
                ids.extend(id(0));
                if let (Some(id), Some(x), Some(y), Some(theta)) =
                    (id(0), number_at(1), number_at(2), number_at(3))
                {
                    poses.insert(id, SE2::new(x, y, theta));
                }
            }
            "EDGE_SE2" => {
                if let (Some(from), Some(to), Some(x), Some(y), Some(theta)) =
                    (id(0), id(1), number_at(2), number_at(3), number_at(4))
                {
                    let motion = SE2::new(x, y, theta);
                    edges.push(Edge { from, to, motion });
                }
            }
            "FIX" => fixed.extend((0..words.len()).filter_map(id)),
            "EDGE_PRIOR_SE2" => {
                if let Some(of) = id(0).filter(|_| words.len() == 10) {
                    priors.push((of, words[1..].join(" ")));
                }
            }
            "VERTEX_SE3:QUAT" | "EDGE_SE3:QUAT" | "VERTEX3" | "EDGE3" => {
                in_space.get_or_insert((number + 1, kind.to_owned()));
            }
            kind if is_landmark(kind) => {
                let first = landmarks.get_or_insert_with(|| (number + 1, kind.to_owned(), 0));
                first.2 += 1;
            }
            _ => {}
        }
    }
    if ids.is_empty()
        && edges.is_empty()
        && let Some((line, kind)) = in_space
    {
        return Err(format!(
            "line {line} is a {kind}: the graph is three-dimensional, but only planar graphs are supported; write it with VERTEX_SE2 and EDGE_SE2"
        ));
    }
    if let Some((line, kind, count)) = landmarks {
        remarks.push(format!(
            "line {line}: {kind}: landmarks are not optimized, so {} not used; solve the graph with g2o, or write an EDGE_SE2 between the poses that measure the same landmark",
            if count == 1 {
                "1 record is".to_owned()
            } else {
                format!("{count} records are")
            }
        ));
    }
    let mut lines = text.split_inclusive(|&byte| byte == b'\n').count();
    let mut added = String::new();
    let given: BTreeSet<i64> = ids.iter().copied().collect();
    let mut tree = spanning_tree(&edges, poses);
    tree.retain(|id, _| !given.contains(id));
    if !tree.is_empty() {
        remarks.push(format!(
            "the file has {} and lacks {} that its edges name; their poses are computed from a spanning tree of the edges",
            plural(given.len(), "pose"),
            tree.len()
        ));
        for (id, pose) in &tree {
            let [x, y, theta] = pose.to_array();
            added.push_str(&format!("VERTEX_SE2 {id} {x} {y} {theta}\n"));
            ids.push(*id);
        }
        lines += tree.len();
    }
    let mut helper = None;
    let mut helpers = String::new();
    let known: BTreeSet<i64> = ids.iter().copied().collect();
    priors.retain(|(of, _)| known.contains(of));
    if !priors.is_empty() {
        let id = ids.iter().max().map_or(0, |id| id.saturating_add(1));
        helpers.push_str(&format!("VERTEX_SE2 {id} 0 0 0\nFIX {id}\n"));
        for (of, rest) in &priors {
            helpers.push_str(&format!("EDGE_SE2 {id} {of} {rest}\n"));
        }
        remarks.push(format!(
            "{} taken as measurements",
            plural(priors.len(), "prior")
        ));
        helper = Some(id);
    }
    let parts = parts(&ids, &edges);
    let held: BTreeSet<i64> = fixed
        .iter()
        .chain(priors.iter().map(|(of, _)| of))
        .copied()
        .collect();
    let is_held = |part: &[i64]| part.iter().any(|id| held.contains(id));
    if parts.len() > 1 || helper.is_some() && fixed.is_empty() {
        let loose = parts.iter().filter(|part| !is_held(part));
        for part in loose {
            helpers.push_str(&format!("FIX {}\n", part[0]));
        }
    }
    if parts.len() > 1 {
        let single = parts.iter().filter(|part| part.len() == 1).count();
        remarks.push(format!(
            "the graph has {}, {single} of them a single vertex; each is solved separately with its first vertex fixed",
            plural(parts.len(), "connected component")
        ));
    }
    let text = if added.is_empty() && helpers.is_empty() {
        text
    } else {
        let mut whole = text.into_owned();
        if whole.last().is_some_and(|&byte| byte != b'\n') {
            whole.push(b'\n');
        }
        whole.extend_from_slice(added.as_bytes());
        whole.extend_from_slice(helpers.as_bytes());
        Cow::Owned(whole)
    };
    Ok(Prepared {
        text,
        lines,
        helpers: usize::from(helper.is_some()),
        priors: priors.len(),
        remarks,
    })
}

/// Whether a record is that of a landmark.
pub(super) fn is_landmark(kind: &str) -> bool {
    kind == "LANDMARK" || kind.ends_with("_XY")
}

/// The text with its FIX records at the end: GTSAM 4.3 reads no edge after one.
#[must_use]
pub fn with_fix_last(text: &[u8]) -> Cow<'_, [u8]> {
    let lines = || text.split_inclusive(|&byte| byte == b'\n');
    let is_fix =
        |line: &&[u8]| line.starts_with(b"FIX") && line.get(3).is_none_or(u8::is_ascii_whitespace);
    let mut after = lines().skip_while(|line| !is_fix(line));
    if after.all(|line| is_fix(&line)) {
        return Cow::Borrowed(text);
    }
    let mut moved = Vec::with_capacity(text.len() + 1);
    let others = lines().filter(|line| !is_fix(line));
    for line in others.chain(lines().filter(is_fix)) {
        moved.extend_from_slice(line);
        if moved.last() != Some(&b'\n') {
            moved.push(b'\n');
        }
    }
    Cow::Owned(moved)
}

impl Prepared<'_> {
    /// The lines of the original graph within a text that was written from this one.
    #[must_use]
    pub fn own_lines<'b>(&self, written: &'b [u8]) -> &'b [u8] {
        let mut left = self.lines;
        let end = written.iter().position(|&byte| {
            left -= usize::from(byte == b'\n' && left > 0);
            byte == b'\n' && left == 0
        });
        end.map_or(written, |end| &written[..=end])
    }
}

/// Adjacent vertices of each vertex, with the relative pose.
fn neighbours(edges: &[Edge]) -> BTreeMap<i64, Vec<(i64, SE2)>> {
    let mut near: BTreeMap<i64, Vec<(i64, SE2)>> = BTreeMap::new();
    for edge in edges {
        near.entry(edge.from)
            .or_default()
            .push((edge.to, edge.motion));
        near.entry(edge.to)
            .or_default()
            .push((edge.from, edge.motion.inverse()));
    }
    near
}

/// A pose for each vertex of an edge, by breadth-first search from those with known poses, else from the lowest id.
fn spanning_tree(edges: &[Edge], mut poses: BTreeMap<i64, SE2>) -> BTreeMap<i64, SE2> {
    let near = neighbours(edges);
    let known: Vec<i64> = poses.keys().copied().collect();
    let alone = near.keys().map(|&root| vec![root]);
    for roots in std::iter::once(known).chain(alone) {
        for root in &roots {
            poses.entry(*root).or_default();
        }
        let mut waiting = VecDeque::from(roots);
        while let Some(id) = waiting.pop_front() {
            let pose = poses[&id];
            for &(next, motion) in near.get(&id).into_iter().flatten() {
                if let Entry::Vacant(free) = poses.entry(next) {
                    free.insert(pose * motion);
                    waiting.push_back(next);
                }
            }
        }
    }
    poses
}

/// Connected components, each in the order of the file.
fn parts(ids: &[i64], edges: &[Edge]) -> Vec<Vec<i64>> {
    let near = neighbours(edges);
    let mut part_of: BTreeMap<i64, usize> = BTreeMap::new();
    let mut count = 0;
    for &root in ids {
        if part_of.contains_key(&root) {
            continue;
        }
        part_of.insert(root, count);
        let mut waiting = VecDeque::from([root]);
        while let Some(id) = waiting.pop_front() {
            for (next, _) in near.get(&id).into_iter().flatten() {
                if part_of.insert(*next, count).is_none() {
                    waiting.push_back(*next);
                }
            }
        }
        count += 1;
    }
    let mut parts = vec![Vec::new(); count];
    for id in ids {
        parts[part_of[id]].push(*id);
    }
    parts
}

#[cfg(test)]
mod tests {
    use pr_optim::g2o::G2oFile;

    use super::*;

    fn prepare(text: &str) -> (G2oFile, String, Vec<u8>) {
        let prepared = prepared(text.as_bytes()).unwrap();
        let file = G2oFile::parse(&prepared.text).unwrap();
        let own = prepared.own_lines(&file.to_bytes()).to_vec();
        (file, prepared.remarks.join("; "), own)
    }

    #[test]
    fn edges_alone_make_the_vertices_and_parts_stand_by_themselves() {
        let edges = "EDGE_SE2 0 1 1 0 1.5707963 100 0 0 100 0 400\nEDGE_SE2 1 2 1 0 1.5707963 100 0 0 100 0 400\n";
        let (file, remarks, own) = prepare(&format!("{edges}EDGE_SE2 8 9 1 0 0 1 0 0 1 0 1"));
        assert_eq!(file.problem.node_count(), 5);
        assert!(file.problem.chi2() < 1e-12);
        assert!(
            remarks.contains("has 0 poses and lacks 5")
                && remarks.contains("2 connected components"),
            "{remarks}"
        );
        let own = String::from_utf8(own).unwrap();
        assert!(
            own.ends_with("VERTEX_SE2 9 1 0 0\n") && !own.contains("FIX"),
            "{own}"
        );
    }

    #[test]
    fn vertices_that_the_file_lacks_are_placed_from_those_it_has() {
        let edge = |a: i64| format!("EDGE_SE2 {a} {} 1 0 0 1 0 0 1 0 1\n", a + 1);
        let text = format!("VERTEX_SE2 1 5 5 0\n{}{}", edge(0), edge(1));
        let (file, remarks, own) = prepare(&text);
        assert_eq!(file.problem.node_count(), 3);
        assert!(file.problem.chi2() < 1e-12);
        assert!(remarks.contains("has 1 pose and lacks 2"), "{remarks}");
        let own = String::from_utf8(own).unwrap();
        assert!(
            own.ends_with("VERTEX_SE2 0 4 5 0\nVERTEX_SE2 2 6 5 0\n"),
            "{own}"
        );
        assert!(prepared(b"# Created by Octave 6.4.0\n").is_err());
    }

    #[test]
    fn a_prior_pulls_its_vertex_and_stays_a_prior_in_the_file() {
        let text = "VERTEX_SE2 4 0 0 0\nVERTEX_SE2 5 1 0 0\nEDGE_SE2 4 5 1 0 0 1 0 0 1 0 1\n\
                    EDGE_PRIOR_SE2 4 2 0 0 100 0 0 100 0 100\n";
        let (file, remarks, own) = prepare(text);
        assert_eq!(file.problem.factors().len(), 2);
        assert!((file.problem.chi2() - 400.0).abs() < 1e-9);
        assert_eq!(
            (remarks.as_str(), own.as_slice()),
            ("1 prior taken as measurements", text.as_bytes())
        );
    }

    #[test]
    fn fix_records_move_behind_all_others() {
        let last: &[u8] = b"VERTEX_SE2 0 0 0 0\nFIX 0\nFIX 1\n";
        assert_eq!(with_fix_last(last), last);
        assert_eq!(
            with_fix_last(b"FIX 0\nFIXED 1\nFIX 1\nEDGE_SE2").as_ref(),
            b"FIXED 1\nEDGE_SE2\nFIX 0\nFIX 1\n"
        );
    }

    #[test]
    fn a_graph_in_space_is_named() {
        let problem = prepared(b"VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n").unwrap_err();
        assert!(problem.starts_with("line 1 is a VERTEX_SE3:QUAT: the graph is three-dimensional"));
    }
}
