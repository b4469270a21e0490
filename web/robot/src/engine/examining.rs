//! The doctor's pass over a log, which comes before its map.

use robot_io::doctor::Checkup;
use robot_io::log::LogReader as _;
use robot_io::motion::ComparedReader;

use super::{Engine, Work};
use crate::given::{Choices, Given, compared};
use crate::update::Update;

/// A log under the doctor's eyes.
pub(super) struct Examination<'a> {
    pub(super) reader: ComparedReader<'a>,
    checkup: Checkup,
    /// What is opened once more to be mapped.
    given: Given<'a>,
    choices: Choices,
}

impl<'a> Examination<'a> {
    /// Opens what was given.
    ///
    /// # Errors
    /// One sentence if it is no log.
    pub(super) fn begin(given: Given<'a>, choices: Choices) -> Result<Self, String> {
        Ok(Self {
            reader: compared(&given, &choices)?,
            checkup: Checkup::default(),
            given,
            choices,
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
                checkup.take(&frame);
                self.work = Work::Examining(examination);
                return;
            }
            // What the log ends with is told again when it is mapped.
            Ok(None) => {}
            Err(_) if checkup.scans() > 0 => {}
            Err(problem) => return self.end_of_log(&examination.reader, Some(problem.to_string())),
        }
        self.tell_diagnosis(&examination);
        let Examination {
            reader,
            given,
            choices,
            ..
        } = *examination;
        self.work = match compared(&given, &choices) {
            Ok(again) => Work::Reading(Box::new(match reader.motion() {
                Some(motion) => again.knowing(motion.clone()),
                None => again,
            })),
            Err(problem) => Work::Failed(problem),
        };
    }

    pub(super) fn tell_diagnosis(&mut self, examination: &Examination<'_>) {
        let Examination {
            reader, checkup, ..
        } = examination;
        let motion = reader.motion().cloned().unwrap_or_default();
        let diagnosis = checkup.finish(&self.name, reader.notes(), &motion);
        let told = serde_json::to_string(&diagnosis).expect("plain numbers, strings and lists");
        self.waiting.push(Update::text("diagnosis", told));
    }
}
