use core::f64::consts::{PI, TAU};

use super::*;

/// Readings in a room of 10 m × 6 m, with a post of 0.3 m over the last third of the beams if there is one.
struct Room {
    frames: VecDeque<LogFrame>,
    notes: LogNotes,
}

impl Room {
    fn new(poses: impl Iterator<Item = SE2>, has_post: bool, has_odometry: bool) -> Box<Self> {
        let beams = 120;
        let step = TAU / f64::from(beams);
        let frame = |(number, pose): (usize, SE2)| {
            let range_m = |beam: i32| {
                if has_post && beam >= 80 {
                    return 0.3;
                }
                let (sin, cos) = math::sin_cos(pose.theta() - PI + f64::from(beam) * step);
                let along = if cos > 0.0 {
                    10.0 - pose.x()
                } else {
                    -pose.x()
                };
                let across = if sin > 0.0 { 6.0 - pose.y() } else { -pose.y() };
                (along / cos).min(across / sin)
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

#[test]
fn a_body_in_view_is_cut_out_and_said_with_and_without_odometry() {
    for has_odometry in [true, false] {
        assert_eq!(cut(Room::new(around(), true, has_odometry)), (40, 1));
    }
}

#[test]
fn a_wall_beside_the_way_and_a_robot_at_rest_lose_nothing() {
    for has_odometry in [true, false] {
        let room = |poses: &[SE2]| Room::new(poses.iter().copied(), false, has_odometry);
        let at_rest = [SE2::new(0.4, 0.4, 0.0); 300];
        for poses in [
            around().collect(),
            along_a_wall().collect(),
            at_rest.to_vec(),
        ] {
            assert_eq!(cut(room(&poses)), (0, 0), "{has_odometry}: {:?}", poses[1]);
        }
    }
}
