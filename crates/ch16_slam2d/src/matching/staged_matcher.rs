//! From coarse to fine, and from other starts where the first one leads to a poor fit.

use pr_geom::SE2;

use super::{IcpMatcher, MapConfig, MatchRequest, MatchSummary, Matcher};
use crate::cloud::PointCloud;
use crate::icp::{IcpConfig, IcpVariant, Pair};
use crate::ndt::{NdtAlign, NdtConfig, NdtMap};

/// A step of NDT that is shorter than this, m and rad added, is the last: points go on from there.
const ARRIVED: f64 = 0.02;

/// Two starts that are no farther apart, m and rad added, end at the same place.
const SAME_PLACE: f64 = 0.05;

/// Stages and starts of a [`StagedMatcher`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StagedMatcherConfig {
    /// Correspondence distances of the stages of ICP, one after the other, m; 0 ends the list.
    pub taus_m: [f64; 3],
    /// Residual beyond which a pair weighs less, m.
    pub huber_width_m: f64,
    /// A point that lies nearer to the map than this fits, m.
    pub fit_m: f64,
    /// With this score ICP from the guess is believed, 0 to 1.
    pub good_score: f64,
    /// Widths of the Gaussians' cells where it is not, wide ones first, m.
    pub cells_m: [f64; 2],
    /// Points that a cell needs.
    pub min_points: usize,
    /// Most iterations of each stage on Gaussians.
    pub ndt_iterations: usize,
    /// Other starts on either side of the guess.
    pub turns: usize,
    /// Heading from one of them to the next, rad.
    pub turn_rad: f64,
    /// Another start is taken where its score is better by so much.
    pub lead: f64,
    /// With this score the last stage alone is believed, and above 1 it never is; all stages are made
    /// besides. Infinite leaves the last stage out that begins at the guess.
    pub near_score: f64,
    /// From farther off is better where its score is ahead of the last stage's by so much.
    pub near_lead: f64,
}

impl Default for StagedMatcherConfig {
    fn default() -> Self {
        Self {
            taus_m: [0.6, 0.3, 0.15],
            huber_width_m: 0.05,
            fit_m: 0.15,
            good_score: 0.75,
            cells_m: [1.0, 0.5],
            min_points: 4,
            ndt_iterations: 15,
            turns: 3,
            turn_rad: 0.2,
            lead: 0.0,
            near_score: f64::INFINITY,
            near_lead: 0.0,
        }
    }
}

/// Point-to-plane ICP from far to near; NDT and other starts where that leads to a poor fit.
///
/// The score of a pose is the share of the scan that fits, each point by `1 − d²/fit²` of its
/// distance d from the map. With a poor one the Gaussians of wide and of narrow cells find the place
/// from a guess that is off by half a metre or half a radian, then other headings are tried, and the
/// best is taken.
#[derive(Clone)]
pub struct StagedMatcher {
    config: StagedMatcherConfig,
    target: PointCloud,
    /// Gaussians of the target, once they are needed.
    gaussians: Vec<NdtMap>,
    points: IcpMatcher,
}

impl StagedMatcher {
    /// A matcher without a target; `map` is that of the points.
    #[must_use]
    pub fn new(config: StagedMatcherConfig, map: &MapConfig) -> Self {
        let icp = IcpConfig {
            variant: IcpVariant::PointToPlane,
            huber_width_m: config.huber_width_m,
            ..IcpConfig::default()
        };
        Self {
            config,
            target: PointCloud::default(),
            gaussians: Vec::new(),
            points: IcpMatcher::new(icp, map),
        }
    }

    /// ICP from the guess, first from near and then from far to near; the last stage alone where that fits.
    ///
    /// Pairs from far off pull a scan along a bare wall, and where the guess is good none are needed.
    fn refine(&mut self, source: &PointCloud, request: &MatchRequest) -> MatchSummary {
        let stages = self.config.taus_m;
        if self.config.near_score.is_infinite() {
            return self.staged(source, request, &stages);
        }
        let last = stages.iter().rev().find(|tau_m| **tau_m > 0.0);
        let last = last.map_or(&[][..], core::slice::from_ref);
        let near = self.staged(source, request, last);
        if near.score >= Some(self.config.near_score) {
            return near;
        }
        let far = self.staged(source, request, &stages);
        if far.score > near.score.map(|score| score + self.config.near_lead) {
            return far;
        }
        self.fit(source, near.pose, near.iterations)
    }

