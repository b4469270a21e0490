//! What a robot records on its drive through a building.

use core::f64::consts::PI;

use ch16_slam2d::scan::{Frame, LaserScan};
use pr_geom::{Point2, SE2, math};
use pr_sim::world::Viewpoint;
use pr_sim::{LidarConfig, Rng, Wall, World, WorldRect};

use super::plan::BuildingPlan;
use crate::lap::Drive;

/// Sine of the angle to a pane's normal up to which beams are reflected by the glass.
const GLASS_SINE: f64 = 0.15;
/// Half the side of a person, m.
const PERSON_M: f64 = 0.18;
/// Turn from one scan to the next on the spot, rad.
const TURN_RAD: f64 = 0.3;

/// Whether a log contains the pose of the sensor on the body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mounting {
    /// Every scan contains it.
    #[default]
    Logged,
    /// The log lacks it: the sensor seems to sit above the axle.
    Missing,
}

/// A robot: its sensor and its errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recorder {
    /// Seed of all noise.
    pub seed: u32,
    /// Number of beams.
    pub beams: usize,
    /// Field of view, rad; 2π is the full circle.
    pub field_of_view_rad: f64,
    /// Longest range, m.
    pub max_range_m: f64,
    /// Standard deviation of a range, m.
    pub range_sigma_m: f64,
    /// Resolution of the reported ranges, m.
    pub range_step_m: f64,
    /// Share of the beams that report a random range in front of the wall.
    pub stray: f64,
    /// Share of the beams without a range: 0, NaN or infinity.
    pub dropped: f64,
    /// Pose of the sensor on the body.
    pub body_from_sensor: SE2,
    /// Whether the log contains the mounting.
    pub mounting: Mounting,
    /// Shortest and longest distance between scans, m.
    pub spacing_m: [f64; 2],
    /// Additional scans on each spot where the path bends.
    pub rests: usize,
    /// Scale error of the odometry: measured path length over true path length.
    pub wheel_scale: f64,
    /// Standard deviation of the slip as a share of the path length.
    pub slip: f64,
    /// Heading drift of the odometry, rad/m, constant over the drive.
    pub drift_rad: f64,
    /// Share of the scans at which the odometry jumps.
    pub jumps: f64,
    /// Number of people who walk by.
    pub people: usize,
}

impl Default for Recorder {
    /// A scanner with half a degree between beams, and odometry that drifts and jumps.
    fn default() -> Self {
        Self {
            seed: 1,
            beams: 361,
            field_of_view_rad: PI,
            max_range_m: 80.0,
            range_sigma_m: 0.015,
            range_step_m: 0.01,
            stray: 0.01,
            dropped: 0.0,
            body_from_sensor: SE2::identity(),
            mounting: Mounting::Logged,
            spacing_m: [0.2, 0.5],
            rests: 0,
            wheel_scale: 1.0,
            slip: 0.05,
            drift_rad: 0.01,
            jumps: 0.004,
            people: 2,
        }
    }
}

impl Recorder {
    /// From the body to the frame that a reader of the log takes for the body's.
    fn assumed_body(&self) -> SE2 {
        match self.mounting {
            Mounting::Logged => SE2::identity(),
            Mounting::Missing => self.body_from_sensor,
        }
    }
}

/// A frame with its true pose, which the estimator does not see.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedFrame {
    /// Time, s.
    pub stamp_s: f64,
    /// Pose of the body in the odometry frame.
    pub odometry: SE2,
    /// The scan with its geometry.
    pub scan: LaserScan,
    /// True pose `world_from_body`, or of the sensor if the log lacks the mounting.
    pub truth: SE2,
}

/// A complete recording.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// The frames in order.
    pub frames: Vec<RecordedFrame>,
}

impl Recording {
    /// Drives through `plan` and records every scan.
    #[must_use]
    pub fn new(plan: &BuildingPlan, recorder: &Recorder) -> Self {
        let mut rng = Rng::new(recorder.seed);
        let truths = poses(plan, recorder, &mut rng);
        let mut wheels = Wheels::new(recorder, &mut rng);
        let mut scanner = Scanner::new(recorder);
        let mut people: Vec<Person> = (0..recorder.people)
            .map(|_| Person::new(&mut rng))
            .collect();
        let mut frames = Vec::with_capacity(truths.len());
        for (number, truth) in truths.iter().enumerate() {
            let before = number.checked_sub(1).map_or(*truth, |k| truths[k]);
            let odometry = wheels.roll(&before.between(truth), &mut rng);
            for person in &mut people {
                person.walk(&mut rng);
            }
            let bodies = people.iter().map(|person| person.place(&truths, number));
            let scan = scanner.sense(plan, bodies.collect(), truth, &mut rng);
            frames.push(RecordedFrame {
                stamp_s: 0.5 * number as f64,
                odometry,
                scan,
                truth: *truth * recorder.assumed_body(),
            });
        }
        Self { frames }
    }

