//! Whether a scan continues a run: by the odometry, because it fits where the robot was, or because the map around that
//! pose shows where it moved meanwhile.

use std::collections::VecDeque;
use std::sync::Arc;

use nalgebra::Vector3;
use pr_geom::{SE2, math};

use super::LogFrame;
use crate::cloud::PointCloud;
use crate::local_map::{LocalMap, MapRegistration, MapRegistrationConfig, RangeProfile};
use crate::metrics::position_error_m;
use crate::scan::ScanPreparer;
use crate::search::SearchWindow;
use crate::slam::Slam;

/// After a longer time, odometry near zero may have started again, s.
const GAP_S: f64 = 10.0;
/// A time between two scans of at most this many usual ones is no gap.
const USUAL: f64 = 2.0;
/// The last times between scans: one of ten may be longer than the usual one, because drivers drop scans and stamps jitter.
const RECENT: usize = 31;
/// Odometry is not followed, and a robot need not stand where it stood, over a longer time, s.
const LONG_GAP_S: f64 = 120.0;
/// Odometry within this of zero may have started again, m and rad.
const ZERO: (f64, f64) = (0.5, 0.3);
/// Odometry that moved by more measured a motion during the gap, m and rad.
const MOVED: (f64, f64) = (0.3, 0.2);
/// Fastest plausible motion, m/s.
const MAX_SPEED: f64 = 3.0;
/// Keyframes for the test: their largest distance, m, and their number.
const NEAR: (f64, usize) = (4.0, 12);
/// A scan with at least this score fits, 0 to 1.
const FITS: f64 = 0.7;
/// Largest share of points in observed free space of a scan that fits.
const MAX_CONTRADICTING: f64 = 0.05;
/// Largest correction of a scan that fits, m and rad.
const SHIFT: (f64, f64) = (0.5, 0.35);
/// Scores of a search within this of the best one are compared by their registrations, 0 to 1.
const MARGIN: f64 = 0.2;
/// Costs that differ by more than this, nats, decide between two poses: odds of 20 to 1.
const SURE: f64 = 3.0;

/// How a scan follows the last one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Continuity {
    /// By the motion that odometry, or else constant velocity, predicts.
    Predicted,
    /// By this motion, by which it was found on the map around the last pose.
    Found(SE2),
    /// The scan fits within the robot's reach, at this pose or at others beside it.
    Roughly(RoughPose),
    /// Nothing explains how the robot came there.
    Interrupted,
}

/// A pose among others that fit as well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RoughPose {
    /// `map_from_body`.
    pub pose: SE2,
    /// Standard deviations: as far as the others are, m and rad.
    pub sigmas: (f64, f64),
}

/// The recording's own pace: what is usual between two scans, and how fast the robot has been.
#[derive(Clone, Debug, Default)]
pub(super) struct Pace {
    recent_s: VecDeque<f64>,
    /// Scores of the last scans on the map, 0 to 1.
    scores: VecDeque<f64>,
    /// Fastest motion between two scans, m/s and rad/s.
    fastest: (f64, f64),
}

impl Pace {
    /// Takes the time between two scans, s, the motion if the scan continued the run, and its score on the map.
    pub fn add(&mut self, gap_s: f64, motion: Option<SE2>, score: Option<f64>) {
        self.scores.extend(score);
        if self.scores.len() > RECENT {
            self.scores.pop_front();
        }
        if let Some(motion) = motion.filter(|_| !self.is_gap(gap_s)) {
            let speed = math::norm2(motion.x(), motion.y()) / gap_s;
            self.fastest.0 = math::max(self.fastest.0, speed);
            self.fastest.1 = math::max(self.fastest.1, motion.theta().abs() / gap_s);
        }
        self.recent_s.push_back(gap_s);
        if self.recent_s.len() > RECENT {
            self.recent_s.pop_front();
        }
    }

