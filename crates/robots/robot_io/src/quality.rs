//! Reliability of a map: keyframes, loops, and a list of doubts.
//!
//! A keyframe's covariance is that of the graph relative to its first keyframe, scaled by the keyframe's inconsistency
//! ([`Slam::keyframe_covariances`]). A loop in the graph is tested against the rest of the graph. With the residual e
//! of its edge, the information Ω of its measurement and the marginal covariance P of the relative pose by the whole
//! graph including the loop, `eᵀ(Ω⁻¹ − P)⁻¹e` has three degrees of freedom. It is the squared innovation of the loop
//! against the graph without it. A step between consecutive keyframes is tested in the same way.
//!
//! Source: Cook & Weisberg, "Residuals and influence in regression", 1982, §2.1.2.

mod doubts;

pub use doubts::unsolved;

use ch16_slam2d::graph::{EdgeKind, EdgeView};
use ch16_slam2d::loops::{LoopRejection, LoopVerification};
use ch16_slam2d::slam::Slam;
use pr_geom::{Matrix3, SE2, math};
use serde::Serialize;

use crate::evidence::{PoorFit, TriedLoop};

/// Gate of a loop's χ²: the 99.9 % quantile with three degrees of freedom.
pub const GATE_CHI2: f64 = ch16_slam2d::chi_squared::GATE_999;

/// Quality of a map.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Quality {
    /// The keyframes in order.
    pub keyframes: Vec<KeyframeQuality>,
    /// The loops of the graph.
    pub links: Vec<LinkQuality>,
    /// Path segments that the rest of the graph contradicts, in order.
    #[serde(rename = "refuted_ways")]
    pub refuted_paths: Vec<RefutedPath>,
    /// The loops that were tested while scans came in.
    pub tried: Vec<LinkQuality>,
    /// What should be checked, one sentence each.
    pub doubts: Vec<String>,
}

/// A keyframe with its covariance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct KeyframeQuality {
    /// Stamp of its scan, s.
    pub stamp_s: f64,
    /// `[x, y, θ]`, `world_from_body`, m and rad.
    pub pose: [f64; 3],
    /// Covariance relative to the first keyframe in the body frame, x, y, θ: m² and rad².
    pub covariance: [[f64; 3]; 3],
}

/// Consecutive odometry edges, each of which the rest of the graph contradicts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RefutedPath {
    /// The keyframe before the first edge.
    pub from: usize,
    /// The keyframe after the last edge.
    pub to: usize,
    /// The largest squared innovation.
    pub chi2: f64,
}

/// A loop and its evidence.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LinkQuality {
    /// The newer keyframe.
    pub from: usize,
    /// The older keyframe.
    pub to: usize,
    /// Share of the newer scan that are inliers, 0 to 1.
    pub score: Option<f64>,
    /// Root mean square distance of the inliers, m; null if there are none.
    pub rmse_m: Option<f64>,
    /// Number of inliers.
    pub inliers: usize,
    /// Score margin over the best alternative pose; null if no search was done.
    pub margin: Option<f64>,
    /// Squared innovation; null if it could not be computed.
    pub chi2: Option<f64>,
    /// Gate of the squared innovation.
    pub gate_chi2: f64,
    /// Whether it is in the graph.
    pub accepted: bool,
    /// Why it is not in the graph.
    pub reason: Option<String>,
}

