//! Pose graphs in g2o text: read, written, and solved as in the command.

use pr_optim::g2o::G2oFile;
use pr_optim::{JacobianModel, Settings, Start};

use crate::solve::solve;

/// Larger graphs are read and written, but not solved: this target tests the reader.
const MAX_SOLVED: usize = 12;
/// Most steps of an attempt.
const MAX_ITERATIONS: usize = 8;

/// An error names a line of the file. A graph that is read survives a round trip.
pub fn fuzz(text: &[u8]) {
    let mut file = match G2oFile::parse(text) {
        Ok(file) => file,
        Err(rejection) => {
            let lines = text.split(|&byte| byte == b'\n').count();
            assert!((1..=lines).contains(&rejection.line), "{rejection}");
            assert!(rejection.to_string().len() < 400, "{rejection}");
            return;
        }
    };
    let written = file.to_bytes();
    let again = G2oFile::parse(&written).expect("what was written can be read");
    assert_eq!(again.to_bytes(), written);
    assert_eq!(again.kept_records(), file.kept_records());
    assert_eq!(again.problem.factors(), file.problem.factors());
    assert_eq!(again.problem.fixed(), file.problem.fixed());
    for (node, (old, new)) in pairs(&file, &again) {
        // Headings are wrapped again when they are read.
        assert_eq!(old.x().to_bits(), new.x().to_bits(), "node {node}");
        assert_eq!(old.y().to_bits(), new.y().to_bits(), "node {node}");
        assert!((old.theta() - new.theta()).abs() < 1e-12, "node {node}");
        assert_eq!(file.id_of(node), again.id_of(node));
        assert_eq!(file.line_of(node), again.line_of(node));
    }
    if file.problem.node_count() <= MAX_SOLVED && file.problem.factors().len() <= 2 * MAX_SOLVED {
        let settings = Settings {
            jacobians: JacobianModel::Exact,
            max_iterations: MAX_ITERATIONS,
            decrease_tolerance: 1e-8,
            ..Settings::default()
        };
        solve(&mut file.problem, settings, Start::Auto);
    }
}

fn pairs<'a>(
    a: &'a G2oFile,
    b: &'a G2oFile,
) -> impl Iterator<Item = (usize, (&'a pr_geom::SE2, &'a pr_geom::SE2))> {
    let poses = a.problem.poses().iter().zip(b.problem.poses());
    poses.enumerate()
}
