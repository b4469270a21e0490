//! Doubts about a map: uncertain keyframes, loops and path segments that the rest contradicts, and scans with a poor
//! fit.

use ch16_slam2d::loops::LoopRejection;
use ch16_slam2d::slam::Slam;
use pr_geom::{math, sort_numbers};

use super::{GATE_CHI2, KeyframeQuality, LinkQuality, Quality, RefutedPath};
use crate::evidence::{PoorFit, TriedLoop};

/// Keyframes are doubted if their standard deviation exceeds the median one by this factor.
const UNCERTAIN_FACTOR: f64 = 3.0;
/// Keyframes with a smaller standard deviation are not doubted, m.
const MIN_UNCERTAIN_M: f64 = 0.1;
/// Keyframes whose 95 % ellipse has a larger half axis are doubted, however uncertain the others are, m.
const MAX_OFF_M: f64 = 0.5;
/// Half axis of the 95 % ellipse over that of the 1σ ellipse: √χ²₂(0.95) = √(−2 ln 0.05).
const RADIUS_95: f64 = 2.4477;
/// The map violates a loop that it differs from by more, m and degrees: as much as from a false loop.
const VIOLATION: (f64, f64) = (0.3, 5.0);
/// Most doubts of one kind that are listed.
const MAX_DOUBTS: usize = 10;

/// A loop that was accepted once and that the map violates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ViolatedLoop {
    /// The newer keyframe.
    from: usize,
    /// The older keyframe.
    to: usize,
    /// Distance between the relative pose by the loop and by the map, m.
    off_m: f64,
    /// Angle between both, degrees.
    off_deg: f64,
}

/// Loops that were accepted while scans came in and that the final graph violates: they were removed, or others
/// outweigh them.
pub(super) fn violated(slam: &Slam, tried: &[TriedLoop]) -> Vec<ViolatedLoop> {
    let poses = slam.graph().poses();
    let closed = tried.iter().filter(|tried| tried.accepted);
    let all = closed.filter_map(|TriedLoop { verification, .. }| {
        let (to, from) = (verification.candidate.node, verification.from_node);
        let by_map = poses.get(to)?.between(poses.get(from)?);
        let off = verification.registered.between(&by_map);
        Some(ViolatedLoop {
            from,
            to,
            off_m: math::norm2(off.x(), off.y()),
            off_deg: off.theta().abs().to_degrees(),
        })
    });
    all.filter(|it| it.off_m > VIOLATION.0 || it.off_deg > VIOLATION.1)
        .collect()
}

/// The doubt about a map that could not be optimized at the end of its run.
#[must_use]
pub fn unsolved(reason: &LoopRejection) -> String {
    let reason = match reason {
        LoopRejection::OptimizationFailed(stop) => stop.to_string(),
        other => other.to_string(),
    };
    format!("the last optimization failed, so the map does not follow its newest loops: {reason}")
}

/// One sentence per doubt, the worst of a kind first, at most ten of a kind.
pub(super) fn sentences(
    quality: &Quality,
    violated: &[ViolatedLoop],
    poor: &[PoorFit],
) -> Vec<String> {
    let mut doubts = Vec::new();
    for kind in [
        uncertain_keyframes(&quality.keyframes),
        contradicted_loops(&quality.links),
        contradicted_paths(&quality.refuted_paths),
        violated_loops(violated),
        poor_fits(poor),
    ] {
        let more = kind.len().saturating_sub(MAX_DOUBTS);
        doubts.extend(kind.into_iter().take(MAX_DOUBTS));
        if more > 0 {
            doubts.push(format!("and {more} more of this kind"));
        }
    }
    doubts
}

