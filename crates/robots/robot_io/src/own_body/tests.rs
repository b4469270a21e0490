use core::f64::consts::{PI, TAU};

use pr_geom::SE2;

use super::*;

/// What travels with the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Travels {
    Nothing,
    /// A post at 0.3 m over the last third of the beams.
    Post,
    /// The floor, 2 m ahead of a laser that leans.
    Floor,
}

/// Readings in a room of 10 m × 6 m.
struct Room {
    frames: VecDeque<LogFrame>,
    notes: LogNotes,
}

impl Room {
    fn new(poses: impl Iterator<Item = SE2>, travels: Travels, has_odometry: bool) -> Box<Self> {
        let beams = 120;
        let step = TAU / f64::from(beams);
        let frame = |(number, pose): (usize, SE2)| {
            let range_m = |beam: i32| {
                if travels == Travels::Post && beam >= 80 {
                    return 0.3;
                }
                let (sin, cos) = math::sin_cos(pose.theta() - PI + f64::from(beam) * step);
                let along = if cos > 0.0 {
                    10.0 - pose.x()
                } else {
                    -pose.x()
                };
                let across = if sin > 0.0 { 6.0 - pose.y() } else { -pose.y() };
                let ahead = math::cos(-PI + f64::from(beam) * step);
                let floor_m = if travels == Travels::Floor && ahead > 0.1 {
                    2.0 / ahead
                } else {
                    f64::INFINITY
                };
                (along / cos).min(across / sin).min(floor_m)
            };
            LogFrame {
                stamp_s: number as f64,
                odometry: has_odometry.then_some(pose),
                scan: LaserScan {
                    first_angle_rad: -PI,
                    angle_step_rad: step,
                    ranges_m: (0..beams).map(range_m).collect(),
                    ..LaserScan::default()
                },
            }
        };
        Box::new(Self {
            frames: poses.enumerate().map(frame).collect(),
            notes: LogNotes::default(),
        })
    }
}

impl LogReader for Room {
    fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError> {
        Ok(self.frames.pop_front())
    }

    fn notes(&self) -> &LogNotes {
        &self.notes
    }
}

/// Number of readings cut out of the last scan, and the number of remarks.
fn cut(room: Box<Room>) -> (usize, usize) {
    let mut reader = BodyReader::new(room);
    let mut last = 0;
    while let Some(frame) = reader.next_frame().unwrap() {
        last = frame
            .scan
            .ranges_m
            .iter()
            .filter(|range_m| range_m.is_nan())
            .count();
    }
    (last, reader.notes().warnings.len())
}

fn along_a_wall() -> impl Iterator<Item = SE2> {
    // 0.3 m beside a wall: its beams see the same range everywhere.
    (0..40).map(|k| SE2::new(1.0 + 0.2 * f64::from(k), 0.3, 0.0))
}

fn around() -> impl Iterator<Item = SE2> {
    (0..40).map(|k| {
        let turn = 0.15 * f64::from(k);
        SE2::new(5.0 + 2.0 * math::cos(turn), 3.0 + math::sin(turn), turn)
    })
}

/// 1 m beside the walls, also around the corners: what is to the right has the same range everywhere.
fn along_all_walls() -> impl Iterator<Item = SE2> {
    let sides = [
        (1.0, 1.0, 0, 8.0),
        (9.0, 1.0, 1, 4.0),
        (9.0, 5.0, 2, 8.0),
        (1.0, 5.0, 3, 4.0),
    ];
    sides.into_iter().flat_map(|(x, y, quarter, length_m)| {
        let heading = f64::from(quarter) * PI / 2.0;
        let start = SE2::new(x, y, heading);
        let steps = (length_m / 0.2) as i32;
        let straight = (0..steps).map(move |k| start * SE2::new(0.2 * f64::from(k), 0.0, 0.0));
        let corner = start * SE2::new(length_m, 0.0, 0.0);
        straight.chain((0..5).map(move |k| corner * SE2::new(0.0, 0.0, PI / 10.0 * f64::from(k))))
    })
}

#[test]
fn the_floor_before_a_leaning_laser_is_cut_out_and_said_with_and_without_odometry() {
    for has_odometry in [true, false] {
        let room = Room::new(around(), Travels::Floor, has_odometry);
        let expected = room.frames.back().map(|frame| {
            let beams = frame.scan.ranges_m.iter().enumerate();
            let on = beams.filter(|(beam, range_m)| {
                let ahead_m = *range_m * math::cos(frame.scan.bearing_rad(*beam));
                (ahead_m - 2.0).abs() < 1e-9
            });
            on.count()
        });
        let (last, remarks) = cut(room);
        assert_eq!(remarks, 1, "{has_odometry}");
        // A beam or two on a wall end near the line.
        let off = last.checked_sub(expected.unwrap());
        assert!(off.is_some_and(|off| off <= 2), "{has_odometry}: {last}");
    }
}

#[test]
fn a_body_in_view_is_cut_out_and_said_with_and_without_odometry() {
    for has_odometry in [true, false] {
        assert_eq!(
            cut(Room::new(around(), Travels::Post, has_odometry)),
            (40, 1)
        );
    }
}

#[test]
fn a_wall_beside_the_way_and_a_robot_at_rest_lose_nothing() {
    for has_odometry in [true, false] {
        let room = |poses: &[SE2]| Room::new(poses.iter().copied(), Travels::Nothing, has_odometry);
        let at_rest = [SE2::new(0.4, 0.4, 0.0); 300];
        for poses in [
            around().collect(),
            along_a_wall().collect(),
            along_all_walls().collect(),
            at_rest.to_vec(),
        ] {
            assert_eq!(cut(room(&poses)), (0, 0), "{has_odometry}: {:?}", poses[1]);
        }
    }
}