impl Quality {
    /// Evaluates the graph; empty if there is none.
    pub(crate) fn new(
        slam: Option<&mut Slam>,
        tried: &[TriedLoop],
        links: &[LoopVerification],
        poor: &[PoorFit],
        unsolved: Option<&LoopRejection>,
    ) -> Self {
        let Some(slam) = slam else {
            return Self::default();
        };
        let mut quality = Self {
            keyframes: keyframes(slam),
            links: Vec::new(),
            refuted_paths: Vec::new(),
            tried: tried.iter().map(LinkQuality::tried).collect(),
            doubts: Vec::new(),
        };
        let tests = edge_tests(slam);
        let closed = tried.iter().filter(|tried| tried.accepted);
        let evidence: Vec<&LoopVerification> = if links.is_empty() {
            closed.map(|tried| &tried.verification).collect()
        } else {
            links.iter().filter(|link| link.accepted()).collect()
        };
        let mut open: Vec<_> = tests.iter().collect();
        for link in evidence {
            let is_it = |test: &&(EdgeView, _)| test.0.loop_id() == Some(link.id());
            // Loops that were removed again are no links; of two between the same keyframes the first comes first.
            let Some(at) = open.iter().position(is_it) else {
                continue;
            };
            let (_, chi2) = open.remove(at);
            quality.links.push(LinkQuality {
                chi2: *chi2,
                gate_chi2: GATE_CHI2,
                ..LinkQuality::new(link, true)
            });
        }
        quality.refuted_paths = refuted_paths(&tests);
        quality.doubts = unsolved.map(doubts::unsolved).into_iter().collect();
        let others = doubts::sentences(&quality, &doubts::violated(slam, tried), poor);
        quality.doubts.extend(others);
        quality
    }

    /// Path length over the keyframes, m.
    #[must_use]
    pub fn path_length_m(&self) -> f64 {
        let steps = self.keyframes.windows(2);
        let steps = steps.map(|two| {
            let [[ax, ay, _], [bx, by, _]] = [two[0].pose, two[1].pose];
            math::norm2(bx - ax, by - ay)
        });
        steps.sum()
    }
}

impl KeyframeQuality {
    /// Standard deviation of the position along its worst direction, m.
    #[must_use]
    pub fn sigma_m(&self) -> f64 {
        self.ellipse().0
    }

    /// Half axes (m) and the heading (rad, world frame) of the position's 1σ ellipse.
    #[must_use]
    pub fn ellipse(&self) -> (f64, f64, f64) {
        let [[xx, xy, _], [_, yy, _], _] = self.covariance;
        let (mean, half) = ((xx + yy) / 2.0, (xx - yy) / 2.0);
        let radius = math::norm2(half, xy);
        let angle = math::atan2(xy, half) / 2.0;
        let axis = |variance: f64| math::sqrt(math::max(variance, 0.0));
        (
            axis(mean + radius),
            axis(mean - radius),
            self.pose[2] + angle,
        )
    }

    /// Standard deviation of the heading, degrees.
    #[must_use]
    pub fn sigma_deg(&self) -> f64 {
        math::sqrt(math::max(self.covariance[2][2], 0.0)).to_degrees()
    }
}

impl LinkQuality {
    fn new(found: &LoopVerification, accepted: bool) -> Self {
        let is_nowhere = matches!(found.rejection, Some(LoopRejection::NoPlace { .. }));
        Self {
            from: found.from_node,
            to: found.candidate.node,
            score: found.score,
            rmse_m: found.rmse_m.is_finite().then_some(found.rmse_m),
            inliers: found.inliers,
            margin: found.margin.filter(|margin| margin.is_finite()),
            // Without a pose there was no gate test.
            chi2: (found.gate.chi2.is_finite() && !is_nowhere).then_some(found.gate.chi2),
            gate_chi2: found.gate.gate_chi2,
            accepted,
            reason: found.reason(),
        }
    }

    fn tried(tried: &TriedLoop) -> Self {
        Self::new(&tried.verification, tried.accepted)
    }
}

fn keyframes(slam: &mut Slam) -> Vec<KeyframeQuality> {
    let Ok(covariances) = slam.keyframe_covariances() else {
        return Vec::new();
    };
    let posed = slam.keyframes().iter().zip(slam.graph().poses());
    posed
        .zip(&covariances)
        .map(|((keyframe, pose), covariance)| KeyframeQuality {
            stamp_s: keyframe.stamp_s,
            pose: pose.to_array(),
            covariance: core::array::from_fn(|i| core::array::from_fn(|j| covariance[(i, j)])),
        })
        .collect()
}