    /// The worst score of the last scans; 1 before the first one.
    fn worst_score(&self) -> f64 {
        self.scores.iter().copied().fold(1.0, math::min)
    }

    /// Whether scans are missing in a time between two of them.
    fn is_gap(&self, gap_s: f64) -> bool {
        let mut recent_s: Vec<f64> = self.recent_s.iter().copied().collect();
        pr_geom::sort_numbers(&mut recent_s);
        let usual_s = recent_s.get(recent_s.len() * 9 / 10);
        usual_s.is_some_and(|usual_s| gap_s > USUAL * usual_s)
    }

    /// How far the robot may have come in that time, m and rad.
    fn reach(&self, gap_s: f64) -> (f64, f64) {
        let turn_rad = math::min(self.fastest.1 * gap_s, core::f64::consts::PI);
        (self.fastest.0 * gap_s, turn_rad)
    }
}

/// What the odometry says of the time between two scans.
enum Odometry {
    /// It moved by this, and did not start again.
    Moved,
    /// It stood still, and did not start again.
    Still,
    /// There is none, it may have started again, or its motion is not plausible.
    Unknown,
}

impl Odometry {
    fn between(last: Option<SE2>, now: Option<SE2>, gap_s: f64) -> Self {
        let (Some(last), Some(now)) = (last, now) else {
            return Self::Unknown;
        };
        let is_within = |pose: &SE2, (m, rad): (f64, f64)| {
            math::norm2(pose.x(), pose.y()) <= m && pose.theta().abs() <= rad
        };
        let motion = last.between(&now);
        let may_be_new = gap_s > GAP_S && is_within(&now, ZERO);
        if may_be_new || position_error_m(&last, &now) > MAX_SPEED * gap_s {
            return Self::Unknown;
        }
        if is_within(&motion, MOVED) {
            Self::Still
        } else {
            Self::Moved
        }
    }
}

/// How a valid scan, `gap_s` seconds after the last one, continues the run.
///
/// After a gap without explanation the robot may have been carried, or it may be another day.
pub(super) fn continuity(
    slam: &Slam,
    last_odometry: Option<SE2>,
    recorded: &LogFrame,
    gap_s: f64,
    pace: &Pace,
) -> Continuity {
    let is_short = gap_s <= GAP_S;
    if is_short && !pace.is_gap(gap_s) {
        return Continuity::Predicted;
    }
    let odometry = Odometry::between(last_odometry, recorded.odometry, gap_s);
    let is_long = gap_s > LONG_GAP_S;
    let settings = slam.config().local_map.unwrap_or_default().registration();
    let reach = pace.reach(gap_s);
    match odometry {
        Odometry::Moved if !is_long => return Continuity::Predicted,
        Odometry::Unknown if is_long => return Continuity::Interrupted,
        // The registration of each scan searches as far.
        Odometry::Unknown
            if is_short && reach.0 <= settings.search_m && reach.1 <= settings.search_rad =>
        {
            return Continuity::Predicted;
        }
        _ => {}
    }
    let last = slam.front_end().estimate();
    let motion = match (&odometry, last_odometry, recorded.odometry) {
        (Odometry::Moved, Some(last), Some(now)) => last.between(&now),
        _ => SE2::identity(),
    };
    // The motion during the gap does not skew the sweep.
    let cloud = ScanPreparer::new().prepare(&recorded.scan, &Vector3::zeros(), &slam.config().scan);
    let mut around = Around::new(slam, &cloud, settings);
    if is_short {
        around.worst_score = pace.worst_score();
    }
    if !(is_short && matches!(odometry, Odometry::Unknown)) && around.fits(last * motion) {
        return Continuity::Predicted;
    }
    // The last message of wheels that seem to stand may be as old as the gap.
    match is_short.then(|| around.found(last, reach)).flatten() {
        Some((pose, None)) => Continuity::Found(last.between(&pose)),
        Some((pose, Some(rival))) => roughly(pose, rival),
        None => Continuity::Interrupted,
    }
}

