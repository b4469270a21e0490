//! The front end: registers each scan on a map of the last few.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};
use pr_geom::SE2;
use serde::{Deserialize, Serialize};

use super::config::SlamConfig;
use super::map_matching::{FrameMotion, MapMatching};
use super::snapshot::FrontEndSnapshot;
use crate::chapter::WindowMatching;
use crate::cloud::PointCloud;
use crate::matching::{MatchSummary, Matcher};
use crate::metrics::position_error_m;
use crate::scan::{MovingSweep, PreparedFrame, is_finite};

/// Smallest time between two stamps that determines a velocity, s.
const MIN_INTERVAL_S: f64 = 1e-6;
/// Largest predicted motion by a velocity, m; beyond any map.
const MAX_MOTION_M: f64 = 1e9;

/// A sweep of the local map.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WindowSweep {
    /// The frame in which it was taken.
    pub frame: usize,
    /// Its estimated pose: `world_from_body`.
    pub pose: SE2,
}

/// Result of registering one scan.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Registration {
    /// Estimate before it, moved by the odometry or by the last velocity: `world_from_body`.
    pub prediction: SE2,
    /// The result, or the prediction if too few pairs were found.
    pub estimate: SE2,
    /// Correspondence threshold τ that was used, m.
    pub tau_m: f64,
    /// τ for the next registration, m, adapted to this one's correction.
    pub next_tau_m: f64,
    /// Whether the result was accepted.
    pub accepted: bool,
    /// Whether the scan joined the window of the next local map.
    pub joined_window: bool,
    /// The registration itself.
    pub matched: MatchSummary,
}

/// Registers scans on the window.
#[derive(Clone)]
enum Registrar {
    /// The chapter's matchers, which start at the prediction.
    Window(Box<WindowMatching>),
    /// For robots: the prediction is part of the cost.
    Map(Box<MapMatching>),
}

/// Local map, threshold and estimate, with the memory of a registration.
///
/// Its memory is bounded: it holds only the scans of its window.
#[derive(Clone)]
pub struct FrontEnd {
    estimate: SE2,
    velocity: Vector3<f64>,
    /// Duration of the last motion, s.
    last_dt_s: f64,
    window: Vec<WindowSweep>,
    scans: Vec<Arc<PointCloud>>,
    registrar: Registrar,
}

impl FrontEnd {
    /// A front end without scans that registers with `matcher`; the one for robots ignores it.
    #[must_use]
    pub fn new(config: &SlamConfig, matcher: Box<dyn Matcher>) -> Self {
        Self {
            estimate: config.start,
            velocity: Vector3::zeros(),
            last_dt_s: f64::INFINITY,
            window: Vec::new(),
            scans: Vec::new(),
            registrar: match config.robot {
                Some(robot) => Registrar::Map(Box::new(MapMatching::new(robot))),
                None => Registrar::Window(Box::new(WindowMatching::new(&config.chapter, matcher))),
            },
        }
    }

    /// The estimated pose, `world_from_body`.
    #[must_use]
    pub fn estimate(&self) -> SE2 {
        self.estimate
    }

    /// Twist of the last motion, in m/s, m/s, rad/s.
    #[must_use]
    pub fn velocity(&self) -> Vector3<f64> {
        self.velocity
    }

    /// Correspondence threshold τ for the next registration, m; 0 for robots, whose threshold is fixed.
    #[must_use]
    pub fn tau_m(&self) -> f64 {
        self.window_matching()
            .map_or(0.0, |matching| matching.threshold.tau_m())
    }

    /// The sweeps of the next local map, oldest first.
    #[must_use]
    pub fn window(&self) -> &[WindowSweep] {
        &self.window
    }

    /// The points of the last local map, world frame.
    #[must_use]
    pub fn local_cloud(&self) -> &PointCloud {
        match &self.registrar {
            Registrar::Window(matching) => &matching.local_cloud,
            Registrar::Map(matching) => matching.cloud(),
        }
    }

    fn window_matching(&self) -> Option<&WindowMatching> {
        match &self.registrar {
            Registrar::Window(matching) => Some(matching),
            Registrar::Map(_) => None,
        }
    }

    /// Its state between two frames.
    pub(crate) fn snapshot(&self) -> FrontEndSnapshot {
        let (deviations_m2, deviations) = self
            .window_matching()
            .map_or((0.0, 0), |matching| matching.threshold.seen());
        FrontEndSnapshot {
            estimate: self.estimate,
            velocity: self.velocity,
            last_dt_s: self.last_dt_s,
            window: self.window.clone(),
            scans: self.scans.clone(),
            deviations_m2,
            deviations,
            motion_covariance: match &self.registrar {
                Registrar::Window(_) => Matrix3::zeros(),
                Registrar::Map(matching) => matching.motion_covariance(),
            },
            unregistered: self
                .window_matching()
                .and_then(|matching| matching.unregistered),
        }
    }

    /// Continues from a snapshot; the local map is rebuilt before it is used.
    pub(crate) fn restore(&mut self, snapshot: &FrontEndSnapshot) {
        self.estimate = snapshot.estimate;
        self.velocity = snapshot.velocity;
        self.last_dt_s = snapshot.last_dt_s;
        self.window.clone_from(&snapshot.window);
        self.scans.clone_from(&snapshot.scans);
        match &mut self.registrar {
            Registrar::Window(matching) => {
                matching.threshold = matching
                    .threshold
                    .having_seen(snapshot.deviations_m2, snapshot.deviations);
                matching.unregistered = snapshot.unregistered;
            }
            Registrar::Map(matching) => matching.restore(&self.scans, snapshot.motion_covariance),
        }
    }

