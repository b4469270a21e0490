//! A piece: what is mapped on its own after an interruption, until it is found on the map.

use std::sync::Arc;

use pr_geom::SE2;

use crate::localize::{KnownMap, LocalizeConfig, Localizer, StartPose};
use crate::metrics::position_error_m;
use crate::scan::{Frame, FrameError};
use crate::slam::{PiecePose, Slam, SlamConfig, SlamReport};

/// A piece joins after this many consecutive scans that were found at one pose of it.
const FOUND_SCANS: usize = 3;
/// Poses of a piece within this are one, m and rad.
const ONE_POSE: (f64, f64) = (0.4, 0.15);

/// An estimator of its own, and the search for the robot on the map.
#[derive(Clone)]
pub(super) struct Piece {
    pub slam: Slam,
    localizer: Option<Localizer>,
    /// The poses of the piece by the last scans that were found.
    found: Vec<PiecePose>,
}

impl Piece {
    /// A piece without scans after the map of `map`, whose robot starts at `start` on it.
    pub fn new(map: &Slam, start: StartPose) -> Self {
        let config = LocalizeConfig::default();
        let poses = map.graph().poses().to_vec();
        let known = KnownMap::new(map.keyframes().to_vec(), poses, &config);
        let settings = map.config().clone();
        let localizer = known
            .ok()
            .map(|known| Localizer::new(Arc::new(known), settings.clone(), config, start));
        let alone = SlamConfig {
            start: SE2::identity(),
            ..settings
        };
        Self {
            slam: Slam::new(alone),
            localizer,
            found: Vec::new(),
        }
    }

    /// Takes a frame, and searches for it on the map.
    ///
    /// # Errors
    /// If the frame cannot be used; the piece is unchanged.
    pub fn step(&mut self, frame: &Frame) -> Result<SlamReport, FrameError> {
        let report = self.slam.step(frame)?;
        // A loop moves the piece below the poses that were found.
        if report.closed_loop().is_some() {
            self.found.clear();
        }
        let localized = self
            .localizer
            .as_mut()
            .and_then(|localizer| localizer.step(frame).ok())
            .filter(|localized| localized.verdict.is_localized());
        let found = localized.and_then(|localized| {
            Some(PiecePose {
                map_from_piece: localized.pose? * report.estimate.inverse(),
                covariance: localized.covariance?,
            })
        });
        match found {
            Some(found) => {
                let is_one = |other: &PiecePose| {
                    let (one, other) = (
                        found.map_from_piece * report.estimate,
                        other.map_from_piece * report.estimate,
                    );
                    position_error_m(&one, &other) <= ONE_POSE.0
                        && one.between(&other).theta().abs() <= ONE_POSE.1
                };
                if !self.found.iter().all(is_one) {
                    self.found.clear();
                }
                self.found.push(found);
            }
            None => self.found.clear(),
        }
        Ok(report)
    }

    /// Where the piece lies on the map, once enough scans agree; at the end of the log one is enough.
    pub fn pose(&self, is_end: bool) -> Option<PiecePose> {
        let needed = if is_end { 1 } else { FOUND_SCANS };
        self.found
            .last()
            .copied()
            .filter(|_| self.found.len() >= needed)
    }
}
