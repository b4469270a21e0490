//! ATE and RPE equal evo's, on the files that `tests/evo/make.py` wrote with evo 1.38.1.

use robot_io::evaluate::{Alignment, PoseErrors, truth_errors};
use robot_io::trajectory::Trajectory;
use serde_json::Value;

const TRUTH: &str = include_str!("evo/truth.tum");
const ESTIMATE: &str = include_str!("evo/estimate.tum");
const VALUES: &str = include_str!("evo/values.json");

#[track_caller]
fn assert_same(found: &PoseErrors, evo: &Value) {
    let pairs = [
        ("rmse", found.rmse),
        ("mean", found.mean),
        ("median", found.median),
        ("std", found.std),
        ("min", found.min),
        ("max", found.max),
        ("sse", found.sse),
    ];
    for (name, value) in pairs {
        let expected = evo[name].as_f64().unwrap();
        // 1e-9: the guaranteed accuracy; both round numbers below 10 a few hundred times.
        assert!(
            (value - expected).abs() < 1e-9,
            "{name}: {value} {expected}"
        );
    }
}

#[test]
fn errors_against_the_truth_are_those_of_evo() {
    let values: Value = serde_json::from_str(VALUES).unwrap();
    let truth = Trajectory::read_tum(TRUTH.as_bytes(), "truth").unwrap();
    let estimate = Trajectory::read_tum(ESTIMATE.as_bytes(), "estimate").unwrap();
    for (name, alignment) in [("none", Alignment::None), ("se2", Alignment::Se2)] {
        let evo = &values[name];
        let found = truth_errors(&estimate, &truth, alignment).unwrap();
        assert_eq!(found.n as u64, evo["n"].as_u64().unwrap());
        assert_same(&found.ate, &evo["ate"]);
        assert_same(&found.rpe.trans, &evo["rpe"]["trans"]);
        assert_same(&found.rpe.rot_deg, &evo["rpe"]["rot_deg"]);
    }
}
