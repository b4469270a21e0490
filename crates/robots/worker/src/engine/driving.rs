//! A robot that drives while it is mapped. The page holds the connection and tells what comes; requests to the robot and
//! bytes of the recording go back to it.

use std::time::Duration;

use robot_io::live::drive::{Drive, DriveEnd, Heard};
use robot_io::live::network::{
    ConnectError, Host, Lost, NO_ANSWER, OTHER_SUBPROTOCOL, connected_again, connecting_again,
};
use robot_io::live::{RECORDING, WAIT_S, queue};
use robot_io::log::LogOptions;
use robot_io::log_format::LogFormat;
use robot_io::motion::ComparedReader;

use super::{Engine, Work};
use crate::update::DriveReport;

/// Why there is no connection, as far as a browser knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoConnection {
    /// It is not an address.
    Address,
    /// Nobody is there.
    Refused,
    /// Nobody answers in time.
    Silent,
    /// Somebody else answers.
    OtherSubprotocol,
}

/// A robot that drives, or has driven.
pub(super) struct Driving {
    /// `None` once it has ended.
    drive: Option<Drive>,
    /// What came, once it has ended.
    heard: Option<Heard>,
    /// The last bytes of the recording.
    last: Vec<u8>,
    /// Topics that are read.
    reads: Vec<String>,
    said: String,
    /// The last report.
    told: Option<DriveReport>,
}

/// What the network did in a drive.
#[derive(Default)]
pub(super) struct EndOfDrive {
    pub(super) remarks: Vec<String>,
    /// Why there is no scan.
    pub(super) without_scans: Option<String>,
    /// Whether the network ended it.
    pub(super) is_cut: bool,
}

impl Driving {
    /// What came, if it has changed since the last call.
    pub(super) fn report(&mut self, mapped: usize) -> Option<DriveReport> {
        let of_drive = self.drive.as_ref().map(|drive| &drive.heard);
        let heard = of_drive.or(self.heard.as_ref());
        let scans = heard.map_or((0, 0), |heard| (heard.scans, heard.dropped));
        let report = DriveReport {
            reads: self.reads.clone(),
            lasers: heard.map_or_else(Vec::new, |heard| heard.lasers.clone()),
            scans: [scans.0, mapped, scans.1],
            said: self.said.clone(),
            is_driving: self.drive.is_some(),
        };
        let is_new = self.told.as_ref() != Some(&report);
        is_new.then(|| self.told.insert(report).clone())
    }
}

impl<'a> Engine<'a> {
    /// Maps a robot at this address while it drives, by what [`hear_text`](Self::hear_text) and the others are told.
    #[must_use]
    pub fn listen(url: &str, options: &LogOptions) -> Self {
        let (feeder, feed) = queue::stream(false);
        let reader = ComparedReader::chosen(LogFormat::open_live(feed, url, options), options);
        Self {
            driving: Some(Driving {
                drive: Some(Drive::new(feeder, options.scan_topics())),
                heard: None,
                last: Vec::new(),
                reads: Vec::new(),
                said: String::new(),
                told: None,
            }),
            has_scans: true,
            ..Self::with_work(Work::Reading(Box::new(reader)), url, 0)
        }
    }

    /// Whether more may come.
    #[must_use]
    pub fn is_driving(&self) -> bool {
        self.drive().is_some()
    }

    /// The time to wait for the first scan is over: so is the drive, if none has come.
    pub fn end_without_scans(&mut self) {
        if self.drive().is_some_and(|drive| drive.heard.scans == 0) {
            self.end_with(DriveEnd::NoScans);
        }
    }

    /// A text of the robot's server.
    pub fn hear_text(&mut self, text: &str) {
        let Some(driving) = &mut self.driving else {
            return;
        };
        let Some(drive) = &mut driving.drive else {
            return;
        };
        drive.text(text);
        let read = drive.take_read().into_iter();
        driving.reads.extend(read.map(|(name, _)| name));
    }

    /// A binary message of the robot's server.
    pub fn hear_bytes(&mut self, bytes: &[u8]) {
        if let Some(drive) = self.drive_mut() {
            drive.binary(bytes);
        }
    }

    /// There is no first connection.
    pub fn is_not_there(&mut self, why: NoConnection) {
        let url = self.name.clone();
        let problem = match why {
            NoConnection::Address => ConnectError::Address(url),
            NoConnection::Refused => ConnectError::Refused {
                url,
                why: "nobody answers there".to_owned(),
            },
            NoConnection::Silent => ConnectError::Refused {
                url,
                why: NO_ANSWER.to_owned(),
            },
            NoConnection::OtherSubprotocol => ConnectError::Other {
                url,
                found: OTHER_SUBPROTOCOL.to_owned(),
            },
        };
        let problem = problem.to_string();
        self.end_with(DriveEnd::Asked);
        if let Some(driving) = &mut self.driving {
            driving.said.clone_from(&problem);
        }
        self.work = Work::Failed(problem);
    }

    /// The connection is lost, and is tried again.
    pub fn lose(&mut self, lost: &Lost) {
        let said = connecting_again(&self.name, lost, WAIT_S);
        if let Some(driving) = &mut self.driving {
            driving.said = said;
            driving.drive.iter_mut().for_each(Drive::lost);
        }
    }

    /// The connection is there again after this time.
    pub fn regain(&mut self, gap: Duration) {
        let said = connected_again(&self.name);
        if let Some(driving) = &mut self.driving {
            driving.said = said;
            let drive = driving.drive.iter_mut();
            drive.for_each(|drive| drive.heard.gaps.push(gap));
        }
    }

    /// The drive is over; what came is mapped to its end.
    pub fn end_with(&mut self, end: DriveEnd) {
        if let Some(driving) = &mut self.driving
            && let Some(drive) = driving.drive.take()
        {
            let (mut heard, last) = drive.end();
            heard.end = end;
            driving.last = last;
            driving.heard = Some(heard);
            let ended = self.end_of_drive();
            let of_network = ended.remarks.last().filter(|_| ended.is_cut).cloned();
            let said = ended.without_scans.or(of_network);
            if let Some(driving) = &mut self.driving {
                driving.said = said.unwrap_or_default();
            }
        }
    }

    /// Requests to the robot's server since the last call.
    pub fn take_requests(&mut self) -> Vec<String> {
        self.drive_mut().map_or_else(Vec::new, Drive::take_requests)
    }

    /// Bytes of the recording since the last call.
    pub fn take_recorded(&mut self) -> Vec<u8> {
        let Some(driving) = &mut self.driving else {
            return Vec::new();
        };
        match &mut driving.drive {
            Some(drive) => drive.take_recorded(),
            None => core::mem::take(&mut driving.last),
        }
    }

    /// What the network did, once the drive is over.
    pub(super) fn end_of_drive(&self) -> EndOfDrive {
        let driving = self.driving.as_ref();
        let Some(heard) = driving.and_then(|driving| driving.heard.as_ref()) else {
            return EndOfDrive::default();
        };
        EndOfDrive {
            remarks: heard.remarks(&self.name, Some(RECORDING), Host::Page),
            without_scans: heard.without_scans(&self.name, Host::Page),
            is_cut: !matches!(heard.end, DriveEnd::Asked),
        }
    }

    fn drive(&self) -> Option<&Drive> {
        self.driving.as_ref()?.drive.as_ref()
    }

    fn drive_mut(&mut self) -> Option<&mut Drive> {
        self.driving.as_mut()?.drive.as_mut()
    }
}
