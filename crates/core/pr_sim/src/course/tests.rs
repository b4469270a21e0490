use std::collections::BTreeSet;

use proptest::prelude::*;

use super::clearance::{nearest_wall, nearest_wall_to_leg};
use super::*;
use crate::driver::WaypointDriver;
use crate::motion::drive_exactly;
use crate::world::{Wall, WorldRect};

/// Tick of the chapter's lap, s, and the largest number of ticks of a lap.
const DT_S: f64 = 0.25;
const MAX_TICKS: usize = 2000;

/// The least distance to a wall on the whole drive in metres; `None` if it does not end.
fn clearance_of_drive(course: &Course) -> Option<f64> {
    let mut driver = WaypointDriver::new(DriverConfig {
        waypoints: course.way_points().to_vec(),
        ..DriverConfig::default()
    });
    let mut pose = course.start();
    let mut least_m = f64::INFINITY;
    for _ in 0..MAX_TICKS {
        let step = driver.step(&pose);
        let next = drive_exactly(&pose, step.command, DT_S);
        let (from, to) = (pose.position(), next.position());
        least_m = least_m.min(nearest_wall_to_leg(course.world(), from, to).1);
        pose = next;
        if step.finished {
            return Some(least_m);
        }
    }
    None
}

fn read(text: &str) -> Result<Course, CourseError> {
    Course::from_json(text.as_bytes())
}

/// A square room of 8 m with a wall, in which a test replaces one text by another.
fn room(replace: &str, with: &str) -> String {
    let text = r#"{
  "walls_m": [[0, 0, 8, 0], [8, 0, 8, 8], [8, 8, 0, 8], [0, 8, 0, 0], [3, 4, 5, 4]],
  "start": { "x_m": 1, "y_m": 1, "heading_deg": 90 },
  "way_points_m": [[7, 1], [7, 7], [1, 7], [1, 1]],
  "turn_at": 4
}"#;
    assert!(text.contains(replace), "{replace}");
    text.replace(replace, with)
}

#[test]
fn the_worlds_that_break_a_map_can_be_driven_all_the_same() {
    for course in [
        Course::twin_rooms(),
        Course::bare_corridor(),
        Course::round_hall(),
    ] {
        assert_eq!(course.check(), Ok(()));
        assert!(clearance_of_drive(&course).is_some(), "the drive ends");
    }
}

#[test]
fn the_twin_rooms_are_alike_to_the_millimetre() {
    let course = Course::twin_rooms();
    let sweep = |x: f64| -> Vec<f64> {
        let cast = |k: u32| {
            // Half a degree off: no ray meets the end of a wall.
            let angle = (f64::from(k) + 0.5) / 360.0 * core::f64::consts::TAU;
            course.world().cast(Point2::new(x, 3.7), angle, 3.0)
        };
        // Up from the south: through the door the scans of the corridor differ.
        (0..180).map(cast).collect()
    };
    for (one, other) in sweep(4.85).iter().zip(sweep(6.15)) {
        // 1e-9: the coordinates of the second room's walls round differently.
        assert!((one - other).abs() < 1e-9, "{one} and {other}");
    }
}

#[test]
fn a_file_is_read_as_it_is_written() {
    let course = read(&room("", "")).unwrap();
    assert_eq!(course.world().walls().len(), 5);
    assert_eq!(course.world().bounds().max, Point2::new(8.0, 8.0));
    assert_eq!(
        course.start(),
        SE2::new(1.0, 1.0, core::f64::consts::FRAC_PI_2)
    );
    assert_eq!(course.way_points()[2], Point2::new(1.0, 7.0));
    assert_eq!(course.turn(), Some(3));
    let with_mark = format!("\u{feff}{}", room(",\n  \"turn_at\": 4", ""));
    assert_eq!(read(&with_mark).unwrap().turn(), None);
}

#[test]
fn the_example_of_the_documentation_is_a_course() {
    let page = include_str!("../../../../../docs/worlds.md");
    let (_, rest) = page.split_once("```json\n").unwrap();
    let (example, _) = rest.split_once("```").unwrap();
    let course = read(example).unwrap();
    assert_eq!((course.world().walls().len(), course.turn()), (8, Some(3)));
    assert!(clearance_of_drive(&course).is_some());
}

