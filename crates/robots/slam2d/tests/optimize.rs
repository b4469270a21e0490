//! Tests of `slam2d optimize`.

use std::fs;
use std::path::{Path, PathBuf};

use crate::support::{assert_rejected, json, slam2d};
use bench_support::skip::{NO_RECORDED_GRAPHS, skip};
use pr_optim::g2o::G2oFile;
use serde_json::Value;
use tempfile::TempDir;

const SQUARE: &str = "\
VERTEX_SE2 0 0 0 0
VERTEX_SE2 1 1.2 0.1 1.5
VERTEX_SE2 2 1 1.1 3.1
VERTEX_SE2 3 0 1 -1.5
EDGE_SE2 0 1 1 0 1.5707963 50 0 0 50 0 100
EDGE_SE2 1 2 1 0 1.5707963 50 0 0 50 0 100
EDGE_SE2 2 3 1 0 1.5707963 50 0 0 50 0 100
EDGE_SE2 3 0 1 0 1.6 50 0 0 50 0 100
";

/// A folder with one graph in it.
struct Graph {
    folder: TempDir,
    input: PathBuf,
}

impl Graph {
    fn new(text: impl AsRef<[u8]>) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let input = folder.path().join("in.g2o");
        fs::write(&input, text).unwrap();
        Self { folder, input }
    }

    fn input(&self) -> &str {
        self.input.to_str().unwrap()
    }

    fn output(&self) -> PathBuf {
        self.folder.path().join("out.g2o")
    }

    fn solve(&self, options: &[&str]) -> Value {
        let arguments = [&["optimize", self.input(), "--json"], options].concat();
        json(&arguments)
    }

    /// Asserts that the graph is rejected in one line, and that the output is unchanged.
    #[track_caller]
    fn assert_rejected(&self, options: &[&str], expected: &str) {
        let output = self.output();
        fs::write(&output, "old").unwrap();
        let to = ["optimize", self.input(), "-o", output.to_str().unwrap()];
        assert_rejected(&[&to, options].concat(), expected);
        assert_eq!(fs::read(&output).unwrap(), b"old");
        // No temporary file is left either.
        assert_eq!(fs::read_dir(self.folder.path()).unwrap().count(), 2);
    }
}

fn number(summary: &Value, key: &str) -> f64 {
    summary[key]
        .as_f64()
        .unwrap_or_else(|| panic!("{key} is {}", summary[key]))
}

#[test]
fn the_written_graph_has_the_reported_chi2() {
    let graph = Graph::new(SQUARE);
    let output = graph.output();
    let summary = graph.solve(&["-o", output.to_str().unwrap(), "--repeat", "2"]);
    let written = fs::read(output).unwrap();
    let problem = G2oFile::parse(&written).unwrap().problem;
    let chi2 = number(&summary, "chi2");
    // Numbers are written with all their digits, so the sum has the same bits.
    assert_eq!(problem.chi2(), chi2);
    // The headings add up to 0.0292 rad too much, which costs at least 0.0213 over four edges of weight 100.
    assert!(chi2 > 0.0213 && chi2 < 0.1);
    assert!(chi2 < 0.01 * number(&summary, "chi2_initial"));
}

#[test]
fn json_has_the_keys_that_are_promised() {
    let summary = Graph::new(SQUARE).solve(&["--repeat", "3"]);
    let mut keys: Vec<&String> = summary.as_object().unwrap().keys().collect();
    keys.sort();
    let promised = [
        "chi2",
        "chi2_initial",
        "cost",
        "cpu_ms",
        "cpu_ms_first",
        "edges",
        "init",
        "iterations",
        "nodes",
        "stop",
        "total_iterations",
        "tried",
    ];
    assert_eq!(keys, promised);
    assert_eq!(
        (&summary["nodes"], &summary["edges"]),
        (&4.into(), &4.into())
    );
    assert!(number(&summary, "cpu_ms") > 0.0);
    assert!(number(&summary, "cpu_ms") <= number(&summary, "cpu_ms_first"));
    assert_eq!(number(&summary, "cost"), number(&summary, "chi2"));
    assert!(summary["stop"].as_str().unwrap().contains("below"));
}

