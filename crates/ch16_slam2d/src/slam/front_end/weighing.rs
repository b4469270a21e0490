//! A registration against what was predicted, and what is believed where they contradict each other.

use nalgebra::{Matrix3, Vector3};
use pr_geom::{SE2, math};

use super::FrontEnd;
use crate::matching::{MatchRequest, MatchSummary, without_aperture};
use crate::scan::PreparedFrame;
use crate::slam::config::{ContradictionConfig, SlamConfig};
use crate::slam::fusion::fuse;

impl ContradictionConfig {
    /// Covariance of wheels that jump, 3×3, translation first.
    fn jump(&self) -> Matrix3<f64> {
        let deviations = Vector3::new(self.jump_m, self.jump_m, self.jump_rad);
        Matrix3::from_diagonal(&deviations.map(|sigma| sigma * sigma))
    }
}

/// What the wheels tell of a scan's place.
pub(super) struct Driven {
    /// Where they lead to.
    pub prediction: SE2,
    /// The motion up to there.
    pub motion: SE2,
    /// Where the robot would be had it gone on as before, if the wheels say something quite different.
    pub going_on: Option<SE2>,
}

/// Wheels that lead so far from where the robot would be had it gone on lead beyond what a registration finds: m and rad.
const JUMP: (f64, f64) = (1.0, 0.8);

/// A place that needs a jump of the wheels costs as much as so many standard deviations.
const JUMP_DEVIATIONS: f64 = 2.0;

impl Driven {
    /// What the wheels tell by a motion from the pose before, where `going_on` would be the motion without them.
    pub fn new(before: &SE2, motion: SE2, going_on: &SE2, frame: &PreparedFrame) -> Self {
        let away = going_on.between(&motion);
        let is_jump = math::norm2(away.x(), away.y()) > JUMP.0 || away.theta().abs() > JUMP.1;
        Self {
            prediction: *before * motion,
            motion,
            going_on: (is_jump && frame.odometry.is_some()).then(|| *before * *going_on),
        }
    }
}

/// What leads to a place.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Lead {
    /// The wheels.
    Wheels,
    /// The motion before, had the wheels not jumped.
    GoingOn,
}

impl Lead {
    /// Standard deviations that a place costs in any case.
    fn deviations(self) -> f64 {
        match self {
            Self::Wheels => 0.0,
            Self::GoingOn => JUMP_DEVIATIONS,
        }
    }
}

/// Where a scan may have been taken, and by what it is judged.
struct Start {
    lead: Lead,
    /// Where its registration begins; none where it is known.
    from: Option<SE2>,
    /// The place that it should be near to.
    expected: SE2,
}

/// A place that a scan may have been taken from.
struct Place {
    lead: Lead,
    pose: SE2,
    /// The place that it should be near to.
    expected: SE2,
    /// Share of the scan that fits.
    share: f64,
    /// Its share, less what it costs that the wheels have jumped there.
    worth: f64,
}

impl FrontEnd {
    /// Moves the estimate from the registration towards the prediction, by what both know.
    ///
    /// Where they disagree by more than both allow, wheels have jumped or the scan was led astray. Answers with what
    /// was found instead where the wheels have jumped farther than the registration looked.
    pub(super) fn weigh(
        &mut self,
        matched: &MatchSummary,
        wheels: &Driven,
        frame: &PreparedFrame,
        config: &SlamConfig,
    ) -> Option<MatchSummary> {
        let prediction = &wheels.prediction;
        let share = matched.score.unwrap_or(1.0);
        let known = self.claimed(&matched.pose, share, config);
        let noise = config.motion_noise(frame.odometry.is_some());
        let driven = noise.covariance(&wheels.motion);
        let fusion = fuse(&matched.pose, &known, prediction, &driven)?;
        self.estimate = fusion.pose;
        // A scan that hardly fits where wheels lead to that have jumped does not contradict them: it says nothing.
        let rules = config.contradiction;
        if fusion.chi2 > rules.chi2 || wheels.going_on.is_some() && share < rules.min_score {
            return self.settle(matched, wheels, &driven, frame, config);
        }
        None
    }