#[test]
fn what_is_wrong_is_one_sentence_that_says_what_where_and_what_to_do() {
    let far = "give coordinates in metres near it";
    for (replace, with, start, end) in [
        (
            "\"turn_at\": 4",
            "\"turn_at\": NaN",
            "line 5, column 14: expected value; the file has to be JSON",
            "last item",
        ),
        (
            "\"turn_at\": 4\n}",
            "",
            "line 5, column 2: EOF while parsing",
            "last item",
        ),
        // Control characters are not printed.
        (
            "\"turn_at\"",
            "\"turn\u{7f}at\u{9b}\"",
            "line 5, column 13: unknown field `turnat`, expected one of `walls_m`",
            "[[x, y], …]",
        ),
        (
            "\"turn_at\"",
            "\"turnat\"",
            "line 5, column 10: unknown field `turnat`, expected one of `walls_m`",
            "[[x, y], …]",
        ),
        (
            "heading_deg",
            "heading",
            "line 3, column 42: unknown field `heading`",
            "[[x, y], …]",
        ),
        (
            "\"turn_at\": 4",
            "\"walls_m\": []",
            "line 5, column 11: duplicate field `walls_m`",
            "[[x, y], …]",
        ),
        (
            "[3, 4, 5, 4]",
            "[3, 4, 5]",
            "line 2, column 79: invalid length 3",
            "[[x, y], …]",
        ),
        (
            "[3, 4, 5, 4]",
            "[3, 4, 1e999, 4]",
            "line 2, column 82: number out of range",
            "last item",
        ),
        (
            "[3, 4, 5, 4]",
            "[3, 4, 1e300, 4]",
            "wall 5 is more than 100 m from the origin",
            far,
        ),
        (
            "[3, 4, 5, 4]",
            "[3, 4, 3, 4]",
            "wall 5 starts where it ends",
            "leave it out",
        ),
        (
            "[[7, 1], [7, 7], [1, 7], [1, 1]]",
            "[]",
            "way_points_m is empty",
            "as [x, y]",
        ),
        (
            "[7, 7]",
            "[-1e4, 0]",
            "waypoint 2 is more than 100 m from the origin",
            far,
        ),
        (
            "[7, 7]",
            "[9, 7]",
            "waypoint 2 is outside the walls, which reach from (0, 0) to (8, 8) m",
            "move it inside",
        ),
        (
            "[7, 7]",
            "[4, 4.1]",
            "waypoint 2 is 0.10 m from wall 5",
            "0.3 m from every wall",
        ),
        (
            "\"x_m\": 1",
            "\"x_m\": 0.1",
            "the start is 0.10 m from wall 4",
            "0.3 m from every wall",
        ),
        (
            "[7, 1], [7, 7]",
            "[4, 3], [4, 5]",
            "the straight line from waypoint 1 to waypoint 2 comes within 0.00 m of wall 5",
            "0.3 m from every wall",
        ),
        (
            "[7, 1]",
            "[7, 7]",
            "the straight line from the start to waypoint 1 comes within 0.00 m of wall 5",
            "every wall",
        ),
        (
            "90",
            "361",
            "heading_deg of the start is not between -360 and 360",
            "give it in degrees",
        ),
        (
            "\"turn_at\": 4",
            "\"turn_at\": 5",
            "turn_at is 5, but there are 4 waypoints",
            "from 1",
        ),
        (
            "\"turn_at\": 4",
            "\"turn_at\": 0",
            "turn_at is 0, but there are 4 waypoints",
            "from 1",
        ),
    ] {
        let message = read(&room(replace, with)).unwrap_err().to_string();
        assert!(
            message.starts_with(start) && message.ends_with(end),
            "{with}: {message}"
        );
        assert!(!message.contains('\n'), "{message}");
    }
}

#[test]
fn what_is_too_much_is_rejected_with_its_limit() {
    let (course, way) = (Course::ring(), Course::ring().way_points().to_vec());
    let with = |walls: Vec<Wall>, way_points| {
        let world = World::new(course.world().bounds(), walls);
        Course::new(world, course.start(), way_points, None).map_err(|error| error.to_string())
    };
    let walls = course.world().walls().to_vec();
    assert_eq!(
        with(walls.repeat(75), way.clone()),
        Err(
            "walls_m has 2025 walls, but at most 2000 are allowed: leave small ones out".to_owned()
        )
    );
    assert_eq!(
        with(walls.clone(), way.repeat(9)),
        Err("way_points_m has 54 waypoints, but at most 50 are allowed: leave some out".to_owned())
    );
    assert_eq!(
        with(walls, way[..5].repeat(6)),
        Err(
            "the path is 218 m long, but at most 200 m are allowed: leave waypoints out".to_owned()
        )
    );
    assert_eq!(
        with(Vec::new(), way),
        Err("walls_m is empty: give it at least one wall as [x, y, x, y]".to_owned())
    );
}

#[test]
fn numbers_that_are_not_finite_are_rejected() {
    let course = Course::apartment();
    let with = |start, way_points| Course::new(course.world().clone(), start, way_points, None);
    let way = course.way_points().to_vec();
    assert_eq!(
        with(SE2::new(1.0, 4.4, f64::NAN), way.clone()),
        Err(CourseError::NoHeading)
    );
    assert!(matches!(
        with(SE2::new(f64::NAN, 4.4, 0.0), way),
        Err(CourseError::TooFar {
            place: CoursePoint::Start,
            ..
        })
    ));
    assert!(matches!(
        with(course.start(), vec![Point2::new(2.0, f64::INFINITY)]),
        Err(CourseError::TooFar {
            place: CoursePoint::WayPoint(1),
            ..
        })
    ));
}

