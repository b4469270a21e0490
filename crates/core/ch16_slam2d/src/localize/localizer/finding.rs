//! What a localizer does with the results of its searches.

use nalgebra::{Matrix3, Vector3};
use pr_geom::SE2;

use super::super::belief::Belief;
use super::super::pending_fix::PendingFix;
use super::super::trial::{Trial, Tried, TriedPart};
use super::{CONFIRMATION_REACH, Localizer, MAX_SEARCH_INTERVAL, MIN_POINTS, SEARCH_EVERY};
use crate::cloud::PointCloud;
use crate::icp::{INFORMATION_CAP, INFORMATION_RIDGE, regularize};
use crate::local_map::MapRegistration;
use crate::localize::{LocalizeReport, MapSearch, Verdict};
use crate::loops::chi_squared_gate;
use crate::metrics::position_error_m;
use crate::search::SearchResult;

impl Localizer {
    /// Tests the result of a search around a given start against it.
    pub(super) fn evaluate_near(
        &mut self,
        start: &SE2,
        result: Option<SearchResult>,
        pending: &mut PendingFix,
    ) {
        let Some(result) = result else { return };
        let square = |sigma: f64| 1.0 / (sigma * sigma);
        let xy = square(self.config.start_sigma_m);
        let theta = square(self.config.start_sigma_rad);
        let localized = Matrix3::from_diagonal(&Vector3::new(xy, xy, theta));
        let found = self.register(&pending.scan, result.best.pose);
        let innovation = start.between(&found.registered.pose).log();
        let gate = chi_squared_gate(&innovation, &localized, self.config.gate_chi2);
        if gate.passes() {
            self.accept(&found, Some(localized), &mut pending.report);
        }
        pending.report.search = Some(result);
    }

    /// Starts a search of the whole map for the trail, if the robot is not localized and a search is due.
    pub(super) fn plan_search(&mut self, pending: &mut PendingFix) {
        let is_settled = |belief: Belief| self.is_usual(&belief) && !self.is_suspect(&belief);
        if self.belief.is_some_and(is_settled) {
            self.running = None;
            return;
        }
        self.searched_ago += 1;
        self.scans_until_search = self
            .scans_until_search
            .saturating_sub(usize::from(pending.joined));
        if let Some((search, since)) = self.running.take() {
            pending.sums_before = search.sums();
            pending.since = since;
            pending.search = Some(search);
            return;
        }
        let has_moved = pending.joined && self.scans_until_search == 0;
        let is_due = has_moved || self.searched_ago >= SEARCH_EVERY || self.frames == 1;
        if !is_due || pending.scan.is_empty() {
            return;
        }
        self.searched_ago = 0;
        let trail = self.trail_cloud(&pending.scan);
        let search = MapSearch::whole(&self.map, trail, &pending.scan, &self.config);
        pending.search = Some(search);
    }

    /// Accepts or rejects the best pose on the whole map.
    pub(super) fn evaluate_whole_map(
        &mut self,
        result: Option<SearchResult>,
        pending: &mut PendingFix,
    ) {
        let Some(result) = result else {
            self.candidate = None;
            self.search_interval = (2 * self.search_interval).min(MAX_SEARCH_INTERVAL);
            self.scans_until_search = self.search_interval;
            return;
        };
        self.search_interval = 1;
        let report = &mut pending.report;
        report.search = Some(result);
        let trial = Trial {
            map: &self.map,
            trail: &self.trail,
            scan: &pending.scan,
            config: &self.config,
            registration: &self.registration,
        };
        let Some(Tried {
            pose: best,
            parts,
            margin,
        }) = trial.run(&result, self.candidate)
        else {
            return;
        };
        let is_best = |pose: &SE2| {
            position_error_m(pose, &best) < CONFIRMATION_REACH
                && pose.between(&best).theta().abs() < CONFIRMATION_REACH
        };
        if let Some(belief) = self.belief.as_mut().filter(|belief| is_best(&belief.pose)) {
            // The pose is correct after all: the environment has changed.
            belief.drops = 0;
            belief.usual_score = report.score.unwrap_or(belief.usual_score);
            return;
        }
        let is_again = self.candidate.as_ref().is_some_and(is_best);
        self.candidate = Some(best);
        let is_free = |part: &TriedPart| part.fit.in_free_space > self.expected.in_free_space;
        let fits = !parts.iter().any(is_free)
            && parts.iter().any(|part| {
                part.fit.score >= self.expected.found_score
                    && (self.was_found || part.spread_m >= trial.room_spread_m())
            });
        let is_localized = fits
            && (margin >= self.config.unconfirmed_margin
                || (margin >= self.config.min_margin && is_again));
        let found = self.register(&pending.scan, best);
        if (is_localized && self.accept(&found, None, report)) || self.belief.is_some() {
            return;
        }
        report.verdict = Verdict::Doubtful;
        report.pose = Some(best);
        report.score = Some(found.fit.score);
    }

    /// The points of the trail for a search, body frame.
    pub(super) fn trail_cloud(&self, scan: &PointCloud) -> PointCloud {
        let (scale, config) = (self.map.scale(), &self.config);
        self.trail.cloud(
            scan,
            scale * config.search_reach_m,
            scale * config.search_cell_m,
        )
    }

    /// Accepts a registration if it fits with enough points; returns whether it did.
    pub(super) fn accept(
        &mut self,
        found: &MapRegistration,
        prior: Option<Matrix3<f64>>,
        report: &mut LocalizeReport,
    ) -> bool {
        let score = found.fit.score;
        if score < self.expected.good_score || found.fit.inliers < MIN_POINTS {
            return false;
        }
        let known = found.information() + prior.unwrap_or_default();
        let known = regularize(known, INFORMATION_RIDGE, INFORMATION_CAP);
        let covariance = known.try_inverse().unwrap_or_else(Matrix3::identity);
        self.belief = Some(Belief {
            pose: found.registered.pose,
            covariance,
            misses: 0,
            usual_score: score,
            drops: 0,
        });
        self.candidate = None;
        report.verdict = if score >= self.expected.usual_score {
            self.was_found = true;
            Verdict::Found
        } else {
            Verdict::Doubtful
        };
        report.pose = Some(found.registered.pose);
        report.covariance = Some(covariance);
        report.score = Some(score);
        true
    }
}