    /// Decides where the scan and the wheels contradict each other.
    ///
    /// The place that was found competes with those that the wheels lead to, with their heading and with
    /// the one that was found. A false place always fits somewhere: it costs by how many standard deviations
    /// the wheels would have jumped there. The best is believed where half of the scan fits at that cost,
    /// and clearly more than at the prediction; then the wheels have jumped, and tell only what the scan
    /// does not. Elsewhere the scan's information is taken to be less, by the square of how much the
    /// disagreement is too large: a place that is far off moves nothing.
    ///
    /// Where the wheels lead to quite another place than going on would, that one competes as well: it costs a jump, and how
    /// far from it the scan is.
    ///
    /// On submaps the score counts points at walls alone, and so does not compare places: there the found
    /// place stands by itself, without a cost.
    fn settle(
        &mut self,
        matched: &MatchSummary,
        wheels: &Driven,
        driven: &Matrix3<f64>,
        frame: &PreparedFrame,
        config: &SlamConfig,
    ) -> Option<MatchSummary> {
        let rules = config.contradiction;
        let prediction = &wheels.prediction;
        let compares = self.submaps.is_none();
        let jumped = driven + rules.jump();
        let request =
            |pose, iterations| MatchRequest::new(pose, config.threshold.initial_m, iterations);
        let cloud = &frame.cloud;
        let predicted = self.match_near(cloud, &request(*prediction, 0));
        let predicted = predicted.score.unwrap_or(0.0);
        let turned = SE2::new(prediction.x(), prediction.y(), matched.pose.theta());
        let mut best: Option<Place> = None;
        let by_wheels = [None, Some(*prediction), Some(turned)].map(|from| Start {
            lead: Lead::Wheels,
            from,
            expected: *prediction,
        });
        let by_going_on = wheels.going_on.map(|place| Start {
            lead: Lead::GoingOn,
            from: Some(place),
            expected: place,
        });
        let starts = by_wheels.into_iter().chain(by_going_on);
        for start in starts.take(if compares { 4 } else { 1 }) {
            let found = match start.from {
                None => self.match_near(cloud, &request(matched.pose, 0)),
                Some(from) => self.match_near(cloud, &request(from, config.max_iterations)),
            };
            let (pose, share) = (found.pose, found.score.unwrap_or(1.0));
            let known = self.claimed(&pose, share, config);
            let expected = start.expected;
            let Some(apart) = fuse(&pose, &known, &expected, &jumped) else {
                continue;
            };
            let cost = match frame.odometry {
                Some(_) if compares => {
                    rules.jump_cost * (start.lead.deviations() + math::sqrt(apart.chi2))
                }
                _ => 0.0,
            };
            let worth = share - math::min(cost, rules.max_cost);
            if best.as_ref().is_none_or(|best| worth > best.worth) {
                best = Some(Place {
                    lead: start.lead,
                    pose,
                    expected,
                    share,
                    worth,
                });
            }
        }
        let place = best?;
        let Place { pose, share, .. } = place;
        // The pairs are asked for later: those of the pose that is taken.
        self.match_near(cloud, &request(pose, 0));
        let known = self.claimed(&pose, share, config);
        let is_jump = place.worth >= rules.min_score && predicted < share - rules.lead;
        let fused = if is_jump && !compares {
            self.estimate = pose;
            return None;
        } else if is_jump {
            self.driven += rules.jump();
            fuse(&pose, &known, &place.expected, &jumped)
        } else {
            let apart = fuse(&pose, &known, prediction, driven);
            let chi2 = apart.map_or(f64::INFINITY, |apart| apart.chi2);
            let doubt = math::min(rules.chi2 / chi2, 1.0);
            self.believed = if compares { doubt * doubt } else { doubt };
            fuse(&pose, &(known * self.believed), prediction, driven)
        };
        let fused = fused?;
        self.estimate = fused.pose;
        let found = self.match_near(cloud, &request(fused.pose, 0));
        (is_jump && place.lead == Lead::GoingOn).then_some(found)
    }