/// The edges of the graph, each with its squared innovation against the rest; `None` if it cannot be computed.
#[must_use]
pub fn edge_tests(slam: &mut Slam) -> Vec<(EdgeView, Option<f64>)> {
    let Ok(covariances) = slam.graph_mut().edge_covariances() else {
        return Vec::new();
    };
    let graph = slam.graph();
    let edges = graph.edges().zip(&covariances);
    edges
        .map(|(view, covariance)| {
            let relative = graph.pose(view.from).between(&graph.pose(view.to));
            let chi2 = innovation_chi2(
                &view.edge.measurement,
                &view.edge.information,
                &relative,
                covariance,
            );
            (view, chi2)
        })
        .collect()
}

/// Odometry edges beyond the gate, with consecutive ones merged.
fn refuted_paths(tests: &[(EdgeView, Option<f64>)]) -> Vec<RefutedPath> {
    let mut paths: Vec<RefutedPath> = Vec::new();
    for (view, chi2) in tests {
        let beyond = chi2.filter(|chi2| *chi2 > GATE_CHI2);
        let (EdgeKind::Odometry, Some(chi2)) = (view.edge.kind, beyond) else {
            continue;
        };
        let (from, to) = (view.from.index(), view.to.index());
        match paths.last_mut() {
            Some(path) if path.to == from => {
                path.to = to;
                path.chi2 = math::max(path.chi2, chi2);
            }
            _ => paths.push(RefutedPath { from, to, chi2 }),
        }
    }
    paths
}

/// `eᵀ(Ω⁻¹ − P)⁻¹e`; `None` if the measurement alone connects the two nodes.
fn innovation_chi2(
    measured: &SE2,
    information: &Matrix3<f64>,
    relative: &SE2,
    covariance: &Matrix3<f64>,
) -> Option<f64> {
    let residual = measured.between(relative).log();
    let left = (information.try_inverse()? - covariance).try_inverse()?;
    let chi2 = residual.dot(&(left * residual));
    (chi2.is_finite() && chi2 >= 0.0).then_some(chi2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_innovation_is_that_against_the_graph_without_the_loop() {
        // Along x: odometry says 0 ± 1, the loop says 3 ± 2. The mean is 3 · (1/4) / (1 + 1/4).
        let information = Matrix3::identity() * 0.25;
        let covariance = Matrix3::identity() / 1.25;
        let relative = SE2::from_xy(0.6, 0.0);
        let measured = SE2::from_xy(3.0, 0.0);
        let chi2 = innovation_chi2(&measured, &information, &relative, &covariance).unwrap();
        // Against the graph without the loop: 3² / (1 + 4).
        assert!((chi2 - 1.8).abs() < 1e-12, "{chi2}");
    }

    #[test]
    fn an_ellipse_has_the_axes_of_its_covariance() {
        // Axes 0.3 and 0.1 m, the long one at 30° in the body's frame, which is turned by 90°.
        let (sin, cos) = 30f64.to_radians().sin_cos();
        let (long, short) = (0.09, 0.01);
        let xy = (long - short) * sin * cos;
        let keyframe = KeyframeQuality {
            stamp_s: 0.0,
            pose: [1.0, 2.0, core::f64::consts::FRAC_PI_2],
            covariance: [
                [long * cos * cos + short * sin * sin, xy, 0.0],
                [xy, long * sin * sin + short * cos * cos, 0.0],
                [0.0, 0.0, 1e-4],
            ],
        };
        let (a, b, heading) = keyframe.ellipse();
        // 1e-12: a dozen roundings of numbers below 1.
        assert!((a - 0.3).abs() < 1e-12 && (b - 0.1).abs() < 1e-12);
        assert!((heading.to_degrees() - 120.0).abs() < 1e-9);
        assert!((keyframe.sigma_deg() - 0.01f64.to_degrees()).abs() < 1e-12);
    }
}