    /// Converts a simulated lap into a recording: the start and every tick.
    #[must_use]
    pub fn from_drive(drive: &Drive) -> Self {
        let frame = |tick: usize| {
            let Frame { stamp_s, scan, .. } = drive.frame(tick);
            RecordedFrame {
                stamp_s,
                odometry: drive.dead_reckoning(tick),
                scan,
                truth: drive.truth(tick),
            }
        };
        Self {
            frames: (0..=drive.ticks().len()).map(frame).collect(),
        }
    }

    /// A frame as the estimator sees it, with or without odometry.
    #[must_use]
    pub fn frame(&self, number: usize, with_wheels: bool) -> Frame {
        let frame = &self.frames[number];
        let before = number.checked_sub(1).filter(|_| with_wheels);
        Frame {
            stamp_s: frame.stamp_s,
            odometry: before.map(|k| self.frames[k].odometry.between(&frame.odometry)),
            scan: frame.scan.clone(),
        }
    }
}

/// Poses of the scans: along the path, and turning on the spot where it bends.
fn poses(plan: &BuildingPlan, recorder: &Recorder, rng: &mut Rng) -> Vec<SE2> {
    let [shortest, longest] = recorder.spacing_m;
    let mut poses: Vec<SE2> = Vec::new();
    let mut sway = 0.0;
    for pair in plan.path.windows(2) {
        let (dx, dy) = (pair[1].x - pair[0].x, pair[1].y - pair[0].y);
        let span = math::norm2(dx, dy);
        if span < 1e-6 {
            continue;
        }
        let heading = math::atan2(dy, dx);
        let mut along = 0.0;
        if let Some(last) = poses.last().copied() {
            let mut left = SE2::new(0.0, 0.0, last.theta())
                .between(&SE2::new(0.0, 0.0, heading))
                .theta();
            let mut theta = last.theta();
            while left.abs() > TURN_RAD {
                let turn = TURN_RAD.copysign(left) * rng.uniform(0.6, 1.0);
                theta += turn;
                left -= turn;
                poses.push(SE2::new(last.x(), last.y(), theta));
            }
            along = rng.uniform(shortest, longest);
        }
        while along < span {
            // The robot sways a little, so no two passes are the same.
            sway = 0.9 * sway + rng.normal(0.0, 0.05);
            let (x, y) = (
                pair[0].x + along * dx / span - sway * dy / span,
                pair[0].y + along * dy / span + sway * dx / span,
            );
            poses.push(SE2::new(x, y, heading + rng.normal(0.0, 0.04)));
            along += rng.uniform(shortest, longest);
        }
        let last = poses.last().copied();
        poses.extend(last.into_iter().cycle().take(recorder.rests));
    }
    poses
}

/// Odometry that slips, drifts and jumps.
struct Wheels {
    pose: SE2,
    recorder: Recorder,
    scale: f64,
}

impl Wheels {
    fn new(recorder: &Recorder, rng: &mut Rng) -> Self {
        Self {
            pose: SE2::new(
                rng.uniform(-5.0, 5.0),
                rng.uniform(-5.0, 5.0),
                rng.uniform(-PI, PI),
            ),
            recorder: *recorder,
            scale: recorder.wheel_scale + rng.normal(0.0, 0.5 * recorder.slip),
        }
    }

    fn roll(&mut self, motion: &SE2, rng: &mut Rng) -> SE2 {
        let Recorder {
            slip,
            drift_rad,
            jumps,
            ..
        } = self.recorder;
        let path_length_m = math::norm2(motion.x(), motion.y());
        let share = self.scale + rng.normal(0.0, slip);
        let turn = motion.theta() * (1.0 + rng.normal(0.0, slip)) + drift_rad * path_length_m;
        let mut rolled = SE2::new(
            motion.x() * share,
            motion.y() * share,
            turn + rng.normal(0.0, 0.2 * slip * path_length_m + 0.002),
        );
        if rng.unit() < jumps {
            let heading = rng.normal(0.0, 0.35);
            rolled = rolled * SE2::new(rng.normal(0.0, 0.4), rng.normal(0.0, 0.2), heading);
        }
        self.pose = self.pose * rolled;
        self.pose
    }
}

/// A person who walks a few scans ahead of the robot or behind it.
struct Person {
    scans_ahead: f64,
    aside_m: f64,
}

