//! A robot is switched on anywhere on a map of an earlier drive: how often it is localized, how accurately,
//! and what it reports if its location is ambiguous.

use std::sync::Arc;

use ch16_lab::lap::{Drive, DriveConfig};
use ch16_lab::laps::LapsConfig;
use ch16_lab::relocalization::switched_on as switched_on_at;
use ch16_slam2d::localize::{KnownMap, LocalizeConfig, LocalizeReport, Localizer, StartPose};
use ch16_slam2d::metrics::{position_error_m, rms};
use ch16_slam2d::scan::PreparedFrame;
use ch16_slam2d::slam::{Slam, SlamConfig};
use pr_geom::{Point2, SE2};
use pr_sim::{Course, Wall, World, WorldRect};

/// A course with the map that one lap of it leaves.
struct MappedWorld {
    drive: DriveConfig,
    slam: SlamConfig,
    map: Arc<KnownMap>,
    /// Error of the map's own keyframes, m.
    map_rms_m: f64,
}

impl MappedWorld {
    fn new(course: &Course) -> Self {
        let LapsConfig { drive, slam, .. } = LapsConfig::new(course, 1, 1.0);
        let lap = Drive::simulate(&drive);
        let mut estimator = Slam::new(slam.clone());
        for tick in 0..=lap.ticks().len() {
            estimator.step_prepared(&lap.prepared(tick)).unwrap();
        }
        estimator.conclude();
        let keyframes = estimator.keyframes().to_vec();
        let poses = estimator.graph().poses().to_vec();
        let places = keyframes.iter().zip(&poses);
        let off_m =
            places.map(|(keyframe, pose)| position_error_m(pose, &lap.truth(keyframe.frame)));
        let map_rms_m = rms(off_m);
        let map = KnownMap::new(keyframes, poses, &LocalizeConfig::default());
        let map = Arc::new(map.unwrap());
        Self {
            drive,
            slam,
            map,
            map_rms_m,
        }
    }

    /// A lap with other noise.
    fn drive(&self, seed: u32) -> Drive {
        Drive::simulate(&DriveConfig {
            seed: 1000 + seed,
            ..self.drive.clone()
        })
    }

    fn localizer(&self, start: StartPose) -> Localizer {
        let config = LocalizeConfig::default();
        Localizer::new(Arc::clone(&self.map), self.slam.clone(), config, start)
    }
}

/// A frame of a drive as if it followed another one directly: odometry does not notice that the robot was
/// carried.
fn at(drive: &Drive, tick: usize, stamp_s: f64) -> PreparedFrame {
    PreparedFrame {
        stamp_s,
        ..drive.prepared(tick)
    }
}

fn error_m(report: &LocalizeReport, truth: &SE2) -> f64 {
    report
        .pose
        .map_or(f64::INFINITY, |pose| position_error_m(&pose, truth))
}

/// Of twenty starts along the path: how many were localized within ten seconds, how many frames were
/// localized half a metre or more off, and the median error of the right ones.
fn switched_on(place: &MappedWorld) -> (usize, usize, f64) {
    let (mut found, mut wrong) = (0, 0);
    let mut errors_m = Vec::new();
    for seed in 1..=20 {
        let drive = place.drive(seed);
        let first = (drive.ticks().len() - 40) * (seed as usize - 1) / 19;
        let mut localizer = place.localizer(StartPose::Anywhere);
        let mut is_found = false;
        for tick in first..first + 40 {
            let frame = at(&drive, tick, tick as f64);
            let report = localizer.step_prepared(&frame).unwrap();
            if !report.verdict.is_localized() {
                continue;
            }
            is_found = true;
            let error_m = error_m(&report, &drive.truth(tick));
            if error_m > 0.5 {
                wrong += 1;
            } else {
                errors_m.push(error_m);
            }
        }
        found += usize::from(is_found);
    }
    errors_m.sort_by(f64::total_cmp);
    (found, wrong, errors_m[errors_m.len() / 2])
}

#[test]
fn a_robot_that_is_switched_on_anywhere_is_found_and_never_in_the_wrong_place() {
    for course in [Course::apartment(), Course::ring()] {
        let place = MappedWorld::new(&course);
        let (found, wrong, median_m) = switched_on(&place);
        println!(
            "{found} of 20 found, {wrong} frames wrong, median error {median_m:.3} m, map off by {:.3} m",
            place.map_rms_m
        );
        assert!(found >= 18, "{found} of 20");
        assert_eq!(wrong, 0);
        // 0.1: two cells of the thinned scans, in addition to the error of the map itself.
        assert!(median_m < place.map_rms_m + 0.1, "{median_m} m");
    }
}

#[test]
fn a_robot_that_is_carried_away_notices_and_is_found_again() {
    let place = MappedWorld::new(&Course::apartment());
    let drive = place.drive(5);
    let mut localizer = place.localizer(StartPose::Near(drive.truth(20) * SE2::new(0.2, 0.1, 0.1)));
    let mut stamp_s = 0.0;
    let mut step = |localizer: &mut Localizer, tick: usize| {
        stamp_s += 0.25;
        let report = localizer.step_prepared(&at(&drive, tick, stamp_s)).unwrap();
        let error_m = error_m(&report, &drive.truth(tick));
        (report.verdict.is_localized(), error_m)
    };
    let mut followed = 0;
    for tick in 20..40 {
        let (is_localized, error_m) = step(&mut localizer, tick);
        assert!(error_m < place.map_rms_m + 0.1, "{tick}: {error_m}");
        followed += usize::from(is_localized);
    }
    // Along the corridor a scan may slide by a step. The next one then contradicts odometry and is not
    // localized, although its pose is right.
    assert!(followed >= 18, "{followed} of 20");
    // The robot is carried three metres on.
    let mut localized = Vec::new();
    for tick in 60..100 {
        let (is_localized, error_m) = step(&mut localizer, tick);
        if is_localized {
            assert!(error_m < 0.5, "{tick}: {error_m}");
            localized.push(tick);
        }
    }
    assert!(
        localized.first().is_some_and(|tick| *tick > 60),
        "{localized:?}"
    );
    assert!(localized.len() > 15, "{localized:?}");
}

