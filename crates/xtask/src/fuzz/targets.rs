//! The targets, and what of the sources each leads to.

/// A fuzz target with the sources whose coverage counts.
pub struct Target {
    /// Name of the target and of its door.
    pub name: &'static str,
    /// Files, or folders with a slash at the end, of what the door leads to.
    pub sources: &'static [&'static str],
}

/// Every target, the fast ones first.
pub const TARGETS: [Target; 11] = [
    Target {
        name: "links",
        sources: &["widgets/kit/src/param.rs"],
    },
    Target {
        name: "messages",
        sources: &["widgets/kit/src/param.rs", "widgets/kit/src/model.rs"],
    },
    Target {
        name: "g2o",
        sources: &[
            "crates/pr_optim/src/g2o.rs",
            "crates/pr_optim/src/g2o/record.rs",
        ],
    },
    Target {
        name: "clouds",
        sources: &["crates/ch16_slam2d/src/cloud/csv.rs"],
    },
    Target {
        name: "files",
        sources: &[
            "crates/robot_io/src/trajectory.rs",
            "crates/robot_io/src/relations.rs",
            "crates/robot_io/src/graph_file.rs",
            "crates/pr_sim/src/course/clearance.rs",
            "crates/pr_sim/src/course/error.rs",
            "crates/pr_sim/src/course/file.rs",
            "crates/pr_sim/src/sketch",
        ],
    },
    Target {
        name: "logs",
        sources: &[
            "crates/robot_io/src/carmen",
            "crates/robot_io/src/json_log.rs",
            "crates/robot_io/src/line_log.rs",
            "crates/robot_io/src/lines.rs",
            "crates/robot_io/src/log.rs",
            "crates/robot_io/src/motion",
            "crates/robot_io/src/restamped.rs",
            "crates/robot_io/src/ros",
            "crates/robot_io/src/stamps.rs",
        ],
    },
    Target {
        name: "databases",
        sources: &["crates/robot_io/src/ros/sqlite_file"],
    },
    Target {
        name: "sessions",
        sources: &["crates/robot_io/src/session"],
    },
    Target {
        name: "graphs",
        sources: &["crates/pr_optim/src/"],
    },
    Target {
        name: "registration",
        sources: &["crates/ch16_slam2d/src/icp/", "crates/ch16_slam2d/src/ndt/"],
    },
    Target {
        name: "hands",
        sources: &["widgets/src/"],
    },
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::root;

    #[test]
    fn every_target_has_a_file_and_sources_that_exist() {
        for target in &TARGETS {
            let file = format!("fuzz/fuzz_targets/{}.rs", target.name);
            assert!(root().join(file).exists(), "{}", target.name);
            for source in target.sources {
                // A model may be a file with a folder beside it.
                let path = root().join(source);
                assert!(path.exists(), "{source}");
            }
        }
    }
}