impl Person {
    fn new(rng: &mut Rng) -> Self {
        Self {
            scans_ahead: rng.uniform(-20.0, 20.0),
            aside_m: rng.uniform(-0.6, 0.6),
        }
    }

    fn walk(&mut self, rng: &mut Rng) {
        self.scans_ahead += rng.normal(0.0, 1.5);
        self.aside_m = (self.aside_m + rng.normal(0.0, 0.1)).clamp(-0.7, 0.7);
        if self.scans_ahead.abs() > 40.0 {
            self.scans_ahead = -self.scans_ahead;
        }
    }

    fn place(&self, poses: &[SE2], number: usize) -> Point2<f64> {
        let last = poses.len() as f64 - 1.0;
        let at = (number as f64 + self.scans_ahead).clamp(0.0, last) as usize;
        let aside = poses[at] * SE2::from_xy(0.0, self.aside_m);
        aside.position()
    }
}

struct Scanner {
    recorder: Recorder,
    first_angle_rad: f64,
    angle_step_rad: f64,
    opaque: Viewpoint,
    glass: Viewpoint,
    people: Viewpoint,
}

impl Scanner {
    fn new(recorder: &Recorder) -> Self {
        let lidar = LidarConfig {
            beams: recorder.beams,
            field_of_view_rad: recorder.field_of_view_rad,
            ..LidarConfig::default()
        };
        Self {
            recorder: *recorder,
            first_angle_rad: lidar.first_angle_rad(),
            angle_step_rad: lidar.angle_step_rad(),
            opaque: Viewpoint::default(),
            glass: Viewpoint::default(),
            people: Viewpoint::default(),
        }
    }

    fn sense(
        &mut self,
        plan: &BuildingPlan,
        people: Vec<Point2<f64>>,
        body: &SE2,
        rng: &mut Rng,
    ) -> LaserScan {
        let Recorder {
            max_range_m,
            range_sigma_m,
            range_step_m,
            stray,
            dropped,
            body_from_sensor,
            mounting,
            ..
        } = self.recorder;
        let sensor = *body * body_from_sensor;
        let (here, far) = (sensor.position(), max_range_m);
        let nearby = crowd(
            people
                .into_iter()
                .filter(|person| (person - here).norm() > 0.6),
        );
        self.opaque.stand_at(&plan.opaque, here, far);
        self.glass.stand_at(&plan.glass, here, far);
        self.people.stand_at(&nearby, here, far);
        let mut ranges_m = Vec::with_capacity(self.recorder.beams);
        for beam in 0..self.recorder.beams {
            let angle = sensor.theta() + self.first_angle_rad + beam as f64 * self.angle_step_rad;
            let mut range = self.opaque.cast(angle);
            let pane = self.glass.cast(angle);
            // Facades are parallel to the axes: a pane reflects beams that are almost perpendicular to it.
            let (sin, cos) = math::sin_cos(angle);
            if pane < range && sin.abs().min(cos.abs()) < GLASS_SINE {
                range = pane;
            }
            range = range.min(self.people.cast(angle));
            if rng.unit() < stray {
                range *= rng.uniform(0.3, 1.0);
            }
            let noise = rng.normal(0.0, range_sigma_m);
            if dropped > 0.0 && rng.unit() < dropped {
                ranges_m.push([0.0, f64::NAN, f64::INFINITY][beam % 3]);
                continue;
            }
            ranges_m.push(if range >= far {
                // Such a scanner reports this if a beam has no return.
                far + 1.0
            } else {
                (((range + noise) / range_step_m).round() * range_step_m).max(0.0)
            });
        }
        LaserScan {
            first_angle_rad: self.first_angle_rad,
            angle_step_rad: self.angle_step_rad,
            range_max_m: far,
            body_from_sensor: match mounting {
                Mounting::Logged => body_from_sensor,
                Mounting::Missing => SE2::identity(),
            },
            ranges_m,
            ..LaserScan::default()
        }
    }
}

/// The outlines of people.
fn crowd(people: impl Iterator<Item = Point2<f64>>) -> World {
    let mut walls = Vec::new();
    for person in people {
        let at = |x: f64, y: f64| Point2::new(person.x + x * PERSON_M, person.y + y * PERSON_M);
        let corners = [
            at(-1.0, -1.0),
            at(1.0, -1.0),
            at(1.0, 1.0),
            at(-1.0, 1.0),
            at(-1.0, -1.0),
        ];
        walls.extend(corners.windows(2).map(|pair| Wall {
            start: pair[0],
            end: pair[1],
        }));
    }
    let bounds = WorldRect {
        min: Point2::new(0.0, 0.0),
        max: Point2::new(0.0, 0.0),
    };
    World::new(bounds, walls)
}
