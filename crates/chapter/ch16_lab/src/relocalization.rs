//! A robot is switched on somewhere on a map of an earlier drive: its path, and its localization, box by box.
//!
//! The start pose is unknown. The robot drives to the nearest visible spot of the course's path and follows
//! it. Each frame goes to the [`Localizer`], whose searches are recorded at some of their steps, so that a
//! figure can show any of them.

use std::sync::Arc;

use ch16_slam2d::localize::{LocalizeReport, Localizer, PendingFix};
use ch16_slam2d::metrics::position_error_m;
use ch16_slam2d::scan::PreparedFrame;
use ch16_slam2d::search::{PoseBox, ScoredPose, SearchCounts};
use pr_geom::{Point2, SE2, order_by};
use pr_sim::World;

use crate::lap::{Drive, DriveConfig};

/// Spacing of the spots along the path, m.
const SPOT_M: f64 = 0.25;
/// Boxes that one step processes.
const BOXES_PER_PIECE: usize = 24;
/// The number of open boxes that are kept for a figure, the best ones.
const BOXES_KEPT: usize = 400;
/// A search is recorded whenever the number of expanded boxes has grown by this factor.
const KEPT_EVERY: f64 = 4.0;

/// The drive of a robot that is switched on at `pose`, `ticks` long: to the nearest visible spot of the path,
/// to the path's end and back. If no spot is visible it stands still.
#[must_use]
pub fn switched_on(yesterday: &DriveConfig, pose: SE2, ticks: usize) -> DriveConfig {
    let start = core::iter::once(yesterday.start.position());
    let corners: Vec<Point2<f64>> = start
        .chain(yesterday.driver.waypoints.iter().copied())
        .collect();
    let here = pose.position();
    let mut nearest: Option<(f64, usize, Point2<f64>)> = None;
    for (leg, ends) in corners.windows(2).enumerate() {
        let along = ends[1] - ends[0];
        let spots = (along.norm() / SPOT_M).ceil() as usize;
        for k in 0..=spots {
            let spot = ends[0] + along * (k as f64 / spots.max(1) as f64);
            let away_m = (spot - here).norm();
            if nearest.is_none_or(|(known_m, ..)| away_m < known_m)
                && sees(&yesterday.world, here, spot)
            {
                nearest = Some((away_m, leg, spot));
            }
        }
    }
    let mut drive = DriveConfig {
        start: pose,
        turn: None,
        max_ticks: ticks,
        ..yesterday.clone()
    };
    match nearest {
        Some((_, leg, spot)) => {
            let on = corners[leg + 1..].iter().copied();
            let back = corners.iter().rev().copied();
            let way = core::iter::once(spot).chain(on).chain(back.skip(1));
            drive.driver.waypoints = way.collect();
        }
        None => drive.max_ticks = 0,
    }
    drive
}

/// Whether no wall is between two points.
fn sees(world: &World, from: Point2<f64>, to: Point2<f64>) -> bool {
    let ray = to - from;
    let away_m = ray.norm();
    let angle_rad = pr_geom::math::atan2(ray.y, ray.x);
    away_m < 1e-6 || world.cast(from, angle_rad, away_m) >= away_m
}

/// One moment of the localization, for a figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// Scans taken before this one.
    pub tick: usize,
    /// The most promising open boxes of the whole-map search.
    pub boxes: Vec<PoseBox>,
    /// The best pose so far, if a search is under way or finished.
    pub best: Option<ScoredPose>,
    /// The best pose so far at another location.
    pub runner_up: Option<ScoredPose>,
    /// The work of the search so far.
    pub counts: Option<SearchCounts>,
    /// The result for the frame; `None` while its search is under way.
    pub report: Option<LocalizeReport>,
}

/// A localization under way: one drive on one map.
pub struct LocalizationRun {
    localizer: Localizer,
    drive: Arc<Drive>,
    pending: Option<PendingFix>,
    /// Expanded boxes of the search under way, and the number at which it is recorded next.
    taken: usize,
    kept_at: usize,
    moments: Vec<Moment>,
    reports: Vec<LocalizeReport>,
}

impl LocalizationRun {
    /// A localization before its first frame.
    #[must_use]
    pub fn new(localizer: Localizer, drive: Arc<Drive>) -> Self {
        Self {
            localizer,
            drive,
            pending: None,
            taken: 0,
            kept_at: 1,
            moments: Vec::new(),
            reports: Vec::new(),
        }
    }

    /// Takes a frame or expands some boxes of its search. Returns false once the drive is over.
    pub fn step(&mut self) -> bool {
        let Some(mut pending) = self.pending.take() else {
            let tick = self.reports.len();
            if tick > self.drive.ticks().len() {
                return false;
            }
            let frame: PreparedFrame = self.drive.prepared(tick);
            let begun = self.localizer.begin(&frame);
            self.pending = Some(begun.expect("a simulated frame is in order"));
            (self.taken, self.kept_at) = (0, 1);
            return true;
        };
        for _ in 0..BOXES_PER_PIECE {
            if !self.localizer.search_step(&mut pending) {
                self.end_frame(&pending);
                return true;
            }
            self.keep(&pending);
        }
        self.pending = Some(pending);
        true
    }

    /// The moments so far.
    #[must_use]
    pub fn moments(&self) -> &[Moment] {
        &self.moments
    }

    /// The results of the frames so far.
    #[must_use]
    pub fn reports(&self) -> &[LocalizeReport] {
        &self.reports
    }

    /// The drive.
    #[must_use]
    pub fn drive(&self) -> &Drive {
        &self.drive
    }

    /// Error of a frame's pose, m; `None` if it has no pose.
    #[must_use]
    pub fn error_m(&self, tick: usize) -> Option<f64> {
        let pose = self.reports.get(tick)?.pose?;
        Some(position_error_m(&pose, &self.drive.truth(tick)))
    }

    /// The first frame whose pose is localized.
    #[must_use]
    pub fn found(&self) -> Option<usize> {
        let mut reports = self.reports.iter();
        reports.position(|report| report.verdict.is_localized())
    }

    fn keep(&mut self, pending: &PendingFix) {
        // Searches of small windows only yield the score to beat.
        let search = pending.search().filter(|search| search.is_at_last());
        let Some(search) = search.and_then(|search| search.under_way()) else {
            return;
        };
        self.taken += 1;
        if self.taken < self.kept_at {
            return;
        }
        self.kept_at = (self.taken as f64 * KEPT_EVERY).ceil() as usize;
        let open: Vec<PoseBox> = search.open_boxes().collect();
        let highest_first = order_by(open.len(), &|at| -open[at].bound).into_iter();
        let boxes = highest_first.take(BOXES_KEPT).map(|at| open[at]).collect();
        let found = search.result();
        self.moments.push(Moment {
            tick: self.reports.len(),
            boxes,
            best: found.map(|found| found.best),
            runner_up: found.and_then(|found| found.runner_up),
            counts: Some(search.counts()),
            report: None,
        });
    }

    fn end_frame(&mut self, pending: &PendingFix) {
        let report = pending.report().clone();
        let search = report.search;
        self.moments.push(Moment {
            tick: self.reports.len(),
            boxes: Vec::new(),
            best: search.map(|found| found.best),
            runner_up: report.runner_up(),
            counts: search.map(|found| found.counts),
            report: Some(report.clone()),
        });
        self.reports.push(report);
    }
}
