//! Arguments and help of the command.

use std::fs;
use std::path::Path;

use robot_io::log::LogOption;

use crate::support::{assert_rejected, slam2d};

#[test]
fn wrong_arguments_end_in_one_line_and_exit_code_2() {
    for (arguments, expected) in [
        (&[][..], "a subcommand is required"),
        (
            &["bogus"],
            "unrecognized subcommand 'bogus' (try slam2d --help)",
        ),
        (&["--frob"], "--frob"),
        (&["optimize"], "IN.g2o"),
        (&["optimize", "absent.g2o"], "absent.g2o"),
        (&["optimize", "a.g2o", "--kernel", "huber:0"], "positive"),
        (&["optimize", "a.g2o", "--kernel", "cauchy:1"], "dcs:PHI"),
        (&["optimize", "a.g2o", "--init", "zero"], "zero"),
        (&["optimize", "a.g2o", "--method", "sgd"], "sgd"),
        (&["optimize", "a.g2o", "--max-iterations", "-1"], "-1"),
        (&["optimize", "a.g2o", "--tolerance", "nan"], "finite"),
        (&["optimize", "a.g2o", "--tolerance", "-1"], "0 to 1"),
        (&["optimize", "a.g2o", "--repeat", "0"], "0"),
    ] {
        assert_rejected(arguments, expected);
    }
}

#[test]
fn help_goes_to_standard_output() {
    let output = slam2d(&["--help"]);
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    for command in [
        "doctor", "info", "run", "live", "localize", "map", "convert", "evaluate", "optimize",
    ] {
        assert!(text.contains(command), "{command} is not in\n{text}");
    }
}

#[test]
fn a_subcommand_that_moved_names_its_program_and_the_folder_that_has_it() {
    for (word, program, folder) in [
        ("lap", "ch16 lap", "crates/chapter/ch16"),
        ("sweep", "ch16 sweep", "crates/chapter/ch16"),
        ("mark", "ch16-mark", "teaching/mark"),
        ("logs", "slam2d-dev logs", "crates/dev/slam2d_dev"),
    ] {
        let sentence =
            format!("slam2d {word} is now {program}; cargo install --path {folder} installs it");
        assert_rejected(&[word, "--json"], &sentence);
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
        let package = fs::read_to_string(root.join(folder).join("Cargo.toml")).unwrap();
        let name = program.split(' ').next().unwrap();
        assert!(
            package.contains(&format!("[[bin]]\nname = \"{name}\"")),
            "{folder}"
        );
    }
}

#[test]
fn evaluate_says_that_a_trajectory_in_another_frame_fits_once_it_is_aligned() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, line: fn(f64) -> [f64; 2]| {
        let path = folder.path().join(name);
        let lines = (0..20).map(|k| {
            let [x, y] = line(f64::from(k));
            format!("{k} {x} {y} 0 0 0 0 1\n")
        });
        fs::write(&path, lines.collect::<String>()).unwrap();
        path.display().to_string()
    };
    let truth = write("truth.tum", |k| [k, k % 5.0]);
    let turned = write("turned.tum", |k| [5.0 - k % 5.0, k]);
    let noisy = write("noisy.tum", |k| [k, k % 5.0 + 0.1 * (k % 2.0)]);
    let evaluated = |file: &str, align: &str| {
        let output = slam2d(&["evaluate", file, "--truth", &truth, "--align", align]);
        assert!(output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    assert!(evaluated(&turned, "none").contains("0.0000 m after a rigid motion"));
    for (file, align) in [(&turned, "se2"), (&noisy, "none"), (&truth, "none")] {
        assert_eq!(evaluated(file, align), "", "{file}");
    }
}

#[test]
fn the_command_and_python_offer_every_option_of_a_log() {
    // Options that a host does not offer, with the reason.
    const WITHOUT: [(&str, &str, &str); 4] = [
        ("Pipeline", "no_odometry", "odometry=False"),
        ("connect", "no_odometry", "odometry=False"),
        ("connect", "columns", "a robot sends messages of ROS"),
        ("connect", "all_robots", "one robot drives"),
    ];
    let help = String::from_utf8(slam2d(&["run", "--help"]).stdout).unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let stub = root.join("crates/robots/slam2d_py/python/rustslam2d/__init__.pyi");
    let stub = fs::read_to_string(stub).unwrap();
    for option in LogOption::ALL {
        let dashed = format!("--{} ", option.name());
        assert!(help.replace('\n', " \n").contains(&dashed), "{option:?}");
        let name = option.name().replace('-', "_");
        for (host, start) in [("Pipeline", "class Pipeline"), ("connect", "def connect(")] {
            let arguments = stub.split(start).nth(1).unwrap();
            let arguments = arguments.split(") ->").next().unwrap();
            let mut without = WITHOUT.iter();
            let is_without = without.any(|(of, absent, _)| (*of, *absent) == (host, &name));
            let is_offered = arguments.contains(&format!(" {name}: "));
            assert_ne!(is_offered, is_without, "{host}: {name}");
        }
    }
}