#[test]
fn starts_are_listed_with_their_costs() {
    let summary = Graph::new(SQUARE).solve(&[]);
    let tried = summary["tried"].as_array().unwrap();
    let starts: Vec<&Value> = tried.iter().map(|trial| &trial["init"]).collect();
    // The better of two initial guesses is followed, and listed last.
    assert!(starts == ["file", "spanning-tree"] || starts == ["spanning-tree", "file"]);
    assert_eq!(starts[1], &summary["init"]);
    assert!(number(&tried[1], "cost_initial") <= number(&tried[0], "cost_initial"));
    assert_eq!(number(&tried[1], "cost"), number(&summary, "cost"));
    let iterations: f64 = tried.iter().map(|trial| number(trial, "iterations")).sum();
    assert_eq!(iterations, number(&summary, "total_iterations"));
    assert!(tried[0]["stop"].as_str().unwrap().contains("not continued"));
}

#[test]
fn every_method_and_start_reaches_the_same_optimum() {
    let graph = Graph::new(SQUARE);
    let best = number(&graph.solve(&[]), "chi2");
    for (options, init) in [
        (["--method", "lm"], None),
        (["--init", "auto"], None),
        (["--init", "file"], Some("file")),
        (["--init", "spanning-tree"], Some("spanning-tree")),
        (["--init", "chordal"], Some("chordal")),
        // The residuals are within the quadratic part of the kernels.
        (["--kernel", "huber:10"], None),
        (["--kernel", "dcs:10"], None),
        (["--repeat", "4"], None),
    ] {
        let summary = graph.solve(&options);
        // 1e-8: the relative decrease at which a solve stops, of a χ² far below 1.
        let difference = (number(&summary, "chi2") - best).abs();
        assert!(difference < 1e-8, "{options:?}: {difference:e}");
        if let Some(init) = init {
            assert_eq!(summary["init"], init);
        }
    }
}

#[test]
fn a_kernel_prints_the_cost_that_it_lowered() {
    // A fifth edge that states that vertex 2 coincides with vertex 0.
    let graph = Graph::new(format!("{SQUARE}EDGE_SE2 0 2 0 0 0 50 0 0 50 0 100\n"));
    let plain = graph.solve(&[]);
    for (kernel, most) in [("dcs:1", 3.2), ("huber:1", f64::INFINITY)] {
        let robust = graph.solve(&["--kernel", kernel]);
        let (cost, chi2) = (number(&robust, "cost"), number(&robust, "chi2"));
        // DCS counts no measurement with more than 3 φ; the others are within 0.1.
        assert!(
            cost < most && cost < 0.1 * chi2,
            "{kernel}: {cost} of {chi2}"
        );
        assert!(chi2 > number(&plain, "chi2"));
        let output = slam2d(&["optimize", graph.input(), "--kernel", kernel]);
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(text.contains(&format!("cost          {cost:.6}")), "{text}");
    }
    let text = String::from_utf8(slam2d(&["optimize", graph.input()]).stdout).unwrap();
    // Each start that was tried has a cost; the row of the result belongs to the kernel.
    assert!(!text.lines().any(|line| line.starts_with("cost")), "{text}");
}

#[test]
fn missing_parts_of_a_graph_are_added_and_reported() {
    let edges: String = SQUARE
        .lines()
        .filter(|line| line.starts_with("EDGE"))
        .map(|line| format!("{line}\n"))
        .collect();
    for (text, expected) in [
        (
            format!("{SQUARE}VERTEX_SE2 9 0 0 0\n"),
            "the graph has 2 connected components, 1 of them a single vertex",
        ),
        (
            edges,
            "the file has 0 poses and lacks 4 that its edges name; their poses are computed from a spanning tree",
        ),
        (
            format!("{SQUARE}EDGE_SE2 3 9 1 0 0 1 0 0 1 0 1\n"),
            "the file has 4 poses and lacks 1 that its edges name",
        ),
        (
            format!("{SQUARE}EDGE_PRIOR_SE2 0 5 5 0 1 0 0 1 0 1\n"),
            "1 prior taken as measurements",
        ),
        (
            format!("{SQUARE}VERTEX_XY 9 1 1\n"),
            "1 × VERTEX_XY kept unchanged, not part of the problem",
        ),
    ] {
        let graph = Graph::new(text);
        let output = slam2d(&["optimize", graph.input()]);
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(
            output.status.success() && message.contains(expected),
            "{message}"
        );
    }
    let in_space = "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n";
    Graph::new(in_space).assert_rejected(
        &[],
        "in.g2o: line 1 is a VERTEX_SE3:QUAT: the graph is three-dimensional",
    );
}

