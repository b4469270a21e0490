//! The robots of a recording: lasers that no transform connects may be on different ones.

use super::{MIN_SHARE, PlannedScans};
use crate::log::LogOptions;
use crate::ros::survey::{POINT_CLOUD, SCANS, ScanStream, Survey};

/// The topics of the lasers of each robot whose scans are not read, separated by commas; none if the user chose topics.
pub fn others(survey: &Survey, options: &LogOptions, read: &[PlannedScans]) -> Vec<String> {
    if options.scan_topic.is_some() {
        return Vec::new();
    }
    let root = |stream: &ScanStream| {
        let root = survey.transforms.root_of(&stream.frame, None);
        root.unwrap_or(&stream.frame).to_owned()
    };
    let read = read
        .iter()
        .filter_map(|scans| survey.scans.get(&scans.topic));
    let known: Vec<String> = read.map(root).collect();
    let lasers = survey
        .scans
        .iter()
        .filter(|(_, stream)| stream.is_usable && SCANS[stream.kind] != POINT_CLOUD);
    let mut lasers: Vec<_> = lasers.collect();
    lasers.sort_by_key(|(_, stream)| stream.order);
    let most = lasers.iter().map(|(_, stream)| stream.stamps_s.len()).max();
    let least = MIN_SHARE * most.unwrap_or_default() as f64;
    let mut robots: Vec<(String, Vec<&ScanStream>, String)> = Vec::new();
    for (topic, stream) in lasers {
        let root = root(stream);
        if (stream.stamps_s.len() as f64) < least || known.contains(&root) {
            continue;
        }
        match robots.iter_mut().find(|(other, ..)| *other == root) {
            // A filtered copy of a laser has its frame.
            Some((_, streams, _)) if streams.iter().any(|other| other.frame == stream.frame) => {}
            Some((_, streams, topics)) => {
                streams.push(stream);
                topics.push(',');
                topics.push_str(topic);
            }
            None => robots.push((root, vec![stream], topic.clone())),
        }
    }
    robots.into_iter().map(|(_, _, topics)| topics).collect()
}