fn uncertain_keyframes(keyframes: &[KeyframeQuality]) -> Vec<String> {
    let mut sorted: Vec<f64> = keyframes.iter().map(KeyframeQuality::sigma_m).collect();
    sort_numbers(&mut sorted);
    let median_m = sorted.get(sorted.len() / 2).copied().unwrap_or_default();
    let limit_m = (UNCERTAIN_FACTOR * median_m).clamp(MIN_UNCERTAIN_M, MAX_OFF_M / RADIUS_95);
    let is_uncertain = |number: &usize| keyframes[*number].sigma_m() > limit_m;
    let uncertain: Vec<usize> = (0..keyframes.len()).filter(is_uncertain).collect();
    let runs = uncertain.chunk_by(|a, b| b - a == 1).map(|run| {
        let (first, last) = (run[0], run[run.len() - 1]);
        let worst_m = run.iter().map(|k| keyframes[*k].sigma_m());
        let worst_m = worst_m.fold(0.0, f64::max);
        format!(
            "keyframes {first} to {last} may be up to {:.2} m off (95%); the median keyframe {:.2} m",
            RADIUS_95 * worst_m,
            RADIUS_95 * median_m
        )
    });
    runs.collect()
}

fn contradicted_loops(links: &[LinkQuality]) -> Vec<String> {
    let beyond = |link: &LinkQuality| link.chi2.filter(|chi2| *chi2 > link.gate_chi2);
    let links = links.iter();
    let mut found: Vec<_> = links
        .filter_map(|link| Some((beyond(link)?, link)))
        .collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let found = found.into_iter().map(|(chi2, link)| {
        format!(
            "the loop from keyframe {} to {} contradicts the rest of the graph: chi-squared {chi2:.1} above {:.1}",
            link.from, link.to, link.gate_chi2
        )
    });
    found.collect()
}

fn contradicted_paths(paths: &[RefutedPath]) -> Vec<String> {
    let mut paths = paths.to_vec();
    paths.sort_by(|a, b| b.chi2.total_cmp(&a.chi2));
    let paths = paths.iter().map(|RefutedPath { from, to, chi2 }| {
        format!(
            "the path from keyframe {from} to {to} contradicts the rest of the graph: chi-squared {chi2:.1} above {GATE_CHI2:.1}"
        )
    });
    paths.collect()
}

fn violated_loops(violated: &[ViolatedLoop]) -> Vec<String> {
    let mut violated = violated.to_vec();
    violated.sort_by(|a, b| b.off_m.total_cmp(&a.off_m));
    let violated = violated.iter().map(|violated| {
        let ViolatedLoop { from, to, off_m, off_deg } = violated;
        format!(
            "the loop from keyframe {from} to {to} was accepted, but the map violates it by {off_m:.2} m and {off_deg:.0}°"
        )
    });
    violated.collect()
}

fn poor_fits(poor: &[PoorFit]) -> Vec<String> {
    let mut poor = poor.to_vec();
    poor.sort_by(|a, b| a.score.total_cmp(&b.score));
    let poor = poor.iter().map(|poor| {
        let (stamp_s, share) = (poor.stamp_s, 100.0 * poor.score);
        format!("only {share:.0}% of the scan at {stamp_s:.3} s fits the map")
    });
    poor.collect()
}

#[cfg(test)]
mod tests {
    use ch16_slam2d::graph::EdgeKind;
    use ch16_slam2d::scan::LaserScan;
    use pr_geom::{Matrix3, SE2};

    use super::super::GATE_CHI2;
    use super::*;
    use crate::log::LogFrame;
    use crate::run::LogRun;

    #[test]
    fn a_failed_last_optimization_is_the_first_doubt() {
        let doubts = |information: f64| {
            let mut run = LogRun::default();
            for k in 0..20 {
                run.step(LogFrame {
                    stamp_s: f64::from(k),
                    odometry: Some(SE2::new(0.0, 0.0, 0.2 * f64::from(k))),
                    scan: LaserScan {
                        angle_step_rad: 0.05,
                        ranges_m: vec![3.0; 120],
                        ..LaserScan::default()
                    },
                });
            }
            let graph = run.slam_mut().unwrap().graph_mut();
            let (measured, information) = (graph.pose(2), Matrix3::identity() * information);
            graph.add_edge(0, 2, measured, information, EdgeKind::Odometry);
            run.finish();
            run.quality().doubts
        };
        let failed = "the last optimization failed, so the map does not follow its newest loops: ";
        // The normal equations of a negative information have no minimum.
        assert!(doubts(-1e9)[0].starts_with(failed));
        assert!(!doubts(1e3).iter().any(|doubt| doubt.starts_with(failed)));
    }