#[test]
fn loops_with_a_switch_or_a_weight_are_edges_of_the_problem() {
    let (poses, closing) = SQUARE.trim_end().rsplit_once('\n').unwrap();
    let plain = Graph::new(SQUARE).solve(&[]);
    for tag in ["SWITCHABLE 3 0 4", "MAXMIX 3 0 0.01", "SWITCHABLE 3 0"] {
        let edge = closing.replace("EDGE_SE2 3 0", &format!("EDGE_SE2_{tag}"));
        let graph = Graph::new(format!("{poses}\n{edge}\n"));
        let summary = graph.solve(&[]);
        assert_eq!(summary["edges"], plain["edges"], "{tag}");
        assert_eq!(summary["chi2"], plain["chi2"], "{tag}");
        let output = slam2d(&["optimize", graph.input()]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(
            said.contains("line 8: 1 switchable or max-mixture edge read as EDGE_SE2")
                && said.contains("--robust gnc"),
            "{said}"
        );
    }
}

#[test]
fn graphs_that_cannot_be_solved_are_rejected_in_one_line() {
    for (line, expected) in [
        (
            "EDGE_SE2 0 1 1 0",
            "in.g2o: line 9: EDGE_SE2 needs 11 numbers, found 4",
        ),
        (
            "EDGE_SE2 3 0 inf 0 0 1 0 0 1 0 1",
            "line 9: `inf` is not a finite number",
        ),
        (
            "EDGE_SE2 3 0 1 0 0 1 2 0 1 0 1",
            "line 9: the information matrix is not",
        ),
        (
            "VERTEX_SE2 0 0 0 0",
            "line 9: vertex 0 is already in line 1",
        ),
        ("FIX", "line 9: FIX names no vertex"),
        ("FIX 7", "line 9: there is no vertex 7"),
    ] {
        Graph::new(format!("{SQUARE}{line}\n")).assert_rejected(&[], expected);
    }
    Graph::new("").assert_rejected(&[], "the file has no VERTEX_SE2");
    Graph::new(b"VERTEX_SE2 0 0 0 \xFF\n").assert_rejected(&[], "line 1: the line is not UTF-8");
}

#[test]
fn kept_records_are_reported_and_standard_output_is_complete() {
    let tags = "VERTEX_XY 7 1 1\nODD\u{7}TAG 1\nODD\u{7}TAG 2\n";
    let graph = Graph::new(format!("{SQUARE}{tags}"));
    let output = graph.output();
    let printed = slam2d(&["optimize", graph.input(), "-o", output.to_str().unwrap()]);
    assert!(printed.status.success());
    let notes = String::from_utf8(printed.stderr).unwrap();
    assert_eq!(
        notes,
        format!(
            "slam2d: {}: line 9: VERTEX_XY: landmarks are not optimized, so 1 record is not used; solve the graph with g2o, or write an EDGE_SE2 between the poses that measure the same landmark\n\
         2 × ODD\\u{{7}}TAG kept unchanged, not part of the problem\n\
         1 × VERTEX_XY kept unchanged, not part of the problem\n",
            graph.input()
        )
    );
    assert!(fs::read_to_string(output).unwrap().ends_with(tags));
}

#[test]
fn an_edge_whose_cost_overflows_is_named() {
    let far = SQUARE.replace("VERTEX_SE2 2 1 1.1", "VERTEX_SE2 2 1e200 1.1");
    Graph::new(far).assert_rejected(&[], "in.g2o: line 6: eᵀΩe of this edge is too large");
    // Each edge alone has a finite cost, but the sum overflows: the largest is named.
    let heavy = SQUARE.replace(
        "EDGE_SE2 2 3 1 0 1.5707963 50 0 0 50",
        "EDGE_SE2 2 3 1 10 1.5707963 1.5e306 0 0 1.5e306",
    );
    let heavy = heavy.replace(
        "EDGE_SE2 1 2 1 0 1.5707963 50 0 0 50",
        "EDGE_SE2 1 2 1 10 1.5707963 1.5e306 0 0 1.5e306",
    );
    Graph::new(heavy).assert_rejected(&[], "eᵀΩe of this edge is too large");
}

#[test]
fn an_unobservable_vertex_is_named_by_id_and_line() {
    // Both edges of vertex 70 measure along one direction only, with weights beyond any regularization.
    let text = "\
VERTEX_SE2 50 0 0 0
VERTEX_SE2 60 1 0 0
VERTEX_SE2 70 2 0.5 0
EDGE_SE2 50 60 1 0 0 50 0 0 50 0 100
EDGE_SE2 60 70 1 0 0 1e12 1e12 0 1e12 0 0
EDGE_SE2 50 70 2 0 0 1e12 1e12 0 1e12 0 0
";
    Graph::new(text).assert_rejected(
        &[],
        "in.g2o: line 3: the measurements do not determine the pose of vertex 70",
    );
}

#[cfg(unix)]
mod unix {
    use std::io::Read as _;
    use std::os::unix::fs::{FileTypeExt as _, PermissionsExt as _, symlink};
    use std::process::Command;
    use std::thread;

    use super::*;

    fn written_to(output: &Path) -> Vec<u8> {
        let graph = Graph::new(SQUARE);
        graph.solve(&["-o", output.to_str().unwrap()]);
        let ours = graph.output();
        graph.solve(&["-o", ours.to_str().unwrap()]);
        fs::read(ours).unwrap()
    }

    #[test]
    fn an_output_that_is_a_link_stays_one() {
        let folder = tempfile::tempdir().unwrap();
        let (target, link) = (folder.path().join("target"), folder.path().join("link"));
        symlink("target", &link).unwrap();
        // The first time, the target does not exist yet.
        for _ in 0..2 {
            let whole = written_to(&link);
            assert!(link.is_symlink());
            assert_eq!(fs::read(&target).unwrap(), whole);
        }
    }

    #[test]
    fn an_output_keeps_its_permissions() {
        let folder = tempfile::tempdir().unwrap();
        let output = folder.path().join("out.g2o");
        fs::write(&output, "old").unwrap();
        fs::set_permissions(&output, fs::Permissions::from_mode(0o640)).unwrap();
        let whole = written_to(&output);
        assert_eq!(fs::read(&output).unwrap(), whole);
        let mode = fs::metadata(&output).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o640);
    }

    #[test]
    fn a_pipe_as_output_is_written_to_and_stays_a_pipe() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        assert!(
            Command::new("mkfifo")
                .arg(&pipe)
                .status()
                .unwrap()
                .success()
        );
        let reader = {
            let pipe = pipe.clone();
            thread::spawn(move || {
                let mut read = Vec::new();
                fs::File::open(pipe)
                    .unwrap()
                    .read_to_end(&mut read)
                    .unwrap();
                read
            })
        };
        let whole = written_to(&pipe);
        assert_eq!(reader.join().unwrap(), whole);
        assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
    }
}

/// A recorded graph; the recordings have no licence and are not part of the project.
fn recorded(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../../shared/data/graphs")
        .join(name);
    path.exists().then_some(path)
}

#[test]
fn a_kernel_costs_no_more_on_mit_than_at_the_plain_optimum() {
    let Some(path) = recorded("mit.g2o") else {
        skip("kernels on mit", NO_RECORDED_GRAPHS);
        return;
    };
    let path = path.to_str().unwrap();
    let plain = json(&["optimize", path, "--json"]);
    for kernel in ["dcs:5", "dcs:1", "huber:1"] {
        let robust = json(&["optimize", path, "--kernel", kernel, "--json"]);
        // A kernel never exceeds the squared norm.
        let cost = number(&robust, "cost");
        assert!(cost <= number(&plain, "chi2"), "{kernel}: {cost}");
    }
}