    /// ICP from the guess in these stages.
    fn staged(
        &mut self,
        source: &PointCloud,
        request: &MatchRequest,
        taus_m: &[f64],
    ) -> MatchSummary {
        let mut pose = request.guess;
        let mut made = 0;
        for tau_m in taus_m.iter().copied().take_while(|tau_m| *tau_m > 0.0) {
            let stage = MatchRequest {
                guess: pose,
                tau_m,
                ..*request
            };
            let stage = self.points.register_again(source, &stage);
            pose = stage.pose;
            made += stage.iterations;
            // Points without a pair from far off will have none from near.
            if (stage.inliers as f64) < request.min_score * source.len() as f64 {
                break;
            }
        }
        self.fit(source, pose, made)
    }

    /// The fit at a pose; the pairs are those that fit.
    ///
    /// All registrations of one scan share what is known of its points' neighbours.
    fn fit(&mut self, source: &PointCloud, pose: SE2, iterations: usize) -> MatchSummary {
        let fit_m = self.config.fit_m;
        let fit = self.points.fit_again(source, pose, fit_m);
        let missed = self.points.truncated_cost_m2() / (fit_m * fit_m);
        MatchSummary {
            iterations,
            score: Some(if fit.inliers == 0 { 0.0 } else { 1.0 - missed }),
            ..fit
        }
    }

    /// NDT on wide cells, then on narrow ones; none where either leads to a place that is known.
    fn climb(&mut self, source: &PointCloud, start: SE2, known: &mut [Vec<SE2>; 2]) -> Option<SE2> {
        let StagedMatcherConfig {
            cells_m,
            min_points,
            ndt_iterations,
            ..
        } = self.config;
        if self.gaussians.is_empty() {
            let build = |cell_m| NdtMap::build(&self.target, cell_m, min_points);
            self.gaussians.extend(cells_m.map(build));
        }
        let mut pose = start;
        for (map, known) in self.gaussians.iter().zip(known) {
            pose = climb(source, map, pose, ndt_iterations);
            let is_here = |place: &SE2| place.between(&pose).step_size() < SAME_PLACE;
            if known.iter().any(is_here) {
                return None;
            }
            known.push(pose);
        }
        Some(pose)
    }
}

/// NDT from `start` to where its steps are short.
fn climb(source: &PointCloud, map: &NdtMap, start: SE2, iterations: usize) -> SE2 {
    let solver = NdtConfig {
        max_iters: iterations,
        ..NdtConfig::default()
    };
    let mut registration = NdtAlign::new(source, map, start, &solver);
    let mut pose = start;
    loop {
        let step = registration.step();
        let moved = pose.between(&step.pose).step_size();
        pose = step.pose;
        if step.stop.is_some() || moved < ARRIVED {
            return pose;
        }
    }
}

impl Matcher for StagedMatcher {
    fn set_target(&mut self, target: &PointCloud) {
        self.target.clone_from(target);
        self.gaussians.clear();
        self.points.set_target(target);
    }

    fn register(&mut self, source: &PointCloud, request: &MatchRequest) -> MatchSummary {
        self.points.forget();
        if request.max_iterations == 0 {
            return self.fit(source, request.guess, 0);
        }
        let mut best = self.refine(source, request);
        let mut is_last = true;
        // Where Gaussians led to, wide ones and narrow ones.
        let mut known = [Vec::new(), vec![best.pose]];
        for step in 0..=self.config.turns {
            if best.score >= Some(self.config.good_score) {
                break;
            }
            let sides = if step == 0 { &[0.0][..] } else { &[1.0, -1.0] };
            for side in sides {
                let turn_rad = side * step as f64 * self.config.turn_rad;
                let start = request.guess * SE2::new(0.0, 0.0, turn_rad);
                let Some(start) = self.climb(source, start, &mut known) else {
                    continue;
                };
                let needed = best.score.map(|score| score + self.config.lead);
                let from_there = MatchRequest {
                    guess: start,
                    min_score: needed.unwrap_or_default(),
                    ..*request
                };
                let found = self.refine(source, &from_there);
                is_last = found.score > needed;
                if is_last {
                    best = found;
                }
            }
        }
        if !is_last {
            // The pairs are those of the last registration.
            self.fit(source, best.pose, best.iterations);
        }
        best
    }