    #[test]
    fn poor_fits_and_contradicted_loops_and_paths_are_doubted() {
        let keyframe = |sigma_m: f64| KeyframeQuality {
            stamp_s: 0.0,
            pose: [0.0; 3],
            covariance: [
                [sigma_m * sigma_m, 0.0, 0.0],
                [0.0, 1e-4, 0.0],
                [0.0, 0.0, 1e-6],
            ],
        };
        let link = |chi2| LinkQuality {
            from: 9,
            to: 2,
            score: Some(0.8),
            rmse_m: Some(0.02),
            inliers: 90,
            margin: None,
            chi2: Some(chi2),
            gate_chi2: GATE_CHI2,
            accepted: true,
            reason: None,
        };
        let path = |from, to, chi2| RefutedPath { from, to, chi2 };
        let quality = Quality {
            keyframes: [0.02, 0.02, 0.02, 0.4, 0.5].map(keyframe).to_vec(),
            links: vec![link(3.0), link(40.0)],
            refuted_paths: vec![path(4, 5, 20.0), path(7, 11, 84.44)],
            ..Quality::default()
        };
        let removed = |from, off_m| ViolatedLoop {
            from,
            to: 4,
            off_m,
            off_deg: 90.4,
        };
        let poor = PoorFit {
            stamp_s: 12.5,
            score: 0.31,
        };
        let violated = [removed(31, 0.5), removed(30, 2.345)];
        assert_eq!(
            sentences(&quality, &violated, &[poor]),
            [
                "keyframes 3 to 4 may be up to 1.22 m off (95%); the median keyframe 0.05 m",
                "the loop from keyframe 9 to 2 contradicts the rest of the graph: chi-squared 40.0 above 16.3",
                "the path from keyframe 7 to 11 contradicts the rest of the graph: chi-squared 84.4 above 16.3",
                "the path from keyframe 4 to 5 contradicts the rest of the graph: chi-squared 20.0 above 16.3",
                "the loop from keyframe 30 to 4 was accepted, but the map violates it by 2.35 m and 90°",
                "the loop from keyframe 31 to 4 was accepted, but the map violates it by 0.50 m and 90°",
                "only 31% of the scan at 12.500 s fits the map",
            ]
        );
    }

    #[test]
    fn half_a_metre_is_doubted_even_if_every_keyframe_is_that_uncertain() {
        let keyframe = |sigma_m: f64| KeyframeQuality {
            stamp_s: 0.0,
            pose: [0.0; 3],
            covariance: [[sigma_m * sigma_m, 0.0, 0.0], [0.0; 3], [0.0; 3]],
        };
        let doubts = |sigma_m| uncertain_keyframes(&[keyframe(sigma_m); 4]);
        assert_eq!(doubts(0.2), Vec::<String>::new());
        assert_eq!(
            doubts(0.21),
            ["keyframes 0 to 3 may be up to 0.51 m off (95%); the median keyframe 0.51 m"]
        );
    }

    #[test]
    fn ten_of_a_kind_are_spelled_out_and_the_others_counted() {
        let poor = |share: u8| PoorFit {
            stamp_s: 0.0,
            score: f64::from(share) / 100.0,
        };
        let poor: Vec<PoorFit> = (0..13).map(poor).collect();
        let doubts = sentences(&Quality::default(), &[], &poor);
        assert_eq!(doubts.len(), 11);
        assert_eq!(doubts[10], "and 3 more of this kind");
    }
}
