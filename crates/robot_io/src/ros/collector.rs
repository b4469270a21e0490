//! Puts frames together from messages.

mod offers;

use std::collections::BTreeMap;

use ch16_slam2d::scan::LaserScan;

use super::container::Recorded;
use super::messages::{Header, TransformMessage, laser_scan, odometry, transforms};
use super::point_cloud::point_cloud;
use super::transforms::{Mount, Transforms, planar};
use super::waiting::{WaitingScan, WaitingScans};
use super::wire::WireReader;
use crate::lines::listed;
use crate::log::{LogFrame, LogNotes, LogOptions};
use crate::place::checked;
use crate::wheel_poses::WheelPoses;

/// A recording of garbage has no end of topics.
const MOST_TOPICS: usize = 1000;

/// The topic of transforms.
const TRANSFORMS: &str = "/tf";

/// Where the wheels' poses come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum WheelSource {
    Odometry,
    Transforms,
}

/// What was met, and the scans that wait.
#[derive(Debug, Default)]
pub struct Collector {
    options: LogOptions,
    scan_topic: Option<String>,
    odometry_topic: Option<String>,
    wheel_source: Option<WheelSource>,
    by_odometry: WheelPoses,
    by_transforms: WheelPoses,
    /// The frames that the wheels tie together, by Odometry or by a transform.
    wheel_frames: Option<(String, String)>,
    transforms: Transforms,
    waiting: WaitingScans,
    sensor: Option<String>,
    mount: Option<Mount>,
    counts: BTreeMap<(String, String), usize>,
    /// Why clouds that were not asked for are no scans.
    other_clouds: Option<String>,
    warning: Option<String>,
    /// Scans whose odometry had not come when they had waited long enough.
    early: usize,
    is_done: bool,
}

impl Collector {
    /// A collector that has seen nothing.
    pub fn new(options: &LogOptions) -> Self {
        Self {
            options: options.clone(),
            ..Self::default()
        }
    }

