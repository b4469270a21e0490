//! Second days in a building: the robot starts somewhere along the path, and its odometry at zero.

use ch16_lab::lap::{BuiltInWorld, Drive, DriveConfig};
use ch16_slam2d::metrics::position_error_m;
use ch16_slam2d::pipeline::{LogFrame, PieceFate};
use pr_geom::{SE2, math};
use rayon::prelude::*;
use robot_io::run::LogRun;
use robot_io::session::Session;

/// Number of starts along the path.
const STARTS: usize = 5;
/// Seconds of a day.
const DAY_S: f64 = 86_400.0;
/// Part of the path that is driven on the second day.
const LENGTH: f64 = 0.4;
/// Largest difference between the stamps of a scan and its pose, s.
const SLACK_S: f64 = 1e-3;

/// A building with the map of the first day.
struct Building {
    name: &'static str,
    first_day: Drive,
    second_day: Drive,
    session: Session,
    /// Largest error of the first day itself, m.
    own_m: f64,
}

impl Building {
    fn new(name: &'static str, world: BuiltInWorld) -> Self {
        let drive = |seed| {
            let config = DriveConfig {
                seed,
                ..DriveConfig::default()
            };
            Drive::simulate(&config.on_course(&world.course()))
        };
        let first_day = drive(1);
        let run = mapped(LogRun::default(), first_day.log_frames());
        let truth = (0..).map(|tick| first_day.truth(0).between(&first_day.truth(tick)));
        let frames = first_day.log_frames().zip(truth);
        let own_m = largest_error_m(&run, frames.map(|(frame, right)| (frame.stamp_s, right)));
        Self {
            own_m,
            name,
            session: run.session().expect("a drive has scans"),
            first_day,
            second_day: drive(2),
        }
    }

    /// Frames of the second day from this one on, and their true poses in the frame of the first day's map.
    fn frames(&self, first: usize) -> impl Iterator<Item = (LogFrame, SE2)> + '_ {
        let count = (LENGTH * self.second_day.ticks().len() as f64) as usize;
        let frames = self.second_day.log_frames().enumerate();
        let mut start = None;
        frames.skip(first).take(count).map(move |(tick, frame)| {
            let odometry = frame.odometry.unwrap_or_default();
            let zero = *start.get_or_insert(odometry);
            let later = LogFrame {
                stamp_s: frame.stamp_s + DAY_S,
                odometry: Some(zero.between(&odometry)),
                ..frame
            };
            let on_map = self.first_day.truth(0);
            (later, on_map.between(&self.second_day.truth(tick)))
        })
    }

    /// The second day from a share of the path on, continued on this map.
    fn row(&self, start: usize, map: &Self) -> String {
        let first = start * self.second_day.ticks().len() / STARTS;
        let (frames, truth): (Vec<LogFrame>, Vec<SE2>) = self.frames(first).unzip();
        let stamps_s: Vec<f64> = frames.iter().map(|frame| frame.stamp_s).collect();
        let run = LogRun::resume(&map.session).expect("this program saved it");
        let run = mapped(run, frames.into_iter());
        let off_m = largest_error_m(&run, stamps_s.into_iter().zip(truth));
        let outcome = match run.pieces().first().map(|piece| piece.fate) {
            Some(PieceFate::Joined(scans)) => format!("{scans} | {off_m:.3}"),
            None => format!("0 | {off_m:.3}"),
            Some(_) => "not found: mapped alone | –".to_owned(),
        };
        let percent = 100 * start / STARTS;
        format!(
            "| {}, from {percent} % of the path on | {} | {:.3} | {outcome} |",
            self.name, map.name, map.own_m
        )
    }
}

/// Largest distance of the run's poses from the true ones at their stamps, m.
fn largest_error_m(run: &LogRun, truth: impl Iterator<Item = (f64, SE2)>) -> f64 {
    let trajectory = run.trajectory();
    let off_m = truth.filter_map(|(stamp_s, right)| {
        let pose = trajectory.at(stamp_s, SLACK_S)?;
        Some(position_error_m(&right, &pose))
    });
    off_m.fold(0.0, math::max)
}

fn mapped(mut run: LogRun, frames: impl Iterator<Item = LogFrame>) -> LogRun {
    for frame in frames {
        run.step(frame);
    }
    run.finish();
    run
}

/// Where the robot of each second day was found, and how far its poses are off on the first day's map, in Markdown.
pub fn table() -> String {
    let buildings = [
        Building::new("the ring", BuiltInWorld::Ring),
        Building::new("the Apartment", BuiltInWorld::Apartment),
    ];
    let mut days: Vec<(usize, usize, usize)> = Vec::new();
    for building in 0..buildings.len() {
        days.extend((0..STARTS).map(|start| (building, start, building)));
        days.push((building, 0, 1 - building));
    }
    let rows = days.par_iter();
    let rows = rows.map(|&(day, start, map)| buildings[day].row(start, &buildings[map]));
    let rows: Vec<String> = rows.collect();
    let mut lines = vec![
        "| second day | on the map of | largest error of the map, m | found after, scans | largest error, m |".to_owned(),
        "| --- | --- | ---: | ---: | ---: |".to_owned(),
    ];
    lines.extend(rows);
    lines.join("\n")
}
