//! The map for localization.

use std::sync::Arc;

use pr_geom::{SE2, math, sort_ranked};

use super::LocalizeConfig;
use crate::cloud::PointCloud;
use crate::local_map::{LocalMap, RangeProfile};
use crate::metrics::position_error_m;
use crate::places::{ContextConfig, ScanContext};
use crate::search::{
    LikelihoodConfig, ScanSearch, SearchError, SearchMap, SearchNeighborhood, SearchWindow,
};
use crate::slam::Keyframe;

/// Largest number of doublings of the grid's cells until the map fits.
const DOUBLINGS: usize = 8;

/// Share of the map's points that are nearer to their sensor than the reach of a search.
const REACH_QUANTILE: f64 = 0.8;
/// Largest enlargement of a search.
const MAX_SCALE: f64 = 8.0;
/// Keyframes for the test of a trail: their largest distance from its newest scan, m, the least between two, m and rad,
/// and their number.
const WIDE: (f64, (f64, f64), usize) = (12.0, (0.7, 1.0), 60);

/// A keyframe that looks similar to a scan.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PlaceGuess {
    /// Its index.
    pub keyframe: usize,
    /// Dissimilarity, 0 to 1.
    pub distance: f64,
    /// The keyframe's position with the heading of the best match, `map_from_body`.
    pub pose: SE2,
}

/// Keyframes at their poses: for registration while tracking, for search while lost.
#[derive(Clone, Debug)]
pub struct KnownMap {
    keyframes: Vec<Keyframe>,
    poses: Vec<SE2>,
    contexts: Vec<ScanContext>,
    looks: ContextConfig,
    profiles: Vec<Arc<RangeProfile>>,
    points: PointCloud,
    search: Arc<SearchMap>,
    scale: f64,
}

impl KnownMap {
    /// The map of these keyframes, `map_from_body` each.
    ///
    /// # Errors
    /// If they have no point, or are too far apart for any grid.
    pub fn new(
        keyframes: Vec<Keyframe>,
        poses: Vec<SE2>,
        config: &LocalizeConfig,
    ) -> Result<Self, SearchError> {
        let mut points = PointCloud::default();
        let mut ranges_m = Vec::new();
        for (keyframe, pose) in keyframes.iter().zip(&poses) {
            points.extend_transformed(&keyframe.scan, pose);
            let ranges = keyframe.scan.iter();
            ranges_m.extend(ranges.map(|point| math::norm2(point.x, point.y)));
        }
        pr_geom::sort_numbers(&mut ranges_m);
        let farthest_m = math::max(ranges_m.last().copied().unwrap_or_default(), 1.0);
        let at = (REACH_QUANTILE * ranges_m.len() as f64) as usize;
        let usual_m = ranges_m.get(at).copied().unwrap_or_default();
        let scale = (usual_m / config.search_reach_m).clamp(1.0, MAX_SCALE);
        let mut grid = LikelihoodConfig {
            cell_m: scale * config.grid.cell_m,
            sigma_m: scale * config.grid.sigma_m,
        };
        let points = points.downsample(grid.cell_m);
        let mut search = SearchMap::build(&points, grid);
        for _ in 0..DOUBLINGS {
            if !matches!(search, Err(SearchError::MapTooLarge { .. })) {
                break;
            }
            grid = LikelihoodConfig {
                cell_m: 2.0 * grid.cell_m,
                sigma_m: 2.0 * grid.sigma_m,
            };
            search = SearchMap::build(&points, grid);
        }
        let looks = ContextConfig {
            max_range_m: math::min(farthest_m, 20.0),
            ..ContextConfig::default()
        };
        let scans = keyframes.iter().map(|keyframe| &*keyframe.scan);
        let profiles = scans.map(|scan| Arc::new(RangeProfile::new(scan)));
        let profiles = profiles.collect();
        let contexts = keyframes.iter();
        Ok(Self {
            profiles,
            contexts: contexts
                .map(|keyframe| ScanContext::new(&keyframe.scan, &looks))
                .collect(),
            search: Arc::new(search?),
            keyframes,
            poses,
            looks,
            points,
            scale,
        })
    }

    /// The keyframes in order.
    #[must_use]
    pub fn keyframes(&self) -> &[Keyframe] {
        &self.keyframes
    }