    /// What the last registration claims to know at a pose.
    fn claimed(&self, pose: &SE2, share: f64, config: &SlamConfig) -> Matrix3<f64> {
        let known = self.matched_information(pose, &config.odometry_trust);
        // What fits in part may fit elsewhere as well.
        let known = known * (share * share * share * share);
        without_aperture(&known, config.aperture)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::cloud::PointCloud;
    use crate::icp::Pair;
    use crate::matching::{MatchStop, Matcher, TrustConfig};
    use crate::slam::{Slam, test_room};

    /// A scan that fits in one place, and a little everywhere else.
    #[derive(Clone)]
    struct FitsAt {
        pose: SE2,
        share: f64,
        information: Matrix3<f64>,
    }

    impl FitsAt {
        fn found(&self, pose: SE2) -> MatchSummary {
            let gap = pose.between(&self.pose).log();
            // Where the scan says nothing, a place fits as well as the next one.
            let is_there = gap.dot(&(self.information * gap)) < 1.0;
            MatchSummary {
                pose,
                rmse_m: 0.02,
                inliers: 60,
                iterations: 5,
                score: Some(if is_there { self.share } else { 0.3 }),
                runner_up: None,
                stop: MatchStop::Other("it knows"),
            }
        }
    }

    impl Matcher for FitsAt {
        fn set_target(&mut self, _target: &PointCloud) {}

        fn register(&mut self, _source: &PointCloud, _request: &MatchRequest) -> MatchSummary {
            self.found(self.pose)
        }

        fn register_near(&mut self, _source: &PointCloud, request: &MatchRequest) -> MatchSummary {
            self.found(request.guess)
        }

        fn pairs(&self, pairs: &mut Vec<Pair>) {
            pairs.clear();
        }

        fn information(&self, _registered: &SE2, _trust: &TrustConfig) -> Matrix3<f64> {
            self.information
        }
    }

    const WHEELS: (f64, f64, f64) = (0.4, 0.0, 0.0);

    /// Where the robot is taken to be after the wheels told [`WHEELS`].
    fn estimate(matcher: FitsAt) -> SE2 {
        let config = SlamConfig::for_robot(&test_room::frame(0).scan);
        let mut front_end = FrontEnd::new(&config, Box::new(matcher));
        front_end.start(Arc::new(PointCloud::default()));
        let frame = PreparedFrame {
            stamp_s: 1.0,
            odometry: Some(SE2::new(WHEELS.0, WHEELS.1, WHEELS.2)),
            cloud: Arc::new(PointCloud::default()),
        };
        front_end.register(&frame, 1.0, 1, &config).estimate
    }

    fn sure() -> Matrix3<f64> {
        Matrix3::identity() * 1e4
    }

    #[test]
    fn a_false_place_far_off_costs_more_than_it_fits() {
        // As in a door: a few points, and a false place two metres and a quarter turn away.
        let pose = SE2::new(-1.6, 0.0, 1.55);
        let found = estimate(FitsAt {
            pose,
            share: 0.8,
            information: sure(),
        });
        assert!((found.x() - WHEELS.0).abs() < 0.02, "{found:?}");
        assert!(found.theta().abs() < 0.02, "{found:?}");
        // What fits nearly whole is believed, wherever it is.
        let found = estimate(FitsAt {
            pose,
            share: 0.97,
            information: sure(),
        });
        assert!((found.x() - pose.x()).abs() < 0.02, "{found:?}");
    }

    #[test]
    fn wheels_that_jump_by_half_a_metre_are_not_believed() {
        let pose = SE2::new(0.1, 0.3, 0.4);
        let found = estimate(FitsAt {
            pose,
            share: 0.8,
            information: sure(),
        });
        assert!((found.x() - pose.x()).abs() < 0.02, "{found:?}");
        assert!((found.theta() - pose.theta()).abs() < 0.02, "{found:?}");
    }

    #[test]
    fn wheels_that_jump_by_five_metres_leave_the_robot_where_it_is() {
        // 5 m and 60°: from there no registration finds back. Not at the first frames, which tell no velocity.
        for jump in [
            SE2::new(5.0, 0.0, 0.0),
            SE2::new(-3.0, 4.0, 1.0),
            SE2::new(0.0, 0.0, 2.5),
        ] {
            let config = SlamConfig::for_robot(&test_room::frame(0).scan);
            let mut slam = Slam::new(config);
            let start = test_room::truth(0);
            for step in 0..20 {
                let mut frame = test_room::frame(step);
                if step == 12 {
                    frame.odometry = frame.odometry.map(|motion| motion * jump);
                }
                let report = slam.step(&frame).unwrap();
                let truth = start.between(&test_room::truth(step));
                let off = truth.between(&report.estimate);
                // 5 cm: the noise of the wheels, for a room that four walls tell.
                let is_there = math::norm2(off.x(), off.y()) < 0.05 && off.theta().abs() < 0.02;
                assert!(is_there, "{jump:?}, step {step}: {off:?}");
            }
        }
    }

    #[test]
    fn along_a_corridor_wheels_that_turned_still_tell_the_way() {
        // The scan slid by 0.8 m along a corridor, of which it knows nothing, and saw a turn of 0.4 rad.
        let pose = SE2::new(1.2, 0.0, 0.4);
        let (sin, cos) = math::sin_cos(pose.theta());
        let across = Vector3::new(sin, cos, 0.0);
        let information =
            across * across.transpose() * 1e4 + Vector3::z() * Vector3::z().transpose() * 1e4;
        let found = estimate(FitsAt {
            pose,
            share: 0.8,
            information,
        });
        // 0.05: the wheels' half metre against the 3 m of what says nothing.
        assert!((found.x() - WHEELS.0).abs() < 0.05, "{found:?}");
        assert!((found.theta() - pose.theta()).abs() < 0.02, "{found:?}");
    }
}
