//! The map, the path and the transforms of a drive, shown to Foxglove, Lichtblick and others while it lasts.
//!
//! | topic | type | when |
//! |---|---|---|
//! | `/map` | `nav_msgs/msg/OccupancyGrid` | the map has changed, as often as drawing takes at most a fifth of a core |
//! | `/path` | `nav_msgs/msg/Path`, the keyframes | a pose has changed |
//! | `/tf` | `tf2_msgs/msg/TFMessage`: map → odom → body | each scan |
//!
//! The frame of odometry and that of the body are those of the recording. Without odometry, `/tf` has map → body. A thread
//! draws the map, so that no scan waits for it; what nobody subscribes to is not made.

mod messages;

use std::fmt;
use std::io;
use std::net::SocketAddr;
use std::str::FromStr;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use ch16_slam2d::slam::{Slam, SlamReport};
use pr_geom::SE2;
use robot_connection::{Server, nanoseconds};
use robot_io::log::{LogFrame, LogNotes, LogOption};
use robot_io::map_image::{MapBuilder, MapError, MapImage, NoReturn, finest_map};
use robot_io::run::LogRun;

use self::messages::{MAP, PATH, TRANSFORMS};

/// The port, unless another one is given: one after that of foxglove_bridge.
pub const PORT: &str = "8766";
/// The map is drawn at most this often.
const DRAW_EVERY: Duration = Duration::from_secs(1);
/// Of the time, this many parts rest for one that draws.
const REST: u32 = 4;
/// Most cells of a map that is shown; a larger one has coarser cells.
const MAX_CELLS: u64 = 1 << 24;
/// How long clients have to take the last map.
const LAST: Duration = Duration::from_secs(5);

/// Where the map is served: on the loopback, unless an address is given.
#[derive(Clone, Copy, Debug)]
pub struct ServeAt(SocketAddr);

impl FromStr for ServeAt {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let port = text.parse::<u16>();
        let at = port.map(|port| SocketAddr::from(([127, 0, 0, 1], port)));
        let at = at.or_else(|_| text.parse());
        at.map(Self).map_err(|_| {
            format!(
                "expected a port such as {PORT}, or an address with one, such as 0.0.0.0:{PORT}"
            )
        })
    }
}

impl fmt::Display for ServeAt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)
    }
}

/// Shows a drive.
pub struct Shown {
    server: Arc<Server>,
    cell_m: f64,
    no_return: NoReturn,
    /// Names of the frames of odometry and body.
    frames: Option<[String; 2]>,
    /// Poses of the keyframes of the last path and of the last map.
    shown: Vec<SE2>,
    drawn: Vec<SE2>,
    /// Number of frames of keyframes that the drawing thread has.
    passed: usize,
    to_draw: Sender<ToDraw>,
    drawing: JoinHandle<()>,
    next_map: NextMap,
    stamp_s: f64,
}

/// When the next map may be drawn; `None` while one is.
#[derive(Clone)]
struct NextMap(Arc<Mutex<Option<Instant>>>);

impl NextMap {
    fn at(&self) -> MutexGuard<'_, Option<Instant>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What the map is drawn from.
struct ToDraw {
    stamp_s: f64,
    /// Frames of further keyframes.
    frames: Vec<LogFrame>,
    /// Time (s) and pose of each keyframe.
    poses: Vec<(f64, SE2)>,
}

impl Shown {
    /// Starts to serve.
    ///
    /// # Errors
    /// If the address is taken or not this computer's.
    pub fn start(at: ServeAt, cell_m: f64, no_return: NoReturn) -> io::Result<Self> {
        let server = Server::start("slam2d live", at.0, messages::channels())?;
        let server = Arc::new(server);
        let (to_draw, drawings) = channel();
        let next_map = NextMap(Arc::new(Mutex::new(Some(Instant::now()))));
        let of_thread = (Arc::clone(&server), next_map.clone());
        let drawing = thread::spawn(move || {
            draw_all(&drawings, &of_thread.0, &of_thread.1, |poses, frames| {
                draw(poses, frames, cell_m, no_return)
            });
        });
        Ok(Self {
            server,
            cell_m,
            no_return,
            frames: None,
            shown: Vec::new(),
            drawn: Vec::new(),
            passed: 0,
            to_draw,
            drawing,
            next_map,
            stamp_s: 0.0,
        })
    }

    /// The address for clients.
    pub fn url(&self) -> String {
        format!("ws://{}", self.server.address)
    }

