//! Updates of the engine: progress, keyframes, loops, and choices for options.

use log_messages::{KeyframeReport, MapperProgress, MapperReport, Offer, Stage};
use robot_io::log::{LogOffer, LogReader};

use super::{Engine, Work, links_of, poses_of};
use crate::links::Link;
use crate::update::Update;

/// Share of the work after the doctor's pass, and after reading; the rest is the last loops.
const EXAMINED_SHARE: f64 = 0.1;
const READING_SHARE: f64 = 0.99;

impl Engine<'_> {
    /// Changes since the last call.
    pub fn updates(&mut self) -> Vec<Update> {
        let mut updates = Vec::new();
        let changes = core::mem::take(&mut self.changes);
        if changes.file {
            updates.push(Update::Report(MapperReport::File {
                name: self.name.clone(),
                has_scans: self.has_scans,
            }));
        }
        updates.push(Update::Report(MapperReport::Progress(self.progress())));
        if changes.keyframes {
            updates.push(Update::Report(self.keyframes_report()));
        }
        if changes.loops {
            updates.push(Update::Report(self.loops_report()));
        }
        if changes.doubts {
            updates.push(Update::Report(MapperReport::Doubts {
                sentences: self.doubts.clone(),
                keyframes: self.look_into.clone(),
            }));
        }
        if changes.grade && !matches!(self.stage(), Stage::Reading | Stage::Failed) {
            let grade = self.grade().map(|grade| match grade {
                Ok(grade) => MapperReport::Grade(grade),
                Err(problem) => MapperReport::Answer(problem),
            });
            updates.extend(grade.map(Update::Report));
        }
        if self.has_scans {
            let scans = self.run.keyframe_frames().len();
            let map = self.picture.report(scans).map(MapperReport::Map);
            updates.extend(map.map(Update::Report));
        }
        if let Some(localization) = &mut self.localization {
            let other = localization.report(poses_of(&self.run));
            updates.extend(other.map(|other| Update::Report(MapperReport::OtherLog(other))));
        }
        let mapped = self.run.scans();
        let drive = self.driving.as_mut();
        let drive = drive.and_then(|driving| driving.report(mapped));
        updates.extend(drive.map(Update::Drive));
        updates.append(&mut self.waiting);
        updates
    }

    fn progress(&self) -> MapperProgress {
        let tried = self.run.loops();
        let (mut share, mut problem) = (1.0, String::new());
        match &self.work {
            Work::Examining(examination) => {
                share = EXAMINED_SHARE * self.share_read(&examination.reader);
            }
            Work::Reading(_) if self.is_driving() => share = f64::NAN,
            Work::Reading(reader) => {
                let rest = READING_SHARE - EXAMINED_SHARE;
                share = EXAMINED_SHARE + rest * self.share_read(reader.as_ref());
            }
            Work::Finishing => share = READING_SHARE,
            Work::Failed(why) => problem.clone_from(why),
            Work::Solving(_) | Work::Checking | Work::Idle => {}
        }
        MapperProgress {
            stage: self.stage(),
            share,
            scans: self.scans_before + self.run.scans(),
            closed: tried.iter().filter(|tried| tried.accepted).count(),
            problem,
        }
    }

    fn share_read(&self, reader: &dyn LogReader) -> f64 {
        let read = reader.notes().bytes as f64 / (self.size_bytes as f64).max(1.0);
        read.min(1.0)
    }

    fn keyframes_report(&self) -> MapperReport {
        let keyframes = self.keyframes();
        let odometry = self.run.odometry_at_keyframes();
        let reports = keyframes.poses().iter().enumerate().map(|(k, keyframe)| {
            let of = |values: &[f64]| values.get(k).copied().unwrap_or(f64::NAN);
            KeyframeReport {
                stamp_s: keyframe.stamp_s,
                pose: keyframe.pose.to_array(),
                odometry: odometry
                    .get(k)
                    .copied()
                    .flatten()
                    .map_or([f64::NAN; 3], |pose| pose.to_array()),
                fit: of(&self.fits),
                sigma_m: of(&self.sigmas_m),
            }
        });
        MapperReport::Keyframes(reports.collect())
    }

    fn loops_report(&self) -> MapperReport {
        let under_way;
        let links = match self.work {
            Work::Examining(_) | Work::Reading(_) | Work::Finishing => {
                under_way = links_of(&self.run);
                &under_way
            }
            _ => &self.links,
        };
        MapperReport::Loops(links.iter().map(Link::report).collect())
    }

    /// Reports the choices for the options of a recording.
    pub(super) fn send_offers(&mut self, offers: &[LogOffer]) {
        let offers = offers.iter().map(|offer| Offer {
            option: offer.option.name().to_owned(),
            taken: offer.taken.clone().unwrap_or_default(),
            names: offer.names.clone(),
        });
        self.send(MapperReport::Offers(offers.collect()));
    }

    /// Sends a report with the next updates.
    pub(super) fn send(&mut self, report: MapperReport) {
        self.waiting.push(Update::Report(report));
    }
}