    fn register_near(&mut self, source: &PointCloud, request: &MatchRequest) -> MatchSummary {
        self.points.forget();
        if request.max_iterations == 0 {
            return self.fit(source, request.guess, 0);
        }
        let [_, near, last] = self.config.taus_m;
        self.staged(source, request, &[near, last])
    }

    fn pairs(&self, pairs: &mut Vec<Pair>) {
        self.points.pairs(pairs);
    }
}

#[cfg(test)]
mod tests {
    use pr_geom::Point2;

    use super::*;

    const MAP: MapConfig = MapConfig {
        cell_m: 0.135,
        max_per_cell: 6,
    };

    /// The walls of a room of 6 m × 4 m with a niche, every 5 cm, with normals.
    fn room() -> PointCloud {
        let wall = |from: (f64, f64), to: (f64, f64)| {
            let length = (to.0 - from.0).abs() + (to.1 - from.1).abs();
            let count = (length / 0.05) as i32;
            (0..count).map(move |k| {
                let share = f64::from(k) / f64::from(count);
                Point2::new(
                    from.0 + share * (to.0 - from.0),
                    from.1 + share * (to.1 - from.1),
                )
            })
        };
        let corners = [
            (0.0, 0.0),
            (6.0, 0.0),
            (6.0, 4.0),
            (3.0, 4.0),
            (3.0, 3.0),
            (1.5, 3.0),
            (1.5, 4.0),
            (0.0, 4.0),
            (0.0, 0.0),
        ];
        let mut cloud: PointCloud = corners
            .windows(2)
            .flat_map(|pair| wall(pair[0], pair[1]))
            .collect();
        cloud.estimate_normals(0.2);
        cloud
    }

    /// How far the matcher ends from the truth, m and rad added, and its score.
    fn end(config: StagedMatcherConfig, guess: SE2) -> (f64, f64) {
        let truth = SE2::new(2.5, 1.5, 0.4);
        let map = room();
        let mut matcher = StagedMatcher::new(config, &MAP);
        matcher.set_target(&map);
        let scan = map.transformed(&truth.inverse());
        let found = matcher.register(&scan, &MatchRequest::new(truth * guess, 0.5, 15));
        let error = truth.between(&found.pose);
        let off = error.x().abs() + error.y().abs() + error.theta().abs();
        (off, found.score.unwrap())
    }

    #[test]
    fn a_guess_that_leads_icp_astray_comes_home() {
        let guess = SE2::new(0.5, -0.4, 1.2);
        let (off, score) = end(StagedMatcherConfig::default(), guess);
        // 0.01: points stand every 5 cm, and the map keeps six in a cell.
        assert!(off < 0.01 && score > 0.9, "{off} {score}");
        let near = StagedMatcherConfig {
            good_score: 0.0,
            ..StagedMatcherConfig::default()
        };
        let (off, score) = end(near, guess);
        assert!(off > 0.1 && score < 0.7, "ICP alone: {off} {score}");
    }

    #[test]
    fn what_cannot_reach_the_score_that_is_asked_for_is_given_up() {
        let map = room();
        let near = StagedMatcherConfig {
            good_score: 0.0,
            ..StagedMatcherConfig::default()
        };
        let mut matcher = StagedMatcher::new(near, &MAP);
        matcher.set_target(&map);
        // Three metres off, most of the room has no wall within 0.6 m.
        for (off_m, is_worth_it) in [(0.2, true), (3.0, false)] {
            let guess = SE2::new(off_m, -off_m, 0.1);
            let request = MatchRequest::new(guess, 0.5, 15);
            let patient = matcher.register(&map, &request);
            let hasty = matcher.register(&map, &request.with_min_score(0.7));
            assert_eq!(patient.score >= Some(0.7), is_worth_it);
            assert_eq!(hasty.score >= Some(0.7), is_worth_it);
            if is_worth_it {
                assert_eq!(hasty, patient);
            } else {
                assert!(hasty.iterations < patient.iterations);
            }
        }
    }

    #[test]
    fn a_scan_of_nothing_has_no_score() {
        let mut matcher = StagedMatcher::new(StagedMatcherConfig::default(), &MAP);
        matcher.set_target(&room());
        let request = MatchRequest::new(SE2::identity(), 0.5, 15);
        let found = matcher.register(&PointCloud::default(), &request);
        assert_eq!((found.score, found.inliers), (Some(0.0), 0));
    }
}