    /// Takes the first scan into the window.
    pub(crate) fn start(&mut self, scan: Arc<PointCloud>) {
        if let Registrar::Map(matching) = &mut self.registrar {
            matching.add_scan(&scan, false);
        }
        self.window.push(WindowSweep {
            frame: 0,
            pose: self.estimate,
        });
        self.scans.push(scan);
    }

    /// Registers the scan of a frame `dt_s` seconds after the last one, deskews it with the velocity that results,
    /// and updates the window.
    pub(crate) fn register(
        &mut self,
        frame: &mut PreparedFrame,
        dt_s: f64,
        number: usize,
        config: &SlamConfig,
    ) -> Registration {
        let before = self.estimate;
        let extrapolated = self.constant_velocity(dt_s, config);
        let motion = frame.odometry.unwrap_or(extrapolated);
        let motion = if is_finite(&(before * motion)) {
            motion
        } else {
            SE2::identity()
        };
        let prediction = before * motion;
        let tau_m = self.tau_m();
        let sweep = frame.sweep.clone();
        let sweep = sweep.as_deref();
        let sweep = sweep.map(|sweep| MovingSweep::new(sweep, before, dt_s.max(MIN_INTERVAL_S)));
        let matched = match &mut self.registrar {
            Registrar::Window(matching) => {
                matching.local_cloud.clear();
                for (sweep, scan) in self.window.iter().zip(&self.scans) {
                    matching.local_cloud.extend_transformed(scan, &sweep.pose);
                }
                matching.matcher.set_target(&matching.local_cloud);
                let found = matching.register(&frame.cloud, &prediction, &config.chapter);
                match &sweep {
                    Some(sweep) => sweep.register(
                        &self.velocity,
                        found,
                        |found| found.pose,
                        |scan| matching.register(scan, &prediction, &config.chapter),
                    ),
                    None => found,
                }
            }
            Registrar::Map(matching) => {
                let moved = FrameMotion {
                    before,
                    motion,
                    extrapolated,
                    sweep,
                };
                matching.register(frame, &moved, &self.window, &self.scans)
            }
        };
        let accepted = matched.inliers >= config.min_inliers && is_finite(&matched.pose);
        self.estimate = if accepted { matched.pose } else { prediction };
        self.last_dt_s = dt_s;
        self.velocity = match &sweep {
            Some(moving) => moving.velocity(&self.estimate),
            None => before.between(&self.estimate).log() / dt_s.max(MIN_INTERVAL_S),
        };
        if let Some(moving) = &sweep {
            frame.cloud = Arc::new(moving.sweep.cloud(&self.velocity));
        }
        if let Registrar::Window(matching) = &mut self.registrar {
            let is_measured = frame.odometry.is_some();
            matching.remember(accepted, &motion, is_measured, &config.chapter);
            matching.threshold.update(&prediction, &self.estimate);
        }
        Registration {
            prediction,
            estimate: self.estimate,
            tau_m,
            next_tau_m: self.tau_m(),
            accepted,
            joined_window: self.join_window(frame, number, config),
            matched,
        }
    }

    /// Information of the estimate for the edge from the last keyframe, whose heading is `source_theta`.
    pub(super) fn information(&mut self, source_theta: f64, config: &SlamConfig) -> Matrix3<f64> {
        match &mut self.registrar {
            Registrar::Map(matching) => matching.take_information(),
            Registrar::Window(matching) => {
                matching.information(&self.estimate, source_theta, &config.chapter)
            }
        }
    }

    /// Moves the estimate and the window by `correction`, applied on the left, after a loop closure.
    pub(super) fn correct(&mut self, correction: &SE2) {
        self.estimate = *correction * self.estimate;
        for sweep in &mut self.window {
            sweep.pose = *correction * sweep.pose;
        }
        if let Registrar::Map(matching) = &mut self.registrar {
            matching.mark_moved();
        }
    }

    /// The motion with the last velocity, for the limited time of extrapolation.
    fn constant_velocity(&self, dt_s: f64, config: &SlamConfig) -> SE2 {
        let stays_s = dt_s.min(config.extrapolation * self.last_dt_s);
        let motion = SE2::exp(&(self.velocity * stays_s));
        // The velocity of a jump may be arbitrary: then it is ignored.
        if position_error_m(&SE2::identity(), &motion) <= MAX_MOTION_M {
            motion
        } else {
            SE2::identity()
        }
    }

    fn join_window(&mut self, frame: &PreparedFrame, number: usize, config: &SlamConfig) -> bool {
        let is_full = self.window.len() >= config.window_sweeps;
        if let Some(newest) = self.window.last()
            && is_full
        {
            let turn = newest.pose.between(&self.estimate).theta().abs();
            if position_error_m(&newest.pose, &self.estimate) < config.window_distance_m
                && turn < config.window_turn_rad
            {
                return false;
            }
            self.window.remove(0);
            self.scans.remove(0);
        }
        if let Registrar::Map(matching) = &mut self.registrar {
            matching.add_scan(&frame.cloud, is_full);
        }
        self.window.push(WindowSweep {
            frame: number,
            pose: self.estimate,
        });
        self.scans.push(Arc::clone(&frame.cloud));
        true
    }
}
