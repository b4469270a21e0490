//! Final refinement: registers every keyframe again on the earlier visits to its surroundings.
//!
//! While frames come in, loops are searched at every few keyframes only. At the end each keyframe is linked with
//! every earlier visit around it, from poses that are nearly correct. The links of a pass replace
//! the earlier loops: a loop that the final map does not confirm is removed.

use nalgebra::{Matrix3, Vector3};
use pr_geom::math;
use pr_optim::OptimizeError;

use super::submaps::Submaps;
use super::tuning::{
    HALF_VISIT, LINK_GAP_NODES, LINK_HUBER, LINK_PASSES, LINK_RADIUS_M, LINK_SHIFT_M,
    LINK_SHIFT_RAD, LINK_VISITS, MIN_LINK_SCORE, REQUEST_M, REQUEST_RAD, REQUEST_SIGMAS,
};
use crate::chi_squared::CHAPTER_GATE;
use crate::loops::{LoopCandidate, LoopRejection, LoopVerification, detect_visits};
use crate::metrics::position_error_m;
use crate::search::SearchWindow;
use crate::slam::Mapper;

/// Gate of a link against the graph.
#[derive(Clone, Copy)]
struct LinkGate {
    /// S⁻¹ of the innovation.
    information: Matrix3<f64>,
    chi2: f64,
    /// Half the width of the search window if the keyframe does not fit, m, and its range of headings, rad.
    window: Option<(f64, f64)>,
}

/// Links all keyframes with the visits around them, and optimizes. Returns the links of the last pass, accepted
/// or not. A graph that cannot be solved is unchanged.
pub(super) fn link_all(mapper: &mut Mapper, submaps: &mut Submaps) -> Vec<LoopVerification> {
    let mut last = Vec::new();
    for _ in 0..LINK_PASSES {
        let links = links(mapper, submaps);
        if !mapper.replace_loops(&links, LINK_HUBER) {
            return last;
        }
        last = links;
    }
    last
}

/// The registrations of all keyframes on the visits around them, by keyframe, nearest visit first.
fn links(mapper: &Mapper, submaps: &mut Submaps) -> Vec<LoopVerification> {
    let gate = LinkGate {
        information: Matrix3::from_diagonal(&Vector3::new(
            1.0 / (LINK_SHIFT_M * LINK_SHIFT_M),
            1.0 / (LINK_SHIFT_M * LINK_SHIFT_M),
            1.0 / (LINK_SHIFT_RAD * LINK_SHIFT_RAD),
        )),
        chi2: CHAPTER_GATE,
        window: None,
    };
    let visits_of = |node| {
        let visits = detect_visits(mapper.poses(), node, LINK_RADIUS_M, LINK_GAP_NODES);
        let visits = visits.into_iter().take(LINK_VISITS);
        visits.map(move |visit| (node, visit))
    };
    let pairs: Vec<_> = (0..mapper.keyframes().len()).flat_map(visits_of).collect();
    // Several keyframes share a visit, whose submap and normals are then computed once.
    let mut by_visit: Vec<usize> = (0..pairs.len()).collect();
    by_visit.sort_by_key(|&pair| pairs[pair].1.node);
    let mut links = vec![None; pairs.len()];
    for shared in by_visit.chunk_by(|&one, &other| pairs[one].1.node == pairs[other].1.node) {
        // The first is the earliest of them, and all are farther from the visit than its last keyframe.
        let (earliest, visit) = pairs[shared[0]];
        build_visit(mapper, visit.node, earliest, submaps);
        for &pair in shared {
            let (node, visit) = pairs[pair];
            links[pair] = Some(link(mapper, node, visit, gate, submaps));
        }
    }
    links.into_iter().flatten().collect()
}

/// Registers keyframe `new` on the surroundings of keyframe `old`, on request of the caller.
///
/// # Errors
/// If the graph has no covariance for the test.
pub(super) fn link_on_request(
    mapper: &mut Mapper,
    old: usize,
    new: usize,
    submaps: &mut Submaps,
) -> Result<LoopVerification, OptimizeError> {
    // The graph's covariance of the relative pose, and a floor.
    let floor = Vector3::new(LINK_SHIFT_M, LINK_SHIFT_M, LINK_SHIFT_RAD).map(|sigma| sigma * sigma);
    let covariance =
        mapper.graph_mut().relative_covariance(old, new)? + Matrix3::from_diagonal(&floor);
    let information = covariance
        .try_inverse()
        .ok_or(OptimizeError::NotPositiveDefinite { node: new })?;
    let sigma = |variance: f64| math::sqrt(math::max(variance, 0.0));
    let half_m = REQUEST_SIGMAS * sigma(math::max(covariance.m11, covariance.m22));
    let half_rad = REQUEST_SIGMAS * sigma(covariance.m33);
    let poses = mapper.poses();
    let candidate = LoopCandidate {
        node: old,
        distance_m: position_error_m(&poses[old], &poses[new]),
        proposal: None,
    };
    let gate = LinkGate {
        information,
        chi2: CHAPTER_GATE,
        window: Some((
            math::min(half_m, REQUEST_M),
            math::min(half_rad, REQUEST_RAD),
        )),
    };
    build_visit(mapper, old, new, submaps);
    Ok(link(mapper, new, candidate, gate, submaps))
}

/// Builds the submap of the visit around keyframe `center` from keyframes before `new`.
fn build_visit(mapper: &Mapper, center: usize, new: usize, submaps: &mut Submaps) {
    let last = (center + HALF_VISIT).min(new - 1);
    submaps.build(mapper, center.saturating_sub(HALF_VISIT)..=last, center);
}

/// Registers keyframe `node` on the submap of the visit around an older one, from its pose in the graph.
fn link(
    mapper: &Mapper,
    node: usize,
    visit: LoopCandidate,
    allowed: LinkGate,
    submaps: &mut Submaps,
) -> LoopVerification {
    let poses = mapper.poses();
    let settings = &submaps.registration;
    let predicted = poses[visit.node].between(&poses[node]);
    let stages = [settings.max_correspondence_m, settings.inlier_distance_m];
    let scan = mapper.scan(node);
    let mut found = submaps
        .map
        .register(scan, predicted, &stages, None, settings);
    if let Some((half_m, half_rad)) = allowed.window
        && found.fit.score < MIN_LINK_SCORE
        && let window = SearchWindow::around(predicted, half_m, half_rad)
        && let Some(better) = submaps.map.search(scan, &window, 0.0)
    {
        found = submaps
            .map
            .register(scan, better.best.pose, &stages, None, settings);
    }
    let (gate_information, gate_chi2) = (allowed.information, allowed.chi2);
    let mut link = found.verification(node, visit, predicted, gate_information, gate_chi2);
    let score = found.fit.score;
    link.rejection = if score < MIN_LINK_SCORE {
        let min_score = MIN_LINK_SCORE;
        Some(LoopRejection::LowScore { score, min_score })
    } else {
        (!link.gate.passes()).then_some(LoopRejection::OutsideGate(link.gate))
    };
    link
}
