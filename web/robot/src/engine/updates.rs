//! Updates of the engine: progress, keyframes, loops, and choices for options.

use robot_io::log::{LogOffer, LogReader};

use super::{Engine, Work, links_of, poses_of};
use crate::links::Link;
use crate::update::{Stage, Update};

/// Share of the work after the doctor's pass, and after reading; the rest is the last loops.
const EXAMINED_SHARE: f64 = 0.1;
const READING_SHARE: f64 = 0.99;

impl Engine<'_> {
    /// Changes since the last call.
    pub fn updates(&mut self) -> Vec<Update> {
        let mut updates = Vec::new();
        let changes = core::mem::take(&mut self.changes);
        if changes.file {
            let mut file = Update::text("file", self.name.clone());
            let has_scans = f64::from(u8::from(self.has_scans));
            file.numbers = vec![self.size_bytes as f64, has_scans];
            updates.push(file);
        }
        updates.push(self.stage_update());
        if changes.keyframes {
            updates.push(self.keyframes_update());
        }
        if changes.loops {
            updates.push(self.loops_update());
        }
        if changes.doubts {
            let mut doubts = Update::text("doubts", self.doubts.join("\n"));
            doubts.numbers = self.look_into.iter().map(|&k| k as f64).collect();
            updates.push(doubts);
        }
        if changes.grade && !matches!(self.stage(), Stage::Reading | Stage::Failed) {
            updates.extend(self.grade_updates());
        }
        if self.has_scans {
            let scans = self.recorder.keyframes().len();
            updates.extend(self.picture.update(scans));
        }
        if let Some(localization) = &mut self.localization {
            updates.extend(localization.update(poses_of(&self.run)));
        }
        updates.append(&mut self.waiting);
        updates
    }

    fn stage_update(&self) -> Update {
        let tried = self.run.loops();
        let (mut share, mut words) = (1.0, String::new());
        match &self.work {
            Work::Examining(examination) => {
                share = EXAMINED_SHARE * self.share_read(&examination.reader);
            }
            Work::Reading(reader) => {
                let rest = READING_SHARE - EXAMINED_SHARE;
                share = EXAMINED_SHARE + rest * self.share_read(reader.as_ref());
            }
            Work::Finishing => share = READING_SHARE,
            Work::Failed(problem) => words.clone_from(problem),
            Work::Solving(_) | Work::Checking | Work::Idle => {}
        }
        Update {
            text: words,
            ..Update::numbers(
                "stage",
                vec![
                    f64::from(self.stage() as u8),
                    share,
                    (self.scans_before + self.run.scans()) as f64,
                    tried.len() as f64,
                    tried.iter().filter(|tried| tried.accepted).count() as f64,
                ],
            )
        }
    }

    fn share_read(&self, reader: &dyn LogReader) -> f64 {
        let read = reader.notes().bytes as f64 / (self.size_bytes as f64).max(1.0);
        read.min(1.0)
    }

    fn keyframes_update(&self) -> Update {
        let keyframes = self.keyframes();
        let mut numbers = Vec::with_capacity(6 * keyframes.poses().len());
        for (k, keyframe) in keyframes.poses().iter().enumerate() {
            let of = |values: &[f64]| values.get(k).copied().unwrap_or(f64::NAN);
            let [x, y, theta] = keyframe.pose.to_array();
            let sigma_m = of(&self.sigmas_m);
            numbers.extend([keyframe.stamp_s, x, y, theta, of(&self.fits), sigma_m]);
        }
        Update::numbers("keyframes", numbers)
    }

    fn loops_update(&self) -> Update {
        let under_way;
        let links = match self.work {
            Work::Examining(_) | Work::Reading(_) | Work::Finishing => {
                under_way = links_of(&self.run);
                &under_way
            }
            _ => &self.links,
        };
        let reasons: Vec<&str> = links.iter().map(|link| link.reason.as_str()).collect();
        Update {
            text: reasons.join("\n"),
            ..Update::numbers("loops", links.iter().flat_map(Link::numbers).collect())
        }
    }

    /// Reports the choices for the options of a recording.
    pub(super) fn send_offers(&mut self, offers: &[LogOffer]) {
        let lines = offers.iter().map(|offer| {
            let taken = offer.taken.as_deref().unwrap_or_default();
            let names = offer.names.iter().map(String::as_str);
            let words: Vec<&str> = [offer.option.name(), taken]
                .into_iter()
                .chain(names)
                .collect();
            words.join("\t")
        });
        let lines: Vec<String> = lines.collect();
        self.waiting.push(Update::text("offers", lines.join("\n")));
    }
}
