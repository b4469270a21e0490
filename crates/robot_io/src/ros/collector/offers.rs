//! What options could choose in a recording, and what they ask for in vain.

use std::collections::BTreeSet;

use super::{Collector, TRANSFORMS, WheelSource};
use crate::lines::listed;
use crate::log::{LogOffer, LogOption};

/// So many topics or frames are offered for an option.
const MOST_OFFERED: usize = 100;

impl Collector {
    /// What an option could choose.
    pub(super) fn offers(&self) -> Vec<LogOffer> {
        let topics = |kinds: &[&str]| {
            let all = self.counts.keys();
            let of_kind = all.filter(|(_, kind)| kinds.contains(&kind.as_str()));
            of_kind
                .map(|(topic, _)| topic.clone())
                .collect::<BTreeSet<_>>()
        };
        let frames = || self.transforms.edges();
        let parents: BTreeSet<String> = frames().map(|(parent, _)| parent.to_owned()).collect();
        let children = frames().map(|(_, child)| child.to_owned());
        let bodies: BTreeSet<String> = children.chain(parents.iter().cloned()).collect();
        let mut wheels = topics(&["nav_msgs/Odometry"]);
        if !self.by_transforms.is_empty() {
            wheels.insert(TRANSFORMS.to_owned());
        }
        let above = match self.wheel_source {
            Some(WheelSource::Transforms) => self.wheel_frames.as_ref(),
            _ => None,
        };
        LogOption::ALL
            .map(|option| {
                let (taken, names) = match option {
                    LogOption::ScanTopic => (
                        self.scan_topic.clone(),
                        topics(&["sensor_msgs/LaserScan", "sensor_msgs/PointCloud2"]),
                    ),
                    LogOption::OdometryTopic => {
                        (self.wheel_topic().map(str::to_owned), wheels.clone())
                    }
                    LogOption::OdometryFrame => {
                        (above.map(|(above, _)| above.clone()), parents.clone())
                    }
                    LogOption::BodyFrame => (Some(self.body().to_owned()), bodies.clone()),
                };
                LogOffer {
                    option,
                    taken,
                    names: names.into_iter().take(MOST_OFFERED).collect(),
                }
            })
            .to_vec()
    }

    /// An option that asks for what was not met: the wheels' topic or frame, or the body's frame.
    pub fn missing(&self) -> Option<(LogOption, String)> {
        let options = &self.options;
        let offers = self.offers();
        let lacks = |option: LogOption, wanted: &Option<String>| {
            let wanted = wanted.as_ref()?;
            let plain = wanted.trim_start_matches('/');
            let offer = offers.iter().find(|offer| offer.option == option)?;
            let is_there = |name: &String| name.trim_start_matches('/') == plain;
            let is_wheels = option == LogOption::BodyFrame
                && self
                    .wheel_frames
                    .as_ref()
                    .is_some_and(|(_, body)| is_there(body));
            (!is_wheels && !offer.names.iter().any(is_there)).then(|| (option, wanted.clone()))
        };
        lacks(LogOption::OdometryTopic, &options.odometry_topic)
            .or_else(|| lacks(LogOption::OdometryFrame, &options.odometry_frame))
            .or_else(|| lacks(LogOption::BodyFrame, &options.body_frame))
    }

    /// What there is in place of what an option asks for.
    pub fn instead_of(&self, option: LogOption) -> String {
        let offers = self.offers();
        let offer = offers.iter().find(|offer| offer.option == option);
        let names = offer.map_or(&[][..], |offer| &offer.names);
        if names.is_empty() {
            "it has none, so leave the option out".to_owned()
        } else {
            format!("it has {}", listed(names.iter().take(20).cloned()))
        }
    }
}
