//! Choices for options in a recording, and requested names that do not exist.

use std::collections::BTreeSet;

use super::TRANSFORMS;
use super::odometry::SelectedOdometry;
use crate::log::{LogOffer, LogOption, LogOptions};
use crate::ros::survey::{ODOMETRY, POSES, SCANS, Survey};
use crate::ros::transforms::is_ground;

/// Most topics or frames listed for an option.
const MAX_OFFERED: usize = 100;

/// Lists the choices for each option, and the one in use.
pub fn list(
    survey: &Survey,
    scans: Option<&str>,
    odometry: Option<&SelectedOdometry<'_>>,
    body: Option<&str>,
) -> Vec<LogOffer> {
    let topics = |kinds: &[&str]| {
        let all = survey.counts.keys();
        let of_kind = all.filter(|(_, kind)| kinds.contains(&kind.as_str()));
        of_kind
            .map(|(topic, _)| topic.clone())
            .collect::<BTreeSet<_>>()
    };
    let frames = || survey.transforms.edges();
    let grounds = frames()
        .map(|(parent, _)| parent)
        .filter(|frame| is_ground(frame));
    let grounds: BTreeSet<String> = grounds.map(str::to_owned).collect();
    let parents = frames().map(|(parent, _)| parent.to_owned());
    let children = frames().map(|(_, child)| child.to_owned());
    let bodies: BTreeSet<String> = children.chain(parents).collect();
    let mut odometry_topics = topics(&[&[ODOMETRY][..], &POSES].concat());
    if !survey.tracks.is_empty() {
        odometry_topics.insert(TRANSFORMS.to_owned());
    }
    let above = odometry.filter(|odometry| odometry.is_transform);
    let offers = [
        (
            LogOption::ScanTopic,
            scans.map(str::to_owned),
            topics(&SCANS),
        ),
        (
            LogOption::OdometryTopic,
            odometry.map(|odometry| odometry.topic.clone()),
            odometry_topics,
        ),
        (
            LogOption::OdometryFrame,
            above.map(|odometry| odometry.track.above.clone()),
            grounds,
        ),
        (LogOption::BodyFrame, body.map(str::to_owned), bodies),
    ];
    let offers = offers.map(|(option, taken, names)| LogOffer {
        option,
        taken,
        names: names.into_iter().take(MAX_OFFERED).collect(),
    });
    offers.to_vec()
}

/// Returns the first option (odometry topic, odometry frame or body frame) whose name does not exist.
pub fn missing(
    survey: &Survey,
    options: &LogOptions,
    offers: &[LogOffer],
    odometry: Option<&SelectedOdometry<'_>>,
) -> Option<(LogOption, String)> {
    let lacks = |option: LogOption, wanted: &Option<String>| {
        let wanted = wanted.as_ref()?;
        let plain = wanted.trim_start_matches('/');
        let offer = offers.iter().find(|offer| offer.option == option)?;
        let is_there = |name: &String| name.trim_start_matches('/') == plain;
        let of_odometry = odometry.map(|odometry| &odometry.track.body);
        let mut bodies = survey
            .odometry
            .values()
            .map(|track| &track.body)
            .chain(of_odometry);
        let is_body = option == LogOption::BodyFrame && bodies.any(is_there);
        (!is_body && !offer.names.iter().any(is_there)).then(|| (option, wanted.clone()))
    };
    lacks(LogOption::OdometryTopic, &options.odometry_topic)
        .or_else(|| lacks(LogOption::OdometryFrame, &options.odometry_frame))
        .or_else(|| lacks(LogOption::BodyFrame, &options.body_frame))
}