/// A scan, and the map around a pose.
struct Around<'a> {
    slam: &'a Slam,
    scan: &'a PointCloud,
    settings: MapRegistrationConfig,
    map: LocalMap,
    /// A scan whose score is not surely lower fits.
    worst_score: f64,
}

impl<'a> Around<'a> {
    fn new(slam: &'a Slam, scan: &'a PointCloud, settings: MapRegistrationConfig) -> Self {
        Self {
            slam,
            scan,
            settings,
            map: LocalMap::default(),
            worst_score: 1.0,
        }
    }

    /// Builds the map of the keyframes within this distance of a pose, at most so many.
    fn build(&mut self, pose: SE2, (near_m, most): (f64, usize)) {
        let poses = self.slam.graph().poses();
        let mut near: Vec<(f64, usize)> = poses
            .iter()
            .zip(0..)
            .map(|(at, node)| (position_error_m(at, &pose), node))
            .filter(|(away_m, _)| *away_m <= near_m)
            .collect();
        pr_geom::sort_ranked(&mut near);
        near.truncate(most);
        let keyframes = self.slam.keyframes();
        let scans = near.iter().map(|&(_, node)| &keyframes[node].scan);
        let profiles: Vec<Arc<RangeProfile>> = scans
            .map(|scan| Arc::new(RangeProfile::new(scan)))
            .collect();
        self.map.rebuild(
            near.iter()
                .zip(&profiles)
                .map(|(&(_, node), profile)| (poses[node], &*keyframes[node].scan, profile)),
        );
    }

    /// The scan registered from a pose near the right one.
    fn registered(&mut self, start: SE2) -> MapRegistration {
        let stages = [self.settings.inlier_distance_m];
        self.map
            .register(self.scan, start, &stages, None, &self.settings)
    }

    /// How badly the scan fits where it was registered, nats.
    fn cost(&self, found: &MapRegistration) -> f64 {
        self.settings.misfit_cost(self.scan, found.fit.score)
    }

    /// Whether a scan fits: well, or as well as those before it, which may be of a place full of people.
    fn is_good(&self, found: &MapRegistration) -> bool {
        let cost = |score: f64| self.settings.misfit_cost(self.scan, score);
        if cost(found.fit.score) <= cost(self.worst_score) + SURE {
            return true;
        }
        let most = MAX_CONTRADICTING * self.scan.len() as f64;
        found.fit.score >= FITS && found.fit.contradicting as f64 <= most
    }

    /// Whether the scan fits on the keyframes around a pose, there.
    fn fits(&mut self, pose: SE2) -> bool {
        self.build(pose, NEAR);
        let stages = [
            self.settings.max_correspondence_m,
            self.settings.inlier_distance_m,
        ];
        let found = self
            .map
            .register(self.scan, pose, &stages, None, &self.settings);
        let shift = pose.between(&found.registered.pose);
        math::norm2(shift.x(), shift.y()) <= SHIFT.0
            && shift.theta().abs() <= SHIFT.1
            && self.is_good(&found)
    }

    /// The pose at which the scan fits on the keyframes within a reach (m, rad) of a pose, and another one at which it fits
    /// as well; `None` if it fits nowhere.
    fn found(&mut self, pose: SE2, reach: (f64, f64)) -> Option<(SE2, Option<SE2>)> {
        self.build(pose, (NEAR.0 + reach.0, usize::MAX));
        let window = SearchWindow::around(pose, reach.0, reach.1);
        let searched = self.map.search(self.scan, &window, MARGIN)?;
        let best = self.registered(searched.best.pose);
        let rival = searched.runner_up;
        let rival = rival.map(|rival| self.registered(rival.pose));
        let is_elsewhere = |rival: &MapRegistration| {
            let apart = best.registered.pose.between(&rival.registered.pose);
            math::norm2(apart.x(), apart.y()) > SHIFT.0 || apart.theta().abs() > SHIFT.1
        };
        let (best, rival) = match rival.filter(is_elsewhere) {
            Some(rival) if self.cost(&rival) < self.cost(&best) => (rival, Some(best)),
            rival => (best, rival),
        };
        if !self.is_good(&best) {
            return None;
        }
        let most = self.cost(&best) + sure_nats(reach);
        let best = best.registered.pose;
        let Some(rival) = rival.filter(|rival| self.cost(rival) <= most) else {
            return Some((best, None));
        };
        let turned = self.turned(pose, reach, best, most);
        Some((best, turned.or(Some(rival.registered.pose))))
    }