#[test]
fn the_built_in_courses_pass_their_own_checks_and_are_driven() {
    // The Apartment's corridor is 1.2 m wide, the ring's 1.4 m with pillars of 0.35 m.
    for (course, least_m) in [(Course::apartment(), 0.5), (Course::ring(), 0.3)] {
        assert_eq!(course.check(), Ok(()));
        assert!(clearance_of_drive(&course).unwrap() > least_m);
    }
}

/// The cells of 0.2 m that can be reached from one by straight steps between points inside them, none
/// of which is on a wall.
fn reachable(world: &World, from: (i32, i32)) -> BTreeSet<(i32, i32)> {
    let inside = |(x, y)| Point2::new(0.2 * f64::from(x) + 0.07, 0.2 * f64::from(y) + 0.07);
    let mut found = BTreeSet::from([from]);
    let mut open = vec![from];
    while let Some((x, y)) = open.pop() {
        for next in [(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)] {
            let (_, distance_m) = nearest_wall_to_leg(world, inside((x, y)), inside(next));
            if distance_m > 0.0 && found.insert(next) {
                open.push(next);
            }
        }
    }
    found
}

#[test]
fn the_ring_is_a_cycle_and_the_apartment_is_none() {
    let with = |course: Course, cuts: &[Wall]| {
        let walls = course.world().walls().iter().chain(cuts).copied();
        World::new(course.world().bounds(), walls.collect())
    };
    // Across the south and the north corridor, and across the Apartment's beside its doors.
    let (south, north) = (Wall::vertical(6.5, 0.0, 1.4), Wall::vertical(6.5, 7.6, 9.0));
    let all = reachable(&with(Course::ring(), &[]), (10, 3)).len();
    assert_eq!(all, 60 * 45, "every room of the ring has a door");
    assert_eq!(
        reachable(&with(Course::ring(), &[south]), (10, 3)).len(),
        all
    );
    let halves = with(Course::ring(), &[south, north]);
    let (west, east) = (reachable(&halves, (10, 3)), reachable(&halves, (50, 3)));
    assert!(west.is_disjoint(&east) && west.len() + east.len() == all);

    let corridor = with(Course::apartment(), &[Wall::vertical(5.0, 3.8, 5.0)]);
    assert!(!reachable(&corridor, (10, 22)).contains(&(50, 22)));
}

proptest! {
    /// Three walls in a room and waypoints anywhere: whatever is accepted can be driven.
    #[test]
    fn an_accepted_course_is_driven_to_its_end_without_touching_a_wall(
        walls in prop::collection::vec((2.5..7.5, 2.5..7.5, -2.5..2.5, -2.5..2.5), 3),
        stops in prop::collection::vec((0.3..9.7, 0.3..9.7), 2..6),
        heading in -3.1..3.1,
    ) {
        let bounds = WorldRect {
            min: Point2::new(0.0, 0.0),
            max: Point2::new(10.0, 10.0),
        };
        let wall = |&(x, y, dx, dy): &(f64, f64, f64, f64)| Wall {
            start: Point2::new(x, y),
            end: Point2::new(x + dx, y + dy),
        };
        let world = World::new(bounds, walls.iter().map(wall).collect());
        let start = SE2::new(stops[0].0, stops[0].1, heading);
        let way_points = stops[1..].iter().map(|&(x, y)| Point2::new(x, y)).collect();
        // A third of them is accepted.
        if let Ok(course) = Course::new(world, start, way_points, None) {
            let clearance_m = clearance_of_drive(&course);
            prop_assert!(clearance_m.is_some_and(|least_m| least_m > 0.0), "{:?}", clearance_m);
        }
    }
}

#[test]
fn the_longest_drive_that_is_accepted_ends() {
    // 50 waypoints and 200 m: back and forth, with a turn around at each.
    let bounds = WorldRect {
        min: Point2::new(0.0, 0.0),
        max: Point2::new(10.0, 4.0),
    };
    let walls = vec![Wall::horizontal(0.0, 0.0, 10.0)];
    let ends = [Point2::new(5.0, 2.0), Point2::new(1.01, 2.0)];
    let course = Course::new(
        World::new(bounds, walls),
        SE2::new(1.0, 2.0, 0.0),
        ends.repeat(25),
        None,
    );
    assert!(clearance_of_drive(&course.unwrap()).is_some());
}

#[test]
fn the_distance_to_a_wall_is_that_to_its_nearest_part() {
    let world = World::new(
        Course::apartment().world().bounds(),
        vec![Wall::horizontal(0.0, 0.0, 4.0)],
    );
    assert_eq!(nearest_wall(&world, Point2::new(2.0, 1.5)), (0, 1.5));
    assert_eq!(nearest_wall(&world, Point2::new(7.0, 4.0)), (0, 5.0));
    let leg = |x_from, y_from, x_to, y_to| {
        nearest_wall_to_leg(&world, Point2::new(x_from, y_from), Point2::new(x_to, y_to)).1
    };
    assert_eq!(leg(1.0, 1.0, 3.0, -1.0), 0.0);
    assert_eq!(leg(1.0, 2.0, 3.0, 1.0), 1.0);
    assert_eq!(leg(5.0, 3.0, 5.0, -3.0), 1.0);
}
