//! Doubts about a map: uncertain keyframes, loops and path segments that the rest contradicts, and scans with a poor
//! fit.

use ch16_slam2d::slam::Slam;
use pr_geom::{math, sort_numbers};

use super::{GATE_CHI2, KeyframeQuality, LinkQuality, Quality, RefutedWay};
use crate::evidence::{PoorFit, TriedLoop};

/// Keyframes are doubted if their standard deviation exceeds the median one by this factor.
const UNSURE_TIMES: f64 = 3.0;
/// Keyframes with a smaller standard deviation are not doubted, m.
const UNSURE_M: f64 = 0.1;
/// The map violates a loop that it differs from by more, m and degrees: as much as from a false loop.
const DISPUTED: (f64, f64) = (0.3, 5.0);
/// Most doubts of one kind that are listed.
const MOST_DOUBTS: usize = 10;

/// A loop that was accepted once and that the map violates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Disputed {
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
pub(super) fn disputed(slam: &Slam, tried: &[TriedLoop]) -> Vec<Disputed> {
    let poses = slam.graph().poses();
    let closed = tried.iter().filter(|tried| tried.accepted);
    let all = closed.filter_map(|TriedLoop { verification, .. }| {
        let (to, from) = (verification.candidate.node, verification.from_node);
        let by_map = poses.get(to)?.between(poses.get(from)?);
        let off = verification.registered.between(&by_map);
        Some(Disputed {
            from,
            to,
            off_m: math::norm2(off.x(), off.y()),
            off_deg: off.theta().abs().to_degrees(),
        })
    });
    all.filter(|it| it.off_m > DISPUTED.0 || it.off_deg > DISPUTED.1)
        .collect()
}

/// One sentence per doubt, the worst of a kind first, at most ten of a kind.
pub(super) fn sentences(quality: &Quality, disputed: &[Disputed], poor: &[PoorFit]) -> Vec<String> {
    let mut doubts = Vec::new();
    for kind in [
        unsure(&quality.keyframes),
        contradicting(&quality.links),
        refuted(&quality.refuted_ways),
        not_held(disputed),
        hardly_fitting(poor),
    ] {
        let more = kind.len().saturating_sub(MOST_DOUBTS);
        doubts.extend(kind.into_iter().take(MOST_DOUBTS));
        if more > 0 {
            doubts.push(format!("and {more} more of this kind"));
        }
    }
    doubts
}

fn unsure(keyframes: &[KeyframeQuality]) -> Vec<String> {
    let mut sorted: Vec<f64> = keyframes.iter().map(KeyframeQuality::sigma_m).collect();
    sort_numbers(&mut sorted);
    let median_m = sorted.get(sorted.len() / 2).copied().unwrap_or_default();
    let limit_m = (UNSURE_TIMES * median_m).max(UNSURE_M);
    let is_unsure = |number: &usize| keyframes[*number].sigma_m() > limit_m;
    let unsure: Vec<usize> = (0..keyframes.len()).filter(is_unsure).collect();
    let runs = unsure.chunk_by(|a, b| b - a == 1).map(|run| {
        let (first, last) = (run[0], run[run.len() - 1]);
        let worst_m = run.iter().map(|k| keyframes[*k].sigma_m());
        let worst_m = worst_m.fold(0.0, f64::max);
        format!(
            "keyframes {first} to {last} have a standard deviation of up to {worst_m:.2} m; the median is {median_m:.2} m"
        )
    });
    runs.collect()
}

fn contradicting(links: &[LinkQuality]) -> Vec<String> {
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

fn refuted(ways: &[RefutedWay]) -> Vec<String> {
    let mut ways = ways.to_vec();
    ways.sort_by(|a, b| b.chi2.total_cmp(&a.chi2));
    let ways = ways.iter().map(|RefutedWay { from, to, chi2 }| {
        format!(
            "the path from keyframe {from} to {to} contradicts the rest of the graph: chi-squared {chi2:.1} above {GATE_CHI2:.1}"
        )
    });
    ways.collect()
}

fn not_held(disputed: &[Disputed]) -> Vec<String> {
    let mut disputed = disputed.to_vec();
    disputed.sort_by(|a, b| b.off_m.total_cmp(&a.off_m));
    let disputed = disputed.iter().map(|disputed| {
        let Disputed { from, to, off_m, off_deg } = disputed;
        format!(
            "the loop from keyframe {from} to {to} was accepted, but the map violates it by {off_m:.2} m and {off_deg:.0}°"
        )
    });
    disputed.collect()
}

fn hardly_fitting(poor: &[PoorFit]) -> Vec<String> {
    let mut poor = poor.to_vec();
    poor.sort_by(|a, b| a.score.total_cmp(&b.score));
    let poor = poor.iter().map(|poor| {
        let (stamp_s, share) = (poor.stamp_s, 100.0 * poor.score);
        format!("only {share:.0} % of the scan at {stamp_s:.3} s fits the map")
    });
    poor.collect()
}

#[cfg(test)]
mod tests {
    use super::super::GATE_CHI2;
    use super::*;

    #[test]
    fn a_scan_that_hardly_fits_and_loops_and_ways_that_contradict_are_doubted() {
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
        let way = |from, to, chi2| RefutedWay { from, to, chi2 };
        let quality = Quality {
            keyframes: [0.02, 0.02, 0.02, 0.4, 0.5].map(keyframe).to_vec(),
            links: vec![link(3.0), link(40.0)],
            refuted_ways: vec![way(4, 5, 20.0), way(7, 11, 84.44)],
            ..Quality::default()
        };
        let taken_back = |from, off_m| Disputed {
            from,
            to: 4,
            off_m,
            off_deg: 90.4,
        };
        let poor = PoorFit {
            stamp_s: 12.5,
            score: 0.31,
        };
        let disputed = [taken_back(31, 0.5), taken_back(30, 2.345)];
        assert_eq!(
            sentences(&quality, &disputed, &[poor]),
            [
                "keyframes 3 to 4 have a standard deviation of up to 0.50 m; the median is 0.02 m",
                "the loop from keyframe 9 to 2 contradicts the rest of the graph: chi-squared 40.0 above 16.3",
                "the path from keyframe 7 to 11 contradicts the rest of the graph: chi-squared 84.4 above 16.3",
                "the path from keyframe 4 to 5 contradicts the rest of the graph: chi-squared 20.0 above 16.3",
                "the loop from keyframe 30 to 4 was accepted, but the map violates it by 2.35 m and 90°",
                "the loop from keyframe 31 to 4 was accepted, but the map violates it by 0.50 m and 90°",
                "only 31 % of the scan at 12.500 s fits the map",
            ]
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