    /// A pose with another heading than the best one, within the reach, at which the scan costs at most so much, nats.
    fn turned(&mut self, pose: SE2, reach: (f64, f64), best: SE2, most: f64) -> Option<SE2> {
        let turn_rad = pose.between(&best).theta();
        let sides = [
            (-reach.1, turn_rad - SHIFT.1),
            (turn_rad + SHIFT.1, reach.1),
        ];
        for (from_rad, to_rad) in sides.into_iter().filter(|(from, to)| from < to) {
            let middle = pose * SE2::new(0.0, 0.0, 0.5 * (from_rad + to_rad));
            let window = SearchWindow::around(middle, reach.0, 0.5 * (to_rad - from_rad));
            let searched = self.map.search(self.scan, &window, MARGIN);
            let starts = searched.map(|found| [Some(found.best), found.runner_up]);
            for start in starts.into_iter().flatten().flatten() {
                let found = self.registered(start.pose);
                let turned = found.registered.pose;
                if best.between(&turned).theta().abs() > SHIFT.1 && self.cost(&found) <= most {
                    return Some(turned);
                }
            }
        }
        None
    }
}

/// A scan that fits at two poses: loops search positions around either, but not other headings.
fn roughly(pose: SE2, rival: SE2) -> Continuity {
    let apart = pose.between(&rival);
    if apart.theta().abs() > SHIFT.1 {
        return Continuity::Interrupted;
    }
    Continuity::Roughly(RoughPose {
        pose,
        sigmas: (
            math::max(math::norm2(apart.x(), apart.y()), SHIFT.0),
            SHIFT.1,
        ),
    })
}