    /// Takes a message.
    ///
    /// # Errors
    /// What is wrong with it; it is left out.
    pub fn take(&mut self, message: &Recorded) -> Result<(), String> {
        let key = (message.topic.clone(), message.kind.clone());
        if self.counts.len() < MOST_TOPICS || self.counts.contains_key(&key) {
            *self.counts.entry(key).or_default() += 1;
        }
        let named = |problem: String| format!("{} on {}: {problem}", message.kind, message.topic);
        match message.kind.as_str() {
            "sensor_msgs/LaserScan" if self.is_chosen_scan(&message.topic) => {
                let (header, scan) = reader(message)
                    .and_then(|mut fields| laser_scan(&mut fields).map_err(|e| e.to_string()))
                    .map_err(named)?;
                self.take_scan(message, header, scan).map_err(named)
            }
            "sensor_msgs/PointCloud2" if self.is_chosen_scan(&message.topic) => {
                let cloud = reader(message).and_then(|mut fields| point_cloud(&mut fields));
                match cloud {
                    Ok((header, scan)) => self.take_scan(message, header, scan).map_err(named),
                    Err(problem) if self.is_asked_for(&message.topic) => Err(named(problem)),
                    Err(problem) => {
                        self.other_clouds.get_or_insert(named(problem));
                        Ok(())
                    }
                }
            }
            "nav_msgs/Odometry" => self.take_odometry(message).map_err(named),
            "tf2_msgs/TFMessage" | "tf/tfMessage" => {
                let all = reader(message)
                    .and_then(|mut fields| transforms(&mut fields).map_err(|e| e.to_string()))
                    .map_err(named)?;
                for transform in &all {
                    self.take_transform(transform);
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn is_asked_for(&self, topic: &str) -> bool {
        self.options.scan_topic.as_deref() == Some(topic)
            || self.scan_topic.as_deref() == Some(topic)
    }

    fn is_chosen_scan(&self, topic: &str) -> bool {
        let chosen = self
            .options
            .scan_topic
            .as_ref()
            .or(self.scan_topic.as_ref());
        chosen.is_none_or(|chosen| chosen == topic)
    }

    fn take_scan(
        &mut self,
        message: &Recorded,
        header: Header,
        scan: LaserScan,
    ) -> Result<(), String> {
        if scan.ranges_m.is_empty() {
            return Err("a scan has to have ranges, and has none".to_owned());
        }
        scan.validate().map_err(|problem| problem.to_string())?;
        self.scan_topic.get_or_insert_with(|| message.topic.clone());
        self.waiting.push(WaitingScan {
            frame: LogFrame {
                stamp_s: stamp_s(&header, message),
                odometry: None,
                scan,
            },
            sensor: header.frame,
        });
        Ok(())
    }

    fn take_odometry(&mut self, message: &Recorded) -> Result<(), String> {
        let chosen = self.options.odometry_topic.as_ref();
        let chosen = chosen.or(self.odometry_topic.as_ref());
        if chosen.is_some_and(|chosen| *chosen != message.topic) {
            return Ok(());
        }
        let mut fields = reader(message)?;
        let told = odometry(&mut fields).map_err(|problem| problem.to_string())?;
        let pose = checked(planar(&told.pose))?;
        self.odometry_topic
            .get_or_insert_with(|| message.topic.clone());
        if self.by_odometry.is_empty() {
            let child = if told.child.is_empty() {
                "base_link".to_owned()
            } else {
                told.child
            };
            self.wheel_frames = Some((told.header.frame.clone(), child));
        }
        self.by_odometry.push(stamp_s(&told.header, message), pose);
        Ok(())
    }

    fn take_transform(&mut self, told: &TransformMessage) {
        let Ok(pose) = checked(planar(&told.transform)) else {
            return;
        };
        self.transforms.take(told);
        let parent = &told.header.frame;
        let is_odometry = match &self.options.odometry_frame {
            Some(frame) => frame.trim_start_matches('/') == parent,
            None => parent
                .rsplit('/')
                .next()
                .is_some_and(|name| name.contains("odom")),
        };
        // One child: a robot has other frames below its odometry's, such as those of targets.
        let ties = (parent.clone(), told.child.clone());
        if is_odometry && self.wheel_frames.get_or_insert_with(|| ties.clone()) == &ties {
            self.by_transforms.push(told.header.stamp_s, pose);
        }
    }

    /// The oldest scan, once its odometry and its mounting are known, or none of them will come.
    pub fn pop(&mut self) -> Option<LogFrame> {
        let first = self.waiting.first()?;
        let is_over = self.is_done || self.waiting.is_full();
        let stamp_s = first.frame.stamp_s;
        let source = self
            .wheel_source
            .or_else(|| self.choose_wheels(stamp_s, is_over));
        let wheels = source.map(|source| match source {
            WheelSource::Odometry => &self.by_odometry,
            WheelSource::Transforms => &self.by_transforms,
        });
        if !is_over && !wheels.is_some_and(|wheels| wheels.reaches(stamp_s)) {
            return None;
        }
        let odometry = wheels.and_then(|wheels| wheels.at(stamp_s));
        if !is_over && self.mount.is_none() && self.look_for_mount(&first.sensor).is_none() {
            return None;
        }
        if !self.is_done && !wheels.is_some_and(|wheels| wheels.reaches(stamp_s)) {
            self.early += 1;
        }
        self.wheel_source = source;
        let mut scan = self.waiting.pop()?;
        let mount = match self.mount {
            Some(mount) if self.sensor.as_ref() == Some(&scan.sensor) => mount,
            _ => self.settle_mount(&scan.sensor),
        };
        mount.place(&mut scan.frame.scan);
        scan.frame.odometry = odometry;
        Some(scan.frame)
    }

    /// Odometry where it is recorded, transforms else; a choice is for good.
    fn choose_wheels(&self, stamp_s: f64, is_over: bool) -> Option<WheelSource> {
        if self.options.odometry_topic.as_deref() == Some(TRANSFORMS) {
            return Some(WheelSource::Transforms);
        }
        let covers = |wheels: &WheelPoses| wheels.reaches(stamp_s) || is_over && !wheels.is_empty();
        if covers(&self.by_odometry) || self.options.odometry_topic.is_some() {
            Some(WheelSource::Odometry)
        } else if covers(&self.by_transforms) && self.by_odometry.is_empty() {
            Some(WheelSource::Transforms)
        } else {
            None
        }
    }

    /// The frame of the robot's body.
    fn body(&self) -> &str {
        if let Some(body) = &self.options.body_frame {
            return body.trim_start_matches('/');
        }
        self.wheel_frames
            .as_ref()
            .map_or("base_link", |(_, body)| body)
    }

    fn look_for_mount(&self, sensor: &str) -> Option<Result<Mount, String>> {
        let ground = self.wheel_frames.as_ref().map(|(above, _)| above.as_str());
        let chain = self
            .transforms
            .body_from_sensor(self.body(), sensor, ground)?;
        Some(Mount::of(&chain))
    }

    /// The mounting of a sensor whose scans do not wait any longer.
    fn settle_mount(&mut self, sensor: &str) -> Mount {
        let mount = match self.look_for_mount(sensor) {
            Some(Ok(mount)) => mount,
            problem => {
                let why = match problem {
                    Some(Err(problem)) => problem,
                    _ if sensor.is_empty() => "the scans do not name their frame".to_owned(),
                    _ => format!("no transform leads from {} to {sensor}", self.body()),
                };
                self.warning = Some(format!(
                    "{why}; the laser is taken to sit at the body's origin"
                ));
                Mount {
                    body_from_sensor: pr_geom::SE2::identity(),
                    is_upside_down: false,
                }
            }
        };
        self.sensor = Some(sensor.to_owned());
        self.mount = Some(mount);
        mount
    }

    /// Says that no message follows.
    pub fn finish(&mut self) {
        self.is_done = true;
    }

    /// Tells what was met and what was chosen.
    pub fn tell(&self, notes: &mut LogNotes) {
        let counts = self.counts.iter();
        notes.records = counts
            .map(|((topic, kind), &count)| (format!("{topic} {kind}"), count))
            .collect();
        notes.warnings = self.warning.iter().cloned().collect();
        let has_wheels = !self.by_odometry.is_empty() || !self.by_transforms.is_empty();
        if self.early > 0 && has_wheels {
            let scans = match self.early {
                1 => "one scan stands long before the odometry of its time and goes".to_owned(),
                many => format!("{many} scans stand long before the odometry of their time and go"),
            };
            notes
                .warnings
                .push(format!("{scans} without it; sort the recording by time"));
        }
        notes.offers = self.offers();
        notes.about.clear();
        let mut say = |text: String| notes.about.push(text);
        if let (Some(topic), Some(sensor)) = (&self.scan_topic, &self.sensor) {
            let frame = if sensor.is_empty() {
                "without a frame".to_owned()
            } else {
                format!("in frame {sensor}")
            };
            say(format!("scans are those of {topic}, {frame}"));
        }
        if let (Some(topic), Some((above, body))) = (self.wheel_topic(), &self.wheel_frames) {
            say(format!(
                "odometry is that of {topic}, from {above} to {body}"
            ));
        }
        if let Some(mount) = self.mount {
            let [x, y, theta] = mount.body_from_sensor.to_array();
            say(format!(
                "the laser sits at {x:.3} m, {y:.3} m, {:.2}° on {}{}",
                theta.to_degrees(),
                self.body(),
                if mount.is_upside_down {
                    ", upside down"
                } else {
                    ""
                }
            ));
        }
        for (parent, child) in self.transforms.edges().take(100) {
            say(format!("frame {child} hangs on {parent}"));
        }
    }

    /// Where the wheels' poses come from.
    fn wheel_topic(&self) -> Option<&str> {
        match self.wheel_source? {
            WheelSource::Odometry => self.odometry_topic.as_deref(),
            WheelSource::Transforms => Some(TRANSFORMS),
        }
    }

    /// What stands in the recording in place of scans.
    pub fn without_scans(&self) -> String {
        if let Some(problem) = &self.other_clouds {
            return problem.clone();
        }
        let topics = self.counts.keys().take(20);
        let topics = listed(topics.map(|(topic, kind)| format!("{topic} ({kind})")));
        if let Some(topic) = &self.options.scan_topic {
            return format!("{topic} is not one of {topics}");
        }
        if topics.is_empty() {
            return "it has no message".to_owned();
        }
        format!("it has {topics}; record a topic of type sensor_msgs/LaserScan as well")
    }
}

fn reader(message: &Recorded) -> Result<WireReader<'_>, String> {
    WireReader::new(message.wire, &message.bytes).map_err(|problem| problem.to_string())
}

/// The time of measurement; where it was not set, that of the recording.
fn stamp_s(header: &Header, message: &Recorded) -> f64 {
    if header.stamp_s > 0.0 {
        header.stamp_s
    } else {
        message.recorded_s
    }
}
