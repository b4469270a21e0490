//! The doctor's pass over a log, before it is mapped.

use robot_io::doctor::{Checkup, Diagnosis};
use robot_io::log::{LogOptions, LogReader as _};
use robot_io::motion::ComparedReader;
use robot_io::robots::Robots;

use super::{Engine, Work};
use crate::given::{Given, compared};
use crate::update::Update;

/// A log that the doctor is reading.
pub(super) struct Examination<'a> {
    pub(super) reader: ComparedReader<'a>,
    checkup: Checkup,
    /// The files, which are opened again for mapping.
    given: Given<'a>,
    options: LogOptions,
}

impl<'a> Examination<'a> {
    /// Opens the given files.
    ///
    /// # Errors
    /// If they are not a log; the message is one sentence.
    pub(super) fn begin(given: Given<'a>, options: LogOptions) -> Result<Self, String> {
        Ok(Self {
            reader: compared(&given, &options).map_err(|problem| problem.to_string())?,
            checkup: Checkup::default(),
            given,
            options,
        })
    }
}

impl<'a> Engine<'a> {
    pub(super) fn examine(&mut self, mut examination: Box<Examination<'a>>) {
        let Examination {
            reader, checkup, ..
        } = examination.as_mut();
        match reader.next_frame() {
            Ok(Some(frame)) => {
                checkup.add(&frame);
                self.work = Work::Examining(examination);
                return;
            }
            // An error at the end of the log is reported again when it is mapped.
            Ok(None) => {}
            Err(problem) if checkup.scans() > 0 => checkup.stop(&problem),
            Err(problem) => return self.end_of_log(&examination.reader, Some(problem.to_string())),
        }
        self.send_diagnosis(&examination);
        let Examination {
            reader,
            given,
            options,
            ..
        } = *examination;
        // What the doctor found is true of the first robot.
        let mut motion = reader.motion().cloned();
        let open = move |options: &LogOptions| {
            let again = compared(&given, options)?;
            Ok(match motion.take() {
                Some(motion) => again.with_motion(motion),
                None => again,
            })
        };
        self.work = match Robots::open(open, &options) {
            Ok(robots) => Work::Reading(Box::new(robots)),
            Err(problem) => Work::Failed(problem.to_string()),
        };
    }

    pub(super) fn send_diagnosis(&mut self, examination: &Examination<'_>) {
        let Examination {
            reader, checkup, ..
        } = examination;
        let motion = reader.motion().cloned().unwrap_or_default();
        let diagnosis = checkup.finish(&self.name, reader.notes(), &motion);
        self.keep_diagnosis(diagnosis);
    }

    /// Adds to the diagnosis what the map shows about the recording.
    pub(super) fn diagnose_map(&mut self) {
        let found = self.run.remarks();
        if found.is_empty() {
            return;
        }
        if let Some(mut diagnosis) = self.diagnosis.take() {
            diagnosis.extend(found);
            self.keep_diagnosis(diagnosis);
        }
    }

    fn keep_diagnosis(&mut self, diagnosis: Diagnosis) {
        self.waiting
            .push(Update::Diagnosis(Box::new(diagnosis.clone())));
        self.diagnosis = Some(diagnosis);
    }
}