    /// Shows what a scan has changed, whose odometry this is.
    pub fn step(
        &mut self,
        report: &SlamReport,
        odometry: Option<SE2>,
        notes: &LogNotes,
        run: &LogRun,
    ) {
        self.stamp_s = report.stamp_s;
        let [odom, body] = self.frames.get_or_insert_with(|| frames(notes));
        let transforms = match odometry {
            Some(odom_from_body) => vec![
                (
                    messages::MAP_FRAME,
                    &odom[..],
                    report.estimate * odom_from_body.inverse(),
                ),
                (&odom[..], &body[..], odom_from_body),
            ],
            None => vec![(messages::MAP_FRAME, &body[..], report.estimate)],
        };
        let transforms = messages::transforms(report.stamp_s, &transforms);
        self.publish(TRANSFORMS, transforms);
        let poses = run.slam().map_or(&[][..], |slam| slam.graph().poses());
        if self.server.is_wanted(PATH) && self.shown != poses {
            self.shown = poses.to_vec();
            self.publish(PATH, messages::path(self.stamp_s, poses));
        }
        let is_due = self.next_map.at().is_some_and(|at| at <= Instant::now());
        if is_due && self.server.is_wanted(MAP) && self.drawn != poses {
            *self.next_map.at() = None;
            self.drawn = poses.to_vec();
            let frames = run.keyframe_frames();
            let _ = self.to_draw.send(ToDraw {
                stamp_s: report.stamp_s,
                frames: frames[self.passed..].to_vec(),
                poses: posed(run),
            });
            self.passed = frames.len();
        }
    }

    /// Shows the result of the drive, and ends once all clients have it.
    pub fn end(self, run: &LogRun) {
        drop(self.to_draw);
        // A map that is still drawn comes before the last one.
        let _ = self.drawing.join();
        let poses = run.slam().map_or(&[][..], |slam| slam.graph().poses());
        let time_ns = nanoseconds(self.stamp_s);
        let path = messages::path(self.stamp_s, poses);
        self.server.publish(PATH, time_ns, path);
        if self.server.is_wanted(MAP) {
            let posed = posed(run);
            let map = draw(&posed, run.keyframe_frames(), self.cell_m, self.no_return);
            if let Ok(map) = map {
                let map = messages::map(self.stamp_s, &map);
                self.server.publish(MAP, time_ns, map);
            }
        }
        self.server.end(LAST);
    }

    fn publish(&self, channel: usize, message: Vec<u8>) {
        let time_ns = nanoseconds(self.stamp_s);
        self.server.publish(channel, time_ns, message);
    }
}

/// Time (s) and pose of each keyframe.
fn posed(run: &LogRun) -> Vec<(f64, SE2)> {
    let of_slam = |slam: &Slam| -> Vec<(f64, SE2)> {
        let keyframes = slam.keyframes().iter();
        let stamps_s = keyframes.map(|keyframe| keyframe.stamp_s);
        stamps_s.zip(slam.graph().poses().iter().copied()).collect()
    };
    run.slam().map_or_else(Vec::new, of_slam)
}

/// The frames of odometry and body.
fn frames(notes: &LogNotes) -> [String; 2] {
    let usual = [
        (LogOption::OdometryFrame, "odom"),
        (LogOption::BodyFrame, "base_link"),
    ];
    usual.map(|(option, usual)| {
        let offer = notes.offers.iter().find(|offer| offer.option == option);
        let taken = offer.and_then(|offer| offer.taken.clone());
        taken.unwrap_or_else(|| usual.to_owned())
    })
}

/// Draws one map after another.
fn draw_all(
    drawings: &Receiver<ToDraw>,
    server: &Server,
    next_map: &NextMap,
    draw: impl Fn(&[(f64, SE2)], &[LogFrame]) -> Result<MapImage, MapError>,
) {
    let mut all = Vec::new();
    for drawing in drawings {
        let since = Instant::now();
        all.extend(drawing.frames);
        if let Ok(map) = draw(&drawing.poses, &all) {
            let map = messages::map(drawing.stamp_s, &map);
            server.publish(MAP, nanoseconds(drawing.stamp_s), map);
        }
        let rest = DRAW_EVERY.max(since.elapsed() * REST);
        *next_map.at() = Some(Instant::now() + rest);
    }
}

/// The map of keyframes: their times (s) and poses, and the frames, in order of time.
fn draw(
    poses: &[(f64, SE2)],
    frames: &[LogFrame],
    cell_m: f64,
    no_return: NoReturn,
) -> Result<MapImage, MapError> {
    finest_map(cell_m, |cell_m| {
        let mut map = MapBuilder::new(cell_m).with_no_return(no_return);
        for (stamp_s, pose) in poses {
            let at = frames.binary_search_by(|frame| frame.stamp_s.total_cmp(stamp_s));
            if let Ok(at) = at {
                map.add(pose, &frames[at].scan)?;
            }
        }
        let map = map.finish()?;
        let (columns, rows) = (map.width as u64, map.height as u64);
        if columns * rows > MAX_CELLS {
            return Err(MapError::TooWide {
                columns,
                rows,
                cell_m,
            });
        }
        Ok(map)
    })
}