/// Costs that differ by more than this, nats, decide between the poses within a reach (m, rad): the more of them are
/// compared, the sooner a wrong one fits better by chance.
fn sure_nats((reach_m, reach_rad): (f64, f64)) -> f64 {
    let across = math::max(reach_m / SHIFT.0, 1.0);
    let distinct = across * across * math::max(reach_rad / SHIFT.1, 1.0);
    SURE + math::ln(distinct)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline::Pipeline;
    use crate::slam::test_room::{frame, truth};

    /// Scan `step` of the room at this time, with odometry or without.
    fn recorded(step: usize, stamp_s: f64, odometry: Option<SE2>) -> LogFrame {
        LogFrame {
            stamp_s,
            odometry,
            scan: frame(step).scan,
        }
    }

    /// The pieces and the bridged gaps after a gap between two of the first scans and another one of the room.
    fn after_gap(to: usize, gap_s: f64, wheels: impl Fn(usize) -> Option<SE2>) -> (usize, usize) {
        let mut pipeline = Pipeline::default();
        for step in 0..20 {
            let stamp_s = 0.1 * step as f64;
            pipeline
                .step(&recorded(step, stamp_s, wheels(step)))
                .unwrap();
        }
        pipeline
            .step(&recorded(to, 1.9 + gap_s, wheels(19)))
            .unwrap();
        (pipeline.pieces().len(), pipeline.bridged().len())
    }

    #[test]
    fn a_robot_whose_wheels_stand_continues_only_where_it_stands() {
        let wheels = |step: usize| Some(truth(0).between(&truth(step)));
        assert_eq!(after_gap(19, 3.0, wheels), (0, 0));
        // The far side of the room.
        assert_eq!(after_gap(45, 3.0, wheels), (1, 0));
    }

    /// A radio that fails for a second holds back the odometry's messages as well as the scans.
    #[test]
    fn a_robot_that_moved_during_a_gap_is_searched_for_although_its_wheels_seem_to_stand() {
        let wheels = |step: usize| Some(truth(0).between(&truth(step)));
        assert_eq!(after_gap(26, 3.0, wheels), (0, 1));
    }

    #[test]
    fn the_wider_the_search_the_more_evidence_it_takes() {
        // 1e-12: rounding.
        assert!((sure_nats(SHIFT) - SURE).abs() < 1e-12);
        // After a turn in mit-csail, driven backwards, a wrong pose fits 3.26 nats better than its rival, and the right
        // ones 18 and more.
        let sure = sure_nats((1.386, 2.007));
        assert!(3.26 < sure && sure < 18.0, "{sure}");
    }

    #[test]
    fn a_scan_that_fits_beside_continues_roughly_and_one_that_fits_turned_does_not() {
        let pose = SE2::new(2.0, 1.0, 0.5);
        let Continuity::Roughly(rough) = roughly(pose, pose * SE2::new(0.6, 0.8, 0.1)) else {
            panic!("it is interrupted");
        };
        // 1e-12: rounding.
        assert!(rough.pose == pose && (rough.sigmas.0 - 1.0).abs() < 1e-12);
        let turned = roughly(pose, pose * SE2::new(0.6, 0.8, 3.0));
        assert_eq!(turned, Continuity::Interrupted);
    }

    #[test]
    fn a_map_continues_at_a_rough_pose_with_its_uncertainty() {
        let mut pipeline = Pipeline::default();
        let wheels = |step: usize| Some(truth(0).between(&truth(step)));
        for step in 0..20 {
            let stamp_s = 0.1 * step as f64;
            pipeline
                .step(&recorded(step, stamp_s, wheels(step)))
                .unwrap();
        }
        let keyframes = pipeline.map_keyframes();
        let rough = RoughPose {
            pose: truth(0).between(&truth(26)),
            sigmas: (1.0, 0.35),
        };
        let found = pipeline.step_roughly(&frame(26), &rough).unwrap().unwrap();
        assert_eq!(found.new_keyframe, Some(keyframes));
        let slam = pipeline.slam_mut().unwrap();
        // 1e-9: the new edges agree with the pose.
        assert!(position_error_m(&slam.graph().pose(keyframes), &rough.pose) < 1e-9);
        let relative = slam
            .graph_mut()
            .relative_covariance(keyframes - 1, keyframes);
        let sigma_m = relative.unwrap().m11.sqrt();
        // 5 m along the path bounds it as well, and the map's own errors add a little.
        assert!((0.9..1.2).contains(&sigma_m), "{sigma_m}");
    }

    #[test]
    fn without_wheels_a_robot_is_searched_for_as_far_as_it_may_have_come() {
        let (stands, moved) = (after_gap(19, 3.0, |_| None), after_gap(26, 3.0, |_| None));
        assert_eq!((stands, moved), ((0, 1), (0, 1)));
    }

    #[test]
    fn an_even_pace_has_no_gaps_however_slow_it_is() {
        for period_s in [0.05, 2.0, 8.0] {
            let mut pace = Pace::default();
            for _ in 0..5 {
                pace.add(period_s, Some(SE2::from_xy(0.5 * period_s, 0.0)), Some(0.9));
            }
            assert!(!pace.is_gap(1.5 * period_s) && pace.is_gap(2.5 * period_s));
            let (reach_m, _) = pace.reach(4.0);
            // 1e-12: rounding.
            assert!((reach_m - 2.0).abs() < 1e-12);
        }
    }
}
