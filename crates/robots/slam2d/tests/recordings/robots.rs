//! A robot that no place connects with the others.

use ch16_lab::lap::{BuiltInWorld, Drive, DriveConfig};
use robot_io::log::LogFrame;
use robot_io::run::LogRun;

/// Later than any stamp of the first robot, s.
const LATER_S: f64 = 10_000.0;

#[test]
fn a_robot_in_another_building_is_named_and_the_larger_map_stays() {
    let drive =
        |world: BuiltInWorld| Drive::simulate(&DriveConfig::default().on_course(&world.course()));
    let (ring, apartment) = (drive(BuiltInWorld::Ring), drive(BuiltInWorld::Apartment));
    let mut run = LogRun::default();
    for frame in ring.log_frames() {
        run.step(frame);
    }
    run.next_robot("/b/scan", LATER_S);
    for frame in apartment.log_frames() {
        run.step(LogFrame {
            stamp_s: frame.stamp_s + LATER_S,
            ..frame
        });
    }
    run.finish();
    let counts = [&ring, &apartment].map(|drive| drive.ticks().len() + 1);
    let [more, fewer] = [counts.iter().max(), counts.iter().min()].map(Option::unwrap);
    let said = run.sentences("x").join("\n");
    assert!(
        said.contains("the robot of /b/scan was not found on the map")
            && said.contains(&format!("the {fewer} scans"))
            && !said.contains("carried"),
        "{said}"
    );
    assert_eq!(run.trajectory().poses().len(), *more, "{said}");
}