/// Two exactly equal rooms on one corridor.
fn twin_rooms() -> Course {
    let walls = |y: f64| {
        let corners = [[1.4, 0.3], [2.2, 0.3], [2.2, 0.8], [1.4, 0.8]];
        let box_sides = (0..4).map(move |k| (corners[k], corners[(k + 1) % 4]));
        let room = [
            ([0.0, 0.0], [4.0, 0.0]),
            ([0.0, 3.0], [4.0, 3.0]),
            ([0.0, 0.0], [0.0, 3.0]),
            ([4.0, 0.0], [4.0, 1.0]),
            ([4.0, 2.0], [4.0, 3.0]),
        ];
        let sides = room.into_iter().chain(box_sides);
        sides.map(move |([ax, ay], [bx, by])| Wall {
            start: Point2::new(ax, y + ay),
            end: Point2::new(bx, y + by),
        })
    };
    let wall = |ax: f64, ay: f64, bx: f64, by: f64| Wall {
        start: Point2::new(ax, ay),
        end: Point2::new(bx, by),
    };
    let corridor = [
        wall(4.0, -1.0, 5.2, -1.0),
        wall(4.0, -1.0, 4.0, 0.0),
        wall(5.2, -1.0, 5.2, 9.0),
        wall(4.0, 9.0, 5.2, 9.0),
        wall(4.0, 3.0, 4.0, 5.0),
        wall(4.0, 8.0, 4.0, 9.0),
    ];
    let bounds = WorldRect {
        min: Point2::new(0.0, -1.0),
        max: Point2::new(5.2, 9.0),
    };
    let walls = walls(0.0).chain(walls(5.0)).chain(corridor).collect();
    let way = [[4.6, 1.5], [4.6, 6.5], [1.0, 6.6]].map(|[x, y]| Point2::new(x, y));
    Course::new(
        World::new(bounds, walls),
        SE2::new(1.0, 1.6, 0.0),
        way.to_vec(),
        None,
    )
    .unwrap()
}

#[test]
fn in_one_of_two_equal_rooms_no_frame_is_localized_before_the_door() {
    let place = MappedWorld::new(&twin_rooms());
    for seed in 1..=5 {
        let drive = place.drive(seed);
        let end = drive.ticks().len();
        // In the first room, standing; on the way out; and in the second room, standing.
        for ticks in [vec![0; 12], (0..end).collect(), vec![end; 12]] {
            let mut localizer = place.localizer(StartPose::Anywhere);
            let mut localized = 0;
            for (number, &tick) in ticks.iter().enumerate() {
                let mut frame = at(&drive, tick, 0.25 * number as f64);
                let stands = ticks.len() == 12;
                frame.odometry = if stands {
                    Some(SE2::identity())
                } else {
                    frame.odometry
                };
                let report = localizer.step_prepared(&frame).unwrap();
                if report.verdict.is_localized() {
                    let error_m = error_m(&report, &drive.truth(tick));
                    assert!(error_m < 0.5, "seed {seed}, tick {tick}: {error_m}");
                    localized += 1;
                }
            }
            let is_whole = ticks.len() > 12;
            assert_eq!(
                localized > 0,
                is_whole,
                "seed {seed}: {localized} of {}",
                ticks.len()
            );
        }
    }
}

/// Of 24 starts in a room that the lap only saw through its door: how many were localized half a metre or more off.
fn found_in_another_room(place: &MappedWorld, room_m: f64) -> usize {
    let spots = [
        [0.8, 0.7],
        [0.8, 1.9],
        [2.0, 0.7],
        [2.0, 1.9],
        [2.0, 3.1],
        [3.2, 1.9],
    ];
    let starts = spots
        .iter()
        .flat_map(|[x, y]| [0.3, 1.87, -2.84, -1.27].map(|heading| SE2::new(*x, *y, heading)));
    let day = DriveConfig {
        seed: 1001,
        ..place.drive.clone()
    };
    let is_wrong = |start: &SE2| {
        let drive = Drive::simulate(&switched_on_at(&day, *start, 40));
        let config = LocalizeConfig {
            room_m,
            ..LocalizeConfig::default()
        };
        let (map, slam) = (Arc::clone(&place.map), place.slam.clone());
        let mut localizer = Localizer::new(map, slam, config, StartPose::Anywhere);
        (0..=drive.ticks().len()).any(|tick| {
            let report = localizer.step_prepared(&drive.prepared(tick)).unwrap();
            report.verdict.is_localized() && error_m(&report, &drive.truth(tick)) > 0.5
        })
    };
    starts.filter(is_wrong).count()
}

#[test]
fn a_robot_in_a_room_seen_through_its_door_is_not_found_in_one_like_it() {
    let place = MappedWorld::new(&Course::apartment());
    let LocalizeConfig { room_m, .. } = LocalizeConfig::default();
    assert_eq!(found_in_another_room(&place, room_m), 0);
    assert!(found_in_another_room(&place, 0.0) > 0, "without the trial");
}