    /// Their poses, `map_from_body`.
    #[must_use]
    pub fn poses(&self) -> &[SE2] {
        &self.poses
    }

    /// All points, thinned to one per cell of the grid.
    #[must_use]
    pub fn points(&self) -> &PointCloud {
        &self.points
    }

    /// Enlargement of reach and cells of a search: 1 indoors, more where the walls are far away.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// A new search for a scan, or for a trail of scans.
    ///
    /// # Errors
    /// If the scan has no finite point or the window has too many poses.
    pub fn search(
        &self,
        scan: &PointCloud,
        window: &SearchWindow,
        neighborhood: &SearchNeighborhood,
    ) -> Result<ScanSearch, SearchError> {
        ScanSearch::new(Arc::clone(&self.search), scan, window, neighborhood)
    }

    /// The window of the whole map at every heading.
    #[must_use]
    pub fn whole(&self) -> SearchWindow {
        SearchWindow::whole(self.search.grid())
    }

    /// The keyframes most similar to a scan, the best first.
    #[must_use]
    pub fn alike(&self, scan: &PointCloud, most: usize) -> Vec<PlaceGuess> {
        let here = ScanContext::new(scan, &self.looks);
        let mut keyed: Vec<(f64, usize)> = self
            .contexts
            .iter()
            .enumerate()
            .map(|(keyframe, context)| (context.key_distance(&here), keyframe))
            .collect();
        sort_ranked(&mut keyed);
        keyed.truncate(8 * most);
        let guesses = keyed.into_iter().map(|(_, keyframe)| {
            let found = self.contexts[keyframe].compare(&here);
            PlaceGuess {
                keyframe,
                distance: found.distance,
                pose: self.poses[keyframe] * SE2::new(0.0, 0.0, found.turn_rad),
            }
        });
        let mut guesses: Vec<PlaceGuess> = guesses.collect();
        guesses.sort_by(|a, b| {
            let by_looks = a.distance.total_cmp(&b.distance);
            by_looks.then(a.keyframe.cmp(&b.keyframe))
        });
        guesses.truncate(most);
        guesses
    }

    /// The keyframes within `near_m` (m) of a pose, at most `most`, the nearest, by index.
    #[must_use]
    pub fn near(&self, pose: &SE2, near_m: f64, most: usize) -> Vec<usize> {
        let distances = self.poses.iter().map(|at| position_error_m(at, pose));
        let mut near: Vec<(f64, usize)> = distances
            .zip(0..)
            .filter(|(distance_m, _)| *distance_m <= near_m)
            .collect();
        sort_ranked(&mut near);
        near.truncate(most);
        let mut near: Vec<usize> = near.into_iter().map(|(_, keyframe)| keyframe).collect();
        near.sort_unstable();
        near
    }

    /// Keyframes around a pose that show the surroundings of a trail, spread evenly, by index.
    pub(super) fn around(&self, pose: &SE2) -> Vec<usize> {
        let (reach_m, (apart_m, apart_rad), most) = WIDE;
        let distances = self.poses.iter().map(|at| position_error_m(at, pose));
        let mut near: Vec<(f64, usize)> = distances
            .zip(0..)
            .filter(|(distance_m, _)| *distance_m <= self.scale * reach_m)
            .collect();
        sort_ranked(&mut near);
        let mut spread: Vec<usize> = Vec::new();
        for (_, keyframe) in near {
            let is_beside = |other: &usize| {
                let (one, other) = (&self.poses[keyframe], &self.poses[*other]);
                position_error_m(one, other) < apart_m
                    && one.between(other).theta().abs() < apart_rad
            };
            if spread.len() < most && !spread.iter().any(is_beside) {
                spread.push(keyframe);
            }
        }
        spread.sort_unstable();
        spread
    }

    /// Builds `local` from these keyframes, in the map frame.
    pub(super) fn build_local(&self, keyframes: &[usize], local: &mut LocalMap) {
        local.rebuild(keyframes.iter().map(|&keyframe| {
            let scan = &*self.keyframes[keyframe].scan;
            (self.poses[keyframe], scan, &self.profiles[keyframe])
        }));
    }
}
